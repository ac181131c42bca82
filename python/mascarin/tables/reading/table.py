"""Tables with a time column: time zone, regular steps. Every error names the line of the file."""

from __future__ import annotations

import re
from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from datetime import tzinfo
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from mascarin._io import memory
from mascarin._io.arguments import require_type
from mascarin._io.durations import seconds_of
from mascarin.errors import InputError, did_you_mean
from mascarin.tables.arrays import Array, Lines
from mascarin.tables.reading.files import file_hash, read_frame, with_time_column
from mascarin.tables.reading.layout import EMPTY
from mascarin.tables.times import epoch_seconds, stamps_of
from mascarin.tables.timezones import (
    YEARS,
    fixed_offset,
    localize,
    parse_timezone,
    zone_name,
    zone_of,
)

if TYPE_CHECKING:
    import pandas as pd

Stamps = Literal["start", "end"]
"""Which end of its interval a stamp marks."""

_HAS_OFFSET = re.compile(r"\d{1,2}:\d{2}(?::\d{2}(?:\.\d+)?)?\s*(?:Z|[+-]\d{2}:?\d{2})$")
_MIDNIGHT = re.compile(r"[T ]24:00(?::00)?$")


@dataclass(frozen=True)
class Table:
    """A table on a regular grid of times.

    Attributes
    ----------
    frame : pandas.DataFrame
        Columns as read, indexed by the stamps as written in the zone; missing rows are NaN.
    interval : float
        Step between rows [s].
    zone : datetime.tzinfo
        Time zone.
    where : str
        File name, or `table`.
    sha256 : str or None
        Hash of the file.
    lines : ndarray, shape (n,)
        Line of each row in the file; 0 for a row that was missing.
    notes : tuple of str
        What was done.
    """

    frame: pd.DataFrame
    interval: float
    zone: tzinfo
    where: str
    sha256: str | None
    lines: Lines
    notes: tuple[str, ...]

    def numbers(self, column: str, what: str) -> Array:
        """A column as numbers, NaN where empty.

        Raises
        ------
        InputError
            No such column, or an entry that is not a number.
        """
        if column not in self.frame.columns:
            names = [str(name) for name in self.frame.columns]
            hint = did_you_mean(column, names) or f"Columns: {', '.join(names[:40])}."
            raise InputError(f"{self.where}: no column {column!r} (wanted for {what}). {hint}")
        return _numbers(self.frame[column], self.lines, f"{self.where}: column {column!r}")


def read_table(
    source: str | Path | pd.DataFrame,
    *,
    timezone: str | None,
    time: str | Sequence[str] | None = None,
    time_format: str | None = None,
    separator: str | None = None,
    decimal: str | None = None,
    skip_lines: int | None = None,
    step: str | float | None = None,
    missing: Sequence[str | float] = (),
) -> Table:
    """Read a table and put it on a regular grid of times.

    Parameters
    ----------
    source : path or pandas.DataFrame
        CSV or Parquet file, or a frame with a time index or column.
    timezone : str or None
        Zone of the stamps. Required, except for a frame whose stamps have a time zone; where stamps have
        offsets, it is the zone of the result.
    time : str or list of str, optional
        Column with the stamps; several are joined by a space. Default: the first column, or the index.
    time_format : str, optional
        strptime format; default ISO 8601.
    separator : str, optional
        Default: found from the header.
    decimal : str, optional
        Decimal mark. Default: a comma where entries have commas and none has a point.
    skip_lines : int, optional
        Lines before the line with the names of the columns. Default: the names are in the last line above
        the first rows of data that is not a row of units.
    step : str or float, optional
        Expected step, such as `15min` or seconds [s]; default: found.
    missing : sequence
        Entries that mean that there is no value, beside the empty one.

    Returns
    -------
    Table
        The table; stamps unchanged.

    Raises
    ------
    InputError
        The file cannot be read, or its times cannot be used.
    """
    import pandas as pd

    require_type(
        "table",
        source,
        (str, Path, pd.DataFrame),
        "the path of a file or a pandas.DataFrame (Series.to_frame())",
    )
    zone = _zone(source, timezone, time)
    digest: str | None = None
    said: tuple[str, ...] = ()
    if isinstance(source, pd.DataFrame):
        frame, where, first_line = with_time_column(source.copy()), "table", 1
    else:
        path = Path(source)
        where = path.name
        digest = file_hash(path)
        frame, first_line, said = read_frame(path, separator, decimal, skip_lines)
    lines = first_line + np.arange(len(frame), dtype=np.int64)
    empty = frame.isna().all(axis=1).to_numpy()
    frame, lines = frame.loc[~empty], lines[~empty]
    if len(frame) < 2:
        raise InputError(f"{where}: found {len(frame)} rows, expected at least two to know the step.")
    text, used = _time_text(frame, time, where)
    frame = frame.drop(columns=used)
    if missing:
        frame = _without(frame, missing)
    stamps = _stamps(text, time_format, zone, lines, where)
    frame.index = stamps
    length = seconds_of(step, where) if step is not None else None
    return _regular(frame, zone, where, digest, lines, length, said)


def _zone(
    source: str | Path | pd.DataFrame, timezone: str | None, time: str | Sequence[str] | None
) -> tzinfo:
    """Zone that the user states, or that the stamps of a frame have."""
    where = Path(source).name if isinstance(source, str | Path) else "table"
    if timezone is None and not isinstance(source, str | Path):
        stamps = source.index if time is None and _is_time(source.index) else None
        name = time if isinstance(time, str) else source.columns[0] if len(source.columns) else None
        dtype = source.index.dtype if stamps is not None else source[name].dtype if name in source else None
        found = getattr(dtype, "tz", None)
        if found is not None:
            return zone_of(found)
    return parse_timezone(timezone, f"{where}: timezone")


def _is_time(index: pd.Index[Any]) -> bool:
    import pandas as pd

    return isinstance(index, pd.DatetimeIndex)


def _time_text(
    frame: pd.DataFrame, time: str | Sequence[str] | None, where: str
) -> tuple[pd.Series[Any], list[Hashable]]:
    names: list[Hashable]
    names = [frame.columns[0]] if time is None else [time] if isinstance(time, str) else list(time)
    for name in names:
        if name not in frame.columns:
            hint = did_you_mean(str(name), [str(column) for column in frame.columns])
            raise InputError(f"{where}: no time column {name!r}. {hint}".rstrip())
    if len(names) == 1:
        return frame[names[0]], names
    joined = frame[names[0]].astype(str)
    for name in names[1:]:
        joined = joined + " " + frame[name].astype(str)
    return joined, names


def _without(frame: pd.DataFrame, missing: Sequence[str | float]) -> pd.DataFrame:
    texts = [str(entry) for entry in missing]
    values: list[Any] = list(missing) + texts
    for text in texts:
        try:
            values.append(float(text))
        except ValueError:
            continue
    return frame.mask(frame.isin(values))


def _stamps(
    text: pd.Series[Any], time_format: str | None, zone: tzinfo, lines: Lines, where: str
) -> pd.DatetimeIndex:
    import pandas as pd

    if isinstance(text.dtype, pd.DatetimeTZDtype):
        return pd.DatetimeIndex(text).tz_convert(zone)
    if pd.api.types.is_datetime64_any_dtype(text.dtype):
        return localize(_possible(pd.DatetimeIndex(text), lines, where), zone, where)
    written = text.astype(str).str.strip()
    offset = bool(written.str.contains(_HAS_OFFSET).any())
    late = written.str.contains(_MIDNIGHT)
    written = written.where(~late, written.str.replace("24:00", "00:00", n=1, regex=False))
    parsed = pd.to_datetime(written, format=time_format or "ISO8601", errors="coerce", utc=offset)
    bad = np.flatnonzero(parsed.isna().to_numpy() | (text.isna().to_numpy()))
    numeric = time_format is None and pd.api.types.is_numeric_dtype(text.dtype)
    if len(bad) or numeric:
        row = int(bad[0]) if len(bad) else 0
        expected = f"the format {time_format!r}" if time_format else "ISO 8601 such as 2024-09-04 00:15"
        raise InputError(
            f"{where}:{lines[row]}: time {text.iloc[row]!r} cannot be read, expected {expected}; "
            "state time_format (for example '%d/%m/%Y %H:%M'), or repair the row."
        )
    index = _possible(pd.DatetimeIndex(parsed), lines, where)
    index = index + pd.to_timedelta(late.to_numpy().astype(np.int64), unit="D")
    return index.tz_convert(zone) if offset else localize(index, zone, where)


def _possible(index: pd.DatetimeIndex, lines: Lines, where: str) -> pd.DatetimeIndex:
    """Refuse years of which there are no measurements: the calendar of the computer does not reach them."""
    years = index.year.to_numpy()
    bad = np.flatnonzero((years < YEARS[0]) | (years > YEARS[1]))
    if len(bad):
        row = int(bad[0])
        raise InputError(
            f"{where}:{lines[row]}: found a time in the year {years[row]}, expected one from {YEARS[0]} to "
            f"{YEARS[1]} ({len(bad)} such rows in all); repair the row."
        )
    return index


def _regular(
    frame: pd.DataFrame,
    zone: tzinfo,
    where: str,
    digest: str | None,
    lines: Lines,
    expected: float | None,
    said: tuple[str, ...],
) -> Table:
    """Check the order and the step; insert rows that are missing; `said` are notes of the file."""
    import pandas as pd

    index = pd.DatetimeIndex(frame.index)
    seconds = epoch_seconds(index)
    gaps = np.round(np.diff(seconds), 6)
    _ordered(gaps, index, lines, where, zone)
    lengths, place, counts = np.unique(gaps, return_index=True, return_counts=True)
    commonest = np.lexsort((place, -counts))[0]  # the earlier of two that are equally common
    interval = expected if expected is not None else float(lengths[commonest])
    ratio = gaps / interval
    odd = np.flatnonzero(np.abs(ratio - np.round(ratio)) > 1e-6)
    if len(odd):
        row = int(odd[0])
        raise InputError(
            f"{where}:{lines[row + 1]}: the step from {index[row]:%Y-%m-%d %H:%M:%S} to "
            f"{index[row + 1]:%Y-%m-%d %H:%M:%S} is {gaps[row]:g} s, expected a multiple of {interval:g} s "
            f"({len(odd)} such steps in all); put the table on a regular step first."
        )
    size = float(np.round(ratio).sum()) + 1.0
    memory.require(
        size * (frame.shape[1] + 4) * 16.0,  # the table twice, stamps and lines
        f"{where}: {len(frame)} rows over {size:.3g} steps of {interval:g} s",
        "check the first and the last time, or state the step",
    )
    place = np.concatenate([[0], np.cumsum(np.round(ratio).astype(np.int64))])
    notes = [
        f"{where}: {len(frame)} rows of {_length(interval)}, {index[0]:%Y-%m-%d %H:%M} .. "
        f"{index[-1]:%Y-%m-%d %H:%M}, time zone {zone_name(zone)}."
    ]
    notes += [*said, *_clock_changes(index, where, zone), *_skipped_hour(index, gaps - interval, where, zone)]
    absent = int(place[-1]) + 1 - len(frame)
    if absent:
        row = int(np.argmax(ratio > 1.5))
        notes.append(
            f"{where}: {absent} rows are missing, the first after {index[row]:%Y-%m-%d %H:%M}; left empty."
        )
        whole = np.zeros(int(place[-1]) + 1, dtype=np.int64)
        whole[place] = lines
        grid = stamps_of(seconds[0] + interval * np.arange(len(whole)), zone)
        frame = frame.set_axis(stamps_of(seconds[0] + interval * place, zone), axis=0).reindex(grid)
        lines = whole
    return Table(frame, interval, zone, where, digest, lines, tuple(notes))


def _clock_changes(index: pd.DatetimeIndex, where: str, zone: tzinfo) -> list[str]:
    """Sentences on the changes of the clock inside a record."""
    naive = index.tz_localize(None).to_numpy()
    offset = (naive - index.tz_convert("UTC").tz_localize(None).to_numpy()) / np.timedelta64(60, "s")
    changes = [int(k) for k in np.flatnonzero(np.diff(offset))]
    return [
        f"{where}: clocks of {zone_name(zone)} go {'forward' if offset[k + 1] > offset[k] else 'back'} by "
        f"{abs(offset[k + 1] - offset[k]):g} min between {index[k]:%Y-%m-%d %H:%M} and "
        f"{index[k + 1]:%Y-%m-%d %H:%M}."
        for k in changes
    ]


def _skipped_hour(index: pd.DatetimeIndex, extra: Array, where: str, zone: tzinfo) -> list[str]:
    """A warning where a single hour is missing at the time at which clocks go forward in many zones."""
    if not fixed_offset(zone):
        return []
    # On a Sunday between midnight and 4 h, in March, April, September or October.
    found = [
        index[row]
        for row in np.flatnonzero(extra == 3600.0).tolist()
        if (stamp := index[row + 1]).weekday() == 6 and stamp.hour <= 4 and stamp.month in (3, 4, 9, 10)
    ]
    return [
        f"{where}: warning: one hour is missing after {found[0]:%Y-%m-%d %H:%M}, when clocks go forward in "
        "many "
        f"zones. If the clock of the file follows daylight saving time, {zone_name(zone)} is the wrong zone: "
        "state the zone of the place, such as Europe/Paris."
        for _ in found[:1]
    ]


def _ordered(gaps: Array, index: pd.DatetimeIndex, lines: Lines, where: str, zone: tzinfo) -> None:
    wrong = np.flatnonzero(gaps <= 0.0)
    if not len(wrong):
        return
    row = int(wrong[0])
    found = "is repeated" if gaps[row] == 0.0 else f"comes after {index[row]:%Y-%m-%d %H:%M:%S}"
    hint = "remove or sort the rows."
    if gaps[row] == -3600.0 or (gaps[row] < 0.0 and np.any(gaps == -gaps[row])):
        hint = (
            f"if the clock of the file follows daylight saving time, {zone_name(zone)} is the wrong "
            "zone: state the zone of the place, such as Europe/Paris, where the rows of the doubled hour are "
            "taken in order; otherwise remove or sort the rows."
        )
    raise InputError(
        f"{where}:{lines[row + 1]}: time {index[row + 1]:%Y-%m-%d %H:%M:%S} {found}, expected increasing "
        f"times ({len(wrong)} such rows in all); {hint}"
    )


def _length(seconds: float) -> str:
    for unit, name in ((86400.0, "d"), (3600.0, "h"), (60.0, "min")):
        if seconds >= unit and (seconds / unit).is_integer():
            return f"{seconds / unit:g} {name}"
    return f"{seconds:g} s"


def _numbers(series: pd.Series[Any], lines: Lines, where: str) -> Array:
    import pandas as pd

    if pd.api.types.is_numeric_dtype(series.dtype):
        values = series.to_numpy(dtype=np.float64, na_value=np.nan).copy()
    else:
        values = pd.to_numeric(series, errors="coerce").to_numpy(dtype=np.float64, na_value=np.nan).copy()
        text = series.astype(str).str.strip()
        blank = series.isna().to_numpy() | text.str.lower().isin(EMPTY).to_numpy()
        bad = np.flatnonzero(np.isnan(values) & ~blank)
        if len(bad):
            row = int(bad[0])
            raise InputError(
                f"{where}, line {lines[row]}: found {text.iloc[row]!r}, expected a number ({len(bad)} "
                "such entries); repair it, or name it in `missing` (and state `decimal` if the mark is a "
                "comma)."
            )
    infinite = np.flatnonzero(np.isinf(values))
    if len(infinite):
        raise InputError(
            f"{where}, line {lines[int(infinite[0])]}: found an infinite value, expected a number."
        )
    return values

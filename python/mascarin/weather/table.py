"""Tables with a time column: reading, time zone, regular steps. Every complaint names the line."""

from __future__ import annotations

import hashlib
import re
import warnings
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from datetime import tzinfo
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np

from mascarin.errors import InputError, did_you_mean
from mascarin.weather.arrays import Array, Lines
from mascarin.weather.timezones import localise, parse_timezone, zone_name

if TYPE_CHECKING:
    import pandas as pd

Stamps = Literal["start", "end"]

_HAS_OFFSET = re.compile(r"\d{1,2}:\d{2}(?::\d{2}(?:\.\d+)?)?\s*(?:Z|[+-]\d{2}:?\d{2})$")
_MIDNIGHT = re.compile(r"[T ]24:00(?::00)?$")
_EMPTY = frozenset({"", "na", "nan", "n/a", "null", "none", "-", "--"})

FACTORS: Mapping[str, tuple[str, float, float]] = {
    # unit as written: (unit taken, factor, offset)
    "degC": ("degC", 1.0, 0.0),
    "K": ("degC", 1.0, -273.15),
    "degF": ("degC", 5.0 / 9.0, -160.0 / 9.0),
    "W/m2": ("W/m2", 1.0, 0.0),
    "kW/m2": ("W/m2", 1000.0, 0.0),
    "m/s": ("m/s", 1.0, 0.0),
    "km/h": ("m/s", 1.0 / 3.6, 0.0),
    "knot": ("m/s", 1852.0 / 3600.0, 0.0),
    "Pa": ("Pa", 1.0, 0.0),
    "hPa": ("Pa", 100.0, 0.0),
    "mbar": ("Pa", 100.0, 0.0),
    "kPa": ("Pa", 1000.0, 0.0),
    "%": ("%", 1.0, 0.0),
    "1": ("%", 100.0, 0.0),
    "tenths": ("tenths", 1.0, 0.0),
    "oktas": ("tenths", 1.25, 0.0),
    "deg": ("deg", 1.0, 0.0),
}
"""Units that a column may be in, with what they are turned into."""

ENERGIES: Mapping[str, float] = {
    "J/cm2": 1e4,
    "J/m2": 1.0,
    "kJ/m2": 1e3,
    "MJ/m2": 1e6,
    "Wh/m2": 3600.0,
    "kWh/m2": 3.6e6,
}
"""Energies per interval, in J/m2: divided by the interval they become W/m2."""


_SECONDS: Final = {
    **dict.fromkeys(("s", "sec", "second", "seconds"), 1.0),
    **dict.fromkeys(("min", "minute", "minutes"), 60.0),
    **dict.fromkeys(("h", "hour", "hours"), 3600.0),
    **dict.fromkeys(("d", "day", "days"), 86400.0),
}
"""Units of a length of time."""

_TIMES: Final = "a positive time such as 900, 15min or 1h"

_LENGTH_OF_TIME: Final = re.compile(rf"(\d+\.?\d*(?:e[+-]?\d+)?)\s*({'|'.join(_SECONDS)})?", re.IGNORECASE)


@dataclass(frozen=True)
class Column:
    """Where a quantity stands in a table.

    Attributes
    ----------
    column : str
        Name of the column.
    unit : str, optional
        Unit in the file (a key of `FACTORS` or `ENERGIES`); without one the quantity's own unit.
    scale, offset : float
        Applied after the unit: value = scale x + offset.
    kind : str, optional
        `instant` or `mean`; without one the quantity's usual kind.
    """

    column: str
    unit: str | None = None
    scale: float = 1.0
    offset: float = 0.0
    kind: Literal["instant", "mean"] | None = None

    @classmethod
    def of(cls, given: object, where: str) -> Column:
        """Column from its short form (a name) or a mapping with the attributes as keys."""
        if isinstance(given, Column):
            return given
        if isinstance(given, str):
            return cls(given)
        if isinstance(given, Mapping):
            unknown = set(given) - {"column", "unit", "scale", "offset", "kind"}
            if unknown or "column" not in given:
                raise InputError(
                    f"{where}: found {dict(given)!r}, expected a column's name or a mapping with "
                    "'column' and "
                    "optionally 'unit', 'scale', 'offset', 'kind'."
                )
            kind = given.get("kind")
            if kind not in (None, "instant", "mean"):
                raise InputError(f"{where}: kind is {kind!r}, expected 'instant' or 'mean'.")
            scale, offset = float(given.get("scale", 1.0)), float(given.get("offset", 0.0))
            return cls(str(given["column"]), given.get("unit"), scale, offset, kind)
        raise InputError(f"{where}: found {given!r}, expected a column's name or a mapping with 'column'.")

    def convert(self, values: Array, unit: str, interval: float, where: str) -> Array:
        """Values in the wanted unit.

        Parameters
        ----------
        values : ndarray, shape (n,)
            As read.
        unit : str
            Wanted unit.
        interval : float
            Length of an interval, for energies [s].
        where : str
            For the error.

        Raises
        ------
        InputError
            The column's unit cannot be turned into the wanted one.
        """
        if self.unit is not None:
            if self.unit in ENERGIES and unit == "W/m2":
                values = values * (ENERGIES[self.unit] / interval)
            elif self.unit in FACTORS and (not unit or FACTORS[self.unit][0] == unit):
                _, factor, offset = FACTORS[self.unit]
                values = values * factor + offset
            elif self.unit != unit:
                known = [name for name, entry in FACTORS.items() if entry[0] == unit]
                known += list(ENERGIES) if unit == "W/m2" else []
                raise InputError(
                    f"{where}: unit {self.unit!r} of column {self.column!r} cannot be turned into "
                    f"{unit}; expected "
                    f"one of {', '.join(known)}, or give scale and offset instead."
                )
        return values * self.scale + self.offset

    def sentence(self, name: str, unit: str) -> str:
        """What was done, for the provenance; empty where nothing was."""
        parts = []
        if self.unit is not None and self.unit != unit:
            parts.append(f"{self.unit} to {unit}")
        if self.scale != 1.0 or self.offset != 0.0:
            parts.append(f"times {self.scale:g} plus {self.offset:g}")
        return f"{name}: column {self.column!r} converted, {', '.join(parts)}." if parts else ""


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
    decimal: str = ".",
    skip_lines: int = 0,
    step: str | float | None = None,
    missing: Sequence[str | float] = (),
) -> Table:
    """Read a table and put it on a regular grid of times.

    Parameters
    ----------
    source : path or pandas.DataFrame
        CSV or Parquet file, or a frame with a time index or column.
    timezone : str
        Zone of the stamps; required, also where the stamps carry offsets (it is then the zone to show).
    time : str or list of str, optional
        Column with the stamps; several are joined by a space. Default: the first column, or the index.
    time_format : str, optional
        strptime format; default ISO 8601.
    separator : str, optional
        Default: found from the header.
    decimal : str
        Decimal mark.
    skip_lines : int
        Lines before the header.
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

    zone = parse_timezone(timezone, _name(source) + ": timezone")
    digest: str | None = None
    if isinstance(source, pd.DataFrame):
        frame, where, first_line = _indexed(source.copy()), "table", 1
    else:
        path = Path(source)
        where = path.name
        digest = file_hash(path)
        frame, first_line = _read(path, separator, decimal, skip_lines)
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
    return _regular(frame, zone, where, digest, lines, seconds_of(step, where) if step is not None else None)


def file_hash(path: Path) -> str:
    """SHA-256 of a file, in hexadecimal.

    Raises
    ------
    InputError
        There is no such file.
    """
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except FileNotFoundError as error:
        raise InputError(f"{path}: no such file; give the path from the folder you work in.") from error
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}).") from error


def seconds_of(step: str | float, where: str = "step") -> float:
    """Length of a step.

    Parameters
    ----------
    step : str or float
        Text such as `15min`, `1h`, `90s`, `3d`, or a number of seconds [s].
    where : str
        What the length belongs to, for the error.

    Returns
    -------
    float
        Length [s].

    Raises
    ------
    InputError
        No positive length can be read.
    """
    match = _LENGTH_OF_TIME.fullmatch(str(step).strip())
    if match is None or isinstance(step, bool):
        raise InputError(f"{where}: found {step!r}; expected {_TIMES}")
    seconds = float(match[1]) * _SECONDS[(match[2] or "s").lower()]
    if not 0.0 < seconds < float("inf"):
        raise InputError(f"{where}: found {step!r}; expected {_TIMES}")
    return seconds


def epoch_seconds(index: pd.DatetimeIndex) -> Array:
    """Seconds since 1970-01-01 UTC of stamps with a zone, shape (n,) [s]."""
    moments = index.tz_convert("UTC").tz_localize(None).to_numpy()
    return np.asarray((moments - np.datetime64(0, "s")) / np.timedelta64(1, "us") * 1e-6, dtype=np.float64)


def stamps_of(seconds: Array, zone: tzinfo) -> pd.DatetimeIndex:
    """Stamps in a zone from seconds since 1970-01-01 UTC [s]."""
    import pandas as pd

    moments = np.round(np.asarray(seconds) * 1e6).astype(np.int64).astype("datetime64[us]")
    return pd.DatetimeIndex(moments).tz_localize("UTC").tz_convert(zone)


def _name(source: object) -> str:
    return Path(source).name if isinstance(source, str | Path) else "table"


def _indexed(frame: pd.DataFrame) -> pd.DataFrame:
    """A time index becomes the first column."""
    import pandas as pd

    if isinstance(frame.index, pd.DatetimeIndex):
        name = "time" if frame.index.name is None else str(frame.index.name)
        frame.insert(0, name, frame.index, allow_duplicates=True)
    return frame.reset_index(drop=True)


def _read(path: Path, separator: str | None, decimal: str, skip_lines: int) -> tuple[pd.DataFrame, int]:
    import pandas as pd

    if path.suffix.lower() in {".parquet", ".pq"}:
        try:
            return _indexed(pd.read_parquet(path)), 1
        except ImportError as error:
            raise InputError(
                f"{path.name}: reading Parquet needs pyarrow: install mascarin[parquet]."
            ) from error
        except (ValueError, OSError) as error:
            raise InputError(f"{path.name}: cannot be read as Parquet: {error}") from error
    found = separator or _separator(path, skip_lines)
    try:
        with warnings.catch_warnings():
            # Rows with more entries than the header has names: which name they belong to is not known.
            warnings.simplefilter("error", pd.errors.ParserWarning)
            frame = pd.read_csv(
                path,
                sep=found,
                decimal=decimal,
                skiprows=skip_lines,
                skip_blank_lines=False,
                skipinitialspace=True,
                encoding="utf-8-sig",
                low_memory=False,
                index_col=False,
            )
    except pd.errors.ParserWarning as error:
        raise InputError(
            f"{path.name}:{skip_lines + 2}: the row has more entries than the header has names; name "
            "every column."
        ) from error
    except (pd.errors.ParserError, pd.errors.EmptyDataError, UnicodeDecodeError, ValueError) as error:
        raise InputError(
            f"{path.name}: cannot be read as a table separated by {found!r}: {error}".strip()
        ) from error
    frame.columns = pd.Index([str(name).strip() for name in frame.columns])
    _refuse_cut(path, found, len(frame.columns), skip_lines + 1 + len(frame))
    return frame, skip_lines + 2


def _refuse_cut(path: Path, separator: str, fields: int, line: int) -> None:
    """A last line without end and with fewer entries than the header is what is left of a longer file."""
    with path.open("rb") as file:
        file.seek(max(0, path.stat().st_size - 65536))
        last = file.read().decode("utf-8", errors="replace").rsplit("\n", 1)[-1]
    count = last.count(separator) + 1
    if last.strip() and count < fields:
        raise InputError(
            f"{path.name}:{line}: the last line has {count} of {fields} entries and no end: the file is "
            "cut; get it "
            "whole, or remove that line."
        )


def _separator(path: Path, skip_lines: int) -> str:
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        for _ in range(skip_lines):
            file.readline()
        header = file.readline()
    counts = {mark: header.count(mark) for mark in (";", "\t", ",", "|")}
    best = max(counts, key=lambda mark: counts[mark])
    if counts[best] == 0:
        raise InputError(
            f"{path.name}: no separator found in the header {header.strip()[:40]!r}, expected the names of "
            "columns; state separator, or skip_lines if the header stands further down."
        )
    return best


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
        return localise(pd.DatetimeIndex(text), zone, where)
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
    index = pd.DatetimeIndex(parsed) + pd.to_timedelta(late.to_numpy().astype(np.int64), unit="D")
    return index.tz_convert(zone) if offset else localise(index, zone, where)


def _regular(
    frame: pd.DataFrame,
    zone: tzinfo,
    where: str,
    digest: str | None,
    lines: Lines,
    expected: float | None,
) -> Table:
    """Check the order and the step; insert rows that are missing."""
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
    place = np.concatenate([[0], np.cumsum(np.round(ratio).astype(np.int64))])
    notes = [
        f"{where}: {len(frame)} rows of {_length(interval)}, {index[0]:%Y-%m-%d %H:%M} .. "
        f"{index[-1]:%Y-%m-%d %H:%M}, time zone {zone_name(zone)}."
    ]
    notes += _clock_changes(index, where, zone)
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
            "zone: write the "
            "stamps with their offset, as in 2024-10-27T02:00+01:00; otherwise remove or sort the rows."
        )
    raise InputError(
        f"{where}:{lines[row + 1]}: time {index[row + 1]:%Y-%m-%d %H:%M:%S} {found}, expected "
        "increasing times "
        f"({len(wrong)} such rows in all); {hint}"
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
        blank = series.isna().to_numpy() | text.str.lower().isin(_EMPTY).to_numpy()
        bad = np.flatnonzero(np.isnan(values) & ~blank)
        if len(bad):
            row = int(bad[0])
            raise InputError(
                f"{where}, line {lines[row]}: found {text.iloc[row]!r}, expected a number ({len(bad)} "
                "such entries); "
                "repair it, or name it in `missing` (and state `decimal` if the mark is a comma)."
            )
    infinite = np.flatnonzero(np.isinf(values))
    if len(infinite):
        raise InputError(
            f"{where}, line {lines[int(infinite[0])]}: found an infinite value, expected a number."
        )
    return values

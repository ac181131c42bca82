"""Tables with a time column: time zone, regular steps. Every error names the line of the file."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import tzinfo
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np

from mascarin._io import memory
from mascarin._io.arguments import require_type
from mascarin._io.durations import seconds_of, shift_of
from mascarin.errors import InputError, did_you_mean
from mascarin.tables.arrays import Array, Flags, Lines
from mascarin.tables.reading.files import Read, content_of, read_frame, with_time_column
from mascarin.tables.reading.numbers import EMPTY, parse_numbers, points_as_degrees
from mascarin.tables.reading.order import (
    clock_changes,
    first_to_last,
    require_order,
    skipped_hour,
    with_missing_rows,
)
from mascarin.tables.reading.rows import has_words, rows_with_values, without_entries
from mascarin.tables.reading.units_of_entries import without_units
from mascarin.tables.stamps.clocks import offset_in_name, on_grid, require_zone_has, stamps_from
from mascarin.tables.stamps.time_columns import parts_of_time, time_text
from mascarin.tables.times import epoch_seconds, stamps_of
from mascarin.tables.timezones import (
    fixed_zone,
    parse_timezone,
    zone_name,
    zone_of,
)
from mascarin.tables.units import StatedUnit, parse_unit, same_unit, unit_in_name

if TYPE_CHECKING:
    import pandas as pd

Stamps = Literal["start", "end"]
"""Which end of its interval a stamp marks."""

#: Stamps of PVGIS (Joint Research Centre, user manual of PVGIS 5.3): the time of the satellite's image.
_PVGIS: Final = re.compile(r"\d{8}:\d{4}")
_IN_NAME: Final = "the name of the column"
#: Jitter of a clock that is allowed, as a part of the step.
_JITTER: Final = 0.1


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
    units : mapping of str to str
        Entries of the row of units, by the name of the column.
    units_line : int
        Line of that row.
    decimal : str
        Decimal mark of the file.
    decimal_stated : bool
        Whether the user states it.
    decimal_evident : bool
        Whether entries of the file can have this one alone.
    of_pvgis : bool
        Whether the stamps have the form of PVGIS, whose irradiances are values at the stamp (such as 00:10).
    preamble_units : mapping of str to (str, int)
        Units that lines above the names state, and their lines.
    entry_units : mapping of str to str
        Units behind the numbers, or in a column beside them.
    """

    frame: pd.DataFrame
    interval: float
    zone: tzinfo
    where: str
    sha256: str | None
    lines: Lines
    notes: tuple[str, ...]
    units: Mapping[str, str] = field(default_factory=dict)
    units_line: int = 0
    decimal: str = "."
    decimal_stated: bool = False
    decimal_evident: bool = False
    of_pvgis: bool = False
    preamble_units: Mapping[str, tuple[str, int]] = field(default_factory=dict)
    entry_units: Mapping[str, str] = field(default_factory=dict)

    @property
    def names(self) -> list[str]:
        """Names of the columns, without that of the time."""
        return [str(name) for name in self.frame.columns]

    @property
    def words(self) -> list[str]:
        """Columns that hold words alone."""
        return [name for name in self.names if self.frame.columns.is_unique and has_words(self.frame[name])]

    @property
    def numeric(self) -> list[str]:
        """All other columns."""
        words = set(self.words)
        return [name for name in self.names if name not in words]

    def stated_unit(self, column: str) -> StatedUnit | None:
        """Unit of a column by the row of units or by its name; None where there is none.

        Raises
        ------
        InputError
            The two contradict each other.
        """
        units = self._statements(column)
        for other in units[1:]:
            if not same_unit(units[0].unit, other.unit):
                says = (
                    f"whose name says {other.text!r}"
                    if other.place == _IN_NAME
                    else (f"for which {other.place} says {other.text!r}")
                )
                line = f":{self.units_line}" if self.units_line and column in self.units else ""
                raise InputError(
                    f"{self.where}{line}: {units[0].place.split(' (line')[0]} has {units[0].text!r} for the "
                    f"column {column!r}, {says}; expected the same. State the right one: "
                    f"{{column: {column!r}, unit: {other.unit!r}, overrule: true}}."
                )
        return units[0] if units else None

    def _statements(self, column: str) -> list[StatedUnit]:
        """All that the file says of the unit of a column: row of units, entries, name, lines above."""
        statements = []
        spot = f"the row of units (line {self.units_line})" if self.units_line else "the file"
        texts = [(self.units.get(column, ""), spot), (self.entry_units.get(column, ""), "each entry")]
        for text, location in texts:
            unit = parse_unit(text)
            if unit is not None:
                statements.append(StatedUnit(unit, text, location))
        name = unit_in_name(column, self.names)
        if name is not None:
            statements.append(StatedUnit(*name, _IN_NAME))
        if column in self.preamble_units:
            words, line = self.preamble_units[column]
            statements.append(StatedUnit(str(parse_unit(words)), words, f"line {line} above the names"))
        return statements

    def empty_words(self, column: str) -> dict[str, int]:
        """How often each word for no value stands in a column; empty entries are not counted."""
        import pandas as pd

        entries = self.frame[column]
        if pd.api.types.is_numeric_dtype(entries.dtype):
            return {}
        words = entries.dropna().astype(str).str.strip()
        counts = words[words.str.lower().isin(EMPTY) & (words != "")].value_counts()
        return {str(word): int(count) for word, count in counts.items()}

    def numbers(self, column: str, what: str, *, compass: bool = False) -> Array:
        """A column as numbers, NaN where empty; with `compass`, points such as NNE are directions. [deg]

        Raises
        ------
        InputError
            No such column, or an entry that is not a number.
        """
        if column not in self.frame.columns:
            names = [str(name) for name in self.frame.columns]
            hint = did_you_mean(column, names) or f"Columns: {', '.join(names[:40])}."
            raise InputError(
                f"{self.where}: no column {column!r} (wanted for {what}). {hint} Expected the name of a "
                "column of the file."
            )
        location = f"{self.where}: column {column!r}"
        entries = self.frame[column]
        return parse_numbers(
            points_as_degrees(entries) if compass else entries,
            self.decimal,
            self.lines,
            location,
            stated=self.decimal_stated,
            evident=self.decimal_evident,
        )


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
    tolerance: str | float | None = None,
    shift: str | float | None = None,
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
    tolerance : str or float, optional
        Largest deviation of a stamp from the regular grid, to which it is moved, such as `30s` or seconds
        [s]. Default: a tenth of the step.
    shift : str or float, optional
        Added to every stamp, such as `-30min` where the clock of the logger was half an hour fast. [s]

    Returns
    -------
    Table
        The table; stamps unchanged but for `shift`.

    Raises
    ------
    InputError
        The file cannot be read, or its times cannot be used.
    """
    import pandas as pd

    expected = "the path of a file or a pandas.DataFrame (Series.to_frame())"
    require_type("table", source, (str, Path, pd.DataFrame), expected)
    zone = _zone(source, timezone, time)
    digest: str | None = None
    read: Read | None = None
    said: tuple[str, ...] = ()
    if isinstance(source, pd.DataFrame):
        frame, where = with_time_column(source.copy()), "table"
    else:
        path, where = Path(source), Path(source).name
        content = content_of(path)
        digest = hashlib.sha256(content).hexdigest()
        dated = None if time_format is not None else "" if time is None else time
        named = dated if isinstance(dated, str) else None
        read = read_frame(path, content, separator, decimal, skip_lines, named)
        del content
        frame, said = read.frame, read.notes
    frame, of_entries = without_units(frame, where)
    lines = read.lines if read is not None else 1 + np.arange(len(frame), dtype=np.int64)
    empty = _empty_rows(frame)
    if empty.any():
        frame, lines = frame.loc[~empty], lines[~empty]
    _require_two(frame, "rows", where)
    if time is None and time_format is None and (parts := parts_of_time(frame)):
        time, time_format = parts
    text, used = time_text(frame, time, where)
    frame = frame.drop(columns=used)
    frame = without_entries(frame, missing) if missing else frame
    text, frame, lines, dropped = rows_with_values(text, frame, lines, where)
    _require_two(frame, "rows with values", where)
    stated = read.clock if read is not None else ("", 0)
    zone, clock, of_zone = _clock(used, text, zone, where, stated)
    frame.index, notes = stamps_from(text, time_format, zone, clock, lines, where)
    frame, lines, turned = first_to_last(frame, lines, where)
    said = (*said, *turned, *of_zone, *dropped, *(f"{where}: {note}" for note in notes))
    frame.index, said = _shifted(pd.DatetimeIndex(frame.index), shift, zone, where, said)
    length = seconds_of(step, where) if step is not None else None
    allowed = seconds_of(tolerance, f"{where}: tolerance") if tolerance is not None else None
    table = _regular(frame, zone, where, digest, lines, length, allowed, said)
    if _PVGIS.fullmatch(str(text.iloc[0])):
        note = f"{where}: stamps of PVGIS: irradiances are values at the stamp."
        table = replace(table, of_pvgis=True, notes=(*table.notes, note))
    table = table if read is None else replace(table, **read.said_of_itself)
    return replace(table, entry_units=of_entries)


def _require_two(frame: pd.DataFrame, rows: str, where: str) -> None:
    if len(frame) < 2:
        raise InputError(
            f"{where}: found {len(frame)} {rows}, expected at least two to know the step: get the whole file."
        )


def _shifted(
    index: pd.DatetimeIndex, shift: str | float | None, zone: tzinfo, where: str, said: tuple[str, ...]
) -> tuple[pd.DatetimeIndex, tuple[str, ...]]:
    """Stamps of a clock that the user corrects, and the notes with that."""
    moved = 0.0 if shift is None else shift_of(shift, f"{where}: shift")
    if not moved:
        return index, said
    note = f"{where}: {moved / 60.0:+g} min were added to every stamp, as stated (shift)."
    return stamps_of(epoch_seconds(index) + moved, zone), (*said, note)


def _empty_rows(frame: pd.DataFrame) -> Flags:
    """Which rows have no entry at all; most tables have a column without a gap, which settles it."""
    empty = np.ones(len(frame), dtype=bool)
    for k in range(frame.shape[1] - 1, -1, -1):  # the times, which are texts, last
        if not empty.any():
            break
        empty &= frame.iloc[:, k].isna().to_numpy()
    return empty


def _zone(
    source: str | Path | pd.DataFrame, timezone: str | None, time: str | Sequence[str] | None
) -> tzinfo | None:
    """Zone that the user states, or that the stamps of a frame have; None where neither says."""
    where = Path(source).name if isinstance(source, str | Path) else "table"
    if timezone is None and not isinstance(source, str | Path):
        stamps = source.index if time is None and _is_time(source.index) else None
        name = time if isinstance(time, str) else source.columns[0] if len(source.columns) else None
        dtype = source.index.dtype if stamps is not None else source[name].dtype if name in source else None
        stamp_zone = getattr(dtype, "tz", None)
        if stamp_zone is not None:
            return zone_of(stamp_zone)
    return None if timezone is None else parse_timezone(timezone, f"{where}: timezone")


def _is_time(index: pd.Index[Any]) -> bool:
    import pandas as pd

    return isinstance(index, pd.DatetimeIndex)


def _clock(
    names: Sequence[Hashable],
    text: pd.Series[Any],
    zone: tzinfo | None,
    where: str,
    preamble: tuple[str, int],
) -> tuple[tzinfo, tzinfo, tuple[str, ...]]:
    """Zone of the result and zone of the stamps: that which the time column or a line above it states."""
    stated = [hours for name in names if (hours := offset_in_name(str(name))) is not None]
    said = f"the time column {str(names[0])!r} states"
    if not stated and preamble[0]:
        stated = [hours for hours in (offset_in_name(preamble[0]),) if hours is not None]
        said = f"line {preamble[1]}, {preamble[0]!r}, states"
    if not stated:
        if zone is None:
            zone = parse_timezone(None, f"{where}: timezone")
        return zone, zone, ()
    clock = fixed_zone(stated[0])
    if zone is None:
        return clock, clock, (f"{where}: {said} {zone_name(clock)}.",)
    years = sorted(set(re.findall(r"\b(?:19|20)\d{2}\b", f"{text.iloc[0]} {text.iloc[-1]}"))) or ["2024"]
    if stated[0] != 0.0:  # UTC is a clock of its own, which no zone of a place contradicts
        require_zone_has(
            zone, stated[0], (int(years[0]), int(years[-1])), said.removesuffix(" states"), where
        )
    note = f"{where}: {said} {zone_name(clock)}: its stamps were turned into the clock of {zone_name(zone)}."
    return zone, clock, () if zone_name(zone) == zone_name(clock) else (note,)


def _regular(
    frame: pd.DataFrame,
    zone: tzinfo,
    where: str,
    digest: str | None,
    lines: Lines,
    expected: float | None,
    tolerance: float | None,
    said: tuple[str, ...],
) -> Table:
    """Check the order and the step; insert rows that are missing; `said` are notes of the file."""
    import pandas as pd

    index = pd.DatetimeIndex(frame.index)
    gaps = _steps(index)
    require_order(frame, gaps, index, lines, where, zone)
    interval = expected if expected is not None else _commonest(gaps)
    deviating, ratio, odd = _deviating(gaps, interval)
    start = float(epoch_seconds(index[:1])[0])
    moved = _without_jitter(epoch_seconds(index), expected, interval, tolerance) if len(odd) else None
    if moved is not None:
        seconds, interval, text = moved
        said, index, gaps = (*said, f"{where}: {text}"), stamps_of(seconds, zone), np.diff(seconds)
        deviating, ratio, _ = _deviating(gaps, interval)
        start, odd = float(seconds[0]), odd[:0]
    if len(odd):
        row = int(odd[0])
        raise InputError(
            f"{where}:{lines[row + 1]}: the step from {index[row]:%Y-%m-%d %H:%M:%S} to "
            f"{index[row + 1]:%Y-%m-%d %H:%M:%S} is {gaps[row]:g} s, expected a multiple of {interval:g} s "
            f"({len(odd)} such steps in all); state a larger tolerance (tolerance: 30s; by default a tenth "
            "of the step) if the clock is not exact, or put the table on a regular step first."
        )
    size = float(np.round(ratio).sum()) + len(gaps) - len(deviating) + 1.0
    memory.require(
        size * (frame.shape[1] + 4) * 16.0,  # the table twice, stamps and lines
        f"{where}: {len(frame)} rows over {size:.3g} steps of {interval:g} s",
        "check the first and the last time, or state the step",
    )
    notes = [
        f"{where}: {len(frame)} rows of {_length(interval)}, {index[0]:%Y-%m-%d %H:%M} .. "
        f"{index[-1]:%Y-%m-%d %H:%M}, time zone {zone_name(zone)}."
    ]
    extra = gaps - interval if len(deviating) else deviating.astype(np.float64)
    notes += [*said, *clock_changes(index, where, zone), *skipped_hour(index, extra, where, zone)]
    absent = int(size) - len(frame)
    if absent:
        row = int(deviating[np.argmax(ratio > 1.5)])
        notes.append(
            f"{where}: {absent} rows are missing, the first after {index[row]:%Y-%m-%d %H:%M}; left empty."
        )
        times = stamps_of(start + interval * np.arange(int(size)), zone)
        frame, lines = with_missing_rows(frame, lines, (deviating + 1, np.round(ratio)), times)
    if moved is not None and not absent:
        frame = frame.set_axis(index, axis=0)
    return Table(frame, interval, zone, where, digest, lines, tuple(notes))


def _steps(index: pd.DatetimeIndex) -> Array:
    """Steps between stamps, to the microsecond, shape (n - 1,). [s]"""
    steps = np.diff(index.asi8) / _IN_A_SECOND[index.unit]
    return np.round(steps, 6) if index.unit == "ns" else steps


def _deviating(gaps: Array, interval: float) -> tuple[Lines, Array, Lines]:
    """Rows before another step than the usual one, their ratio to it [-], and those of no whole ratio."""
    deviating = np.flatnonzero(gaps != interval)
    ratio = gaps[deviating] / interval
    return deviating, ratio, deviating[np.abs(ratio - np.round(ratio)) > 1e-6]


#: Units of stamps in a second.
_IN_A_SECOND: Final = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}


def _commonest(gaps: Array) -> float:
    """The commonest step, of two that are equally common the earlier one. [s]"""
    likely = float(np.median(gaps[:_FIRST]))
    if 2 * np.count_nonzero(gaps == likely) > len(gaps):
        return likely
    lengths, first_rows, counts = np.unique(gaps, return_index=True, return_counts=True)
    return float(lengths[np.lexsort((first_rows, -counts))[0]])


#: Steps that suggest the commonest one, so that those of a long record need not be sorted.
_FIRST: Final = 1000


def _without_jitter(
    seconds: Array, expected: float | None, interval: float, tolerance: float | None
) -> tuple[Array, float, str] | None:
    """Stamps on the grid from which the clock deviates a little, the step, and a sentence."""
    middle = float(np.median(np.diff(seconds)))
    steps = (
        [expected] if expected is not None else [60.0 * round(middle / 60.0), float(round(middle)), interval]
    )
    for step in steps:
        if step > 0.0:
            aligned = on_grid(seconds, step, _JITTER * step if tolerance is None else tolerance)
            if aligned is not None:
                said = f"stamps were moved to the grid of {_length(step)}, by {aligned[1]:g} s at most."
                return aligned[0], step, said
    return None


def _length(seconds: float) -> str:
    for unit, name in ((86400.0, "d"), (3600.0, "h"), (60.0, "min")):
        if seconds >= unit and (seconds / unit).is_integer():
            return f"{seconds / unit:g} {name}"
    return f"{seconds:g} s"

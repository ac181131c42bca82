"""Values of a period that cannot be used: missing values and impossible values."""

from __future__ import annotations

from typing import Final

import numpy as np

from mascarin._io.limits import above, below
from mascarin.errors import InputError
from mascarin.tables.arrays import Array, Flags, Lines
from mascarin.tables.grid import values_in
from mascarin.tables.record import Record
from mascarin.tables.times import stamps_of

_UNIT_HINTS: Final = {
    "degC": "unit: K or unit: degF",
    "tenths": "unit: oktas, or scale: 0.1 for %",
    "W/m2": "unit: kW/m2, or an energy of each interval such as unit: J/cm2",
    "m/s": "unit: km/h or unit: knot",
    "Pa": "unit: hPa or unit: kPa",
}
"""What to write for a column in another unit than the channel."""


def require_values(
    record: Record,
    name: str,
    start: float,
    rows: Lines,
    gaps: Flags,
    first: float,
    last: float,
) -> None:
    """Refuse missing values that are needed over a span of time.

    Parameters
    ----------
    record : Record
        Where the column is.
    name : str
        Column.
    start : float
        Start of the first row, seconds since 1970-01-01 UTC [s].
    rows : ndarray, shape (k + 1,)
        From `Grid.rows`.
    gaps : ndarray of bool, shape (k + 1,) or (k,)
        Where the column has no value.
    first, last : float
        Span, seconds since 1970-01-01 UTC [s].

    Raises
    ------
    InputError
        A value is missing; the text names file, line, column and time.
    """
    bad = np.flatnonzero(gaps & _needed(record, name, start, len(gaps), first, last))
    if not len(bad):
        return
    raise InputError(
        f"{_where(record, name, int(rows[bad[0]]))}: {name} has no value (NaN) at "
        f"{_shown(record, start, bad)}, expected a number at every time of the period; choose a period "
        f"without gaps, or repair the file{_filling(record)}."
    )


def require_range(
    record: Record, name: str, limits: tuple[float, float], first: float, last: float, unit: str = ""
) -> None:
    """Refuse impossible values that are needed over a span of time.

    Parameters
    ----------
    record : Record
        Where the column is.
    name : str
        Column.
    limits : (float, float)
        Lowest and highest possible value [unit of the column].
    first, last : float
        Span, seconds since 1970-01-01 UTC [s].
    unit : str
        Unit of the column; empty where it has none.

    Raises
    ------
    InputError
        A value is outside the limits; the text names file, line, column, time and value.
    """
    kind = record.kinds[name]
    low, high = limits
    start, rows = record.grid.rows(first, last)
    data = record.columns[name]
    values = values_in(data, record.closing.get(name, np.nan), rows, kind)
    # Comparisons with NaN are False: missing values are refused by `require_values`.
    outside = below(values, low) | above(values, high)
    bad = np.flatnonzero(outside & _needed(record, name, start, len(values), first, last))
    if not len(bad):
        return
    raise InputError(
        f"{_where(record, name, int(rows[bad[0]]))}: {name} is {values[bad[0]]:g} at "
        f"{_shown(record, start, bad)}, expected {low:g} .. {high:g}{' ' if unit else ''}{unit}; "
        f"{_correction(record, unit)}."
    )


def _where(record: Record, name: str, row: int) -> str:
    line = record.line(name, row)
    return f"{record.file}:{line}" if line else record.file


def _needed(record: Record, name: str, start: float, count: int, first: float, last: float) -> Flags:
    """Which values are used over a span.

    Instants: the two stamps around each end of the span are needed; means: every interval it touches.
    """
    interval = record.grid.interval
    times = start + interval * np.arange(count)
    reach = interval if record.kinds[name] == "mean" else 0.0
    margin = interval - reach
    return np.asarray((times + reach > first - margin + 1e-6) & (times < last + margin - 1e-6))


def _shown(record: Record, start: float, bad: Lines) -> str:
    """The first times, and how many more there are."""
    times: Array = start + record.grid.interval * bad
    more = f" and {len(bad) - 3} more" if len(bad) > 3 else ""
    return ", ".join(f"{stamp:%Y-%m-%d %H:%M}" for stamp in stamps_of(times[:3], record.grid.zone)) + more


def _filling(record: Record) -> str:
    if record.of_year:
        return " or fill it (in Python: fill_gaps('2h'))"
    return ", or fill short gaps (fill_gaps: 2h with the table in a study; in Python fill_gaps('2h'))"


def _correction(record: Record, unit: str) -> str:
    if record.of_year:
        return "correct the file, whose format allows no other unit, or choose a period without such values"
    if not unit:
        return (
            "convert the column to degC or W/m2 in the file (in Python: the column's unit, unit='K'), "
            "or correct it there"
        )
    hint = _UNIT_HINTS.get(unit)
    stated = f"if the column is in another unit, write it ({hint}); else " if hint else ""
    return f"{stated}correct the file, or leave such values empty and choose a period without them"

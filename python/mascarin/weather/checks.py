"""Values of a period that cannot be used: missing ones, and ones that no weather and no wall has."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.errors import InputError
from mascarin.weather.arrays import Array, Flags, Lines
from mascarin.weather.channels import UNITS
from mascarin.weather.grid import course
from mascarin.weather.table import stamps_of

if TYPE_CHECKING:
    from mascarin.weather.climate import Climate
    from mascarin.weather.measurements import Measurements

_UNIT_SLIPS: Final = {
    "degC": "unit: K or unit: degF",
    "tenths": "unit: oktas, or scale: 0.1 for %",
    "W/m2": "unit: kW/m2, or an energy of each interval such as unit: J/cm2",
    "m/s": "unit: km/h or unit: knot",
    "Pa": "unit: hPa or unit: kPa",
}
"""What to write where a column is in another unit than the channel."""


def require_values(
    holder: Climate | Measurements,
    name: str,
    start: float,
    rows: Lines,
    gaps: Flags,
    first: float,
    last: float,
) -> None:
    """Refuse missing values that a span needs.

    Parameters
    ----------
    holder : Climate or Measurements
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
    bad = np.flatnonzero(gaps & _needed(holder, name, start, len(gaps), first, last))
    if not len(bad):
        return
    raise InputError(
        f"{_where(holder, name, int(rows[bad[0]]))}: {name} has no value (NaN) at "
        f"{_shown(holder, start, bad)}, expected a number at every time of the period; choose a period "
        f"without gaps, or repair the file{_filling(holder)}."
    )


def require_range(
    holder: Climate | Measurements, name: str, limits: tuple[float, float], first: float, last: float
) -> None:
    """Refuse values that are outside of what the quantity can be, where a span needs them.

    Parameters
    ----------
    holder : Climate or Measurements
        Where the column is.
    name : str
        Column.
    limits : (float, float)
        Lowest and highest possible value [unit of the column].
    first, last : float
        Span, seconds since 1970-01-01 UTC [s].

    Raises
    ------
    InputError
        A value is outside; the text names file, line, column, time and value.
    """
    kind = holder.kinds[name]
    low, high = limits
    slack = 1e-9 * (high - low)
    start, rows = holder.grid.rows(first, last)
    data = holder.data[name].to_numpy(dtype=np.float64)
    values = course(data, holder.closing.get(name, np.nan), rows, kind)
    # Comparisons with NaN are False: what is missing is somebody else's complaint.
    outside = (values < low - slack) | (values > high + slack)
    bad = np.flatnonzero(outside & _needed(holder, name, start, len(values), first, last))
    if not len(bad):
        return
    unit = UNITS.get(name, "")
    raise InputError(
        f"{_where(holder, name, int(rows[bad[0]]))}: {name} is {values[bad[0]]:g} at "
        f"{_shown(holder, start, bad)}, expected {low:g} .. {high:g}{' ' if unit else ''}{unit}; "
        f"{_correction(holder, unit)}."
    )


def line_of(holder: Climate | Measurements, name: str, row: int) -> int:
    """Line of the file that holds a value; 0 where the row was missing from it.

    Parameters
    ----------
    holder : Climate or Measurements
        Where the column is.
    name : str
        Column.
    row : int
        Interval; for an instant column `count` is the end of the record.
    """
    lines = holder.lines if holder.kinds[name] == "mean" or holder.knots is None else holder.knots
    return int(lines[row]) if row < len(lines) else 0


def _where(holder: Climate | Measurements, name: str, row: int) -> str:
    line = line_of(holder, name, row)
    return f"{holder.file}:{line}" if line else holder.file


def _needed(
    holder: Climate | Measurements, name: str, start: float, count: int, first: float, last: float
) -> Flags:
    """Which values act on a span.

    Instants: the two stamps around each end of the span are needed; means: every interval it touches.
    """
    interval = holder.grid.interval
    times = start + interval * np.arange(count)
    reach = interval if holder.kinds[name] == "mean" else 0.0
    margin = interval - reach
    return np.asarray((times + reach > first - margin + 1e-6) & (times < last + margin - 1e-6))


def _shown(holder: Climate | Measurements, start: float, bad: Lines) -> str:
    """The first times, and how many more there are."""
    times: Array = start + holder.grid.interval * bad
    more = f" and {len(bad) - 3} more" if len(bad) > 3 else ""
    return ", ".join(f"{stamp:%Y-%m-%d %H:%M}" for stamp in stamps_of(times[:3], holder.grid.zone)) + more


def _filling(holder: Climate | Measurements) -> str:
    if holder.of_year:
        return " or fill it (in Python: fill_gaps('2h'))"
    return ", or fill short gaps (fill_gaps: 2h with the table in a study; in Python fill_gaps('2h'))"


def _correction(holder: Climate | Measurements, unit: str) -> str:
    if holder.of_year:
        return "correct the file, whose format knows no other unit, or choose a period without such values"
    if not unit:
        return (
            "convert the column to degC or W/m2 in the file (in Python: the column's unit, unit='K'), "
            "or correct it there"
        )
    slip = _UNIT_SLIPS.get(unit)
    stated = f"if the column is in another unit, write it ({slip}); else " if slip else ""
    return f"{stated}correct the file, or leave such values empty and choose a period without them"

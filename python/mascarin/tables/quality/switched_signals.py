"""Columns that are switched: heaters, valves, set points, states. They hold a value for long, and rightly."""

from __future__ import annotations

from typing import Final

import numpy as np

from mascarin.tables.arrays import Array, Flags, Lines

_MAX_STATES: Final = 3
"""A column with so few different values is a state."""
_LEVELS: Final = 10
"""A column with so many different values is switched between them if its changes are large."""
_LARGE: Final = 0.25
"""A change by more than this part of the column's range is a switch: sensors change by less in one row."""
_REST_BAND: Final = 0.05
"""A column is at rest in this lowest part of its range."""
_JUMP: Final = 1.0 / 3.0
"""A column that usually leaves and enters its rest by such a part of its range is turned on and off."""
_SHARE: Final = 0.1
"""A level other than zero is held in at least this part of the rows."""


def is_switched(values: Array) -> bool:
    """Whether a column only takes a few values, as a state, a set point or a heater with steps.

    Parameters
    ----------
    values : ndarray, shape (n,)
        The column, NaN where missing.

    Returns
    -------
    bool
        A column that never changes is not switched.
    """
    valid = values[~np.isnan(values)]
    different = np.unique(valid)
    if len(different) < 2 or len(valid) < 4 * len(different):
        return False
    if len(different) <= _MAX_STATES:
        return True
    changes = np.abs(np.diff(valid))
    changes = changes[changes > 0.0]
    return len(different) <= _LEVELS and bool(np.median(changes) >= _LARGE * np.ptp(valid))


def switched_levels(values: Array, start: Lines, length: Lines) -> Flags:
    """Runs at a level to which a column is switched, such as the zero of a heater that is off.

    Such a level is entered and left by large changes, held several times, and in a tenth of the rows. Zero is
    one in a column without negative values that usually jumps when it is turned on and off.

    Parameters
    ----------
    values : ndarray, shape (n,)
        The column, NaN where missing.
    start, length : ndarray of int, shape (r,)
        Runs of equal values: first row and number of rows.

    Returns
    -------
    ndarray of bool, shape (r,)
        True for a run at such a level.
    """
    switched = np.zeros(len(start), dtype=bool)
    valid = values[~np.isnan(values)]
    if not len(valid):
        return switched
    low, high = np.quantile(valid, [0.01, 0.99])
    if not high > low:
        return switched
    level, end = values[start], start + length
    held = length >= 2
    # Changes at both ends of every run; NaN at the ends of the record and beside missing values.
    before = np.abs(level - np.where(start > 0, values[np.maximum(start - 1, 0)], np.nan))
    after = np.abs(level - np.where(end < len(values), values[np.minimum(end, len(values) - 1)], np.nan))
    off = _turned_on_and_off(valid, low, high)
    different, counts = np.unique(valid, return_counts=True)
    for value in different[counts >= _SHARE * len(valid)]:
        same = held & (level == value)
        changes = np.concatenate([before[same], after[same]])
        changes = changes[~np.isnan(changes)]
        if np.count_nonzero(same) > 1 and np.median(changes) >= _LARGE * (high - low):
            switched[same] = True
    return np.asarray(switched | ((level == 0.0) & off))


def _turned_on_and_off(valid: Array, low: float, high: float) -> bool:
    """Whether a column without negative values usually leaves its lowest values by a jump: a heater, a fan.

    Radiation and wind rise gradually: in the weather files and measurements of the tests by at most a quarter
    of the range. A heater that draws some standby power before it is off is one, too.
    """
    if np.min(valid) < 0.0:
        return False
    small = valid < low + _REST_BAND * (high - low)
    crossing = small[1:] != small[:-1]
    changes = np.abs(np.diff(valid))[crossing]
    return len(changes) > 1 and bool(np.median(changes) >= _JUMP * (high - low))

"""Values of a column over a span of time."""

from __future__ import annotations

from typing import Final

import numpy as np

from mascarin.tables.arrays import Array
from mascarin.tables.checks import require_values
from mascarin.tables.grid import values_in
from mascarin.tables.record import Record
from mascarin.tables.steps import Steps

#: Where a part of a period is looked at, its values begin at a multiple of so many intervals of the period:
#: products of matrices have the bits of the whole, whose last rows a library may add up in another order.
_TOGETHER: Final = 16
#: Intervals behind a part: the last of them change nothing in it.
_BEHIND: Final = 8


def window(
    record: Record, name: str, first: float, last: float, around: tuple[float, float] | None = None
) -> tuple[float, Array, str]:
    """Values of a column over a span and a little more.

    Parameters
    ----------
    record : Record
        Where the column is.
    name : str
        Column.
    first, last : float
        Span, seconds since 1970-01-01 UTC [s].
    around : (float, float), optional
        A longer span whose values are given; those outside of the span may be missing. [s]

    Returns
    -------
    start : float
        Start of the first interval [s].
    values : ndarray
        Instants at both ends of all intervals, or means.
    kind : str
        `instant` or `mean`.

    Raises
    ------
    InputError
        A value that the span needs is missing.
    """
    kind = record.kinds[name]
    start, rows = record.grid.rows(*(around or (first, last)))
    values = values_in(record.columns[name], record.closing.get(name, np.nan), rows, kind)
    gaps = np.isnan(values)
    if gaps.any():
        require_values(record, name, start, rows, gaps, first, last)
        values = _held(values)
    return start, values, kind


def window_of_steps(record: Record, name: str, steps: Steps) -> tuple[float, int, Array, str]:
    """Values of a column over steps and a little more.

    Parameters
    ----------
    record : Record
        Where the column is.
    name : str
        Column.
    steps : Steps
        The steps, all of a period or a part of it.

    Returns
    -------
    start : float
        Start of the first interval around the period, from the start of the period [s].
    before : int
        Intervals between that and the first value.
    values : ndarray
        Instants at both ends of all intervals, or means.
    kind : str
        `instant` or `mean`.

    Raises
    ------
    InputError
        A value that the steps need is missing.
    """
    grid, origin = record.grid, steps.first
    first, last = origin + steps.edges[0], origin + steps.edges[-1]
    if steps.part is None:
        start, values, kind = window(record, name, first, last)
        return start - origin, 0, values, kind
    begin = grid.begin(origin + steps.part.begin)
    before = round((grid.begin(first) - begin) / grid.interval)
    longer = (
        first - before % _TOGETHER * grid.interval,
        min(last + _BEHIND * grid.interval, origin + steps.part.end),
    )
    _, values, kind = window(record, name, first, last, longer)
    return begin - origin, before - before % _TOGETHER, values, kind


def _held(values: Array) -> Array:
    """Gaps in the margin take the nearest value."""
    good = np.flatnonzero(~np.isnan(values))
    if not len(good):
        return np.zeros_like(values)
    row = np.arange(len(values))
    after = np.clip(np.searchsorted(good, row), 0, len(good) - 1)
    before = np.clip(after - 1, 0, len(good) - 1)
    nearer = np.abs(good[before] - row) <= np.abs(good[after] - row)
    return values[np.where(nearer, good[before], good[after])]

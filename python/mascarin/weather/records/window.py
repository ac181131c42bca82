"""Values of a column over a span of time."""

from __future__ import annotations

import numpy as np

from mascarin.tables.arrays import Array
from mascarin.tables.checks import require_values
from mascarin.tables.grid import values_in
from mascarin.tables.record import Record
from mascarin.tables.steps import Steps


def window(record: Record, name: str, first: float, last: float) -> tuple[float, Array, str]:
    """Values of a column over a span and a little more.

    Parameters
    ----------
    record : Record
        Where the column is.
    name : str
        Column.
    first, last : float
        Span, seconds since 1970-01-01 UTC [s].

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
    start, rows = record.grid.rows(first, last)
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
    origin = steps.first
    start, values, kind = window(record, name, origin + steps.edges[0], origin + steps.edges[-1])
    begin = start if steps.part is None else record.grid.begin(origin + steps.begin)
    return begin - origin, round((start - begin) / record.grid.interval), values, kind


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

"""Stretches that were not measured but filled: straight lines, and copies of other days."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.tables.arrays import Array
from mascarin.tables.quality.defects import Defect, Stretch
from mascarin.tables.quality.defects import runs as flagged

if TYPE_CHECKING:
    import pandas as pd

#: Fewest rows of a straight line or of a copy.
_FEWEST: Final = 6
#: Longest part of a day that a straight line may last on a column that is often straight.
_LONGER: Final = 3.0
#: Expected number of such runs by chance in a whole column.
_CHANCE: Final = 1e-3
_DAY: Final = 86400.0
#: Columns with fewer rows are not examined.
_SHORTEST: Final = 48

Run = tuple[int, int, str]


def filled_stretches(data: pd.DataFrame, columns: Iterable[str]) -> list[Stretch]:
    """Find filled stretches of some columns.

    Parameters
    ----------
    data : pandas.DataFrame
        Numbers on a regular time index, NaN where missing.
    columns : iterable of str
        Columns of sensors. Weather is often interpolated rightly, so it is not examined.

    Returns
    -------
    list of Stretch
        Of the kinds ``interpolated`` and ``copied``.

    Examples
    --------
    >>> import pandas as pd
    >>> index = pd.date_range("2024-06-01", periods=200, freq="1h", tz="UTC")
    >>> noise = np.random.default_rng(1).normal(size=200).round(3)
    >>> noise[50:81] = np.linspace(noise[50], noise[80], 31).round(3)
    >>> [(one.kind, one.count) for one in filled_stretches(pd.DataFrame({"T": noise}, index=index), ["T"])]
    [('interpolated', 29)]
    """
    if len(data) < _SHORTEST:
        return []
    interval = float((data.index[1] - data.index[0]).total_seconds())
    stretches = []
    for name in columns:
        if name not in data.columns:
            continue
        values = data[name].to_numpy(dtype=np.float64)
        kinds: list[tuple[Defect, list[Run]]] = [
            ("interpolated", interpolated(values)), ("copied", copied(values, interval)),
        ]  # fmt: skip
        stretches += [
            Stretch(name, kind, data.index[first], data.index[last - 1], last - first, text)
            for kind, parts in kinds
            for first, last, text in parts
        ]
    return stretches


def interpolated(values: Array) -> list[Run]:
    """Find straight lines that are longer than the column usually has.

    Parameters
    ----------
    values : ndarray, shape (n,)
        Regular in time, NaN where missing. [unit]

    Returns
    -------
    list of (int, int, str)
        First row and row past the end of each, between the values that were measured, and words.

    Examples
    --------
    >>> noise = np.random.default_rng(1).normal(size=200).round(3)
    >>> noise[50:81] = np.linspace(noise[50], noise[80], 31).round(3)
    >>> [run[:2] for run in interpolated(noise)]
    [(51, 80)]
    """
    if np.isfinite(values).sum() < _SHORTEST:
        return []
    tolerance = 0.51 * _resolution(values) + 1e-9 * float(np.nanmax(np.abs(values)))
    lines = _lines(values, tolerance)
    lengths = [last - first for first, last in lines]
    # Rows that are on no line count as lines of three rows.
    lengths += [3] * ((values.size - sum(lengths)) // 3)
    usual = float(np.quantile(lengths, 0.99, method="lower"))
    runs = []
    for first, last in lines:
        steps = values[first:last]
        level = np.ptp(steps) <= 2.0 * tolerance
        if last - first >= max(_FEWEST + 2, _LONGER * usual) and not level:
            slope = (steps[-1] - steps[0]) / (steps.size - 1)
            while first > 0 and abs(values[first - 1] - (values[first] - slope)) <= 2.0 * tolerance:
                first -= 1
            text = f"a straight line from {values[first]:g} to {values[last - 1]:g}"
            runs.append((first + 1, last - 1, text))
    return runs


def copied(values: Array, interval: float) -> list[Run]:
    """Find stretches that repeat the values of one or more whole days before.

    Parameters
    ----------
    values : ndarray, shape (n,)
        Regular in time, NaN where missing. [unit]
    interval : float
        Between the rows. [s]

    Returns
    -------
    list of (int, int, str)
        First row and row past the end of each copy, and words.

    Examples
    --------
    >>> noise = np.random.default_rng(1).normal(size=480)
    >>> noise[120:140] = noise[24:44]
    >>> [run[:2] for run in copied(noise, 3600.0)]
    [(120, 140)]
    """
    per_day = _DAY / interval
    if np.isfinite(values).sum() < _SHORTEST or abs(per_day - round(per_day)) > 1e-9:
        return []
    runs: list[Run] = []
    for days in (1, 2, 3, 4, 5, 6, 7):
        lag = days * round(per_day)
        if lag >= values.size - _FEWEST:
            break
        same = np.zeros(values.size, dtype=bool)
        same[lag:] = values[lag:] == values[:-lag]
        for first, last in flagged(same):
            level = np.ptp(values[first:last]) <= 2.0 * _resolution(values)
            rate = (same.sum() - (last - first)) / max(values.size - (last - first), 1)
            expected = values.size * max(rate, 1.0 / values.size) ** (last - first)
            overlaps = any(first < other[1] and other[0] < last for other in runs)
            if last - first >= _FEWEST and expected < _CHANCE and not level and not overlaps:
                runs.append((first, last, f"the same values as {days} day{'s' * (days > 1)} before"))
    return sorted(runs)


def _resolution(values: Array) -> float:
    """Smallest step of the column, from its decimals: that of rounding. [unit]"""
    valid = values[np.isfinite(values)]
    for decimals in range(7):
        if np.allclose(valid, np.round(valid, decimals), rtol=0.0, atol=1e-9):
            return float(10.0**-decimals)
    return 0.0


def _lines(values: Array, tolerance: float) -> list[tuple[int, int]]:
    """Longest runs whose values are within a tolerance of the line between their ends."""
    segments: list[tuple[int, int]] = []
    # Second differences of a rounded line are within four tolerances: only such stretches are examined.
    second = np.full(values.size, np.inf)
    second[1:-1] = np.abs(values[:-2] - 2.0 * values[1:-1] + values[2:])
    for first, last in flagged(np.nan_to_num(second, nan=np.inf) <= 4.0 * tolerance):
        start, end = first - 1, last + 1
        while end - start >= 4:
            stop = _longest(values, start, end, tolerance)
            if stop - start >= 4:
                segments.append((start, stop))
                start = stop - 1
            else:
                start += 1
    return segments


def _longest(values: Array, start: int, end: int, tolerance: float) -> int:
    """Row past the end of the longest line from a start, by doubling and bisection."""

    def straight(stop: int) -> bool:
        part = values[start:stop]
        line = np.linspace(part[0], part[-1], part.size)
        return bool(np.all(np.abs(part - line) <= 2.0 * tolerance))

    low = min(start + 3, end)
    if not straight(low):
        return start
    size = 2
    while low + size <= end and straight(low + size):
        low, size = low + size, 2 * size
    high = min(low + size, end + 1)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if straight(middle) else (low, middle)
    return low

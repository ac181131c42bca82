"""Measured curves: checks of their columns, and monotone interpolation."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

from pydantic_core import InitErrorDetails

from mascarin.building.base.number import Number
from mascarin.building.base.part import fault


def rising(key: str, values: tuple[Number, ...]) -> list[InitErrorDetails]:
    """Points at which a column of a table does not rise."""
    if len(values) < 2:
        return [fault((key,), f"{len(values)} points", "at least two points", "Complete the table.")]
    return [
        fault(
            (key, i + 1),
            f"{after:g} after {before:g}",
            "strictly rising values: enthalpy must rise with heat",
            "Sort the table, remove repeated points; a plateau needs a small slope.",
        )
        for i, (before, after) in enumerate(pairwise(values))
        if not after > before
    ]


def as_many(
    what: str, first: tuple[Number, ...], other: str, second: tuple[Number, ...]
) -> list[InitErrorDetails]:
    """Whether two columns of a table have the same length."""
    if len(first) == len(second):
        return []
    counts = f"{len(first)} {what} and {len(second)} {other}"
    return [fault((), counts, "as many of one as of the other", "Complete the table.")]


def monotone(x: tuple[Number, ...], y: tuple[Number, ...]) -> Callable[[float], float]:
    """Monotone cubic through points, as in the engine; constant beyond the ends.

    References
    ----------
    Fritsch & Butland 1984, SIAM J. Sci. Stat. Comput. 5(2), doi:10.1137/0905021
    """
    lengths = [b - a for a, b in pairwise(x)]
    secants = [(b - a) / length for (a, b), length in zip(pairwise(y), lengths, strict=True)]
    slopes = [secants[0]]
    for (width, next_width), (before, after) in zip(pairwise(lengths), pairwise(secants), strict=True):
        early, late = 2.0 * next_width + width, next_width + 2.0 * width
        slopes.append((early + late) / (early / before + late / after) if before > 0.0 < after else 0.0)
    slopes.append(secants[-1])

    def value_at(point: float) -> float:
        if point <= x[0]:
            return float(y[0])
        for i, length in enumerate(lengths):
            if point < x[i + 1]:
                u = (point - x[i]) / length
                s0, s1, m = slopes[i], slopes[i + 1], secants[i]
                cubic = (3.0 * m - 2.0 * s0 - s1) + u * (s0 + s1 - 2.0 * m)
                return float(y[i] + length * u * (s0 + u * cubic))
        return float(y[-1])

    return value_at

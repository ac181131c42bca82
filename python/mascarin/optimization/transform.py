"""Change of variables that turns bounded parameters into unbounded ones."""

from __future__ import annotations

import math
from collections.abc import Sequence

from mascarin.optimization.space import Continuous, Space


def to_free(c: Continuous, x: float) -> float:
    """Free variable of a parameter value.

    Parameters
    ----------
    c : Continuous
        The parameter; either bound may be missing.
    x : float
        Value within the bounds [unit of the parameter].

    Returns
    -------
    float
        The free variable: an angle between two bounds, a square root beside one bound [-].
    """
    low, high = math.isfinite(c.lower), math.isfinite(c.upper)
    if low and high:
        return math.asin(math.sqrt((x - c.lower) / (c.upper - c.lower)))
    if low:
        return math.sqrt(x - c.lower)
    if high:
        return math.sqrt(c.upper - x)
    return x


def from_free(c: Continuous, t: float) -> float:
    """Parameter value of a free variable, the inverse of `to_free`.

    Parameters
    ----------
    c : Continuous
        The parameter.
    t : float
        The free variable [-].

    Returns
    -------
    float
        Value within the bounds [unit of the parameter].
    """
    low, high = math.isfinite(c.lower), math.isfinite(c.upper)
    if low and high:
        return c.lower + (c.upper - c.lower) * math.sin(t) * math.sin(t)
    if low:
        return c.lower + t * t
    if high:
        return c.upper - t * t
    return t


def free_step(c: Continuous, around: float) -> float:
    """Step in the free variable that matches the step of a parameter around one of its values.

    Parameters
    ----------
    c : Continuous
        The parameter.
    around : float
        The value [unit of the parameter].

    Returns
    -------
    float
        The step [-].
    """
    below, above = around - c.step / 2.0, around + c.step / 2.0
    # The pair of points is shifted as a whole when one of them would leave the bounds.
    if below < c.lower:
        below, above = c.lower, c.lower + c.step
    if above > c.upper:
        below, above = c.upper - c.step, c.upper
    return abs(to_free(c, above) - to_free(c, max(below, c.lower)))


def original(space: Space, t: Sequence[float]) -> tuple[float, ...]:
    """Parameter values of free variables.

    Parameters
    ----------
    space : Space
        The parameters.
    t : sequence of float
        Free variables, one per continuous parameter [-].

    Returns
    -------
    tuple of float
        Values within the bounds [units of the parameters].
    """
    return tuple(from_free(c, v) for c, v in zip(space.continuous, t, strict=True))

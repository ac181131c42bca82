"""The mesh of a pattern search: rounding, starting points, and the decrease that a step must reach."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from mascarin.optimization.random import Lcg48
from mascarin.optimization.space import Evaluation, Point, Space


def decimal_rounding(space: Space) -> Callable[[float, int], float]:
    """Rounding to nine decimal places below the step of each parameter.

    Points of the mesh that are reached in different ways then are the same numbers.

    Parameters
    ----------
    space : Space
        The parameters with their steps.

    Returns
    -------
    callable
        Rounded value for a value and the index of its parameter.
    """
    decimals = [9 - math.floor(math.log10(abs(c.step))) if c.step != 0 else 15 for c in space.continuous]
    return lambda value, i: round(value, decimals[i])


@dataclass(frozen=True)
class SufficientDecrease:
    """Condition that a step must lower the cost by more than a given amount.

    Parameters
    ----------
    zeta : float
        Part of `phi` by which the cost must decrease, relative to the first cost [-].
    phi : callable
        Required decrease for the mesh size, the step number and the evaluation [-].
    alpha : float, optional
        Exponent that couples the mesh size to `phi`, between 0 and 1 [-].
    counts_steps : bool
        Whether `phi` depends on the step number.

    Examples
    --------
    >>> rule = SufficientDecrease(zeta=0.1, phi=lambda mesh, step, evaluation: mesh**2)
    >>> rule.phi(0.5, 1, None)
    0.25
    """

    zeta: float
    phi: Callable[[float, int, Evaluation], float]
    alpha: float | None = None
    counts_steps: bool = False


def uniform_starts(
    space: Space,
    count: int,
    seed: int,
    *,
    divider: int = 2,
    exponent: int = 0,
    rounding: Callable[[float, int], float] | None = None,
    first: Point | None = None,
) -> list[Point]:
    """Starting points on the mesh around the initial point, uniformly random within the bounds.

    Parameters
    ----------
    space : Space
        Parameters with bounds.
    count : int
        Number of points; the first is the initial point [-].
    seed : int
        Seed of the random numbers [-].
    divider, exponent : int
        Mesh, as in `PatternSearch` [-].
    rounding : callable, optional
        As in `PatternSearch`.
    first : Point, optional
        Used in place of the initial point of the space.

    Returns
    -------
    list of Point
        The starts.

    Raises
    ------
    InputError
        When a parameter has no lower or no upper bound.

    Examples
    --------
    >>> from mascarin.optimization import box
    >>> starts = uniform_starts(box(["x"], [0.5], [0.0], [1.0]), count=3, seed=1)
    >>> len(starts), starts[0].x
    (3, (0.5,))
    """
    space.require_bounds()
    to = rounding or decimal_rounding(space)
    random = Lcg48(seed)
    # The first draw of such a generator depends almost linearly on the seed.
    random.uniform()
    mesh = 1.0 / math.pow(divider, exponent)
    starts = [first or space.initial]
    for _ in range(count - 1):
        x = []
        for i, c in enumerate(space.continuous):
            value = c.lower + random.uniform() * (c.upper - c.lower)
            width = c.step * mesh
            v = to(c.initial + round((value - c.initial) / width) * width, i)
            if v < c.lower:
                v = to(v + width, i)
            elif v > c.upper:
                v = to(v - width, i)
            x.append(v)
        starts.append(Point(tuple(x), tuple(random.below(d.size) for d in space.discrete)))
    return starts

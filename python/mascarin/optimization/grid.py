"""Full grids, and variations of one parameter at a time."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence

from mascarin.optimization.base import Observer, Optimizer, Steps
from mascarin.optimization.space import Continuous, Point, Space

_DONE = "all points are evaluated"


def levels(c: Continuous, intervals: int) -> list[float]:
    """Values of a parameter at equal or logarithmic spacing.

    Parameters
    ----------
    c : Continuous
        The parameter with bounds.
    intervals : int
        Number of intervals; negative for logarithmic spacing, 0 for the initial value alone [-].

    Returns
    -------
    list of float
        The values [unit of the parameter].
    """
    n = abs(intervals)
    if n == 0:
        return [c.initial]
    if intervals < 0:
        # Rounding must not move the last level outside the bound.
        ratio = math.log(c.upper / c.lower) / n
        return [min(c.lower * math.exp(i * ratio), c.upper) for i in range(n + 1)]
    return [c.lower + i * (c.upper - c.lower) / n for i in range(n + 1)]


class Grid(Optimizer):
    """All combinations of levels, the first parameter varying fastest.

    Parameters
    ----------
    space : Space
        Parameters; the step of a continuous one is its number of intervals, see `levels`.
    batch : int, optional
        Number of points in a batch; all when absent [-].
    rounding : callable, optional
        Rounded value for a value and its parameter's index.
    fresh_step : int
        Step number of points before their evaluation [-].
    observer, remember
        See `Optimizer`.

    Examples
    --------
    >>> from mascarin.optimization import box
    >>> grid = Grid(box(["x", "y"], [0.0, 0.0], [0.0, 0.0], [1.0, 1.0], step=[2, 1]))
    >>> [p.x for p in grid.ask()]
    [(0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 1.0), (1.0, 1.0)]
    """

    def __init__(
        self,
        space: Space,
        *,
        batch: int | None = None,
        rounding: Callable[[float, int], float] | None = None,
        fresh_step: int = 1,
        observer: Observer | None = None,
        remember: bool = True,
    ) -> None:
        super().__init__(space, observer=observer, remember=remember)
        space.require_bounds()
        self._batch = batch
        self._fresh = fresh_step
        axes = [
            [rounding(v, i) for v in levels(c, int(c.step))] if rounding else levels(c, int(c.step))
            for i, c in enumerate(space.continuous)
        ]
        axes_discrete = [range(d.size) for d in space.discrete]
        self._axes: list[Sequence[float]] = [*axes, *axes_discrete]

    @property
    def expected(self) -> int | None:
        """Number of points of the grid [-]."""
        return math.prod(len(a) for a in self._axes)

    def _search(self) -> Steps:
        """The points, in chunks."""
        count = len(self.space.continuous)
        # product() varies its last argument fastest.
        combinations = itertools.product(*reversed(self._axes))
        points = (
            Point(tuple(reversed(v))[:count], tuple(int(k) for k in tuple(reversed(v))[count:]), self._fresh)
            for v in combinations
        )
        while chunk := list(itertools.islice(points, self._batch or self.expected)):
            for e in (yield chunk):
                self.observer.sub(e, "Function evaluation successful.")
                self.observer.main(e, "Function evaluation successful.")
        return _DONE


class OneAtATime(Optimizer):
    """Vary each parameter through its levels while the others keep their initial values.

    Parameters
    ----------
    space : Space
        Parameters; the step of a continuous one is its number of intervals, see `levels`.
    observer, remember
        See `Optimizer`.

    Examples
    --------
    >>> from mascarin.optimization import box
    >>> search = OneAtATime(box(["x", "y"], [0.0, 0.0], [0.0, 0.0], [1.0, 1.0], step=[1, 1]))
    >>> [p.x for p in search.ask()]
    [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]
    """

    def __init__(self, space: Space, *, observer: Observer | None = None, remember: bool = True) -> None:
        super().__init__(space, observer=observer, remember=remember)
        space.require_bounds()

    @property
    def expected(self) -> int | None:
        """Upper limit of the number of evaluations [-]."""
        return len(self._points())

    def _points(self) -> list[Point]:
        """All points in order, repeated ones included."""
        start, points = self.space.initial, []
        for i, c in enumerate(self.space.continuous):
            if int(c.step) != 0:
                points += [
                    Point((*start.x[:i], v, *start.x[i + 1 :]), start.choices) for v in levels(c, int(c.step))
                ]
        for i, d in enumerate(self.space.discrete):
            if d.size > 1:
                points += [
                    Point(start.x, (*start.choices[:i], k, *start.choices[i + 1 :])) for k in range(d.size)
                ]
        return points or [start]

    def _search(self) -> Steps:
        """One batch."""
        results = yield self._points()
        for i, e in enumerate(results):
            comment = "Function evaluation successful." if i else "Initial point."
            if e.failed:
                comment = "Function evaluation failed."
            self.observer.sub(e, comment)
            self.observer.main(e, comment)
        return _DONE

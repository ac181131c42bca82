"""Interval searches in one dimension: golden section and Fibonacci.

References
----------
Kiefer (1953), Sequential minimax search for a maximum, doi:10.1090/S0002-9939-1953-0055639-3.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable, Generator

from mascarin.errors import InputError, SolverError
from mascarin.optimization.base import Observer, Optimizer, Steps
from mascarin.optimization.space import Evaluation, Point, Space

_GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0
_COMMENT = "Linesearch."
_Batch = Generator[list[Point], list[Evaluation], list[Evaluation]]


class IntervalSearch(Optimizer):
    """Base of the searches that reduce an interval around a minimum; for parameters see `GoldenSection`."""

    def __init__(
        self,
        space: Space,
        points: int,
        *,
        difference: float | None = None,
        text: Callable[[float], str] = repr,
        observer: Observer | None = None,
        remember: bool = True,
    ) -> None:
        super().__init__(space, observer=observer, remember=remember)
        if len(space.continuous) != 1 or space.discrete:
            msg = f"an interval search varies one continuous parameter, found {', '.join(space.names)}"
            raise InputError(msg)
        space.require_bounds()
        self._points = max(points, 2)
        self._difference = difference
        self._text = text
        self._recent: list[float] = []

    @property
    def expected(self) -> int | None:
        """Upper limit of the number of evaluations [-]."""
        return self._points

    @abstractmethod
    def _reduction(self, done: int) -> float:
        """Part of the interval that is kept after `done` evaluations. [-]"""

    def _search(self) -> Steps:
        """Compare two inner points and remove the end beside the higher cost."""
        c = self.space.continuous[0]
        low, high = c.lower, c.upper
        width = self._reduction(2) * (high - low)
        low_point, high_point = yield from self._evaluate([high - width, low + width])
        done = 2
        while done < self._points:
            close = self._difference is not None and abs(low_point.cost - high_point.cost) < self._difference
            width = self._reduction(done + 1) * width
            if high_point.cost < low_point.cost:
                low, low_point = low_point.point.x[0], high_point
                (high_point,) = yield from self._evaluate([low + width])
            else:
                high, high_point = high_point.point.x[0], low_point
                (low_point,) = yield from self._evaluate([high - width])
            done += 1
            if close:
                break
        if high_point.cost < low_point.cost:
            low = low_point.point.x[0]
        else:
            high = high_point.point.x[0]
        self._overview(low, high, c.upper - c.lower)
        return "the interval is reduced"

    def _evaluate(self, values: list[float]) -> _Batch:
        """Evaluate and report points of the line."""
        evaluations = yield [Point((v,), (), self.step_number) for v in values]
        for e in evaluations:
            self.observer.sub(e, _COMMENT)
            self._recent = [*self._recent[-2:], e.cost]
            if len(self._recent) == 3 and len(set(self._recent)) == 1:
                msg = (
                    f"Nullspace: three points in a row cost {e.cost!r}; the parameter "
                    f"'{self.space.continuous[0].name}' has no effect there, so choose other bounds"
                )
                raise SolverError(msg)
        return evaluations

    def _overview(self, low: float, high: float, full_length: float) -> None:
        """Report the remaining interval."""
        rows = [
            ("Lower border of uncertainty interval        ", low),
            ("Upper border of uncertainty interval        ", high),
            ("Mid point of uncertainty interval           ", (low + high) / 2.0),
            ("Length of uncertainty interval              ", high - low),
            ("Normalized reduction of uncertainty interval", (high - low) / full_length),
        ]
        self.observer.summary(
            ["Result overview", "***************", *(f"{k}: {self._text(v)}" for k, v in rows)]
        )


class GoldenSection(IntervalSearch):
    """Interval search that keeps the same part of the interval every time.

    Parameters
    ----------
    space : Space
        One continuous parameter with bounds; its initial value is not used.
    points : int
        Largest number of evaluations. [-]
    difference : float, optional
        Ends the search when the costs of the two inner points differ by less. [unit of the cost]
    text : callable
        Text of a number in the overview.
    observer, remember
        See `Optimizer`.

    References
    ----------
    Kiefer (1953), doi:10.1090/S0002-9939-1953-0055639-3.

    Examples
    --------
    >>> from mascarin.optimization import box, minimize
    >>> search = GoldenSection(box(["x"], [0.5], [0.0], [1.0]), points=20)
    >>> best = minimize(search, lambda points: [(p.x[0] - 0.3) ** 2 for p in points])
    >>> abs(best.point.x[0] - 0.3) < 1e-3
    True
    """

    def _reduction(self, done: int) -> float:
        """The golden ratio."""
        return _GOLDEN


class FibonacciSearch(IntervalSearch):
    """Interval search by ratios of Fibonacci numbers, which are optimal for a given number of points.

    Parameters
    ----------
    space : Space
        One continuous parameter with bounds; its initial value is not used.
    points : int
        Largest number of evaluations. [-]
    difference : float, optional
        Ends the search when the costs of the two inner points differ by less. [unit of the cost]
    text : callable
        Text of a number in the overview.
    observer, remember
        See `Optimizer`.

    References
    ----------
    Kiefer (1953), doi:10.1090/S0002-9939-1953-0055639-3.

    Examples
    --------
    >>> from mascarin.optimization import box, minimize
    >>> search = FibonacciSearch(box(["x"], [0.5], [0.0], [1.0]), points=20)
    >>> best = minimize(search, lambda points: [(p.x[0] - 0.3) ** 2 for p in points])
    >>> abs(best.point.x[0] - 0.3) < 1e-3
    True
    """

    def _reduction(self, done: int) -> float:
        """Ratio of two successive Fibonacci numbers, down to 2/3 at the last point.

        The next ratio, 1/2, would evaluate the same point a second time.
        """
        n = self._points - done + 3
        return _fibonacci(n) / _fibonacci(n + 1)


def golden_points(reduction: float) -> int:
    """Number of points of a golden section search.

    Parameters
    ----------
    reduction : float
        Length of the last interval as a part of the first [-].

    Returns
    -------
    int
        The number of points [-].
    """
    return round(math.log(reduction) / math.log(_GOLDEN) + 1.49999)


def fibonacci_points(reduction: float) -> int:
    """Number of points of a Fibonacci search, by the rule of GenOpt.

    The number n is the smallest one with 1 / F(n + 2) <= `reduction`. The last interval is twice as long,
    2 / F(n + 2), because the last point lies in its middle.

    Parameters
    ----------
    reduction : float
        Length of the last interval as a part of the first [-].

    Returns
    -------
    int
        The number of points [-].
    """
    n = 1
    while 1.0 / _fibonacci(n + 2) > reduction:
        n += 1
    return n


def _fibonacci(n: int) -> int:
    """Fibonacci number with F(1) = F(2) = 1."""
    a, b = 0, 1
    for _ in range(n):
        a, b = b, a + b
    return a

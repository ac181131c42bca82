"""Gradient descent with Armijo line search; the increments of the finite differences are refined.

References
----------
Polak (1997), Optimization: Algorithms and Consistent Approximations, doi:10.1007/978-1-4612-0663-7.
Armijo (1966), doi:10.2140/pjm.1966.16.1.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator
from dataclasses import dataclass

from mascarin.optimization.base import CONVERGED, EXHAUSTED, Observer, Optimizer, Steps
from mascarin.optimization.space import Evaluation, Point, Space
from mascarin.optimization.transform import free_step, original, to_free

_Batch = Generator[list[Point], list[Evaluation], list[Evaluation]]


@dataclass(frozen=True)
class ArmijoRules:
    """Constants of the search, named as in Polak's algorithm.

    Parameters
    ----------
    alpha : float
        Part of the predicted decrease that a step must reach [-].
    beta : float
        Ratio of successive step lengths, between 0 and 1 [-].
    gamma : float
        Required decrease in units of the difference increment [-].
    k0 : int
        First exponent of the difference increment [-].
    k_star : int
        First exponent of the step length [-].
    l_max, kappa : int
        Limits of the line search before it begins again [-].
    epsilon_m : float
        Ends the search when the increments are smaller [-].
    epsilon_x : float
        Ends the search when a step is shorter, in steps of the parameters [-].

    Examples
    --------
    >>> ArmijoRules(beta=0.7).beta
    0.7
    """

    alpha: float = 0.5
    beta: float = 0.8
    gamma: float = 0.1
    k0: int = 10
    k_star: int = 0
    l_max: int = 50
    kappa: int = 50
    epsilon_m: float = 0.05
    epsilon_x: float = 0.05


class ArmijoGradient(Optimizer):
    """Descent along a gradient by forward differences.

    Parameters
    ----------
    space : Space
        Continuous parameters; bounds are kept by a change of variables.
    rules : ArmijoRules
        Constants of the search.
    max_evaluations : int, optional
        Number of evaluations after which the search stops [-].
    text : callable
        Text of a number in comments.
    observer, remember
        See `Optimizer`.

    References
    ----------
    Polak (1997), doi:10.1007/978-1-4612-0663-7. Armijo (1966), doi:10.2140/pjm.1966.16.1.

    Examples
    --------
    >>> from mascarin.optimization import box, minimize
    >>> space = box(["x", "y"], initial=[0.4, 0.4], lower=[-1.0, -1.0], upper=[1.0, 1.0])
    >>> search = ArmijoGradient(space)
    >>> best = minimize(search, lambda points: [1.0 + p.x[0] ** 2 + p.x[1] ** 2 for p in points])
    >>> best.cost < 1.001
    True
    """

    def __init__(
        self,
        space: Space,
        rules: ArmijoRules | None = None,
        *,
        max_evaluations: int | None = None,
        text: Callable[[float], str] = repr,
        observer: Observer | None = None,
        remember: bool = True,
    ) -> None:
        super().__init__(space, observer=observer, remember=remember)
        space.require_continuous(type(self).__name__)
        space.require_start()
        self._rules = rules or ArmijoRules()
        self._limit = max_evaluations
        self._text = text
        self._origin = [to_free(c, c.initial) for c in space.continuous]
        self._width = [free_step(c, c.initial) for c in space.continuous]
        self._scale = 1.0
        self._k = self._rules.k_star

    def _search(self) -> Steps:
        """Directions, line searches and refinements, one after the other."""
        rules, m = self._rules, 0
        y = [0.0] * len(self._origin)
        (current,) = yield [self._point(y)]
        self._scale = current.cost if current.cost != 0.0 else 1.0
        self._both(current, "Initial point.")
        while not self._spent():
            if rules.beta**m < rules.epsilon_m:
                self.observer.minimum("Minimum point.")
                return CONVERGED
            epsilon = rules.beta ** (rules.k0 + m)
            h = yield from self._direction(y, current, epsilon)
            (probe,) = yield from self._reported([_along(y, h, epsilon)], ["Decrease computation."])
            slope = self._change(probe, current) / epsilon
            if slope >= 0.0:
                m += 1
                continue
            length, new = yield from self._line_search(y, h, current, slope)
            if self._spent() or -self._change(new, current) < rules.gamma * epsilon:
                m += 1
                continue
            y, current = _along(y, h, length), new
            distance = length * math.hypot(*h)
            self._both(current, f"Successfull iterate. ||dX|| = {self._text(distance)}")
            if distance < rules.epsilon_x:
                self.observer.minimum("Minimum point.")
                return CONVERGED
        self.observer.minimum("Current lowest point.")
        return EXHAUSTED

    def _direction(
        self, y: list[float], current: Evaluation, epsilon: float
    ) -> Generator[list[Point], list[Evaluation], list[float]]:
        """Negative gradient by forward differences."""
        ahead = [[v + epsilon * (i == j) for j, v in enumerate(y)] for i in range(len(y))]
        evaluations = yield from self._reported(ahead, ["Search direction computation."] * len(y))
        return [-self._change(e, current) / epsilon for e in evaluations]

    def _line_search(
        self, y: list[float], h: list[float], current: Evaluation, slope: float
    ) -> Generator[list[Point], list[Evaluation], tuple[float, Evaluation]]:
        """The longest step with the required decrease, or the next longer one if its cost is lower."""
        rules, k, loops, start, restarted = self._rules, self._k, 0, self._k, False

        def length(exponent: int) -> float:
            return rules.beta**exponent

        def label(exponent: int) -> str:
            return f"Line search. lambda = {self._text(length(exponent))}."

        def decreases(e: Evaluation, exponent: int) -> bool:
            return self._change(e, current) <= length(exponent) * rules.alpha * slope

        short, long = yield from self._pair(y, h, k, label)
        while not self._spent():
            loops += 1
            if (loops > rules.l_max or k > start + rules.kappa) and not restarted:
                restarted, loops, k, start = True, 0, rules.k_star, rules.k_star
                short, long = yield from self._pair(y, h, k, label)
            elif loops > rules.l_max + rules.kappa:
                break
            elif not decreases(short, k):
                k, long = k + 1, short
                (short,) = yield from self._reported([_along(y, h, length(k))], [label(k)])
            elif decreases(long, k - 1):
                k -= 1
                (further,) = yield from self._reported([_along(y, h, length(k - 1))], [label(k - 1)])
                short, long = long, further
            else:
                break
        if long.cost < short.cost:
            k, short = k - 1, long
        self._k = k
        return length(k), short

    def _pair(self, y: list[float], h: list[float], k: int, label: Callable[[int], str]) -> _Batch:
        """Two neighboring step lengths, evaluated together."""
        ends = [_along(y, h, self._rules.beta**j) for j in (k, k - 1)]
        return (yield from self._reported(ends, [label(k), label(k - 1)]))

    def _reported(self, coordinates: list[list[float]], comments: list[str]) -> _Batch:
        """Evaluate points together and report each."""
        evaluations = yield [self._point(y) for y in coordinates]
        for e, comment in zip(evaluations, comments, strict=True):
            self.observer.sub(e, comment)
        return evaluations

    def _point(self, y: list[float]) -> Point:
        """Parameter values for normalized coordinates around the initial point."""
        t = [o + v * w for o, v, w in zip(self._origin, y, self._width, strict=True)]
        return Point(original(self.space, t), (), self.step_number)

    def _change(self, new: Evaluation, old: Evaluation) -> float:
        """Difference of costs in units of the initial cost."""
        return new.cost / self._scale - old.cost / self._scale

    def _spent(self) -> bool:
        return self._limit is not None and self._count >= self._limit

    def _both(self, e: Evaluation, comment: str) -> None:
        self.observer.sub(e, comment)
        self.observer.main(e, comment)


def _along(y: list[float], h: list[float], length: float) -> list[float]:
    """The point at a distance along a direction."""
    return [a + length * b for a, b in zip(y, h, strict=True)]

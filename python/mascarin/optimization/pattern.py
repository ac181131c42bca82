"""Pattern searches: Hooke-Jeeves and coordinate search, with several starts.

References
----------
Hooke and Jeeves (1961), doi:10.1145/321062.321069.
"""

from __future__ import annotations

from itertools import chain, islice

from mascarin.optimization.base import CostOf
from mascarin.optimization.mesh_search import OUTSIDE, MeshSearch, Trials
from mascarin.optimization.space import Evaluation, Point


class PatternSearch(MeshSearch):
    """Base of the pattern searches: a search on a mesh that can predict the next points.

    `HookeJeeves` and `CoordinateSearch` are two such searches.

    Parameters
    ----------
    space : Space
        Continuous parameters; discrete ones keep the value of the start.
    divider : int
        The mesh is `divider ** -exponent` wide, in steps of the parameters [-].
    exponent : int
        First mesh exponent [-].
    increment : int
        Added to the exponent at every reduction [-].
    reductions : int
        Number of reductions before the search ends [-].
    starts : sequence of Point, optional
        Points to start from, one after the other; the initial point of the space when absent.
    max_evaluations : int, optional
        Number of evaluations after which the search stops [-].
    sufficient : SufficientDecrease, optional
        Condition on a decrease; without it any decrease is accepted.
    penalty : bool
        Whether the cost depends on the step number, which then rises with every reduction.
    discrete_moves : bool
        Whether discrete parameters are tried at other values; else they keep the value of the start.
    rounding : callable, optional
        Rounded value for a value and its parameter's index; `decimal_rounding` when absent.
    text : callable
        Text of a number in comments.
    observer, remember
        See `Optimizer`.
    counted : int
        Number of evaluations that another search has made before; the limit counts them. [-]
    report_minimum : bool
        Whether the minimum is reported to the observer at the end.

    Examples
    --------
    >>> issubclass(HookeJeeves, PatternSearch)
    True
    """

    def guesses(self, limit: int, cost_of: CostOf) -> list[Point]:
        """Neighbors that this search would try next, and the next points of later starts.

        Parameters
        ----------
        limit : int
            Largest number of points wanted. [-]
        cost_of : callable
            Cost of a point that has been evaluated, None for another.

        Returns
        -------
        list of Point
            At most `limit` points that are neither known nor pending.
        """
        skip = set(self._pending)
        shadows = self._follow(cost_of)
        ahead = chain(
            chain.from_iterable(s._pending for s in shadows),
            self._plan(),
            chain.from_iterable(s._plan() for s in shadows),
        )
        fresh = (
            p
            for p in dict.fromkeys(ahead)
            if p not in skip and self.space.feasible(p.x) and cost_of(p) is None
        )
        return list(islice(fresh, limit))

    def _follow(self, cost_of: CostOf) -> list[MeshSearch]:
        """Advance a copy of every later start as far as known costs allow.

        The copies assume that the earlier starts do not change the preferred directions. Where that is
        wrong, their guesses are useless but do no harm.
        """
        for k in range(self._current + 1, len(self._starts)):
            if k not in self._shadows:
                self._shadows[k] = self._shadow(self._starts[k])
        for k in [k for k in self._shadows if k <= self._current]:
            del self._shadows[k]
        for shadow in self._shadows.values():
            while points := shadow.ask():
                costs = [cost_of(p) for p in points]
                evaluations = [Evaluation(p, c) for p, c in zip(points, costs, strict=True) if c is not None]
                if len(evaluations) < len(points):
                    break
                shadow.tell(evaluations)
        return list(self._shadows.values())

    def _shadow(self, start: Point) -> PatternSearch:
        """A copy of this search for one start, without an observer."""
        return type(self)(
            self.space,
            divider=self._divider,
            exponent=self._exponent,
            increment=self._increment,
            reductions=self._reductions,
            starts=[start],
            sufficient=self._sufficient,
            penalty=self._penalty,
            discrete_moves=self._discrete_moves,
            rounding=self._round,
            remember=False,
        )


class HookeJeeves(PatternSearch):
    """Pattern search that first repeats the last successful move.

    Parameters
    ----------
    space, divider, exponent, increment, reductions, starts, max_evaluations, sufficient
        As in `PatternSearch`.
    penalty, discrete_moves, rounding, text, observer, remember, counted, report_minimum
        As in `PatternSearch`.

    References
    ----------
    Hooke and Jeeves (1961), doi:10.1145/321062.321069.

    Examples
    --------
    >>> from mascarin.optimization import box, minimize
    >>> space = box(["x", "y"], initial=[0.0, 0.0], lower=[-1.0, -1.0], upper=[1.0, 1.0])
    >>> best = minimize(HookeJeeves(space), lambda points: [p.x[0] ** 2 + p.x[1] ** 2 for p in points])
    >>> best.cost
    0.0
    """

    def _global_search(self, best: Evaluation, previous: Evaluation, iteration: int) -> Trials:
        """Explore around the point one more move ahead."""
        if iteration == 0:
            return (yield from self._local_search(best))
        ahead = tuple(2.0 * a - b for a, b in zip(best.point.x, previous.point.x, strict=True))
        base = yield from self._evaluate(ahead, best.point.choices, self._plan_around(ahead))
        if base.cost != OUTSIDE:
            self.observer.sub(base, f"Exploration base, Delta = {self._text(self._delta)}.")
        return (yield from self._local_search(base))


class CoordinateSearch(PatternSearch):
    """Pattern search that only tries the neighbors of the current point.

    Parameters
    ----------
    space, divider, exponent, increment, reductions, starts, max_evaluations, sufficient
        As in `PatternSearch`.
    penalty, discrete_moves, rounding, text, observer, remember, counted, report_minimum
        As in `PatternSearch`.

    Examples
    --------
    >>> from mascarin.optimization import box, minimize
    >>> space = box(["x"], initial=[0.8], lower=[-1.0], upper=[1.0])
    >>> minimize(CoordinateSearch(space), lambda points: [p.x[0] ** 2 for p in points]).cost
    0.0
    """

    def _global_search(self, best: Evaluation, previous: Evaluation, iteration: int) -> Trials:
        """No trials away from the current point."""
        yield from ()
        return []

"""Simplex search of Nelder and Mead with the restart of O'Neill.

References
----------
Nelder and Mead (1965), doi:10.1093/comjnl/7.4.308.
O'Neill (1971), Algorithm AS 47, doi:10.2307/2346772.
"""

from __future__ import annotations

import math
from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace

from mascarin.errors import InputError, SolverError
from mascarin.optimization.base import CONVERGED, EXHAUSTED, Observer, Optimizer, Steps
from mascarin.optimization.space import Evaluation, Point, Space
from mascarin.optimization.transform import free_step, original, to_free

_Free = tuple[float, ...]
_ESTABLISH = "Establish initial simplex (1)."
_REFLECT = "Reflection (2)."
_EXPAND = "Expansion (4)."
_OUTSIDE = "Partial outside contraction (5)."
_INSIDE = "Partial inside contraction (6)."
_TOTAL = "Total contraction to best known point (7)."
_TOTAL_BEST = "Best known point in total contraction (7)."
_RESTART = "Invoke simplex reconstruction (10)."
_BASE = "Base point for optimality check."
_CHECK = "test optimality condition"
_STRETCH = "expand step size in testing optimality condition"


@dataclass(frozen=True, slots=True)
class _Vertex:
    """A corner of the simplex, in free variables, with its evaluation."""

    t: _Free
    e: Evaluation

    @property
    def f(self) -> float:
        return self.e.cost


_VertexSteps = Generator[list[Point], list[Evaluation], _Vertex]


class NelderMead(Optimizer):
    """Simplex search in free variables, restarted until no neighbor of the best point is lower.

    Parameters
    ----------
    space : Space
        At least two continuous parameters; bounds are kept by a change of variables.
    accuracy : float
        Standard deviation of the costs of the simplex below which it is tested [unit of the cost].
    step_factor : float
        Size of the test and of a restarted simplex, in steps of the parameters [-].
    block : int
        Number of iterations after a test before the next [-].
    modified : bool
        Whether a test also needs a contraction and a simplex that has changed its direction.
    max_iterations : int, optional
        Number of iterations after which the search stops [-].
    penalty : bool
        Whether the cost depends on the step number, which then rises with every iteration.
    observer, remember
        See `Optimizer`.

    References
    ----------
    Nelder and Mead (1965), doi:10.1093/comjnl/7.4.308. O'Neill (1971), doi:10.2307/2346772.

    Examples
    --------
    >>> from mascarin.optimization import box, minimize
    >>> space = box(["x", "y"], initial=[0.5, 0.5], lower=[-1.0, -1.0], upper=[1.0, 1.0])
    >>> best = minimize(NelderMead(space), lambda points: [p.x[0] ** 2 + p.x[1] ** 2 for p in points])
    >>> best.cost < 1e-4
    True
    """

    def __init__(
        self,
        space: Space,
        *,
        accuracy: float = 1e-4,
        step_factor: float = 0.1,
        block: int = 5,
        modified: bool = True,
        max_iterations: int | None = None,
        penalty: bool = False,
        observer: Observer | None = None,
        remember: bool = True,
    ) -> None:
        super().__init__(space, observer=observer, remember=remember)
        space.require_continuous(type(self).__name__)
        space.require_start()
        if len(space.continuous) < 2:
            msg = "a simplex search needs at least two continuous parameters; use a search on a line for one"
            raise InputError(msg)
        self._accuracy, self._factor = accuracy, step_factor
        self._block, self._modified = block, modified
        self._limit = max_iterations
        self._penalty = penalty
        self._main = 1

    # ------------------------------------------------------------------ the algorithm

    def _search(self) -> Steps:
        """Simplex after simplex, until the optimality check passes."""
        start = tuple(to_free(c, c.initial) for c in self.space.continuous)
        corner = yield from self._vertex(start)
        self._both(corner, _ESTABLISH)
        simplex = yield from self._build(corner, 1.0)
        allowed = self._block
        centers = [_center(simplex)]
        while True:
            contracted = yield from self._iterate(simplex)
            centers = [*centers[-2:], _center(simplex)]
            if self._limit is not None and self._main >= self._limit:
                self.observer.minimum("Current lowest point.")
                return EXHAUSTED
            if self._main >= allowed and self._flat(simplex) and self._turning(centers, contracted):
                lower = yield from self._check(_best(simplex))
                if lower is None:
                    self.observer.minimum("Minimum point.")
                    return CONVERGED
                self._report_main(lower, _RESTART)
                simplex = yield from self._build(lower, self._factor)
                allowed = self._main + self._block
                centers = [_center(simplex)]
            elif self._penalty:
                yield from self._raise_step(simplex)

    def _build(
        self, corner: _Vertex, factor: float
    ) -> Generator[list[Point], list[Evaluation], list[_Vertex]]:
        """A simplex with one edge along each coordinate."""
        simplex = [corner]
        for i, step in enumerate(self._free_steps(corner)):
            t = (*corner.t[:i], corner.t[i] + factor * step, *corner.t[i + 1 :])
            simplex.append((yield from self._vertex(t)))
            self._report_sub(simplex[-1], _ESTABLISH)
        return simplex

    def _iterate(self, simplex: list[_Vertex]) -> Generator[list[Point], list[Evaluation], bool]:
        """One step; whether it ended in an inside or total contraction."""
        low = _best(simplex)
        w = max(range(len(simplex)), key=lambda i: (simplex[i].f, i))
        high = simplex[w]
        center = _center([v for i, v in enumerate(simplex) if i != w])
        reflected = yield from self._trial(_line(center, high.t, 2.0), _REFLECT)
        if reflected.f < low.f:
            expanded = yield from self._trial(_line(reflected.t, center, 2.0), _EXPAND)
            simplex[w] = expanded if expanded.f < low.f else reflected
            self._report_main(simplex[w], _EXPAND)
            return False
        rank = sum(v.f <= reflected.f for v in simplex)
        if rank < len(simplex) - 1:
            simplex[w] = reflected
            self._report_main(reflected, _REFLECT)
            return False
        inside = rank == len(simplex)
        towards = high if inside else reflected
        comment = _INSIDE if inside else _OUTSIDE
        pulled = yield from self._trial(_middle(center, towards.t), comment)
        if pulled.f < high.f if inside else pulled.f <= reflected.f:
            simplex[w] = pulled
            self._report_main(pulled, comment)
            return inside
        yield from self._shrink(simplex, low)
        return True

    def _shrink(self, simplex: list[_Vertex], low: _Vertex) -> Generator[list[Point], list[Evaluation], None]:
        """Move every other corner half-way to the best one."""
        self._both(low, _TOTAL_BEST)
        for i, v in enumerate(simplex):
            if v is not low:
                simplex[i] = yield from self._vertex(_middle(v.t, low.t))
                self._both(simplex[i], _TOTAL)

    def _check(self, low: _Vertex) -> Generator[list[Point], list[Evaluation], _Vertex | None]:
        """A lower neighbor of the best corner, if there is one."""
        self._report_sub(low, _BASE)
        for i, step in enumerate(self._free_steps(low)):
            for sign in (1.0, -1.0):
                neighbor = yield from self._probe(low, i, sign * self._factor * step)
                if neighbor.f < low.f:
                    return neighbor
        return None

    def _free_steps(self, corner: _Vertex) -> list[float]:
        """Steps of the parameters in free variables, around a corner."""
        pairs = zip(self.space.continuous, corner.e.point.x, strict=True)
        return [free_step(c, x) for c, x in pairs]

    def _probe(self, low: _Vertex, i: int, step: float) -> _VertexSteps:
        """A neighbor whose cost differs; the distance grows while it does not."""
        for k in range(6):
            t = (*low.t[:i], low.t[i] + step * math.exp(k), *low.t[i + 1 :])
            neighbor = yield from self._vertex(t)
            self._report_sub(neighbor, _STRETCH if k else _CHECK)
            if neighbor.f != low.f:
                return neighbor
        msg = (
            f"the cost {low.f!r} does not change with parameter '{self.space.continuous[i].name}' "
            "(nullspace); remove it, or take larger steps"
        )
        raise SolverError(msg)

    def _raise_step(self, simplex: list[_Vertex]) -> Generator[list[Point], list[Evaluation], None]:
        """Next step number, with the best corner evaluated for the new penalty."""
        self.step_number += 1
        low = _best(simplex)
        (e,) = yield [replace(low.e.point, step=self.step_number)]
        simplex[next(i for i, v in enumerate(simplex) if v is low)] = _Vertex(low.t, e)

    # ------------------------------------------------------------------ tests and reports

    def _flat(self, simplex: Sequence[_Vertex]) -> bool:
        """Whether the costs of the corners are nearly equal."""
        n = len(simplex) - 1
        total = sum(v.f for v in simplex)
        return (sum(v.f * v.f for v in simplex) - total * total / (n + 1)) / n < self._accuracy**2

    def _turning(self, centers: Sequence[_Free], contracted: bool) -> bool:
        """Whether the simplex shrinks and no longer moves in one direction."""
        if not self._modified:
            return True
        if not contracted or len(centers) < 3:
            return False
        a, b, c = centers
        return sum((y - x) * (z - y) for x, y, z in zip(a, b, c, strict=True)) <= 0.0

    def _vertex(self, t: _Free) -> _VertexSteps:
        """Evaluate a point of free variables."""
        (e,) = yield [Point(original(self.space, t), (), self.step_number)]
        return _Vertex(t, e)

    def _trial(self, t: _Free, comment: str) -> _VertexSteps:
        """Evaluate and report a point."""
        v = yield from self._vertex(t)
        self._report_sub(v, comment)
        return v

    def _report_sub(self, v: _Vertex, comment: str) -> None:
        self.observer.sub(v.e, comment)

    def _report_main(self, v: _Vertex, comment: str) -> None:
        self.observer.main(v.e, comment)
        self._main += 1

    def _both(self, v: _Vertex, comment: str) -> None:
        self._report_sub(v, comment)
        self._report_main(v, comment)


def _best(simplex: Sequence[_Vertex]) -> _Vertex:
    """First corner of lowest cost."""
    return min(simplex, key=lambda v: v.f)


def _center(simplex: Sequence[_Vertex]) -> _Free:
    """Mean of the corners."""
    n = len(simplex)
    return tuple(sum(column) / n for column in zip(*(v.t for v in simplex), strict=True))


def _line(a: _Free, b: _Free, factor: float) -> _Free:
    """The point `factor * a - b`, the reflection of `b` at `a` when the factor is 2."""
    return tuple(factor * x - y for x, y in zip(a, b, strict=True))


def _middle(a: _Free, b: _Free) -> _Free:
    """Half-way between two points."""
    return tuple((x + y) / 2.0 for x, y in zip(a, b, strict=True))

"""Search on a mesh that is refined whenever no neighbor has a lower cost.

References
----------
Torczon (1997), On the convergence of pattern search algorithms, doi:10.1137/S1052623493250780.
Polak and Wetter (2006), Precision control for generalized pattern search algorithms,
doi:10.1137/040605527.
"""

from __future__ import annotations

import math
import sys
from abc import abstractmethod
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from itertools import chain, islice, zip_longest

from mascarin.errors import InputError, SolverError
from mascarin.optimization.base import CONVERGED, EXHAUSTED, Observer, Optimizer, Steps
from mascarin.optimization.mesh import SufficientDecrease, decimal_rounding
from mascarin.optimization.space import Evaluation, Point, Space

OUTSIDE = sys.float_info.max
"""Cost of a point outside the bounds, which is not evaluated."""

_Batch = Generator[list[Point], list[Evaluation], Evaluation]
Trials = Generator[list[Point], list[Evaluation], list[Evaluation]]
"""What an exploration is inside: it yields points and returns the evaluations of all its trials."""


class MeshSearch(Optimizer):
    """Base of the searches on a mesh that is refined whenever no neighbor is better.

    Parameters are those of `PatternSearch`.
    """

    def __init__(
        self,
        space: Space,
        *,
        divider: int = 2,
        exponent: int = 0,
        increment: int = 1,
        reductions: int = 4,
        starts: Sequence[Point] | None = None,
        max_evaluations: int | None = None,
        sufficient: SufficientDecrease | None = None,
        penalty: bool = False,
        discrete_moves: bool = False,
        rounding: Callable[[float, int], float] | None = None,
        text: Callable[[float], str] = repr,
        observer: Observer | None = None,
        remember: bool = True,
        counted: int = 0,
        report_minimum: bool = True,
    ) -> None:
        super().__init__(space, observer=observer, remember=remember)
        if divider < 2 or exponent < 0 or increment < 1 or reductions < 1:
            msg = (
                f"mesh of divider {divider}, exponent {exponent}, increment {increment} and "
                f"{reductions} reductions: expected at least 2, 0, 1 and 1"
            )
            raise InputError(msg)
        if starts is None:
            space.require_start()
        self._divider, self._exponent = divider, exponent
        self._increment, self._reductions = increment, reductions
        self._starts = list(starts) if starts is not None else [space.initial]
        self._limit = max_evaluations
        self._sufficient = sufficient
        self._penalty = penalty
        self._discrete_moves = discrete_moves
        self._steps_count = penalty or (sufficient is not None and sufficient.counts_steps)
        self._round = rounding or decimal_rounding(space)
        self._text = text
        # 0: the positive direction of a coordinate is tried first, 1: the negative one.
        self._signs = [0] * len(space.continuous)
        self._delta = self._mesh(exponent)
        self._scale: float | None = None
        self._current = 0
        self._reduced = 0
        self._before = 0
        self._plan: Callable[[], Iterable[Point]] = tuple
        self._shadows: dict[int, MeshSearch] = {}
        self._count = counted
        self._report_minimum = report_minimum

    # ------------------------------------------------------------------ the algorithm

    def _search(self) -> Steps:
        """All starts, one after the other."""
        multi_start = len(self._starts) > 1
        converged = False
        lowest = math.inf
        for k, start in enumerate(self._starts):
            self._current = k
            self._before = self._count
            self.step_number = 1
            if multi_start:
                self.observer.note(f"Start search for point number {k + 1}.")
            reason, end = yield from self._descend(start, multi_start=multi_start)
            converged = converged or reason == CONVERGED
            if multi_start:
                self.observer.note(f"Minimum cost obtained for this point {self._text(end.cost)}.")
                if k > 0:
                    verb = "further decreased" if end.cost < lowest else "did not further decrease"
                    self.observer.note(f"Search {verb} the cost.")
            lowest = min(lowest, end.cost)
        if multi_start and self._report_minimum:
            self.observer.minimum("Minimum point.")
        return CONVERGED if converged else EXHAUSTED

    def _descend(
        self, start: Point, *, multi_start: bool
    ) -> Generator[list[Point], list[Evaluation], tuple[str, Evaluation]]:
        """One search from one start."""
        exponent, done = self._exponent, 0
        self._delta = self._mesh(exponent)
        best = yield from self._evaluate(start.x, start.choices, self._plan_around(start.x))
        previous = best
        self._both(best, "Initial point.")
        iteration = 0
        while True:
            global_trials = yield from self._global_search(best, previous, iteration)
            local_trials: list[Evaluation] = []
            if not global_trials or not self._better(_lowest(global_trials), best):
                local_trials = yield from self._local_search(best)
            candidates = local_trials + global_trials
            candidate = _lowest(candidates) if candidates else best
            iteration += 1
            self._reduced = done
            previous = best
            if candidates and self._better(candidate, best):
                where = "Local" if _index(candidates, candidate) < len(local_trials) else "Global"
                best = candidate
                self._both(best, f"{where} search reduced cost{self._sufficiently_dot}")
            elif done == self._reductions:
                self._both(best, f"{self._failed} Maximum number of step reductions reached.")
                if multi_start:
                    self._both(best, "Best iterate of current search.")
                elif self._report_minimum:
                    self.observer.minimum("Minimum point.")
                return CONVERGED, best
            else:
                exponent, best = yield from self._reduce(exponent, best)
                previous = best
                done += 1
            if self._exhausted:
                self.observer.minimum("Current lowest point.")
                return EXHAUSTED, best

    @abstractmethod
    def _global_search(self, best: Evaluation, previous: Evaluation, iteration: int) -> Trials:
        """Trials away from the current point."""

    def _reduce(
        self, exponent: int, best: Evaluation
    ) -> Generator[list[Point], list[Evaluation], tuple[int, Evaluation]]:
        """Refine the mesh after an iteration without success."""
        by = self._increment
        if self._sufficient is not None and self._sufficient.alpha is not None:
            return (yield from self._control_precision(exponent, best, self._sufficient))
        exponent += by
        self._delta = self._mesh(exponent)
        comment = f"{self._failed} Reduce step size to '{self._text(self._delta)}'."
        self._both(best, comment)
        if self._steps_count:
            best = yield from self._raise_step(best, comment)
        return exponent, best

    def _control_precision(
        self, exponent: int, best: Evaluation, rule: SufficientDecrease
    ) -> Generator[list[Point], list[Evaluation], tuple[int, Evaluation]]:
        """Refine the mesh as far as the required decrease needs."""
        alpha = rule.alpha or 0.0
        before = rule.phi(self._delta, self.step_number, best)
        after = rule.phi(self._delta, self.step_number + 1, best)
        if not after < before:
            msg = (
                f"Phi does not fall when the step number rises from {self.step_number} by one "
                f"({before!r} to {after!r}); with Alpha it must"
            )
            raise SolverError(msg)
        if after**alpha / self._delta < self._delta:
            ratio = math.log(self._delta / after ** (alpha / 2.0)) / math.log(self._divider)
            by = int(self._increment * math.ceil(ratio / self._increment))
            exponent += by
            self._delta = self._mesh(exponent)
            self.observer.note(
                f"Set N = {self.step_number + 1}; Phi = {self._text(after)}; t = {by}; "
                f"Delta = {self._text(self._delta)}."
            )
        # As in GenOpt, the failed iteration is reported once, after the counters have started again, and
        # without the new step size.
        best = yield from self._raise_step(best, self._failed)
        return exponent, best

    def _raise_step(self, best: Evaluation, comment: str) -> _Batch:
        """Next step number: counters start again and the point is evaluated for the new penalty."""
        self.step_number += 1
        self.observer.restart()
        if self._penalty:
            x = best.point.x
            best = yield from self._evaluate(x, best.point.choices, self._plan_around(x))
        self._both(best, comment)
        return best

    def _local_search(self, around: Evaluation) -> Trials:
        """Try both directions of every coordinate; a lower cost becomes the next base."""
        low, trials = around, []
        for i in range(len(self._signs)):
            if self._exhausted:
                break
            trial = yield from self._perturb(low, i)
            trials.append(trial)
            if self._better(trial, low):
                low = trial
            elif not self._exhausted:
                trial = yield from self._perturb(low, i)
                trials.append(trial)
                if self._better(trial, low):
                    low = trial
        if self._discrete_moves:
            trials += yield from self._discrete_search(low)
        return trials

    def _discrete_search(self, low: Evaluation) -> Trials:
        """Try the other values of every discrete parameter; a lower cost becomes the next base.

        Audet and Dennis (2001), doi:10.1137/S1052623499352024.
        """
        trials: list[Evaluation] = []
        for j, d in enumerate(self.space.discrete):
            base_choices = low.point.choices
            for k in range(d.size):
                if k == base_choices[j] or self._exhausted:
                    continue
                choices = (*base_choices[:j], k, *base_choices[j + 1 :])
                trial = yield from self._evaluate(low.point.x, choices, tuple)
                trials.append(trial)
                better = self._better(trial, low)
                if trial.cost != OUTSIDE:
                    verb = "reduced    " if better else "not reduced"
                    self.observer.sub(trial, f"Cost {verb} at {d.name}, value {k + 1}.")
                if better:
                    low = trial
        return trials

    def _perturb(self, base: Evaluation, i: int) -> _Batch:
        """One trial; where it is not better, the base itself, and the other direction is tried next."""
        name = self.space.continuous[i].name
        x = self._moved(base.point.x, i, self._signs[i])
        trial = yield from self._evaluate(x, base.point.choices, self._plan_poll(base.point.x, x, i))
        direction = f"at {name}{'-' if self._signs[i] else '+'}d{name}."
        amount = "sufficiently " if self._sufficient else ""
        feasible = trial.cost != OUTSIDE
        if self._better(trial, base):
            if feasible:
                self.observer.sub(trial, f"Cost {amount}reduced     {direction}")
            return trial
        if feasible:
            self.observer.sub(trial, f"Cost not {amount}reduced {direction}")
        self._signs[i] = 1 - self._signs[i]
        return base

    def _evaluate(
        self, x: tuple[float, ...], choices: tuple[int, ...], plan: Callable[[], Iterable[Point]]
    ) -> _Batch:
        """Cost of a point; one outside the bounds costs more than any other and is not evaluated."""
        point = self._point(x, choices)
        if not self.space.feasible(point.x):
            return Evaluation(point, OUTSIDE, number=self._count)
        self._plan = plan
        (result,) = yield [point]
        return result

    def _better(self, new: Evaluation, old: Evaluation) -> bool:
        """Whether a cost is lower, by the required amount where one is set."""
        rule = self._sufficient
        if rule is None:
            return new.cost < old.cost
        if self._scale is None:
            if abs(old.cost) <= 1e-50:
                scale = 1.0
            else:
                scale = self._scale = old.cost
        else:
            scale = self._scale
        return (new.cost - old.cost) / scale < -rule.zeta * rule.phi(self._delta, self.step_number, new)

    # ------------------------------------------------------------------ small helpers

    @property
    def remaining(self) -> int | None:
        """Estimate: a round of neighbors for each mesh size left; later starts as earlier ones."""
        around = 2 * len(self._signs) + sum(d.size - 1 for d in self.space.discrete if self._discrete_moves)
        current = (self._reductions - self._reduced + 1) * around
        used = self._before / self._current if self._current else self._count + current
        later = (len(self._starts) - self._current - 1) * used
        total = round(current + later)
        return total if self._limit is None else min(total, max(self._limit - self._count, 0))

    @property
    def _failed(self) -> str:
        """First sentence of the comment of an iteration without success."""
        return f"Iteration step did not {'sufficiently ' if self._sufficient else ''}reduce cost."

    @property
    def _sufficiently_dot(self) -> str:
        """End of the comment of an iteration with success."""
        return " sufficiently ." if self._sufficient else "."

    @property
    def _exhausted(self) -> bool:
        """Whether no more evaluations are allowed."""
        return self._limit is not None and self._count >= self._limit

    def _both(self, evaluation: Evaluation, comment: str) -> None:
        """Report the end of an iteration."""
        self.observer.sub(evaluation, comment)
        self.observer.main(evaluation, comment)

    def _mesh(self, exponent: int) -> float:
        """Mesh size for an exponent [steps of the parameters]."""
        return 1.0 / math.pow(self._divider, exponent)

    def _moved(self, x: tuple[float, ...], i: int, sign: int) -> tuple[float, ...]:
        """A neighbor on the mesh along one coordinate."""
        step = self.space.continuous[i].step
        return (*x[:i], x[i] + self._delta * (-step if sign else step), *x[i + 1 :])

    def _point(self, x: Iterable[float], choices: tuple[int, ...]) -> Point:
        """Rounded point at the current step number."""
        rounded = tuple(self._round(v, i) for i, v in enumerate(x))
        return Point(rounded, choices, self.step_number if self._steps_count else 1)

    # ------------------------------------------------------------------ what comes next

    def _plan_around(self, x: tuple[float, ...]) -> Callable[[], Iterable[Point]]:
        """All neighbors of a point, those in the preferred directions first."""
        return lambda: chain.from_iterable(self._neighbors(x, i) for i in range(len(x)))

    def _neighbors(self, x: tuple[float, ...], i: int) -> Iterator[Point]:
        """Both neighbors along one coordinate."""
        choices = self._starts[self._current].choices
        for sign in (self._signs[i], 1 - self._signs[i]):
            yield self._point(self._moved(x, i, sign), choices)

    def _plan_poll(
        self, base: tuple[float, ...], trial: tuple[float, ...], i: int
    ) -> Callable[[], Iterable[Point]]:
        """Points after a trial, alternately for a trial that is not better and for one that is."""

        def plan() -> Iterator[Point]:
            failure = chain(
                islice(self._neighbors(base, i), 1, None),
                chain.from_iterable(self._neighbors(base, j) for j in range(i + 1, len(base))),
            )
            success = chain.from_iterable(self._neighbors(trial, j) for j in range(i + 1, len(base)))
            for pair in zip_longest(failure, success):
                yield from (p for p in pair if p is not None)

        return plan


def _lowest(evaluations: Sequence[Evaluation]) -> Evaluation:
    """First evaluation of lowest cost."""
    return min(evaluations, key=lambda e: e.cost)


def _index(evaluations: Sequence[Evaluation], evaluation: Evaluation) -> int:
    """Position of the very object, not of an equal one."""
    return next(i for i, e in enumerate(evaluations) if e is evaluation)

"""Sequences of an ask and tell optimiser, side by side, until enough of them agree."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.cost import Cost
from mascarin.calibration.evaluations import Evaluator
from mascarin.calibration.fit import Minimum
from mascarin.calibration.problem import CalibrationProblem
from mascarin.calibration.rules import Rules
from mascarin.errors import SolverError
from mascarin.optimization import (
    CovarianceSearch,
    Evaluation,
    HookeJeeves,
    Optimizer,
    ParticleSwarm,
    Point,
    Space,
    SwarmRules,
    SwarmThenPattern,
    box,
)

Floats = NDArray[np.float64]

Make = Callable[[Space, int], Optimizer]
"""Makes the optimiser of one sequence from its space and a seed of its own."""

_GRID: Final = 2.0**26
_LONGEST: Final = 5000  # evaluations of one evolution strategy
_FINE: Final = 1e-6  # of the range, where an evolution strategy ends


def maker(method: str, rules: Rules) -> Make:
    """What makes the optimisers of a method.

    Parameters
    ----------
    method : str
        ``hooke-jeeves``, ``particle-swarm``, ``hybrid`` or ``cma-es``.
    rules : Rules
        How finely they search.
    """
    return {
        "hooke-jeeves": lambda space, _: HookeJeeves(space, reductions=rules.reductions, rounding=_exact),
        "particle-swarm": lambda space, seed: ParticleSwarm(space, _swarm(rules, seed)),
        "hybrid": lambda space, seed: SwarmThenPattern(
            space, _swarm(rules, seed), reductions=rules.reductions, rounding=_exact
        ),
        "cma-es": lambda space, seed: CovarianceSearch(
            space, sigma=rules.step, max_evaluations=_LONGEST, seed=seed, finest=_FINE
        ),
    }[method]


def _exact(value: float, _: int) -> float:
    """No rounding: the binary grid keeps every point of a mesh exact."""
    return value


def _swarm(rules: Rules, seed: int) -> SwarmRules:
    return SwarmRules(particles=rules.particles, generations=rules.generations, seed=seed)


@dataclass(eq=False)
class _Sequence:
    """One running search."""

    number: int
    start: Floats
    optimiser: Optimizer
    asked: int = 0

    def minimum(self, problem: CalibrationProblem) -> Minimum:
        best = self.optimiser.best
        x = problem.values(np.array([best.point.x]))[0]
        return Minimum(
            self.number, problem.values(self.start[None])[0], x, best.cost, self.asked, self.optimiser.reason
        )


def multi_start(
    problem: CalibrationProblem,
    evaluator: Evaluator,
    rules: Rules,
    seed: int,
    make: Make,
    agree: int,
) -> tuple[list[Minimum], str]:
    """Sequences side by side until enough of them, counted from the first, agree on the lowest cost.

    Gives where they ended, and why the searching ended. Which sequences count depends on their numbers alone
    and not on which ended first, so the number that runs side by side does not change the result.
    """
    running: list[_Sequence] = []
    ended: dict[int, Minimum] = {}
    agreement = _Agreement(agree, rules.within, evaluator.cost)
    begun = asked_in_all = 0
    while True:
        while begun < rules.sequences and len(running) < rules.together:
            running.append(_begin(problem, rules, begun, seed, make))
            begun += 1
        batch = [(s, s.optimiser.ask()) for s in running]
        _require_points(batch)
        points = [point.x for _, asked in batch for point in asked]
        costs = iter(evaluator.costs(problem.values(np.array(points)))) if points else iter(())
        for sequence, asked in batch:
            sequence.asked += len(asked)
            asked_in_all += len(asked)
            sequence.optimiser.tell([Evaluation(point, float(next(costs))) for point in asked])
            if sequence.optimiser.done:
                ended[sequence.number] = sequence.minimum(problem)
        running = [s for s in running if not s.optimiser.done]
        counted = agreement.counted(ended)
        if counted is not None:
            return counted, f"{agree} of {len(counted)} sequences reached the same minimum"
        first = _leading(ended)
        if len(first) == rules.sequences:
            return first, f"all {rules.sequences} sequences searched, without agreement of {agree}"
        if rules.evaluations is not None and asked_in_all >= rules.evaluations:
            unfinished = [s.minimum(problem) for s in running if s.asked]
            minima = sorted([*ended.values(), *unfinished], key=lambda m: m.sequence)
            return minima, f"budget of {rules.evaluations} evaluations used"


def _require_points(batch: list[tuple[_Sequence, list[Point]]]) -> None:
    """Refuse an optimiser that goes on without asking for anything: it would never end."""
    for sequence, asked in batch:
        if not asked and not sequence.optimiser.done:
            kind = type(sequence.optimiser).__name__
            msg = f"the optimiser {kind} of sequence {sequence.number} asks for no point and is not done"
            raise SolverError(msg)


class _Agreement:
    """Looks at the sequences in their order until enough of them agree."""

    def __init__(self, agree: int, within: float, cost: Cost) -> None:
        self._agree = agree
        self._within = within
        self._cost = cost
        self._minima: list[Minimum] = []

    def counted(self, ended: dict[int, Minimum]) -> list[Minimum] | None:
        """The sequences up to the one that brought the agreement, None while there is none."""
        while len(self._minima) in ended:
            self._minima.append(ended[len(self._minima)])
            costs = np.array([m.cost for m in self._minima])
            lowest = costs.min()
            if math.isfinite(lowest):
                same = costs <= lowest + self._cost.tolerance(float(lowest), self._within)
                if same.sum() >= self._agree:
                    return self._minima
        return None


def _leading(ended: dict[int, Minimum]) -> list[Minimum]:
    """The sequences from the first on without a gap."""
    minima: list[Minimum] = []
    while len(minima) in ended:
        minima.append(ended[len(minima)])
    return minima


def _begin(problem: CalibrationProblem, rules: Rules, number: int, seed: int, make: Make) -> _Sequence:
    """The given start for the first sequence, for the others one drawn from its number alone."""
    drawn = np.random.default_rng([seed, number])
    if number == 0:
        start = problem.positions(np.array([p.first for p in problem.parameters]))
    else:
        start = drawn.random(len(problem.parameters))
    # Start and step on a binary grid: every point of every refined mesh is then an exact number, and a mesh
    # point reached twice is the same point.
    start = np.round(start * _GRID) / _GRID
    step = max(round(rules.step * _GRID), 1) / _GRID
    n = len(problem.parameters)
    space = box(problem.paths, start.tolist(), [0.0] * n, [1.0] * n, [step] * n)
    return _Sequence(number, start, make(space, int(drawn.integers(1, 2**31))))

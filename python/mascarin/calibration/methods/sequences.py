"""Sequences: searches of one optimizer side by side, until enough of them reach the same minimum."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.base.cost import Cost
from mascarin.calibration.base.evaluations import Evaluator
from mascarin.calibration.base.problem import CalibrationProblem
from mascarin.calibration.base.result import Minimum
from mascarin.calibration.base.search_options import SearchOptions
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
"""Makes the optimizer of one sequence from its space and its seed."""

_GRID: Final = 2.0**26
_MAX_EVALUATIONS: Final = 5000  # evaluations of one evolution strategy
_MIN_STEP: Final = 1e-6  # of the range, where an evolution strategy ends


def maker(method: str, options: SearchOptions) -> Make:
    """Return the function that makes the optimizers of a method.

    Parameters
    ----------
    method : str
        ``hooke-jeeves``, ``particle-swarm``, ``hybrid`` or ``cma-es``.
    options : SearchOptions
        Options of the search.

    Returns
    -------
    callable
        See `Make`.
    """
    return {
        "hooke-jeeves": lambda space, _: HookeJeeves(space, reductions=options.reductions, rounding=_exact),
        "particle-swarm": lambda space, seed: ParticleSwarm(space, _swarm(options, seed)),
        "hybrid": lambda space, seed: SwarmThenPattern(
            space, _swarm(options, seed), reductions=options.reductions, rounding=_exact
        ),
        "cma-es": lambda space, seed: CovarianceSearch(
            space, sigma=options.step, max_evaluations=_MAX_EVALUATIONS, seed=seed, finest=_MIN_STEP
        ),
    }[method]


def _exact(value: float, _: int) -> float:
    """Round nothing: on the binary grid every point of a mesh is exact."""
    return value


def _swarm(options: SearchOptions, seed: int) -> SwarmRules:
    return SwarmRules(particles=options.particles, generations=options.generations, seed=seed)


@dataclass(eq=False)
class _Sequence:
    """One running search."""

    number: int
    start: Floats
    optimizer: Optimizer
    evaluations: int = 0

    def minimum(self, problem: CalibrationProblem) -> Minimum:
        best = self.optimizer.best
        x = problem.values(np.array([best.point.x]))[0]
        return Minimum(
            self.number,
            problem.values(self.start[None])[0],
            x,
            best.cost,
            self.evaluations,
            self.optimizer.reason,
        )


def multi_start(
    problem: CalibrationProblem,
    evaluator: Evaluator,
    options: SearchOptions,
    seed: int,
    make: Make,
    agree: int,
) -> tuple[list[Minimum], str]:
    """Run sequences side by side until enough of them, counted from the first, reach the lowest cost.

    Which sequences count depends on their numbers alone and not on which ended first, so that the number that
    runs side by side does not change the result.

    Parameters
    ----------
    problem : CalibrationProblem
        Parameters, measured series and model.
    evaluator : Evaluator
        Evaluates and keeps the record.
    options : SearchOptions
        Options of the search.
    seed : int
        Of all random numbers.
    make : callable
        Makes the optimizer of a sequence.
    agree : int
        Number of sequences that must reach the same minimum. [-]

    Returns
    -------
    list of Minimum
        Where the sequences ended.
    str
        Why the calibration ended.
    """
    running: list[_Sequence] = []
    ended: dict[int, Minimum] = {}
    agreement = _Agreement(agree, options.within, evaluator.cost)
    started = evaluations = 0
    while True:
        while started < options.sequences and len(running) < options.together:
            running.append(_start(problem, options, started, seed, make))
            started += 1
        batch = [(s, s.optimizer.ask()) for s in running]
        _require_points(batch)
        points = [point.x for _, requested in batch for point in requested]
        costs = iter(evaluator.costs(problem.values(np.array(points)))) if points else iter(())
        for sequence, requested in batch:
            sequence.evaluations += len(requested)
            evaluations += len(requested)
            sequence.optimizer.tell([Evaluation(point, float(next(costs))) for point in requested])
            if sequence.optimizer.done:
                ended[sequence.number] = sequence.minimum(problem)
        running = [s for s in running if not s.optimizer.done]
        counted = agreement.counted(ended)
        if counted is not None:
            return counted, f"{agree} of {len(counted)} sequences reached the same minimum"
        first = _leading(ended)
        if len(first) == options.sequences:
            return first, f"all {options.sequences} sequences searched, without agreement of {agree}"
        if options.evaluations is not None and evaluations >= options.evaluations:
            unfinished = [s.minimum(problem) for s in running if s.evaluations]
            minima = sorted([*ended.values(), *unfinished], key=lambda m: m.sequence)
            return minima, f"budget of {options.evaluations} evaluations used"


def _require_points(batch: list[tuple[_Sequence, list[Point]]]) -> None:
    """Refuse an optimizer that asks for no point and is not done: it would never end."""
    for sequence, requested in batch:
        if not requested and not sequence.optimizer.done:
            kind = type(sequence.optimizer).__name__
            msg = f"the optimizer {kind} of sequence {sequence.number} asks for no point and is not done"
            raise SolverError(msg)


class _Agreement:
    """Counts the sequences in their order until enough of them agree."""

    def __init__(self, agree: int, within: float, cost: Cost) -> None:
        self._agree = agree
        self._within = within
        self._cost = cost
        self._minima: list[Minimum] = []

    def counted(self, ended: dict[int, Minimum]) -> list[Minimum] | None:
        """Return the sequences up to the one that completes the agreement, None while there is none."""
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
    """Return the sequences from the first on without a gap."""
    minima: list[Minimum] = []
    while len(minima) in ended:
        minima.append(ended[len(minima)])
    return minima


def _start(
    problem: CalibrationProblem, options: SearchOptions, number: int, seed: int, make: Make
) -> _Sequence:
    """Start a sequence: at the given start for the first one, at one drawn from its number for the others."""
    rng = np.random.default_rng([seed, number])
    if number == 0:
        start = problem.positions(np.array([p.first for p in problem.parameters]))
    else:
        start = rng.random(len(problem.parameters))
    # Start and step on a binary grid: every point of every refined mesh is then an exact number, and a mesh
    # point reached twice is the same point.
    start = np.round(start * _GRID) / _GRID
    step = max(round(options.step * _GRID), 1) / _GRID
    n = len(problem.parameters)
    space = box(problem.paths, start.tolist(), [0.0] * n, [1.0] * n, [step] * n)
    return _Sequence(number, start, make(space, int(rng.integers(1, 2**31))))

"""The searches: gradient least squares and pattern search, each from several starts."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.cost import Cost, CostName
from mascarin.calibration.fit import Fit, Minimum
from mascarin.calibration.problem import CalibrationProblem
from mascarin.calibration.record import Evaluator
from mascarin.calibration.uncertainty import estimate, on_bounds, warnings
from mascarin.errors import InputError, SolverError
from mascarin.optimise import Evaluation, HookeJeeves, Optimiser, Space, box

Floats = NDArray[np.float64]
MethodName = Literal["least_squares", "pattern_search"]

METHODS: Final = ("least_squares", "pattern_search")

_GRID: Final = 2.0**26
_FINEST: Final = 24  # halvings after which a mesh on that grid is still exact


@dataclass(frozen=True, slots=True)
class Rules:
    """How long and how finely to search.

    Attributes
    ----------
    starts : int
        Least squares: number of starts, the given one and others spread over the ranges by a Latin
        hypercube. [-]
    difference : float
        Least squares and uncertainty: step of the finite differences, in ranges. [-]
    tolerance : float
        Least squares: relative change of cost or position at which a search ends. [-]
    agree : int
        Pattern search: number of sequences that must have reached the same minimum. [-]
    within : float
        Pattern search: costs within this share of the lowest are the same minimum, see `Cost.tolerance`. [-]
    sequences : int
        Pattern search: largest number of sequences. [-]
    evaluations : int, optional
        Pattern search: number of evaluations at which every sequence is stopped where it stands. [-]
    step : float
        Pattern search: first step, in ranges. [-]
    reductions : int
        Pattern search: how often the step is halved before a sequence ends. [-]
    together : int
        Pattern search: number of sequences that run side by side; unless `evaluations` ends the search,
        it changes only the time it takes. [-]
    """

    starts: int = 5
    difference: float = 1e-4
    tolerance: float = 1e-8
    agree: int = 10
    within: float = 1e-3
    sequences: int = 200
    evaluations: int | None = None
    step: float = 0.1
    reductions: int = 10
    together: int = 16

    def __post_init__(self) -> None:
        for name in ("starts", "agree", "sequences", "reductions", "together"):
            if getattr(self, name) < 1:
                msg = f"{name}: found {getattr(self, name)}, expected at least 1"
                raise InputError(msg)
        if self.reductions > _FINEST:
            msg = f"reductions: found {self.reductions}, expected at most {_FINEST}"
            raise InputError(msg)
        for name in ("difference", "step"):
            if not 0.0 < getattr(self, name) <= 0.5:
                msg = f"{name}: found {getattr(self, name):g}, expected a share of the range, 0 to 0.5"
                raise InputError(msg)


def solve(
    problem: CalibrationProblem,
    *,
    method: MethodName = "least_squares",
    cost: CostName = "nll",
    seed: int = 0,
    rules: Rules | None = None,
    optimiser: Callable[[Space], Optimiser] | None = None,
    record: Path | None = None,
    batch: int = 64,
    confidence: float = 0.95,
    progress: Callable[[int, float], object] | None = None,
) -> Fit:
    """Find the parameters that bring the model closest to the measurements.

    Parameters
    ----------
    problem : CalibrationProblem
        Parameters, measurements and model.
    method : str
        ``least_squares``: the sum of squared residuals over the sensors' uncertainty (and priors), by a
        trust-region method within the bounds, derivatives by differences made in one batch.
        ``pattern_search``: any cost, by Hooke-Jeeves sequences from random starts until the same minimum
        was reached by several.
    cost : str
        What is minimised, see `mascarin.calibration.cost`; least squares knows ``nll`` only.
    seed : int
        Of the random starts. Same problem, seed and rules: same fit.
    rules : Rules, optional
        How long and how finely to search.
    optimiser : callable, optional
        Makes the optimiser of one sequence from its space (positions between 0 and 1, the start included),
        in the place of Hooke-Jeeves.
    record : Path, optional
        File in which every evaluation is kept. If it exists, nothing in it is evaluated again: a calibration
        that was interrupted, or whose budget is raised, goes on from there and ends with the same result.
    batch : int
        Largest number of members handed to the model at once. [-]
    confidence : float
        Of the intervals. [-]
    progress : callable, optional
        Called after each batch with the number of evaluations and the lowest cost so far.

    Returns
    -------
    Fit

    Raises
    ------
    InputError
        For an unknown method or cost, a cost that is not a number at the start, or a foreign record.
    SolverError
        When no search ended at a point that can be evaluated.
    """
    if method not in METHODS:
        msg = f"method '{method}' is not known. Known: {', '.join(METHODS)}."
        raise InputError(msg)
    if method == "least_squares" and cost != "nll":
        msg = f"least squares minimises 'nll'; for the cost '{cost}' use the method 'pattern_search'"
        raise InputError(msg)
    if not 0.0 < confidence < 1.0:
        msg = f"confidence: found {confidence:g}, expected a number between 0 and 1, such as 0.95"
        raise InputError(msg)
    chosen = rules or Rules()
    function = Cost(problem, cost)
    keep = method == "least_squares"
    with Evaluator(function, record, keep_residuals=keep, batch=batch, progress=progress) as evaluator:
        _require_start(problem, evaluator)
        if method == "least_squares":
            minima, reason = _least_squares(problem, evaluator, chosen, seed)
        else:
            minima, reason = _multi_start(problem, evaluator, chosen, seed, optimiser)
        best = min(minima, key=lambda m: (m.cost, m.sequence))
        if not math.isfinite(best.cost):
            msg = f"none of {len(minima)} searches ended where the model could be evaluated; check the ranges"
            raise SolverError(msg)
        return _report(problem, evaluator, chosen, minima, reason, method, best, confidence, seed)


# --- least squares ------------------------------------------------------------------------------------


def _least_squares(
    problem: CalibrationProblem, evaluator: Evaluator, rules: Rules, seed: int
) -> tuple[list[Minimum], str]:
    """One trust-region search from each start."""
    from scipy.optimize import least_squares

    minima = []
    skipped = 0
    for k, z in enumerate(_hypercube(problem, rules.starts, seed)):
        if k and not np.isfinite(evaluator.costs(problem.values(z[None]))[0]):
            skipped += 1
            continue
        squares = _Squares(problem, evaluator, rules.difference)
        tight = rules.tolerance
        found = least_squares(
            squares.residuals,
            z,
            jac=squares.jacobian,
            bounds=(0.0, 1.0),
            method="trf",
            ftol=tight,
            xtol=tight,
            gtol=tight,
            max_nfev=100,
        )
        # The method stays a hair's breadth inside its bounds; what it means is the bound.
        end = np.where(found.x < 1e-6, 0.0, np.where(found.x > 1.0 - 1e-6, 1.0, found.x))
        x = problem.values(end[None])[0]
        cost = float(evaluator.costs(x[None])[0])
        minima.append(Minimum(k, problem.values(z[None])[0], x, cost, squares.asked, str(found.message)))
    text = f"{len(minima)} start{'s' * (len(minima) != 1)} searched"
    return minima, text + (f", {skipped} skipped because the model fails there" if skipped else "")


class _Squares:
    """Weighted residuals and their derivative by the positions z."""

    def __init__(self, problem: CalibrationProblem, evaluator: Evaluator, difference: float) -> None:
        self._problem = problem
        self._evaluator = evaluator
        self._difference = difference
        weight = np.array([s.weight for s in problem.sensors])
        self._scale = np.where(problem.mask, np.sqrt(weight) / problem.sigma, 0.0)[problem.mask]
        self.asked = 0

    def residuals(self, z: Floats) -> Floats:
        """Residuals over their uncertainty, then those of the priors."""
        # The neighbours are wanted next, unless the step is refused; together they fill a batch.
        points = np.concatenate([z[None], self._neighbours(z)])
        self.asked += points.shape[0]
        values: Floats = self._weighted(points)[0]
        return values

    def jacobian(self, z: Floats) -> Floats:
        """Forward differences, backward at the upper bound or where the model fails ahead."""
        points = np.concatenate([z[None], self._neighbours(z)])
        values = self._weighted(points)
        for i in np.flatnonzero(~np.isfinite(values[1:]).all(axis=1)):
            points[1 + i, i] = 2.0 * z[i] - points[1 + i, i]
            if not 0.0 <= points[1 + i, i] <= 1.0:
                points[1 + i, i] = z[i]
            values[1 + i] = self._weighted(points[1 + i : 2 + i])[0]
            self.asked += 1
        steps = np.diagonal(points[1:]) - z
        if not np.isfinite(values).all() or np.any(steps == 0.0):
            where = self._problem.values(z[None])[0]
            text = ", ".join(f"{p} = {v:g}" for p, v in zip(self._problem.paths, where, strict=True))
            msg = f"the model cannot be evaluated in the neighbourhood of {text}: no derivative there"
            raise SolverError(msg)
        return np.asarray(((values[1:] - values[0]) / steps[:, None]).T)

    def _neighbours(self, z: Floats) -> Floats:
        step = np.where(z + self._difference <= 1.0, self._difference, -self._difference)
        return np.asarray(z + np.diag(step))

    def _weighted(self, z: Floats) -> Floats:
        x = self._problem.values(z)
        residuals = self._evaluator.residuals(x)[:, self._problem.mask] * self._scale
        priors = self._evaluator.cost.prior_residuals(x)
        return np.asarray(np.concatenate([residuals, priors], axis=1), dtype=np.float64)


def _hypercube(problem: CalibrationProblem, count: int, seed: int) -> Iterator[Floats]:
    """The given start, then a Latin hypercube over the ranges."""
    from scipy.stats import qmc

    yield problem.positions(np.array([p.first for p in problem.parameters]))
    if count > 1:
        yield from qmc.LatinHypercube(len(problem.parameters), rng=np.random.default_rng(seed)).random(
            count - 1
        )


# --- sequences of an ask and tell optimiser -----------------------------------------------------------


@dataclass(eq=False)
class _Sequence:
    """One running search."""

    number: int
    start: Floats
    optimiser: Optimiser
    asked: int = 0

    def minimum(self, problem: CalibrationProblem) -> Minimum:
        best = self.optimiser.best
        x = problem.values(np.array([best.point.x]))[0]
        return Minimum(
            self.number, problem.values(self.start[None])[0], x, best.cost, self.asked, self.optimiser.reason
        )


def _multi_start(
    problem: CalibrationProblem,
    evaluator: Evaluator,
    rules: Rules,
    seed: int,
    make: Callable[[Space], Optimiser] | None,
) -> tuple[list[Minimum], str]:
    """Sequences side by side until enough of them, counted from the first, agree on the lowest cost.

    Which sequences count depends on their numbers alone and not on which ended first, so the number that
    runs side by side does not change the result.
    """
    running: list[_Sequence] = []
    ended: dict[int, Minimum] = {}
    agreement = _Agreement(rules, evaluator.cost)
    begun = asked_in_all = 0
    while True:
        while begun < rules.sequences and len(running) < rules.together:
            running.append(_begin(problem, rules, begun, seed, make))
            begun += 1
        batch = [(s, s.optimiser.ask()) for s in running]
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
            return counted, f"{rules.agree} of {len(counted)} sequences reached the same minimum"
        first = _leading(ended)
        if len(first) == rules.sequences:
            return first, f"all {rules.sequences} sequences searched, without agreement of {rules.agree}"
        if rules.evaluations is not None and asked_in_all >= rules.evaluations:
            unfinished = [s.minimum(problem) for s in running if s.asked]
            minima = sorted([*ended.values(), *unfinished], key=lambda m: m.sequence)
            return minima, f"budget of {rules.evaluations} evaluations used"


class _Agreement:
    """Looks at the sequences in their order until enough of them agree."""

    def __init__(self, rules: Rules, cost: Cost) -> None:
        self._rules = rules
        self._cost = cost
        self._minima: list[Minimum] = []

    def counted(self, ended: dict[int, Minimum]) -> list[Minimum] | None:
        """The sequences up to the one that brought the agreement, None while there is none."""
        while len(self._minima) in ended:
            self._minima.append(ended[len(self._minima)])
            costs = np.array([m.cost for m in self._minima])
            lowest = costs.min()
            if math.isfinite(lowest):
                same = costs <= lowest + self._cost.tolerance(float(lowest), self._rules.within)
                if same.sum() >= self._rules.agree:
                    return self._minima
        return None


def _leading(ended: dict[int, Minimum]) -> list[Minimum]:
    """The sequences from the first on without a gap."""
    minima: list[Minimum] = []
    while len(minima) in ended:
        minima.append(ended[len(minima)])
    return minima


def _begin(
    problem: CalibrationProblem,
    rules: Rules,
    number: int,
    seed: int,
    make: Callable[[Space], Optimiser] | None,
) -> _Sequence:
    """The given start for the first sequence, for the others one drawn from its number alone."""
    if number == 0:
        start = problem.positions(np.array([p.first for p in problem.parameters]))
    else:
        start = np.random.default_rng([seed, number]).random(len(problem.parameters))
    # Start and step on a binary grid: every point of every refined mesh is then an exact number, and a mesh
    # point reached twice is the same point.
    start = np.round(start * _GRID) / _GRID
    step = max(round(rules.step * _GRID), 1) / _GRID
    n = len(problem.parameters)
    space = box(problem.paths, start.tolist(), [0.0] * n, [1.0] * n, [step] * n)
    optimiser = make(space) if make is not None else _hooke_jeeves(space, rules)
    return _Sequence(number, start, optimiser)


def _hooke_jeeves(space: Space, rules: Rules) -> Optimiser:
    return HookeJeeves(space, reductions=rules.reductions, rounding=lambda value, _: value)


# --- both ---------------------------------------------------------------------------------------------


def _require_start(problem: CalibrationProblem, evaluator: Evaluator) -> None:
    """Refuse a start at which the cost is not a number, before anything else is evaluated."""
    x = np.array([[p.first for p in problem.parameters]])
    if math.isfinite(evaluator.costs(x)[0]):
        return
    simulated = np.asarray(problem.model(x), dtype=np.float64)[0]
    bad = [
        sensor.name
        for s, sensor in enumerate(problem.sensors)
        if not np.isfinite(simulated[sensor.mask, s]).all()
    ]
    at = ", ".join(f"{p.path} = {p.first:g} {p.unit}".rstrip() for p in problem.parameters)
    msg = f"the cost is not a number at the start ({at}): the model gives no number for {', '.join(bad)}"
    raise InputError(msg)


def _report(
    problem: CalibrationProblem,
    evaluator: Evaluator,
    rules: Rules,
    minima: list[Minimum],
    reason: str,
    method: str,
    best: Minimum,
    confidence: float,
    seed: int,
) -> Fit:
    """The fit at the best minimum with its uncertainty."""
    cost = evaluator.cost
    z = problem.positions(best.x)
    residuals, jacobian = _derivative(problem, z, rules.difference)
    weights = cost.weights(residuals)
    found = estimate(
        problem,
        z,
        residuals,
        jacobian,
        weights,
        priors=_prior_information(problem, z),
        blind_to_bias=cost.blind_to_bias,
        confidence=confidence,
    )
    centred = residuals
    if cost.blind_to_bias:
        centred = np.where(problem.mask, residuals - residuals.sum(axis=0) / problem.mask.sum(axis=0), 0.0)
    slope = np.einsum("ts,tsp->p", weights * centred, jacobian)
    notes = warnings(problem, z, found, residuals, jacobian)
    low, high = problem.values(found.low[None])[0], problem.values(found.high[None])[0]
    if cost.name == "nmbe":
        low, high = np.full_like(low, np.nan), np.full_like(high, np.nan)
        notes = ["the cost 'nmbe' compares means only: there are no intervals; use it as a criterion", *notes]
    of_sensors = cost.of_sensors(residuals[None])[0]
    return Fit(
        problem=problem,
        method=method,
        cost_name=cost.name,
        x=best.x,
        low=low,
        high=high,
        correlation=found.correlation,
        confidence=confidence,
        cost=best.cost,
        of_sensors=of_sensors,
        residuals=np.where(problem.mask, residuals, np.nan),
        uncertainty=found,
        on_bound=on_bounds(problem, z, slope, found),
        warnings=tuple(notes),
        minima=tuple(minima),
        reason=reason,
        trace=evaluator.trace(),
        seed=seed,
    )


def _derivative(problem: CalibrationProblem, z: Floats, difference: float) -> tuple[Floats, Floats]:
    """Residuals (T, S) and their central differences by z (T, S, P), one-sided at a bound, in one batch."""
    n = z.size
    ahead = np.minimum(z + difference, 1.0)
    behind = np.maximum(z - difference, 0.0)
    points = np.tile(z, (2 * n + 1, 1))
    for i in range(n):
        points[1 + i, i] = ahead[i]
        points[1 + n + i, i] = behind[i]
    values = problem.residuals(problem.values(points))
    if not np.isfinite(values).all():
        msg = "the model cannot be evaluated in the neighbourhood of the minimum: no uncertainty can be given"
        raise SolverError(msg)
    jacobian = (values[1 : 1 + n] - values[1 + n :]) / (ahead - behind)[:, None, None]
    return values[0], np.moveaxis(jacobian, 0, -1)


def _prior_information(problem: CalibrationProblem, z: Floats) -> Floats:
    """Inverse variance of each parameter's prior in positions, 0 without one; shape (P,). [-]"""
    information = np.zeros(z.size)
    for i, p in enumerate(problem.parameters):
        if p.prior is not None:
            span = p.upper - p.lower
            slope = span if p.scale == "linear" else p.value(float(z[i])) * math.log(p.upper / p.lower)
            information[i] = (slope / p.prior[1]) ** 2
    return information

"""One function for all search methods: find the minimum, then estimate the uncertainty."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mascarin._io.arguments import require_type, whole_number
from mascarin.calibration.base.cost import ONE_NUMBER, Cost, CostName
from mascarin.calibration.base.evaluations import Evaluator
from mascarin.calibration.base.problem import CalibrationProblem
from mascarin.calibration.base.result import Calibration, Minimum
from mascarin.calibration.base.search_options import METHODS, WITH_SQUARES, MethodName, SearchOptions
from mascarin.calibration.base.uncertainty import estimate
from mascarin.calibration.base.warnings import on_bounds, warnings
from mascarin.calibration.methods.least_squares import least_squares, residuals_and_derivatives
from mascarin.calibration.methods.posterior import sampled
from mascarin.calibration.methods.sequences import Make, maker, multi_start
from mascarin.errors import InputError, SolverError, did_you_mean
from mascarin.optimization import Optimizer, Space
from mascarin.progress import ProgressOption, reporting

Floats = NDArray[np.float64]


def solve(
    problem: CalibrationProblem,
    *,
    method: MethodName = "least-squares",
    cost: CostName = "nll",
    seed: int = 0,
    options: SearchOptions | None = None,
    optimizer: Callable[[Space], Optimizer] | None = None,
    record: Path | None = None,
    batch: int = 64,
    confidence: float = 0.95,
    progress: ProgressOption = None,
    on_batch: Callable[[int, float], object] | None = None,
) -> Calibration:
    """Estimate the parameters of a calibration problem.

    Parameters
    ----------
    problem : CalibrationProblem
        Parameters, measured series and model.
    method : str
        ``least-squares``: the sum of squared residuals over the uncertainty of the sensors (and priors), by a
        trust-region method within the bounds from several starts, with derivatives by differences (one batch
        of runs) or exact ones (`SearchOptions.slopes`).
        ``hooke-jeeves``: any cost, by pattern search from random starts until several sequences have reached
        the same minimum.
        ``particle-swarm``, ``hybrid`` (a swarm, then a pattern search from its best point), ``cma-es`` (an
        evolution strategy): any cost, repeated until two sequences have reached the same minimum.
        ``emcee``: least squares, then a sample of the posterior distribution about its minimum.
    cost : str
        What is minimized, see `mascarin.calibration.base.cost`; least squares and emcee support ``nll`` only.
    seed : int
        Of all random numbers. The same problem, seed and options give the same result.
    options : SearchOptions, optional
        Options of the search.
    optimizer : callable, optional
        Makes the optimizer of one sequence from its space (positions between 0 and 1, with the start);
        replaces that of the method.
    record : Path, optional
        File in which every evaluation is kept. If it exists, nothing in it is evaluated again: a calibration
        that was interrupted, or whose budget is increased, continues from there and ends with the same
        result.
    batch : int
        Largest number of parameter vectors in one call of the model. [-]
    confidence : float
        Of the intervals. [-]
    progress : bool or callable, optional
        Shows progress; a function is called with the number of evaluations and 0, because their total is not
        known in advance.
    on_batch : callable, optional
        Called after each batch with the number of evaluations and the lowest cost so far.

    Returns
    -------
    Calibration
        Estimates with their uncertainty.

    Raises
    ------
    InputError
        For an unknown method or cost, a cost that is not a number at the start, or a record of another
        problem.
    SolverError
        When no search ended at a point that can be evaluated.

    Examples
    --------
    >>> from mascarin.calibration import FitParameter, FitSensor
    >>> hour = np.arange(48.0)
    >>> measured = 5.0 * np.exp(-hour / 10.0)
    >>> problem = CalibrationProblem(
    ...     (FitParameter("time_constant", 1.0, 50.0, unit="h"),),
    ...     (FitSensor("heat", measured, 0.1, unit="W"),),
    ...     lambda x: (5.0 * np.exp(-hour / x))[:, :, None],
    ... )
    >>> round(solve(problem).values["time_constant"], 3)
    10.0
    """
    with reporting(progress, "evaluations") as report:

        def report_batch(count: int, lowest: float) -> None:
            report(count, 0)
            if on_batch is not None:
                on_batch(count, lowest)

        return _solved(
            problem, method, cost, seed, options, optimizer, record, batch, confidence, report_batch
        )


def _solved(
    problem: CalibrationProblem,
    method: MethodName,
    cost: CostName,
    seed: int,
    options: SearchOptions | None,
    optimizer: Callable[[Space], Optimizer] | None,
    record: Path | None,
    batch: int,
    confidence: float,
    on_batch: Callable[[int, float], object],
) -> Calibration:
    _require(method, cost, confidence, optimizer is not None)
    whole_number("seed", seed)
    if options is not None:
        require_type("options", options, SearchOptions, "mascarin.calibration.SearchOptions")
    chosen = options or SearchOptions()
    if chosen.slopes == "exact":
        problem.require_slopes()
    function = Cost(problem, cost)
    make = None if optimizer is None else _maker_of(optimizer)
    squares = method in WITH_SQUARES and make is None
    with Evaluator(function, record, keep_residuals=squares, batch=batch, on_batch=on_batch) as evaluator:
        _require_start(problem, evaluator)
        if squares:
            minima, reason = least_squares(problem, evaluator, chosen, seed)
        else:
            agree = chosen.agreeing(method)
            minima, reason = multi_start(
                problem, evaluator, chosen, seed, make or maker(method, chosen), agree
            )
        best = min(minima, key=lambda m: (m.cost, m.sequence))
        if not math.isfinite(best.cost):
            msg = f"none of {len(minima)} searches ended where the model could be evaluated; check the ranges"
            raise SolverError(msg)
        name = method if optimizer is None else "your optimizer"
        fit = _report(problem, evaluator, chosen, minima, reason, name, best, confidence, seed)
        if method == "emcee" and make is None:
            return sampled(fit, evaluator, chosen)
        return fit


def _require(method: str, cost: str, confidence: float, own_cost: bool) -> None:
    if method not in METHODS:
        closest = did_you_mean(method, METHODS, known=False)
        raise InputError(
            f"method: found '{method}', expected one of {', '.join(METHODS)}. {closest}".rstrip()
        )
    if method in WITH_SQUARES and cost != "nll" and not own_cost:
        msg = f"{method} minimizes 'nll'; for the cost '{cost}' use a method such as 'hooke-jeeves'"
        raise InputError(msg)
    if not 0.0 < confidence < 1.0:
        msg = f"confidence: found {confidence!r}, expected a number between 0 and 1, such as 0.95"
        raise InputError(msg)


def _maker_of(optimizer: Callable[[Space], Optimizer]) -> Make:
    return lambda space, _: optimizer(space)


def _require_start(problem: CalibrationProblem, evaluator: Evaluator) -> None:
    """Refuse a start at which the cost is not a number, before the search."""
    x = np.array([[p.first for p in problem.parameters]])
    evaluator.prepare(x)
    if math.isfinite(evaluator.costs(x)[0]):
        return
    simulated = np.asarray(problem.model(x), dtype=np.float64)[0]
    bad = [
        sensor.name
        for s, sensor in enumerate(problem.sensors)
        if not np.isfinite(simulated[sensor.mask, s]).all()
    ]
    start_text = ", ".join(f"{p.path} = {p.first:g} {p.unit}".rstrip() for p in problem.parameters)
    msg = (
        f"the cost is not a number at the start ({start_text}): the model gives no number for "
        f"{', '.join(bad)}"
    )
    raise InputError(msg)


def _report(
    problem: CalibrationProblem,
    evaluator: Evaluator,
    options: SearchOptions,
    minima: list[Minimum],
    reason: str,
    method: str,
    best: Minimum,
    confidence: float,
    seed: int,
) -> Calibration:
    """The result at the best minimum, with its uncertainty."""
    cost = evaluator.cost
    z = problem.positions(best.x)
    residuals, jacobian = residuals_and_derivatives(problem, evaluator, z, options)
    weights = cost.weights(residuals)
    uncertainty = estimate(
        problem,
        z,
        residuals,
        jacobian,
        weights,
        priors=_prior_information(problem, z),
        ignores_bias=cost.ignores_bias,
        confidence=confidence,
    )
    centered = residuals
    if cost.ignores_bias:
        centered = np.where(problem.mask, residuals - residuals.sum(axis=0) / problem.mask.sum(axis=0), 0.0)
    slope = np.einsum("ts,tsp->p", weights * centered, jacobian)
    notes = warnings(problem, z, uncertainty, residuals, jacobian)
    low, high = problem.values(uncertainty.low[None])[0], problem.values(uncertainty.high[None])[0]
    if cost.name in ONE_NUMBER:
        low, high = np.full_like(low, np.nan), np.full_like(high, np.nan)
        text = f"the cost '{cost.name}' compares means only: there are no intervals; use it as a criterion"
        notes = [text, *notes]
    if cost.note:
        notes = [cost.note, *notes]
    of_sensors = cost.of_sensors(residuals[None])[0]
    return Calibration(
        problem=problem,
        method=method,
        cost_name=cost.name,
        x=best.x,
        low=low,
        high=high,
        correlation=uncertainty.correlation,
        confidence=confidence,
        cost=best.cost,
        of_sensors=of_sensors,
        residuals=np.where(problem.mask, residuals, np.nan),
        uncertainty=uncertainty,
        on_bound=on_bounds(problem, z, slope, uncertainty),
        warnings=tuple(notes),
        minima=tuple(minima),
        reason=reason,
        trace=evaluator.trace(),
        seed=seed,
    )


def _prior_information(problem: CalibrationProblem, z: Floats) -> Floats:
    """Inverse variance of the prior of each parameter in positions, 0 without one; shape (P,). [-]"""
    return np.asarray(np.sum(Cost(problem, "nll").prior_slopes(z) ** 2, axis=0))

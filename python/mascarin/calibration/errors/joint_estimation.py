"""A calibration refined with the errors of the sensors and of the model.

The method: `mascarin.calibration.errors.joint_posterior`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.base.cost import Cost
from mascarin.calibration.base.evaluations import Evaluator
from mascarin.calibration.base.problem import CalibrationProblem
from mascarin.calibration.base.result import Calibration
from mascarin.calibration.base.search_options import SearchOptions
from mascarin.calibration.base.uncertainty import AT_BOUND
from mascarin.calibration.base.warnings import on_bounds, warnings
from mascarin.calibration.errors.discrepancy import Discrepancy
from mascarin.calibration.errors.joint_posterior import JointPosterior, joint_posteriors
from mascarin.calibration.errors.linear_estimation import (
    ErrorStatement,
    Linear,
    best_positions,
    columns_of_sensors,
    objective,
)
from mascarin.calibration.errors.sampled_posterior import ChainLengths
from mascarin.calibration.methods.least_squares import residuals_and_derivatives, residuals_at

Floats = NDArray[np.float64]
Keep = Callable[[object, Callable[[], tuple[Floats, Floats]]], tuple[Floats, Floats]]
Further = Callable[[Floats], Floats]
"""From parameter values (P,) to the effects (T, S, K) of numbers that are not estimated."""

METHOD: Final = (
    "joint normal distribution of the parameters, the errors of the sensors and the errors of the model, "
    "linearized at the estimates, within the ranges, over the sizes of the errors that the days allow"
)
"""How the intervals are computed, for reports."""

SAMPLED: Final = (
    "the parameters and errors of sensors sampled with the model itself (NUTS with delayed acceptance), in "
    "place of the linearization"
)
"""What sampling changes, for reports."""

#: Factor of the intervals by blocks of days from which it is said. [-]
_NOTED: Final = 1.05
#: What the residuals of its warnings are without.
_BESIDE: Final = ", beside the estimated errors of sensors and model"
_MAX_STEPS: Final = 8
_MAX_HALVINGS: Final = 3
#: With which an estimate is said to lie beyond the end of its range. [-]
_CONFIDENCE: Final = 0.95
#: The search has converged when a step would lower minus the log density by less than this. [-]
_MIN_DECREASE: Final = 0.05


def estimate_jointly(
    fit: Calibration,
    stated: ErrorStatement,
    options: SearchOptions,
    further: Further | None = None,
    *,
    keep: Keep | None = None,
) -> tuple[Calibration, JointPosterior]:
    """Estimate the parameters again, together with the errors of the sensors and of the model.

    Parameters
    ----------
    fit : Calibration
        From `solve`; where the first linearization is made.
    stated : ErrorStatement
        What is known of the errors.
    options : SearchOptions
        Kind of derivatives, and whether the posterior is sampled with the model itself.
    further : callable, optional
        From parameter values (P,) to the effects (T, S, K) of numbers that are not estimated, for one
        standard uncertainty of each. They are computed where all else is linearized. [unit]
    keep : callable, optional
        From a key and a function to what the function returns, or returned before.

    Returns
    -------
    Calibration
        With the estimates and intervals of the joint distribution.
    JointPosterior
        The joint distribution.

    Raises
    ------
    SolverError
        The model cannot be simulated near the estimates.
    """
    estimates, joints = estimate_experiments(fit, [stated], options, further, keep=keep)
    return estimates, joints[0]


def estimate_experiments(
    fit: Calibration,
    stated: Sequence[ErrorStatement],
    options: SearchOptions,
    further: Further | None = None,
    *,
    keep: Keep | None = None,
) -> tuple[Calibration, tuple[JointPosterior, ...]]:
    """Estimate the parameters of several experiments again, together with the errors of each.

    Parameters
    ----------
    fit, options, further, keep
        As for `estimate_jointly`.
    stated : sequence of ErrorStatement
        What is known of the errors of each experiment.

    Returns
    -------
    Calibration
        With the estimates and intervals of the joint distribution.
    tuple of JointPosterior
        The joint distribution, as each experiment has it.

    Raises
    ------
    SolverError
        The model cannot be simulated near the estimates.
    """
    problem = fit.problem
    evaluator = Evaluator(Cost(problem, fit.cost_name))
    compute: Keep = keep or (lambda key, make: make())

    def linear(z: Floats) -> Linear:
        residuals, jacobian = compute(
            z.tolist(), lambda: residuals_and_derivatives(problem, evaluator, z, options)
        )
        simulated = np.where(problem.mask, residuals + np.where(problem.mask, problem.measured, 0.0), 0.0)
        return Linear(z, simulated, jacobian, np.zeros((*simulated.shape, 0)))

    def series(z: Floats) -> Linear:
        measured = np.where(problem.mask, problem.measured, 0.0)
        simulated = np.where(problem.mask, residuals_at(problem, z) + measured, 0.0)
        none = np.zeros((*simulated.shape, 0))
        return Linear(z, simulated, none, none)

    # The estimates are those of the model as it will be used, with all other numbers as described.
    linearization = _searched(
        problem, (linear, series), [replace(each, further=()) for each in stated], problem.positions(fit.x)
    )
    if further is not None:
        # At the estimates themselves, with which all later steps run the model.
        z = _on_ends(linearization.z)
        linearization = replace(linearization, further=further(problem.values(z[None])[0]))

    def simulate(z: Floats) -> Floats:
        measured = np.where(problem.mask, problem.measured, 0.0)
        return evaluator.residuals(problem.values(z)) + measured

    lengths = None
    if options.posterior == "sampled":
        lengths = ChainLengths(options.chains, options.draws, options.warmup, fit.seed)
    joints = joint_posteriors(
        problem, linearization, stated, simulate=simulate if lengths else None, lengths=lengths
    )
    return _reported(fit, problem, linearization, joints, stated), joints


def _searched(
    problem: CalibrationProblem,
    model: tuple[Callable[[Floats], Linear], Callable[[Floats], Linear]],
    stated: Sequence[ErrorStatement],
    first: Floats,
) -> Linear:
    """Linearize about better and better estimates, until the density no longer rises.

    `model`: linearized at positions (P,), and its series there alone.
    """
    linear, series = model
    linearization = linear(first)
    covariances: list[Discrepancy] | None = None
    for _ in range(_MAX_STEPS):
        goal, covariances = best_positions(problem, linearization, stated, covariances)
        before = objective(problem, linearization, stated, covariances)
        for _ in range(_MAX_HALVINGS):
            after = objective(problem, series(goal), stated, covariances)
            if after <= before:
                break
            goal = 0.5 * (goal + linearization.z)
        if after <= before:
            linearization = linear(goal)
        if before - after < _MIN_DECREASE:
            break
    return linearization


def _reported(
    fit: Calibration,
    problem: CalibrationProblem,
    linearization: Linear,
    joints: tuple[JointPosterior, ...],
    stated: Sequence[ErrorStatement],
) -> Calibration:
    """The calibration with the estimates of the joint distribution."""
    distribution = joints[0]  # parameters are those of all
    z = _on_ends(linearization.z)
    x = problem.values(z[None])[0]
    tail = 0.5 * (1.0 - fit.confidence)
    low, high = np.quantile(distribution.widened(), [tail, 1.0 - tail], axis=0)
    # An estimate on the end of its range is in no interval with equal tails.
    low, high = np.minimum(low, z), np.maximum(high, z)
    covariance = distribution.covariance[: z.size, : z.size]
    sd = np.sqrt(np.diag(covariance))
    spread = np.where(sd > 0.0, sd, 1.0)  # an estimate on its bound has no variance
    correlation = covariance / np.outer(spread, spread)
    residuals = np.where(
        problem.mask, linearization.simulated - np.where(problem.mask, problem.measured, 0.0), 0.0
    )
    uncertainty = replace(
        fit.uncertainty, low=low, high=high, sd=sd, correlation=correlation, covariance=covariance,
        error=tuple(size for joint in joints for size in joint.error_covariances.spread.tolist()),
    )  # fmt: skip
    expected = np.zeros(residuals.shape)
    of_sensors = columns_of_sensors(problem, linearization.simulated, stated)[0]
    first = 0
    for joint, own_errors, wide in zip(joints, stated, of_sensors, strict=True):
        part = (own_errors.rows, own_errors.columns)
        count = len(joint.names) - linearization.further.shape[2]
        effects, first = wide[:, :, first : first + count], first + count
        error_columns = np.concatenate([effects, linearization.further[part]], axis=2)
        columns = joint.effects(linearization.jacobian[part], error_columns, own_errors.hours)
        expected[part] = joint.predicted(columns, linearization.z)[0]
    remaining = np.where(problem.mask, residuals + expected, 0.0)
    chains, said = (
        distribution.chains,
        tuple(warnings(problem, z, uncertainty, remaining, linearization.jacobian, _BESIDE)),
    )
    cost = Cost(problem, fit.cost_name)
    each = cost.of_sensors(residuals[None])
    return replace(
        fit,
        x=x,
        low=problem.values(low[None])[0],
        high=problem.values(high[None])[0],
        correlation=correlation,
        cost=float(cost.total(x[None], each)[0]),
        of_sensors=each[0],
        residuals=np.where(problem.mask, residuals, np.nan),
        uncertainty=uncertainty,
        on_bound=on_bounds(problem, z, _outward(z, distribution), uncertainty),
        warnings=said if chains is None else (*said, *chains.warnings),
        uncertainty_method="; ".join(_methods(distribution)),
        posterior=chains,
        reason=f"{fit.reason}, then estimated together with the errors of sensors and model",
    )


def _methods(distribution: JointPosterior) -> Iterator[str]:
    """How the intervals were computed, in parts of a sentence."""
    yield METHOD
    if distribution.chains is not None:
        yield SAMPLED
    factor = math.sqrt(distribution.dispersion)
    if factor > _NOTED:
        yield f"what the data say made wider by {factor:.2f}, by which blocks of days differ more than days"


def _on_ends(z: Floats) -> Floats:
    """Positions (P,), those that are nearly on an end of their range on it. [-]"""
    return np.where(z < AT_BOUND, 0.0, np.where(z > 1.0 - AT_BOUND, 1.0, z))


def _outward(z: Floats, distribution: JointPosterior) -> Floats:
    """Sign of the derivative of the cost by positions (P,) on an end of their range, 0 if not significant."""
    from scipy import stats

    significant = distribution.beyond > float(stats.chi2.ppf(_CONFIDENCE, 1))
    return np.where(significant, np.where(z < 0.5, 1.0, -1.0), 0.0)

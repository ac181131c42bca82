"""The linearized model of a calibration: its priors, errors and density, with one experiment or several."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.base.problem import CalibrationProblem
from mascarin.calibration.errors.bounded_coefficients import best_within, ends_of, within
from mascarin.calibration.errors.day_blocks import DayGrid, Experiments
from mascarin.calibration.errors.discrepancy import (
    DayData,
    Discrepancy,
    SizeLimits,
    estimate_together,
    hour_basis,
    together,
)
from mascarin.calibration.errors.sensor_errors import SensorError, error_columns

Floats = NDArray[np.float64]

LEAST_ERROR: Final = 0.5
"""Smallest error of the model that is correlated within a day, in standard uncertainties of the sensor. [-]

A likelihood without it gives any weight to a sensor that the model follows nearly exactly, and gives up the
others.
"""

#: Part of a stated uncertainty that is scatter at least.
_LEAST_SCATTER: Final = 0.2
#: Variance of a position that is equally likely anywhere in its range.
_UNIFORM: Final = 1.0 / 12.0


@dataclass(frozen=True, eq=False)
class Linear:
    """A calibration problem linearized at positions z0.

    Attributes
    ----------
    z : ndarray, shape (P,)
        Positions of the parameters in their ranges. [-]
    simulated : ndarray, shape (T, S)
        Series of the model there. [unit]
    jacobian : ndarray, shape (T, S, P)
        Derivative by z. [unit]
    further : ndarray, shape (T, S, K)
        Derivative by other quantities of a sensor, such as its depth, for one standard uncertainty. [unit]
    """

    z: Floats
    simulated: Floats
    jacobian: Floats
    further: Floats


@dataclass(frozen=True, eq=False)
class ErrorStatement:
    """What is known of the errors before the calibration.

    Attributes
    ----------
    sensors : tuple of SensorError, length S
        Stated uncertainties.
    hours : ndarray, shape (T,)
        Local time of each sample, from any midnight. [h]
    step : float
        Time between samples. [s]
    limit : ndarray, shape (S,)
        Largest standard deviation of each part of the error of the model. [unit]
    persistence : float
        Correlation time of the errors of days. [d]
    further : tuple of str
        Names of other unknown quantities, K of them; numbered when empty, see `Linear`.
    rows, columns : slice
        Samples and sensors of the problem that it is about, where the problem has several experiments.
    names : tuple of str, length S
        Of its sensors; those of the problem when empty.
    """

    sensors: tuple[SensorError, ...]
    hours: Floats
    step: float
    limit: Floats
    persistence: float = 5.0
    further: tuple[str, ...] = field(default=())
    rows: slice = field(default_factory=lambda: slice(None))
    columns: slice = field(default_factory=lambda: slice(None))
    names: tuple[str, ...] = ()


def columns_of_sensors(
    problem: CalibrationProblem, simulated: Floats, stated: Sequence[ErrorStatement]
) -> tuple[list[Floats], list[tuple[str, ...]]]:
    """Effects of the errors of sensors of each experiment, and their names.

    Returns
    -------
    list of ndarray, shape (T, S, k)
        Of the samples and sensors of each experiment, with the columns of all; zero for those of others.
        [unit]
    list of tuple of str
        Names of its own errors.
    """
    effects_of_errors = [
        error_columns(
            each.names or [sensor.name for sensor in problem.sensors[each.columns]],
            each.sensors,
            simulated[each.rows, each.columns],
            each.step,
        )
        for each in stated
    ]
    count, first = sum(len(names) for _, names in effects_of_errors), 0
    wide = []
    for columns, names in effects_of_errors:
        all_columns = np.zeros((*columns.shape[:2], count))
        all_columns[:, :, first : first + len(names)] = columns
        first += len(names)
        wide.append(all_columns)
    return wide, [names for _, names in effects_of_errors]


def best_positions(
    problem: CalibrationProblem,
    linear: Linear,
    stated: Sequence[ErrorStatement],
    first: Sequence[Discrepancy] | None = None,
) -> tuple[Floats, list[Discrepancy]]:
    """Find the most probable positions alone, with the covariances of the errors.

    Parameters
    ----------
    problem, linear, stated
        As for `estimated`.
    first : sequence of Discrepancy, optional
        Covariances of a linearization near by, to begin with.

    Returns
    -------
    ndarray, shape (P,)
        Within the ranges. [-]
    list of Discrepancy
        Sizes of the errors of the model of each experiment.
    """
    after = estimated(problem, linear, stated, None, first)
    count = len(problem.parameters)
    low, high = ends_of(count, after.effect_count - linear.further.shape[2] - count, after.mean.size)
    precision = after.gaussian.precision / np.outer(after.scale, after.scale)
    return best_within(precision, after.mean, low, high, count)[0], after.covariances


@dataclass(frozen=True, eq=False)
class Estimated:
    """The linear model after the data.

    Attributes
    ----------
    gaussian : Experiments
        Distribution of all values.
    data : list of DayData
        Of each experiment.
    mean, scale : ndarray, shape (q,)
        Mean of all coefficients without bounds, and the unit of each in the distribution.
    covariances : list of Discrepancy
        Sizes of the errors of the model.
    """

    gaussian: Experiments
    data: list[DayData]
    mean: Floats
    scale: Floats
    covariances: list[Discrepancy]

    @property
    def effect_count(self) -> int:
        """Number of effects that are known."""
        return int(self.data[0].effects.shape[2])

    @property
    def errors(self) -> list[Floats]:
        """Measured minus simulated values of each experiment. [unit]"""
        return [part.error for part in self.data]


def estimated(
    problem: CalibrationProblem,
    linear: Linear,
    stated: Sequence[ErrorStatement],
    covariances: Sequence[Discrepancy] | None,
    first: Sequence[Discrepancy] | None = None,
) -> Estimated:
    """Distribution and data, mean of all coefficients without bounds and their scale, sizes of the errors.

    Parameters
    ----------
    problem : CalibrationProblem
        Gives measurements, ranges and priors.
    linear : Linear
        The model.
    stated : sequence of ErrorStatement
        What is known of the errors of each experiment.
    covariances : sequence of Discrepancy, optional
        Sizes of the errors of the model; the most probable ones when absent.
    first : sequence of Discrepancy, optional
        Where their search begins.
    """
    center, spread = priors_of(problem)
    data = _data(problem, linear, stated, center, spread)
    if covariances is None:
        sizes = [
            replace(each, scale=0.25 * each.scale) for each in (sizes_of(problem, part) for part in stated)
        ]
        covariances = estimate_together(data, sizes, persistence=stated[0].persistence, first=first)
    gaussian = together(data, covariances)
    unit = gaussian.coefficients([part.error for part in data])
    scale = np.ones(unit.size)
    scale[: center.size] = spread
    mean = unit * scale
    mean[: center.size] += center
    return Estimated(gaussian, data, mean, scale, list(covariances))


def objective(
    problem: CalibrationProblem,
    linear: Linear,
    stated: Sequence[ErrorStatement],
    covariances: Sequence[Discrepancy],
) -> float:
    """Compute minus the log density of parameters and measurements at the positions of a linearization.

    Parameters
    ----------
    problem, linear, stated, covariances
        As for `estimated`; only the series of the linearization is used.

    Returns
    -------
    float
        Up to a constant. [-]
    """
    center, spread = priors_of(problem)
    empty = replace(linear, jacobian=linear.jacobian[:, :, :0])
    data = _data(problem, empty, stated, center[:0], spread[:0])
    prior = 0.5 * float(np.sum(((linear.z - center) / spread) ** 2))
    gaussian, errors = together(data, covariances), [part.error for part in data]
    mean = gaussian.coefficients(errors)
    ends = ends_of(0, data[0].effects.shape[2] - linear.further.shape[2], mean.size)
    _, deviance = within(gaussian.precision, mean, *ends)
    return prior - gaussian.log_density(errors) + 0.5 * deviance


def _data(
    problem: CalibrationProblem,
    linear: Linear,
    stated: Sequence[ErrorStatement],
    center: Floats,
    spread: Floats,
) -> list[DayData]:
    of_sensors, _ = columns_of_sensors(problem, linear.simulated, stated)
    return [
        _of_experiment(problem, linear, each, columns, center, spread)
        for each, columns in zip(stated, of_sensors, strict=True)
    ]


def _of_experiment(
    problem: CalibrationProblem,
    linear: Linear,
    stated: ErrorStatement,
    of_sensors: Floats,
    center: Floats,
    spread: Floats,
) -> DayData:
    part, parameter_count = (stated.rows, stated.columns), center.size
    mask, jacobian = problem.mask[part], linear.jacobian[part]
    error = np.where(mask, problem.measured[part], 0.0) - np.where(mask, linear.simulated[part], 0.0)
    shift = jacobian @ (linear.z[:parameter_count] - center) if parameter_count else 0.0
    stated_columns = np.concatenate([jacobian * spread, of_sensors, linear.further[part]], axis=2)
    grid = DayGrid.of(stated.hours, interval=stated.step / 3600.0, sensors=mask.shape[1])
    basis = np.repeat(hour_basis(stated.hours)[:, None, :], mask.shape[1], axis=1)
    mean, count_of_slot = grid.means(error + shift, mask)
    return DayData(
        grid,
        mean,
        grid.means(stated_columns, mask)[0],
        grid.means(basis, mask)[0],
        count_of_slot > 0,
        grid.within(error, mask),
    )


def priors_of(problem: CalibrationProblem) -> tuple[Floats, Floats]:
    """Mean and standard deviation of each position before the data, both (P,). [-]"""
    center, spread = np.full(len(problem.parameters), 0.5), np.full(len(problem.parameters), _UNIFORM**0.5)
    for i, p in enumerate(problem.parameters):
        if p.prior is not None:
            mean = min(max(p.prior[0], p.lower), p.upper)
            center[i] = p.position(mean)
            spread[i] = p.prior[1] / p.rate(center[i])
    return center, spread


def sizes_of(problem: CalibrationProblem, stated: ErrorStatement) -> SizeLimits:
    """What is known of the sizes of the errors of the model of an experiment.

    The scale is the stated uncertainty of each sensor less its offset. An offset is an error of its own: were
    the scale the whole uncertainty, the errors of the model would have it once more, on every day and at
    every hour. The error within a day is at least `LEAST_ERROR`.
    """
    sensors = problem.sensors[stated.columns]
    total = np.array([float(np.mean(s.sigma[s.mask] ** 2)) for s in sensors])
    shared = np.array([error.offset**2 + error.common**2 for error in stated.sensors])
    scale = np.asarray(np.sqrt(np.maximum(total - shared, _LEAST_SCATTER**2 * total)))
    spread = np.array([math.sqrt(float(np.mean(s.sigma[s.mask] ** 2))) for s in sensors])
    return SizeLimits(scale, stated.limit, np.minimum(LEAST_ERROR * spread, stated.limit))

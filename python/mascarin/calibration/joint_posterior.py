"""Parameters, errors of sensors and errors of the model, estimated together.

About the estimates of a calibration the measured series are, to first order,

    measured = simulated + J (z - z0) + errors of the sensors + errors of the model

with positions z of the parameters in their ranges. All terms are normal: parameters with their priors,
`SensorError` with the stated uncertainties, `Discrepancy` with sizes that the same data tell. Given the sizes
their joint distribution follows in closed form; the parameters stay within their ranges. The estimates are
found with the most probable sizes: the model is linearized about better and better ones. Intervals are those
of many sizes, drawn from their distribution.

References
----------
Kennedy M.C., O'Hagan A. (2001), J. R. Stat. Soc. B 63, 425. https://doi.org/10.1111/1467-9868.00294
Gelman A. et al. (2013), Bayesian Data Analysis, chapter 14 (linear models with known covariance).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.covariance_sampling import CovarianceSample, sample_covariances
from mascarin.calibration.day_blocks import DayGaussian, DayGrid
from mascarin.calibration.discrepancy import (
    DayData,
    Discrepancy,
    estimate_discrepancy,
    hour_basis,
)
from mascarin.calibration.problem import CalibrationProblem
from mascarin.calibration.sensor_errors import SensorError, sensor_columns
from mascarin.calibration.truncated_normal import within_bounds
from mascarin.calibration.uncertainty import AT_BOUND

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

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
        Names of other unknown quantities of sensors, K of them; see `Linear`.
    """

    sensors: tuple[SensorError, ...]
    hours: Floats
    step: float
    limit: Floats
    persistence: float = 5.0
    further: tuple[str, ...] = field(default=())


@dataclass(frozen=True, eq=False)
class JointPosterior:
    """Parameters and errors given the measurements.

    Attributes
    ----------
    z : ndarray, shape (P,)
        Most probable positions within the ranges. [-]
    mean : ndarray, shape (q,)
        Mean of all coefficients: positions [-], errors of sensors in standard deviations of their priors [-],
        then repeating errors by function and sensor. [unit]
    covariance : ndarray, shape (q, q)
        Of the coefficients, with the doubt about the sizes of the errors.
    sample : ndarray, shape (n, P)
        Sample of the positions. [-]
    error_covariances : Discrepancy
        Sizes of the errors of the model: the mean of every variance.
    names : tuple of str
        Of the errors of sensors.
    by_day : ndarray, shape (D,)
        Log density of each day given all others. [-]
    density : float
        Log density of all days. [-]
    prior : ndarray, shape (P,)
        Standard deviation of the prior of each position. [-]
    beyond : ndarray, shape (P,)
        For positions on an end of their range: by how much minus twice the log density is lower at the best
        position beyond it, in variances of the normal distribution; 0 for others. [-]
    """

    z: Floats
    mean: Floats
    covariance: Floats
    sample: Floats
    error_covariances: Discrepancy
    names: tuple[str, ...]
    by_day: Floats
    density: float
    prior: Floats
    beyond: Floats

    def quantile(self, confidence: float) -> float:
        """Half-width of an interval on other days, in standard deviations: Student's.

        If the errors are as assumed, the quantile is that of the normal distribution. That they are is known
        from a few days of similar weather only, one fewer than which are the degrees of freedom.
        """
        from scipy import stats

        return float(stats.t.ppf(0.5 + 0.5 * confidence, max(self.by_day.size - 1, 2)))

    def widened(self, confidence: float = 0.95) -> Floats:
        """Return the sample of the positions with the spread of `quantile`, shape (n, P). [-]

        Only what the data say is as doubtful as the errors; the priors are as stated.
        """
        from scipy import stats

        factor = self.quantile(confidence) / float(stats.norm.ppf(0.5 + 0.5 * confidence))
        count = self.sample.shape[1]
        curvature = 1.0 / np.diag(self.covariance)[:count]
        prior = np.minimum(1.0 / self.prior**2, curvature)
        wider = np.sqrt(curvature / (prior + (curvature - prior) / factor**2))
        middle = np.median(self.sample, axis=0)
        return np.asarray(np.clip(middle + wider * (self.sample - middle), 0.0, 1.0))

    def predicted(self, columns: Floats, z: Floats) -> tuple[Floats, Floats]:
        """Predict the difference between measured and simulated series.

        Parameters
        ----------
        columns : ndarray, shape (n, S, q)
            From `effects`. [unit]
        z : ndarray, shape (P,)
            Positions at which the series was simulated. [-]

        Returns
        -------
        ndarray, shape (n, S)
            Expected measured minus simulated value. [unit]
        ndarray, shape (n, S)
            Variance of the parameters, of the sensors and of the errors that repeat. [unit^2]
        """
        about = self.mean.copy()
        about[: z.size] -= z
        variance = np.einsum("tsq,qr,tsr->ts", columns, self.covariance, columns, optimize=True)
        return columns @ about, np.maximum(variance, 0.0)

    def effects(self, jacobian: Floats, effects_of_errors: Floats, hours: Floats) -> Floats:
        """Columns of all coefficients at any instants.

        Parameters
        ----------
        jacobian : ndarray, shape (n, S, P)
            Derivative of the series by the positions. [unit]
        effects_of_errors : ndarray, shape (n, S, k)
            Effects of the sensors. [unit]
        hours : ndarray, shape (n,)
            Local time. [h]

        Returns
        -------
        ndarray, shape (n, S, q)
        """
        sensors = jacobian.shape[1]
        repeating = hour_basis(hours)[:, None, :, None] * np.eye(sensors)[None, :, None, :]
        shape = (*jacobian.shape[:2], -1)
        return np.concatenate([jacobian, effects_of_errors, repeating.reshape(shape)], axis=2)


def joint_posterior(
    problem: CalibrationProblem,
    linear: Linear,
    stated: ErrorStatement,
    covariances: Discrepancy | None = None,
) -> JointPosterior:
    """Estimate parameters and errors together from one linearization.

    Parameters
    ----------
    problem : CalibrationProblem
        Gives measurements, ranges and priors.
    linear : Linear
        The model.
    stated : ErrorStatement
        What is known of the errors.
    covariances : Discrepancy, optional
        Sizes of the errors of the model; drawn from their distribution when absent.

    Returns
    -------
    JointPosterior
    """
    gaussian, data, likely, scale, most_probable = _estimated(problem, linear, stated, covariances)
    if covariances is None:
        draws = sample_covariances(data, most_probable, scale=_scale(problem), limit=stated.limit)
    else:
        draws = CovarianceSample.of_covariances(data, covariances)
    count, stated_count = len(problem.parameters), data.effects.shape[2]
    shared_count = stated_count + data.basis.shape[2] * data.sensors
    # The level that the days of the identification have in common says nothing of other days.
    mean, covariance = draws.mean[:, :shared_count].copy(), draws.covariance[:, :shared_count, :shared_count]
    mean[:, :count] *= scale[:count]
    mean[:, :count] += _priors(problem)[0]
    covariance = covariance * np.outer(scale[:shared_count], scale[:shared_count])
    sample = within_bounds(mean[:, :count], covariance[:, :count, :count], np.zeros(count), np.ones(count))
    middle = mean.mean(axis=0)
    away = mean - middle
    together = covariance.mean(axis=0) + away.T @ away / len(mean)
    bounded_mean, bounded = _bounded(middle, together, sample)
    names = (*sensor_columns(problem, stated.sensors, linear.simulated, stated.step)[1], *stated.further)
    z, beyond = _most_probable(gaussian, likely, scale, count)
    return JointPosterior(
        z,
        bounded_mean,
        bounded,
        sample,
        draws.typical,
        names,
        gaussian.left_out(data.error),
        gaussian.log_density(data.error),
        scale[:count],
        beyond,
    )


def best_positions(
    problem: CalibrationProblem,
    linear: Linear,
    stated: ErrorStatement,
    covariances: Discrepancy | None = None,
) -> tuple[Floats, Discrepancy]:
    """Find the most probable positions alone, with the covariances of the errors.

    Returns
    -------
    ndarray, shape (P,)
        Within the ranges. [-]
    Discrepancy
        Sizes of the errors of the model.
    """
    gaussian, _, mean, scale, covariances = _estimated(problem, linear, stated, covariances)
    return _most_probable(gaussian, mean, scale, len(problem.parameters))[0], covariances


def _estimated(
    problem: CalibrationProblem, linear: Linear, stated: ErrorStatement, covariances: Discrepancy | None
) -> tuple[DayGaussian, DayData, Floats, Floats, Discrepancy]:
    """Distribution and data, mean of all coefficients without bounds and their scale, sizes of the errors."""
    center, spread = _priors(problem)
    data = _data(problem, linear, stated, center, spread)
    if covariances is None:
        covariances = estimate_discrepancy(
            data, scale=0.25 * _scale(problem), limit=stated.limit, persistence=stated.persistence
        )
    gaussian = data.gaussian(covariances)
    unit = gaussian.coefficients(data.error)
    scale = np.ones(unit.size)
    scale[: center.size] = spread
    mean = unit * scale
    mean[: center.size] += center
    return gaussian, data, mean, scale, covariances


def objective(
    problem: CalibrationProblem, linear: Linear, stated: ErrorStatement, covariances: Discrepancy
) -> float:
    """Compute minus the log density of parameters and measurements at the positions of a linearization.

    Parameters
    ----------
    problem, linear, stated, covariances
        As for `joint_posterior`; only the series of the linearization is used.

    Returns
    -------
    float
        Up to a constant. [-]
    """
    center, spread = _priors(problem)
    empty = replace(linear, jacobian=linear.jacobian[:, :, :0])
    data = _data(problem, empty, stated, center[:0], spread[:0])
    prior = 0.5 * float(np.sum(((linear.z - center) / spread) ** 2))
    return prior - data.gaussian(covariances).log_density(data.error)


def _data(
    problem: CalibrationProblem, linear: Linear, stated: ErrorStatement, center: Floats, spread: Floats
) -> DayData:
    mask, parameter_count = problem.mask, center.size
    error = np.where(mask, problem.measured, 0.0) - np.where(mask, linear.simulated, 0.0)
    shift = linear.jacobian @ (linear.z[:parameter_count] - center) if parameter_count else 0.0
    of_sensors, _ = sensor_columns(problem, stated.sensors, linear.simulated, stated.step)
    stated_columns = np.concatenate([linear.jacobian * spread, of_sensors, linear.further], axis=2)
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


def _priors(problem: CalibrationProblem) -> tuple[Floats, Floats]:
    """Mean and standard deviation of each position before the data, both (P,). [-]"""
    center, spread = np.full(len(problem.parameters), 0.5), np.full(len(problem.parameters), _UNIFORM**0.5)
    for i, p in enumerate(problem.parameters):
        if p.prior is not None:
            mean = min(max(p.prior[0], p.lower), p.upper)
            center[i] = p.position(mean)
            spread[i] = p.prior[1] / p.rate(center[i])
    return center, spread


def _scale(problem: CalibrationProblem) -> Floats:
    """Stated uncertainty of each sensor (S,): what is no error of the model is rarely larger. [unit]"""
    return np.array([float(np.sqrt(np.mean(s.sigma[s.mask] ** 2))) for s in problem.sensors])


def _most_probable(gaussian: DayGaussian, mean: Floats, scale: Floats, count: int) -> tuple[Floats, Floats]:
    """Positions (P,) of the largest density within the ranges, and `JointPosterior.beyond`."""
    from scipy import optimize

    precision = gaussian.precision / np.outer(scale, scale)
    root = np.linalg.cholesky(precision).T
    low, high = np.full(mean.size, -math.inf), np.full(mean.size, math.inf)
    low[:count], high[:count] = 0.0, 1.0

    def best(free: int | None = None) -> tuple[Floats, float]:
        ends = low.copy(), high.copy()
        if free is not None:
            ends[0][free], ends[1][free] = -math.inf, math.inf
        solution = optimize.lsq_linear(root, root @ mean, bounds=ends, method="bvls")
        return solution.x, 2.0 * float(solution.cost)

    x, deviance = best()
    z = np.asarray(np.clip(x[:count], 0.0, 1.0))
    on_end = (z <= AT_BOUND) | (z >= 1.0 - AT_BOUND)
    beyond = [deviance - best(k)[1] if on_end[k] else 0.0 for k in range(count)]
    return z, np.array(beyond)


def _bounded(mean: Floats, covariance: Floats, sample: Floats) -> tuple[Floats, Floats]:
    """Mean and covariance of all coefficients when the parameters have those of a sample within bounds."""
    count = sample.shape[1]
    middle, sample_covariance = sample.mean(axis=0), np.atleast_2d(np.cov(sample, rowvar=False))
    gain = np.linalg.solve(covariance[:count, :count], covariance[:count, count:]).T
    conditional_mean, conditional = mean.copy(), covariance.copy()
    conditional_mean[:count] = middle
    conditional_mean[count:] += gain @ (middle - mean[:count])
    change = sample_covariance - covariance[:count, :count]
    conditional[:count, :count] = sample_covariance
    conditional[count:, :count] = gain @ sample_covariance
    conditional[:count, count:] = conditional[count:, :count].T
    conditional[count:, count:] += gain @ change @ gain.T
    return conditional_mean, conditional

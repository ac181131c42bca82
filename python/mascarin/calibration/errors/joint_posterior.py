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

from mascarin.calibration.base.problem import CalibrationProblem
from mascarin.calibration.errors.bounded_coefficients import best_within, ends_of, moments_within, within
from mascarin.calibration.errors.covariance_sampling import CovarianceSample, sample_covariances
from mascarin.calibration.errors.day_blocks import DayGaussian, DayGrid
from mascarin.calibration.errors.discrepancy import (
    DayData,
    Discrepancy,
    estimate_discrepancy,
    hour_basis,
)
from mascarin.calibration.errors.sampled_posterior import ChainLengths, Simulate, chains_of, coefficients_of
from mascarin.calibration.errors.sensor_errors import SensorError, sensor_columns
from mascarin.calibration.sampling.posterior_sample import PosteriorSample
from mascarin.calibration.sampling.truncated_normal import within_bounds

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

LEAST_ERROR: Final = 0.5
"""Smallest error of the model that is correlated within a day, in standard uncertainties of the sensor. [-]

A likelihood without it gives any weight to a sensor that the model follows nearly exactly, and gives up the
others.
"""

#: Smallest and largest factor by which days left out change the bands. [-]
_CROSS_VALIDATED: Final = (0.6, 1.5)
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
    unlimited : ndarray, shape (k,)
        Errors of sensors on the end of what they can be: the most probable value without this end, in
        standard uncertainties, if the end is contradicted with 95 %; 0 for others. [-]
    whitened : ndarray, shape (D, H, S)
        What each slot of a day differs from its prediction by all other days, independent and of variance 1
        if the model of the errors is right; NaN where nothing was measured. [-]
    left_out, left_out_sd : ndarray, shape (D, H, S)
        The same difference, and its standard deviation given the sizes of the errors. [unit]
    chains : PosteriorSample, optional
        Chains of the parameters and errors of sensors, where the model itself was sampled.
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
    unlimited: Floats
    whitened: Floats
    left_out: Floats
    left_out_sd: Floats
    chains: PosteriorSample | None = None

    def quantile(self, confidence: float) -> float:
        """Half-width of an interval on other days, in standard deviations: Student's.

        If the errors are as assumed, the quantile is that of the normal distribution. That they are is known
        from a few days of similar weather only, one fewer than which are the degrees of freedom.
        """
        from scipy import stats

        return float(stats.t.ppf(0.5 + 0.5 * confidence, max(self.by_day.size - 1, 2)))

    def days_left_out(self, confidence: float, nearness: Floats | float = 0.0) -> Floats:
        """Factor of the bands of a sensor that days left out of the identification require. [-]

        It is the quantile of what days differ from their predictions by the other days, over the quantile
        that is assumed (cross-validated prediction intervals: Barber R.F., Candes E.J., Ramdas A.,
        Tibshirani R.J. (2021), Annals of Statistics 49, 486. https://doi.org/10.1214/20-AOS1965), within
        limits. A day that is left out has the weather of its neighbours: bands that are wider than such days
        need are made narrower near the identification alone. On other days they are as assumed. Bands that
        are too narrow are made wider on all days.

        Parameters
        ----------
        confidence : float
            Of the bands. [-]
        nearness : float or ndarray, shape (n,)
            Correlation of the errors of each instant with those of the identification, see
            `mascarin.calibration.errors.nearness`; 0 for days of another season. [-]

        Returns
        -------
        ndarray, shape (S,) or (n, S)
        """
        from scipy import stats

        ratio = np.abs(self.left_out) / self.left_out_sd
        assumed = float(stats.norm.ppf(0.5 + 0.5 * confidence))
        ratio_of_days = np.nanquantile(ratio.reshape(-1, ratio.shape[2]), confidence, axis=0) / assumed
        factor = np.clip(ratio_of_days, *_CROSS_VALIDATED)
        weight = np.asarray(nearness)[..., None]
        return np.asarray(np.maximum(factor, 1.0) - weight * np.maximum(1.0 - factor, 0.0))

    def widened(self, confidence: float = 0.95) -> Floats:
        """Return the sample of the positions with the spread of `quantile`, shape (n, P). [-]

        Only what the data say is as doubtful as the errors; the priors are as stated.
        """
        from scipy import stats

        factor = self.quantile(confidence) / float(stats.norm.ppf(0.5 + 0.5 * confidence))
        count = self.sample.shape[1]
        # An estimate on its bound has no variance.
        curvature = 1.0 / np.maximum(np.diag(self.covariance)[:count], np.finfo(np.float64).tiny)
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
    *,
    simulate: Simulate | None = None,
    lengths: ChainLengths | None = None,
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
    simulate : callable, optional
        The model itself, from positions (M, P) to series (M, T, S). With it parameters and errors of sensors
        are sampled by `mascarin.calibration.errors.sampled_posterior`, in place of the linear model within
        bounds.
    lengths : ChainLengths, optional
        How long is sampled.

    Returns
    -------
    JointPosterior
    """
    gaussian, data, likely, scale, most_probable = _estimated(problem, linear, stated, covariances)
    if covariances is None:
        draws = sample_covariances(
            data,
            most_probable,
            scale=_scale(problem, stated),
            limit=stated.limit,
            least=_least(problem, stated),
        )
    else:
        draws = CovarianceSample.of_covariances(data, covariances)
    count, stated_count = len(problem.parameters), data.effects.shape[2]
    shared_count = stated_count + data.basis.shape[2] * data.sensors
    # The level that the days of the identification have in common says nothing of other days.
    mean, covariance = draws.mean[:, :shared_count].copy(), draws.covariance[:, :shared_count, :shared_count]
    mean[:, :count] *= scale[:count]
    mean[:, :count] += _priors(problem)[0]
    covariance = covariance * np.outer(scale[:shared_count], scale[:shared_count])
    low, high = ends_of(count, stated_count - linear.further.shape[2] - count, stated_count)
    bounded_count = int(np.isfinite(high).sum())
    limited = slice(bounded_count)
    bounded_sample = within_bounds(
        mean[:, limited], covariance[:, limited, limited], low[limited], high[limited]
    )
    of_sensors = sensor_columns(problem, stated.sensors, linear.simulated, stated.step)[1]
    names = (*of_sensors, *numbered(linear.further.shape[2], stated.further))
    chains = None
    if simulate is not None:
        chains = chains_of(
            problem, data, draws.covariances, bounded_sample, (low[limited], high[limited]), _priors(problem),
            of_sensors, _departure(linear, simulate), lengths or ChainLengths(),
        )  # fmt: skip
        bounded_sample = coefficients_of(problem, chains)
    middle = mean.mean(axis=0)
    away = mean - middle
    together = covariance.mean(axis=0) + away.T @ away / len(mean)
    bounded_mean, bounded = moments_within(middle, together, bounded_sample)
    sample = bounded_sample[:, :count]
    z, beyond, unlimited = best_within(gaussian.precision / np.outer(scale, scale), likely, low, high, count)
    whitened = gaussian.whitened(data.error).reshape(data.grid.days, data.grid.slots, data.sensors)
    return JointPosterior(
        z, bounded_mean, bounded, sample, draws.typical, names, gaussian.left_out(data.error),
        gaussian.log_density(data.error), scale[:count], beyond, unlimited, whitened,
        *gaussian.days_left_out(data.error, data.sensors), chains=chains,
    )  # fmt: skip


def _departure(linear: Linear, simulate: Simulate) -> Simulate:
    """From positions (M, P) to the difference of the model from the linear one (M, T, S). [unit]"""

    def departure(z: Floats) -> Floats:
        along = np.einsum("tsp,mp->mts", linear.jacobian, z - linear.z, optimize=True)
        return np.asarray(simulate(z) - linear.simulated - along)

    return departure


def numbered(count: int, names: tuple[str, ...]) -> tuple[str, ...]:
    """Names of further quantities: as stated, else with a number each.

    Examples
    --------
    >>> numbered(2, ())
    ('numbers that are not estimated, 1', 'numbers that are not estimated, 2')
    """
    return names or tuple(f"numbers that are not estimated, {k + 1}" for k in range(count))


def best_positions(
    problem: CalibrationProblem,
    linear: Linear,
    stated: ErrorStatement,
    first: Discrepancy | None = None,
) -> tuple[Floats, Discrepancy]:
    """Find the most probable positions alone, with the covariances of the errors.

    Parameters
    ----------
    problem, linear, stated
        As for `joint_posterior`.
    first : Discrepancy, optional
        Covariances of a linearization near by, to begin with.

    Returns
    -------
    ndarray, shape (P,)
        Within the ranges. [-]
    Discrepancy
        Sizes of the errors of the model.
    """
    gaussian, data, mean, scale, covariances = _estimated(problem, linear, stated, None, first)
    count = len(problem.parameters)
    low, high = ends_of(count, data.effects.shape[2] - linear.further.shape[2] - count, mean.size)
    precision = gaussian.precision / np.outer(scale, scale)
    return best_within(precision, mean, low, high, count)[0], covariances


def _estimated(
    problem: CalibrationProblem,
    linear: Linear,
    stated: ErrorStatement,
    covariances: Discrepancy | None,
    first: Discrepancy | None = None,
) -> tuple[DayGaussian, DayData, Floats, Floats, Discrepancy]:
    """Distribution and data, mean of all coefficients without bounds and their scale, sizes of the errors."""
    center, spread = _priors(problem)
    data = _data(problem, linear, stated, center, spread)
    if covariances is None:
        covariances = estimate_discrepancy(
            data,
            scale=0.25 * _scale(problem, stated),
            limit=stated.limit,
            least=_least(problem, stated),
            persistence=stated.persistence,
            first=first,
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
    gaussian = data.gaussian(covariances)
    mean = gaussian.coefficients(data.error)
    ends = ends_of(0, data.effects.shape[2] - linear.further.shape[2], mean.size)
    _, deviance = within(gaussian.precision, mean, *ends)
    return prior - gaussian.log_density(data.error) + 0.5 * deviance


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


def _least(problem: CalibrationProblem, stated: ErrorStatement) -> Floats:
    """Smallest standard deviation of the error of the model within a day (S,), see `LEAST_ERROR`. [unit]"""
    total = np.array([math.sqrt(float(np.mean(s.sigma[s.mask] ** 2))) for s in problem.sensors])
    return np.asarray(np.minimum(LEAST_ERROR * total, stated.limit))


def _scale(problem: CalibrationProblem, stated: ErrorStatement) -> Floats:
    """Scale of the errors of the model of each sensor (S,): its stated uncertainty less its offset. [unit]

    An offset is an error of its own: were the scale the whole uncertainty, the errors of the model would have
    it once more, on every day and at every hour.
    """
    total = np.array([float(np.mean(s.sigma[s.mask] ** 2)) for s in problem.sensors])
    shared = np.array([error.offset**2 + error.common**2 for error in stated.sensors])
    return np.asarray(np.sqrt(np.maximum(total - shared, _LEAST_SCATTER**2 * total)))

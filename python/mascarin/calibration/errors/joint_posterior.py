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
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.base.problem import CalibrationProblem
from mascarin.calibration.errors.block_dispersion import block_dispersion
from mascarin.calibration.errors.bounded_coefficients import best_within, ends_of, moments_within
from mascarin.calibration.errors.covariance_sampling import CovarianceSample, sample_covariances
from mascarin.calibration.errors.discrepancy import DayData, Discrepancy, hour_basis
from mascarin.calibration.errors.linear_estimation import (
    ErrorStatement,
    Estimated,
    Linear,
    columns_of_sensors,
    estimated,
    priors_of,
    sizes_of,
)
from mascarin.calibration.errors.sampled_posterior import ChainLengths, Simulate, chains_of, coefficients_of
from mascarin.calibration.sampling.posterior_sample import PosteriorSample
from mascarin.calibration.sampling.truncated_normal import within_bounds

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

#: Smallest and largest factor by which days left out change the bands. [-]
_CROSS_VALIDATED: Final = (0.6, 1.5)


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
    other_days : int
        Days of other experiments that have the same parameters. [-]
    dispersion : float
        Variance of what blocks of days say of the coefficients, over that of independent days, see
        `mascarin.calibration.errors.block_dispersion`. [-]
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
    other_days: int = 0
    dispersion: float = 1.0

    def of_parameters(self, columns: Sequence[int]) -> JointPosterior:
        """The same distribution of some of the parameters, with all errors of the experiment."""
        chosen = np.asarray(columns, dtype=np.int64)
        coefficient = np.concatenate([chosen, np.arange(self.z.size, self.mean.size)])
        return replace(
            self,
            z=self.z[chosen],
            mean=self.mean[coefficient],
            covariance=self.covariance[np.ix_(coefficient, coefficient)],
            sample=self.sample[:, chosen],
            prior=self.prior[chosen],
            beyond=self.beyond[chosen],
        )

    def quantile(self, confidence: float, *, other_days: int = 0) -> float:
        """Half-width of an interval on other days, in standard deviations: Student's.

        If the errors are as assumed, the quantile is that of the normal distribution. That they are is known
        from a few days of similar weather only, one fewer than which are the degrees of freedom; parameters
        that other experiments share are known from their days, too.
        """
        from scipy import stats

        return float(stats.t.ppf(0.5 + 0.5 * confidence, max(self.by_day.size + other_days - 1, 2)))

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
        """Return the sample of the positions, with the spread of `quantile` and `dispersion`, (n, P). [-]

        Only what the data say is as doubtful as the errors; the priors are as stated.
        """
        from scipy import stats

        factor = math.sqrt(self.dispersion) * self.quantile(confidence, other_days=self.other_days)
        factor /= float(stats.norm.ppf(0.5 + 0.5 * confidence))
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
        return columns @ about, self.dispersion * np.maximum(variance, 0.0)

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
    sizes = None if covariances is None else [covariances]
    return joint_posteriors(problem, linear, [stated], sizes, simulate=simulate, lengths=lengths)[0]


def joint_posteriors(
    problem: CalibrationProblem,
    linear: Linear,
    stated: Sequence[ErrorStatement],
    covariances: Sequence[Discrepancy] | None = None,
    *,
    simulate: Simulate | None = None,
    lengths: ChainLengths | None = None,
) -> tuple[JointPosterior, ...]:
    """Estimate the parameters of several experiments and the errors of each together.

    Parameters
    ----------
    problem, linear, simulate, lengths
        As for `joint_posterior`; one experiment alone can be sampled with the model itself.
    stated : sequence of ErrorStatement
        What is known of the errors of each experiment.
    covariances : sequence of Discrepancy, optional
        As for `joint_posterior`, of each.

    Returns
    -------
    tuple of JointPosterior
        The one distribution, as each experiment has it: all parameters, and its own errors.
    """
    after = estimated(problem, linear, stated, covariances)
    if covariances is None:
        sizes = [sizes_of(problem, each) for each in stated]
        draws = sample_covariances(after.data, after.covariances, sizes)
    else:
        draws = CovarianceSample.of_covariances(after.data, covariances)
    scale, priors = after.scale, priors_of(problem)
    count, stated_count = len(problem.parameters), after.effect_count
    shared_count = stated_count + sum(
        part_data.basis.shape[2] * part_data.sensors for part_data in after.data
    )
    # The level that the days of the identification have in common says nothing of other days.
    mean, covariance = draws.mean[:, :shared_count].copy(), draws.covariance[:, :shared_count, :shared_count]
    mean[:, :count] *= scale[:count]
    mean[:, :count] += priors[0]
    covariance = covariance * np.outer(scale[:shared_count], scale[:shared_count])
    low, high = ends_of(count, stated_count - linear.further.shape[2] - count, stated_count)
    limited = slice(int(np.isfinite(high).sum()))
    bounded_sample = within_bounds(
        mean[:, limited], covariance[:, limited, limited], low[limited], high[limited]
    )
    names = columns_of_sensors(problem, linear.simulated, stated)[1]
    chains = None
    if simulate is not None:
        chains = chains_of(
            problem, after.data[0], [each[0] for each in draws.covariances], bounded_sample,
            (low[limited], high[limited]), priors, names[0], _departure(linear, simulate),
            lengths or ChainLengths(),
        )  # fmt: skip
        bounded_sample = coefficients_of(problem, chains)
    middle = mean.mean(axis=0)
    away = mean - middle
    together = covariance.mean(axis=0) + away.T @ away / len(mean)
    bounded_mean, bounded = moments_within(middle, together, bounded_sample)
    precision = after.gaussian.precision / np.outer(scale, scale)
    z, beyond, unlimited = best_within(precision, after.mean, low, high, count)
    further, none = numbered(linear.further.shape[2], stated[0].further), np.zeros(0)
    of_all = JointPosterior(
        z, bounded_mean, bounded, bounded_sample[:, :count], draws.typical[0], further, none,
        after.gaussian.log_density(after.errors), scale[:count], beyond, unlimited, none, none, none,
        chains=chains, dispersion=block_dispersion(after.gaussian, after.errors, stated[0].persistence),
    )  # fmt: skip
    return tuple(_by_experiment(of_all, after, names, draws.typical))


def _by_experiment(
    of_all: JointPosterior,
    after: Estimated,
    names: Sequence[tuple[str, ...]],
    sizes: Sequence[Discrepancy],
) -> Iterator[JointPosterior]:
    """The distribution as each experiment has it, with its errors of sensors by name and of the model."""
    count, days = of_all.z.size, sum(data.grid.days for data in after.data)
    beside = after.gaussian.beside(after.errors)
    columns = _coefficients(count, names, after.data, after.effect_count)
    for k, (part, data) in enumerate(zip(after.gaussian.parts, after.data, strict=True)):
        shape = (data.grid.days, data.grid.slots, data.sensors)
        left_out, left_out_sd = part.days_left_out(data.error, data.sensors, beside[k])
        yield replace(
            of_all,
            mean=of_all.mean[columns[k]],
            covariance=of_all.covariance[np.ix_(columns[k], columns[k])],
            error_covariances=sizes[k],
            names=(*names[k], *of_all.names),
            by_day=part.left_out(data.error, beside[k]),
            unlimited=of_all.unlimited[columns[k][count : count + len(names[k])] - count],
            whitened=part.whitened(data.error, beside[k]).reshape(shape),
            left_out=left_out,
            left_out_sd=left_out_sd,
            other_days=days - data.grid.days,
        )


def _coefficients(
    count: int, names: Sequence[tuple[str, ...]], data: Sequence[DayData], effect_count: int
) -> list[NDArray[np.int64]]:
    """Coefficients of each experiment: positions, its errors of sensors, further ones, those that repeat."""
    of_sensors, coefficients = count, []
    further, repeating = np.arange(count + sum(map(len, names)), effect_count), effect_count
    for own_names, part_data in zip(names, data, strict=True):
        own_count = part_data.basis.shape[2] * part_data.sensors
        coefficients.append(
            np.concatenate(
                [
                    np.arange(count),
                    np.arange(of_sensors, of_sensors + len(own_names)),
                    further,
                    np.arange(repeating, repeating + own_count),
                ]
            )
        )
        of_sensors, repeating = of_sensors + len(own_names), repeating + own_count
    return coefficients


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

"""Uncertainty of estimates when the residuals are not independent.

At the minimum the estimates respond linearly to a small change of the residuals, with the Jacobian J of the
simulated series and the weights W of the squares: ``B J' W dr`` with ``B = (J' W J)^-1``. Their covariance
is therefore ``B (J' W Omega W J) B``, where Omega is the covariance of the residuals. Residuals of thermal
models are strongly autocorrelated, and those of neighboring sensors are correlated; with a diagonal Omega
the intervals would be many times too narrow. Here the residuals of each sensor are described by an
autoregressive model (order by BIC), with correlated innovations between sensors, which gives Omega.

Omega is itself estimated, from residuals that the fit has reduced, so that a standard deviation computed from
it scatters and is a little small. This is corrected by simulation: errors are drawn from the fitted
autoregressive models and put through the linearized fit and the same estimate, which shows how many estimated
standard deviations contain 95 % of the errors. Where that is more than the quantile of Student's
distribution, it is used (a bootstrap-t).

References
----------
Seber G.A.F., Wild C.J. (1989), Nonlinear Regression, chapter 6 (autocorrelated errors).
https://doi.org/10.1002/0471725315
Efron B., Tibshirani R.J. (1993), An Introduction to the Bootstrap, chapter 12 (bootstrap-t).
https://doi.org/10.1201/9780429246593
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.base.problem import CalibrationProblem
from mascarin.tables.recursion import recursion
from mascarin.validation.series import Autoregression, fit_autoregressions

Floats = NDArray[np.float64]

METHOD: Final = (
    "covariance of the estimates from the Jacobian, with the autocorrelation of the residuals (one "
    "autoregressive model per sensor, order by BIC) and the correlation between sensors; the quantile from "
    "simulated fits to errors of these models (bootstrap-t), at least Student's with the effective number of "
    "independent residuals"
)
"""How the intervals are computed, for reports."""

FREE: Final = 1e3
"""Standard deviation of directions that the data do not determine, in ranges of the parameters. [-]"""

AT_BOUND: Final = 1e-4
"""An estimate nearer to an end of its range than this is on the bound. [ranges]"""

_SIMULATED_FITS: Final = 40  # simulated fits
_SEED: Final = 20


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """Uncertainty of the estimates, at positions z between 0 and 1 of their ranges.

    Attributes
    ----------
    low, high : ndarray, shape (P,)
        Interval, within [0, 1]. [-]
    sd : ndarray, shape (P,)
        Standard deviation in ranges. [-]
    correlation : ndarray, shape (P, P)
        Between the estimates. [-]
    effective_samples : tuple of float, length S
        Number of independent residuals of each sensor. [-]
    order : tuple of int, length S
        Order of each sensor's autoregressive model. [-]
    freedom : float
        Degrees of freedom of Student's quantile. [-]
    quantile : ndarray, shape (P,)
        Half-width of the intervals in standard deviations. [-]
    covariance : ndarray, shape (P, P)
        Of the estimates, in ranges. [-]
    information : ndarray, shape (P, P)
        Fisher information for independent errors of the stated uncertainty, priors included. [-]
    error : tuple of float, length S
        Standard deviation of each sensor's errors about the model. [unit]
    stretch : ndarray, shape (P, P)
        Symmetric matrix by which distances from the estimates are multiplied, so that the likelihood of
        independent errors has the covariance of the data without priors. [-]

    Examples
    --------
    >>> from mascarin.calibration import CalibrationProblem, FitParameter, FitSensor, solve
    >>> measured = 20.0 + 0.1 * np.random.default_rng(1).normal(size=48)
    >>> problem = CalibrationProblem(
    ...     (FitParameter("level", 10.0, 30.0),),
    ...     (FitSensor("room", measured, 0.1),),
    ...     lambda x: np.tile(x[:, :, None], (1, 48, 1)),
    ... )
    >>> found = solve(problem).uncertainty
    >>> found.order, round(found.effective_samples[0])
    ((0,), 48)
    """

    low: Floats
    high: Floats
    sd: Floats
    correlation: Floats
    effective_samples: tuple[float, ...]
    order: tuple[int, ...]
    freedom: float
    quantile: Floats
    covariance: Floats
    information: Floats
    error: tuple[float, ...]
    stretch: Floats


def estimate(
    problem: CalibrationProblem,
    z: Floats,
    residuals: Floats,
    jacobian: Floats,
    weights: Floats,
    *,
    priors: Floats,
    ignores_bias: bool,
    confidence: float,
) -> Uncertainty:
    """Estimate intervals and correlations at a minimum.

    Parameters
    ----------
    problem : CalibrationProblem
        Parameters, measured series and model.
    z : ndarray, shape (P,)
        The estimates, as positions between 0 and 1. [-]
    residuals : ndarray, shape (T, S)
        0 where nothing is compared. [unit]
    jacobian : ndarray, shape (T, S, P)
        Derivative of the residuals by z. [unit]
    weights : ndarray, shape (T, S)
        Weights of the squares, see `Cost.weights`.
    priors : ndarray, shape (P,)
        Inverse variance of the prior of z, 0 without one; counts only with weights of the likelihood. [-]
    ignores_bias : bool
        Whether the cost subtracts the mean residual of each sensor.
    confidence : float
        Of the intervals. [-]

    Returns
    -------
    Uncertainty
    """
    from scipy import stats

    mask = problem.mask
    j = np.where(mask[:, :, None], jacobian, 0.0)
    if ignores_bias:
        j = np.where(mask[:, :, None], j - j.sum(axis=0) / mask.sum(axis=0)[:, None], 0.0)
    r = np.where(mask, residuals, np.nan)
    models = tuple(fit_autoregressions(r.T))
    wj = weights[:, :, None] * j
    information = _summed(wj, j) + np.diag(priors)
    effective = tuple(m.effective_samples for m in models)
    freedom = max(sum(effective) - z.size, 1.0)
    # The fit has reduced the residuals: it used as many degrees of freedom as there are parameters. A prior
    # is a measurement with a known, independent error: it enters the middle as it enters the information.
    inflation = max(sum(effective), 1.0) / freedom
    noise = _Noise.of(r, models, inflation)
    middle = noise.middle(wj) + np.diag(priors)
    covariance = _sandwich(information, middle)
    inside = (z > AT_BOUND) & (z < 1.0 - AT_BOUND)
    sd = np.sqrt(np.diag(covariance))
    quantile = np.full(z.size, float(stats.t.ppf(0.5 + 0.5 * confidence, freedom)))
    # An estimate on its bound is as uncertain as all others: within its range it may be elsewhere, and what
    # compensates for it with it. Conditional on the bound the intervals of the others would be too narrow.
    free = np.flatnonzero(inside) if inside.any() else np.arange(z.size)
    simulated_quantile = _drawn_quantile(noise, j[..., free], wj[..., free], priors[free], mask, confidence)
    quantile[free] = np.maximum(quantile[free], simulated_quantile)
    reach = quantile * sd
    return Uncertainty(
        low=np.clip(z - reach, 0.0, 1.0),
        high=np.clip(z + reach, 0.0, 1.0),
        sd=sd,
        correlation=_correlation(covariance),
        effective_samples=effective,
        order=tuple(m.order for m in models),
        freedom=freedom,
        quantile=quantile,
        covariance=covariance,
        information=information,
        error=tuple(
            math.sqrt(max(m.variance, 0.0) * inflation + float(np.nanmean(r[:, s])) ** 2)
            for s, m in enumerate(models)
        ),
        stretch=_stretch(information - np.diag(priors), middle - np.diag(priors)),
    )


@dataclass(frozen=True, eq=False)
class _Noise:
    """Errors of all sensors: one autoregressive model each, with correlated innovations.

    Attributes
    ----------
    models : tuple of Autoregression, length S
        Of each sensor.
    innovation : ndarray, shape (S, S)
        Covariance of the innovations. [unit^2]
    memory : int
        Number of samples after which an innovation has decayed. [-]
    """

    models: tuple[Autoregression, ...]
    innovation: Floats
    memory: int

    @staticmethod
    def of(r: Floats, models: tuple[Autoregression, ...], factor: float = 1.0) -> _Noise:
        """Model errors like the residuals r (T, S), NaN for gaps; their variance times a factor."""
        memory = min(max((m.memory() for m in models), default=0), 20 * r.shape[0])
        noise = _Noise(models, np.eye(len(models)), memory)
        impulse = np.zeros((r.shape[0] + memory, len(models)))
        impulse[0] = 1.0
        return _Noise(models, factor * _innovations(r, models, noise.response(impulse)), memory)

    def response(self, innovations: Floats) -> Floats:
        """Compute the series (T, S, ...) of innovations of the same shape."""
        series = np.empty_like(innovations)
        for s, model in enumerate(self.models):
            series[:, s] = recursion(model.coefficients, innovations[:, s])
        return series

    def middle(self, wj: Floats) -> Floats:
        """Compute ``J' W Omega W J`` from weighted derivatives (T, S, P).

        Omega of one sensor is ``innovation * Psi Psi'`` with Psi the response to an innovation; the product
        with Psi' is the recursion backwards in time, continued before the first sample until it has decayed.
        """
        filtered = self.response(np.concatenate([wj[::-1], np.zeros((self.memory, *wj.shape[1:]))]))
        shape = (-1, wj.shape[2])
        mixed = self.innovation @ filtered
        return np.asarray(filtered.reshape(shape).T @ mixed.reshape(shape))

    def draw(self, times: int, count: int) -> Floats:
        """Draw random errors, shape (T, S, count), the same in every call. [unit]"""
        value, vector = np.linalg.eigh(self.innovation)
        root = vector * np.sqrt(np.maximum(value, 0.0))
        normal = np.random.default_rng(_SEED).standard_normal((times + self.memory, len(self.models), count))
        return self.response(root @ normal)[self.memory :]


def _drawn_quantile(
    noise: _Noise, j: Floats, wj: Floats, priors: Floats, mask: NDArray[np.bool_], confidence: float
) -> Floats:
    """Quantile of error over estimated standard deviation in simulated fits, shape (P,). [-]"""
    if not np.any(np.diag(noise.innovation) > 0.0):
        return np.zeros(j.shape[2])
    information = _summed(wj, j) + np.diag(priors)
    inverse, _ = _inverted(information)
    true = _diagonal(inverse, noise.middle(wj) + np.diag(priors))
    errors = noise.draw(j.shape[0], _SIMULATED_FITS)
    of_priors = np.random.default_rng(_SEED + 1).standard_normal((priors.size, _SIMULATED_FITS))
    change = -inverse @ (_summed(wj, errors) + np.sqrt(priors)[:, None] * of_priors)
    fit_residuals = errors + j @ change
    ratio = np.ones_like(change)
    remaining = np.where(mask[:, :, None], fit_residuals, np.nan)
    sensors = mask.shape[1]
    fitted = fit_autoregressions(remaining.reshape(len(remaining), -1).T)
    for k in range(_SIMULATED_FITS):
        r = remaining[:, :, k]
        models = tuple(fitted[s * _SIMULATED_FITS + k] for s in range(sensors))
        effective = max(sum(m.effective_samples for m in models), 1.0)
        noise_of_fit = _Noise.of(r, models, effective / max(effective - priors.size, 1.0))
        variance = _diagonal(inverse, noise_of_fit.middle(wj) + np.diag(priors))
        ratio[:, k] = np.sqrt(np.divide(variance, true, out=np.ones_like(true), where=true > 0.0))
    return _widened(ratio, confidence)


def _summed(first: Floats, second: Floats) -> Floats:
    """Sum of the products of columns over all samples, (T, S, p) and (T, S, k), shape (p, k)."""
    return np.asarray(first.reshape(-1, first.shape[2]).T @ second.reshape(-1, second.shape[2]))


def _diagonal(inverse: Floats, middle: Floats) -> Floats:
    return np.asarray(np.sum((inverse @ middle) * inverse, axis=1))


def _widened(ratio: Floats, confidence: float) -> Floats:
    """Quantile of a normal variable in units of a standard deviation that scatters, rows of (P, K). [-]"""
    from scipy.special import ndtr

    low, high = np.zeros(len(ratio)), np.full(len(ratio), 1e3)
    # Bisection: the probability rises with the quantile.
    for _ in range(60):
        middle = 0.5 * (low + high)
        inside = np.mean(2.0 * ndtr(middle[:, None] * ratio) - 1.0, axis=1)
        low, high = np.where(inside < confidence, middle, low), np.where(inside < confidence, high, middle)
    return np.asarray(high)


def _innovations(r: Floats, models: tuple[Autoregression, ...], responses: Floats) -> Floats:
    """Covariance of the innovations of all sensors, from that of the residuals; shape (S, S). [unit^2]"""
    size = np.sqrt([max(m.innovation, 0.0) for m in models])
    finite = np.isfinite(r)
    pairs = finite.T.astype(np.float64) @ finite
    mean = np.where(finite, r, 0.0).sum(axis=0) / np.maximum(np.diag(pairs), 1.0)
    centered = np.where(finite, r - mean, 0.0)
    together = centered.T @ centered / np.maximum(pairs, 1.0)
    scale = np.outer(size, size) * (responses.T @ responses)
    estimable = (scale > 0.0) & (pairs >= 3.0)
    correlation = np.clip(np.divide(together, scale, out=np.zeros_like(scale), where=estimable), -1.0, 1.0)
    np.fill_diagonal(correlation, 1.0)
    # Estimated pair by pair, so not always a covariance: take the nearest one.
    value, vector = np.linalg.eigh(correlation)
    correlation = (vector * np.maximum(value, 0.0)) @ vector.T
    return np.asarray(correlation * np.outer(size, size))


def _inverted(information: Floats) -> tuple[Floats, Floats]:
    """Inverse of the information where the data determine it, and the directions that they do not."""
    value, vector = np.linalg.eigh(information)
    largest = float(value.max(initial=0.0))
    determined = value > max(1e-13 * largest, np.finfo(float).tiny)
    inverse = np.where(determined, 1.0 / np.where(determined, value, 1.0), 0.0)
    return np.asarray((vector * inverse) @ vector.T), np.asarray(vector[:, ~determined])


def _sandwich(information: Floats, middle: Floats) -> Floats:
    """``B middle B``, ``B = information^-1``; undetermined directions have the variance `FREE` squared."""
    b, unseen = _inverted(information)
    covariance = b @ middle @ b + FREE**2 * unseen @ unseen.T
    return np.asarray(0.5 * (covariance + covariance.T))


def symmetric_power(matrix: Floats, exponent: float) -> Floats:
    """Compute a power of a symmetric matrix without negative eigenvalues. [-]

    Parameters
    ----------
    matrix : ndarray, shape (n, n)
        The matrix.
    exponent : float
        The exponent.

    Returns
    -------
    ndarray, shape (n, n)

    Examples
    --------
    >>> symmetric_power(np.diag([4.0, 9.0]), 0.5)
    array([[2., 0.],
           [0., 3.]])
    """
    value, vector = np.linalg.eigh(matrix)
    floor = np.finfo(float).eps * max(float(value.max(initial=0.0)), np.finfo(float).tiny)
    return np.asarray((vector * np.maximum(value, floor) ** exponent) @ vector.T)


def _stretch(information: Floats, middle: Floats) -> Floats:
    """Symmetric C with ``C information C`` the inverse of the sandwich: a geometric mean of matrices."""
    target = symmetric_power(_sandwich(information, middle), -1.0)
    # Where the data determine nothing the likelihood is flat, and any finite matrix serves.
    root = symmetric_power(information + np.eye(len(information)), 0.5)
    back = symmetric_power(information + np.eye(len(information)), -0.5)
    return np.asarray(back @ symmetric_power(root @ target @ root, 0.5) @ back)


def _correlation(covariance: Floats) -> Floats:
    sd = np.sqrt(np.diag(covariance))
    sd = np.where(sd > 0.0, sd, 1.0)
    correlation = np.clip(covariance / np.outer(sd, sd), -1.0, 1.0)
    np.fill_diagonal(correlation, 1.0)
    return np.asarray(correlation)

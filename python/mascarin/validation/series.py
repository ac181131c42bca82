"""Statistics of time series with gaps: autocorrelation, autoregressive models, effective sample size.

References
----------
Parzen E. (1963), Sankhya A 25, 383 (autocovariance of series with gaps).
Brockwell P.J., Davis R.A. (1991), Time Series: Theory and Methods, chapter 8 (Durbin-Levinson, orders).
https://doi.org/10.1007/978-1-4419-0320-4
Bayley G.V., Hammersley J.M. (1946), J. R. Stat. Soc. Suppl. 8, 184 (effective number of observations).
https://doi.org/10.2307/2983560
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mascarin.errors import InputError

Floats = NDArray[np.float64]

_MAX_ORDER = 60


def autocovariance(x: ArrayLike, lags: int) -> Floats:
    """Estimate the autocovariance of a regularly sampled series with gaps.

    Each lag uses the pairs of samples that are both there, with the usual taper ``1 - lag / n``.

    Parameters
    ----------
    x : array_like, shape (n,)
        Series; NaN where there is no sample. The mean is subtracted. [unit]
    lags : int
        Largest lag. [samples]

    Returns
    -------
    ndarray, shape (lags + 1,)
        [unit^2]

    Raises
    ------
    InputError
        When there are fewer than two samples.

    Examples
    --------
    >>> autocovariance([1.0, 2.0, 3.0, 6.0], 1)
    array([3.5, 0.5])
    """
    series = np.asarray(x, dtype=np.float64)
    count = int(np.isfinite(series).sum())
    if count < 2:
        msg = f"autocovariance: the series has {count} samples, expected at least 2"
        raise InputError(msg)
    return np.asarray(_autocovariances(series[None], lags)[0])


def _autocovariances(x: Floats, lags: int) -> Floats:
    """Estimate those of series (B, n), shape (B, lags + 1); zero where there are fewer than two samples."""
    finite = np.isfinite(x)
    count = finite.sum(axis=1)
    mean = np.where(finite, x, 0.0).sum(axis=1) / np.maximum(count, 1)
    centred = np.where(finite & (count > 1)[:, None], x - mean[:, None], 0.0)
    n = x.shape[1]
    most = min(lags, n - 1)

    def products(values: Floats) -> Floats:
        spectrum = np.abs(np.fft.rfft(values, 2 * n)) ** 2
        return np.asarray(np.fft.irfft(spectrum, 2 * n)[:, : most + 1])

    sums, pairs = products(centred), np.round(products(finite.astype(np.float64)))
    gamma = np.zeros((len(x), lags + 1))
    taper = 1.0 - np.arange(most + 1) / n
    gamma[:, : most + 1] = np.where(pairs > 0, sums / np.maximum(pairs, 1.0), 0.0) * taper
    return gamma


def autocorrelation(x: ArrayLike, lags: int) -> Floats:
    """Estimate the autocorrelation of a regularly sampled series with gaps.

    Parameters
    ----------
    x : array_like, shape (n,)
        Series; NaN where there is no sample.
    lags : int
        Largest lag. [samples]

    Returns
    -------
    ndarray, shape (lags + 1,)
        1 at lag 0. [-]

    Raises
    ------
    InputError
        When there are fewer than two samples.

    Examples
    --------
    >>> autocorrelation([1.0, 2.0, 3.0, 6.0], 0)
    array([1.])
    """
    gamma = autocovariance(x, lags)
    if gamma[0] <= 0.0:
        return np.concatenate([[1.0], np.zeros(lags)])
    return np.asarray(gamma / gamma[0])


@dataclass(frozen=True, eq=False)
class Autoregression:
    """Autoregressive model ``x_t = sum_k coefficients[k] x_{t-1-k} + e_t`` about the mean.

    Attributes
    ----------
    coefficients : ndarray, shape (p,)
        [-]
    variance : float
        Of the series. [unit^2]
    innovation : float
        Variance of e. [unit^2]
    samples : int
        Number of samples it was fitted to. [-]
    """

    coefficients: Floats
    variance: float
    innovation: float
    samples: int

    @property
    def order(self) -> int:
        """Number of coefficients. [-]"""
        return self.coefficients.size

    @property
    def inflation(self) -> float:
        """Factor by which the autocorrelation widens the variance of a mean: 1 for white noise. [-]"""
        if self.variance <= 0.0:
            return 1.0
        gain = 1.0 - float(self.coefficients.sum())
        return self.innovation / (gain * gain) / self.variance

    @property
    def effective_samples(self) -> float:
        """Number of independent samples that determine a mean equally well, at most `samples`. [-]"""
        return self.samples / max(self.inflation, 1.0)

    def memory(self, tolerance: float = 1e-6) -> int:
        """Return the number of steps after which a disturbance has decayed to a tolerance. [samples]"""
        if not self.order:
            return 0
        if self.order == 1:
            size = min(abs(float(self.coefficients[0])), 0.999999)
            return 1 + math.ceil(math.log(tolerance) / math.log(size)) if size > 0.0 else 1
        roots = np.abs(np.roots(np.concatenate([[1.0], -self.coefficients])))
        slowest = min(float(roots.max(initial=0.0)), 0.999999)
        if slowest <= 0.0:
            return self.order
        return self.order + math.ceil(math.log(tolerance) / math.log(slowest))


def fit_autoregression(x: ArrayLike, *, longest: int | None = None) -> Autoregression:
    """Fit an autoregressive model to a series with gaps; the order has the lowest BIC.

    Parameters
    ----------
    x : array_like, shape (n,)
        Regularly sampled series, NaN for gaps. [unit]
    longest : int, optional
        Highest order tried; ``10 log10 n`` (at most a tenth of the samples) when absent. [-]

    Returns
    -------
    Autoregression

    Examples
    --------
    >>> x = np.random.default_rng(1).normal(size=500)
    >>> fit_autoregression(x).order
    0
    """
    return fit_autoregressions(np.asarray(x, dtype=np.float64)[None], longest=longest)[0]


def fit_autoregressions(x: Floats, *, longest: int | None = None) -> list[Autoregression]:
    """Fit autoregressive models to several series of equal length at once.

    Parameters
    ----------
    x : ndarray, shape (B, n)
        Regularly sampled series, NaN for gaps. [unit]
    longest : int, optional
        As for `fit_autoregression`. [-]

    Returns
    -------
    list of Autoregression
        One for each series.
    """
    count = np.isfinite(x).sum(axis=1)
    if longest is None:
        tried = np.minimum(np.minimum(10.0 * np.log10(np.maximum(count, 2)), count / 10), _MAX_ORDER)
        most = tried.astype(np.int64)
    else:
        most = np.full(len(x), longest)
    gamma = _autocovariances(x, int(max(most.max(initial=0), 1)))
    valid = gamma[:, 0] > 0.0
    innovation = np.where(valid, gamma[:, 0], 1.0)
    lowest = count * np.log(innovation)
    coefficients = np.zeros((len(x), gamma.shape[1] - 1))
    best = [(np.empty(0), float(variance)) for variance in gamma[:, 0]]
    for p in range(1, gamma.shape[1]):
        before = coefficients[:, : p - 1]
        reflection = (gamma[:, p] - np.sum(before * gamma[:, p - 1 : 0 : -1], axis=1)) / innovation
        # Gaps can make the estimated autocovariance one that no series has: the recursion ends there.
        valid &= (np.abs(reflection) < 1.0) & (p <= most)
        if not valid.any():
            break
        reflection = np.where(valid, reflection, 0.0)
        coefficients[:, : p - 1] = before - reflection[:, None] * before[:, ::-1]
        coefficients[:, p - 1] = reflection
        innovation = innovation * (1.0 - reflection * reflection)
        score = count * np.log(innovation) + p * np.log(np.maximum(count, 1))
        better = valid & (score < lowest)
        lowest = np.where(better, score, lowest)
        for k in np.flatnonzero(better):
            best[k] = (coefficients[k, :p].copy(), float(innovation[k]))
    return [
        Autoregression(best_coefficients, float(variance), best_innovation, int(number))
        for (best_coefficients, best_innovation), variance, number in zip(
            best, gamma[:, 0], count, strict=True
        )
    ]


def effective_samples(x: ArrayLike) -> float:
    """Estimate the number of independent samples that determine a mean as well as a series with gaps does.

    Parameters
    ----------
    x : array_like, shape (n,)
        Regularly sampled series, NaN for gaps.

    Returns
    -------
    float
        From the autoregressive model of the series, at most the number of its samples. [-]

    Examples
    --------
    >>> effective_samples(np.random.default_rng(1).normal(size=500))
    500.0
    """
    return fit_autoregression(x).effective_samples


def correlate(x: ArrayLike, y: ArrayLike) -> tuple[float, float]:
    """Correlate two series, and estimate the correlation that chance would give.

    Parameters
    ----------
    x, y : array_like, shape (n,)
        Regularly sampled series, NaN for gaps.

    Returns
    -------
    tuple of float
        Correlation, and the size that 95 % of unrelated series with the same autocorrelations stay below;
        NaN and infinity when there are fewer than 3 common samples or one series never changes. [-]

    Examples
    --------
    >>> x = np.random.default_rng(1).normal(size=500)
    >>> r, limit = correlate(x, x)
    >>> round(r, 3), limit < 0.2
    (1.0, True)
    """
    a, b = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
    both = np.isfinite(a) & np.isfinite(b)
    if both.sum() < 3:
        return math.nan, math.inf
    a, b = np.where(both, a, np.nan), np.where(both, b, np.nan)
    if np.ptp(a[both]) == 0.0 or np.ptp(b[both]) == 0.0:
        return math.nan, math.inf
    n = int(both.sum())
    lags = min(a.size - 1, max(1, a.size // 4))
    common = autocorrelation(a, lags)[1:] * autocorrelation(b, lags)[1:]
    # Bartlett: the variance of the correlation of two unrelated series.
    spread = max(1.0 + 2.0 * float(common.sum()), 1.0) / n
    return float(np.corrcoef(a[both], b[both])[0, 1]), min(1.959964 * math.sqrt(spread), 1.0)

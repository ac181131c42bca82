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

_LONGEST_ORDER = 60


def autocovariance(x: ArrayLike, lags: int) -> Floats:
    """Autocovariance of a regularly sampled series with gaps.

    Each lag uses the pairs of samples that are both there, with the usual taper ``1 - lag / n``.

    Parameters
    ----------
    x : array_like, shape (n,)
        Series; NaN where there is no sample. The mean is taken off. [unit]
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
    """
    series = np.asarray(x, dtype=np.float64)
    there = np.isfinite(series)
    count = int(there.sum())
    if count < 2:
        msg = f"autocovariance: the series has {count} samples, expected at least 2"
        raise InputError(msg)
    centred = np.where(there, series - series[there].mean(), 0.0)
    n = series.size
    size = 2 * n
    most = min(lags, n - 1)
    sums = np.fft.irfft(np.abs(np.fft.rfft(centred, size)) ** 2, size)[: most + 1]
    pairs = np.fft.irfft(np.abs(np.fft.rfft(there.astype(np.float64), size)) ** 2, size)[: most + 1]
    pairs = np.round(pairs)
    taper = 1.0 - np.arange(most + 1) / n
    gamma = np.zeros(lags + 1)
    gamma[: most + 1] = np.where(pairs > 0, sums / np.maximum(pairs, 1.0), 0.0) * taper
    return gamma


def autocorrelation(x: ArrayLike, lags: int) -> Floats:
    """Autocorrelation of a regularly sampled series with gaps, shape (lags + 1,), 1 at lag 0. [-]"""
    gamma = autocovariance(x, lags)
    if gamma[0] <= 0.0:
        return np.concatenate([[1.0], np.zeros(lags)])
    return np.asarray(gamma / gamma[0])


@dataclass(frozen=True, eq=False)
class Autoregression:
    """``x_t = sum_k coefficients[k] x_{t-1-k} + e_t`` about the mean.

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
        """Number of independent samples that would tell as much about a mean, at most those there are. [-]"""
        return self.samples / max(self.inflation, 1.0)

    def memory(self, tolerance: float = 1e-6) -> int:
        """Number of steps after which a disturbance has died away. [samples]"""
        if not self.order:
            return 0
        roots = np.abs(np.roots(np.concatenate([[1.0], -self.coefficients])))
        slowest = min(float(roots.max(initial=0.0)), 0.999999)
        if slowest <= 0.0:
            return self.order
        return self.order + math.ceil(math.log(tolerance) / math.log(slowest))


def fit_autoregression(x: ArrayLike, *, longest: int | None = None) -> Autoregression:
    """Fit an autoregressive model to a series with gaps; the order is that of lowest BIC.

    Parameters
    ----------
    x : array_like, shape (n,)
        Regularly sampled series, NaN for gaps. [unit]
    longest : int, optional
        Highest order tried; ``10 log10 n`` (at most a tenth of the samples) when absent. [-]

    Returns
    -------
    Autoregression
    """
    series = np.asarray(x, dtype=np.float64)
    count = int(np.isfinite(series).sum())
    if longest is None:
        longest = int(min(10.0 * math.log10(max(count, 2)), count / 10, _LONGEST_ORDER))
    gamma = autocovariance(series, max(longest, 1))
    white = Autoregression(np.empty(0), float(gamma[0]), float(gamma[0]), count)
    if gamma[0] <= 0.0:
        return white
    best, lowest = white, count * math.log(gamma[0])
    coefficients, innovation = np.empty(0), float(gamma[0])
    for p in range(1, longest + 1):
        reflection = (gamma[p] - coefficients @ gamma[p - 1 : 0 : -1]) / innovation
        # Gaps can make the estimated autocovariance one that no series has: the recursion ends there.
        if abs(reflection) >= 1.0:
            break
        coefficients = np.concatenate([coefficients - reflection * coefficients[::-1], [reflection]])
        innovation *= 1.0 - reflection * reflection
        score = count * math.log(innovation) + p * math.log(count)
        if score < lowest:
            lowest = score
            best = Autoregression(coefficients, float(gamma[0]), innovation, count)
    return best


def effective_samples(x: ArrayLike) -> float:
    """Number of independent samples that a series with gaps is worth, from its autoregressive model. [-]"""
    return fit_autoregression(x).effective_samples


def correlate(x: ArrayLike, y: ArrayLike) -> tuple[float, float]:
    """Correlation of two series and how large chance would make it.

    Parameters
    ----------
    x, y : array_like, shape (n,)
        Regularly sampled series, NaN for gaps.

    Returns
    -------
    tuple of float
        Correlation, and the size that 95 % of unrelated series with the same autocorrelations stay below;
        NaN and infinity when there are fewer than 3 common samples or one series never changes. [-]
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

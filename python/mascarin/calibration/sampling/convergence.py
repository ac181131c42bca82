"""Whether chains have converged: R-hat of ranks, and effective sample size of the bulk and of the tails.

References
----------
Vehtari A., Gelman A., Simpson D., Carpenter B., Buerkner P.-C. (2021), Rank-normalization, folding, and
localization: an improved R-hat, Bayesian Analysis 16, 667. https://doi.org/10.1214/20-BA1221
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

LARGEST_R_HAT: Final = 1.01
"""Chains with a larger R-hat have not converged. [-]"""

LEAST_SIZE: Final = 400.0
"""Smallest effective sample size for intervals of 95 %. [-]"""


def r_hat(chains: Floats) -> float:
    """Potential scale reduction of ranks, that of the distances from the median included.

    Parameters
    ----------
    chains : ndarray, shape (C, N)
        Draws of one quantity.

    Examples
    --------
    >>> draws = np.random.default_rng(1).normal(size=(4, 500))
    >>> bool(r_hat(draws) < 1.01), bool(r_hat(draws + np.arange(4)[:, None]) > 1.5)
    (True, True)
    """
    if not np.ptp(chains) > 0.0:
        return math.nan
    halves = _split(chains)
    folded = np.abs(halves - np.median(halves))
    return max(_plain_r_hat(_normal_ranks(halves)), _plain_r_hat(_normal_ranks(folded)))


def bulk_size(chains: Floats) -> float:
    """Effective sample size of the ranks (C, N). [-]

    Examples
    --------
    >>> draws = np.random.default_rng(1).normal(size=(4, 500))
    >>> bool(1500.0 < bulk_size(draws) < 2600.0)
    True
    """
    if not np.ptp(chains) > 0.0:
        return math.nan
    return _size(_normal_ranks(_split(chains)))


def tail_size(chains: Floats) -> float:
    """Smaller effective sample size of being below the quantiles of 5 and 95 % (C, N). [-]

    Examples
    --------
    >>> draws = np.random.default_rng(1).normal(size=(4, 500))
    >>> bool(tail_size(draws) > 1000.0)
    True
    """
    if not np.ptp(chains) > 0.0:
        return math.nan
    ends = np.quantile(chains, [0.05, 0.95])
    return min(_size(_split((chains <= end).astype(np.float64))) for end in ends)


def _split(chains: Floats) -> Floats:
    """Each chain as two, shape (2 C, N // 2)."""
    half = chains.shape[1] // 2
    return np.concatenate([chains[:, :half], chains[:, -half:]])


def _normal_ranks(chains: Floats) -> Floats:
    from scipy import stats

    ranks = stats.rankdata(chains, method="average").reshape(chains.shape)
    return np.asarray(stats.norm.ppf((ranks - 0.375) / (chains.size + 0.25)))


def _plain_r_hat(chains: Floats) -> float:
    count = chains.shape[1]
    between = float(count * np.var(chains.mean(axis=1), ddof=1))
    inside = float(np.mean(np.var(chains, axis=1, ddof=1)))
    if not inside > 0.0:
        return math.inf
    return math.sqrt(((count - 1) / count * inside + between / count) / inside)


def _size(chains: Floats) -> float:
    """Effective sample size by sums of neighbouring autocorrelations that fall (Geyer)."""
    number, count = chains.shape
    away = chains - chains.mean(axis=1, keepdims=True)
    spectrum = np.abs(np.fft.rfft(away, 2 * count, axis=1)) ** 2
    covariance = np.fft.irfft(spectrum, axis=1)[:, :count] / count
    inside = float(np.mean(covariance[:, 0]) * count / (count - 1.0))
    total = inside * (count - 1.0) / count
    if number > 1:
        total += float(np.var(chains.mean(axis=1), ddof=1))
    if not total > 0.0:
        return math.nan
    correlation = 1.0 - (inside - covariance.mean(axis=0) * count / (count - 1.0)) / total
    correlation[0] = 1.0
    pairs = correlation[0 : count - count % 2 : 2] + correlation[1:count:2]
    negative = np.flatnonzero(pairs < 0.0)
    pairs = np.minimum.accumulate(pairs[: negative[0]] if negative.size else pairs)
    time = max(-1.0 + 2.0 * float(pairs.sum()), 1.0 / math.log10(number * count))
    return float(number * count / time)

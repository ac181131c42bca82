"""Indices with intervals from independent replicates, by leaving out one replicate at a time.

The error of an index in one replicate comes from interactions that fall on the lines of another parameter.
It is small in most replicates and large in a few: the errors of the replicates are independent and symmetric,
but their distribution has heavy tails (a kurtosis of 25 to 100 was measured). Student's interval is then too
wide, because one large error increases the spread as much as it moves the mean. Hartigan's interval needs
symmetry only: the means of all subsets of the replicates lie below or above the true value with equal
probability, so that two of these means, of known rank, are the ends of the interval.

References
----------
Hartigan J.A. (1969), J. Am. Stat. Assoc. 64, 1303 (using subsample values as typical values).
https://doi.org/10.1080/01621459.1969.10501057
Tukey's pseudo-values, and the jackknife's variance, which is on average too large rather than too small:
Efron B., Stein C. (1981), Ann. Stat. 9, 586. https://doi.org/10.1214/aos/1176345462
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_MAX_SUBSETS: Final = 1024  # largest number of subsets, the empty one included


@dataclass(frozen=True, eq=False)
class Ratio:
    """Numerator or denominator of an index: from all replicates, and with each one left out.

    Attributes
    ----------
    value : ndarray, shape (..., T) or (...)
        From all replicates.
    without : ndarray, shape (R, ..., T) or (R, ...)
        With each replicate left out.
    """

    value: Floats
    without: Floats

    @staticmethod
    def mean(values: Floats) -> Ratio:
        """Average the values of the replicates, shape (R, ...)."""
        r = values.shape[0]
        return Ratio(values.mean(axis=0), (values.sum(axis=0) - values) / (r - 1))

    def summed(self) -> Ratio:
        """Sum over time, the last axis."""
        return Ratio(self.value.sum(axis=-1), self.without.sum(axis=-1))


def interval(above: Ratio, below: Ratio, confidence: float) -> tuple[Floats, Floats, Floats]:
    """Compute an index with its confidence interval; all within [0, 1].

    Hartigan's interval where there are enough replicates for the confidence (6 for 95 %), else Student's.

    Parameters
    ----------
    above, below : Ratio
        Numerator and denominator; the numerator has one axis more, that of the parameters. [same unit]
    confidence : float
        Of the interval. [-]

    Returns
    -------
    tuple of ndarray
        Index, low and high end. [-]
    """
    index, without = _divided(above, below)
    r = without.shape[0]
    if 0.5 * (1.0 - confidence) * 2.0**r < 1.0:
        reach = _student(confidence, r) * _spread(without)
        low, high = index - reach, index + reach
    else:
        pseudo = r * index - (r - 1) * without
        low, high = _typical(pseudo, confidence)
        # The mean of the pseudo-values differs slightly from the index.
        low, high = np.minimum(low, index), np.maximum(high, index)
    return np.clip(index, 0.0, 1.0), np.clip(low, 0.0, 1.0), np.clip(high, 0.0, 1.0)


def above_zero(above: Ratio, below: Ratio, confidence: float) -> NDArray[np.bool_]:
    """Test whether indices are above zero, by Student's one-sided limit.

    Heavy tails make this test conservative: errors of the first kind become rarer.

    Parameters
    ----------
    above, below
        As for `interval`.
    confidence : float
        Of the test of one index. [-]
    """
    index, without = _divided(above, below)
    # One-sided, because a true index is never negative.
    reach = _student(2.0 * confidence - 1.0, without.shape[0]) * _spread(without)
    return np.asarray(index - reach > 0.0)


def student_reach(values: Floats, confidence: float) -> Floats:
    """Compute the half-width of Student's interval for the mean of independent replicates.

    Parameters
    ----------
    values : ndarray, shape (R, ...)
        One value of each replicate.
    confidence : float
        Of the interval. [-]

    Returns
    -------
    ndarray, shape (...)
        Half-width. [unit of the values]
    """
    r = values.shape[0]
    return np.asarray(_student(confidence, r) * values.std(axis=0, ddof=1) / math.sqrt(r))


def _divided(above: Ratio, below: Ratio) -> tuple[Floats, Floats]:
    """Indices, and those with each replicate left out."""
    with np.errstate(invalid="ignore", divide="ignore"):
        # Two axes more in front: parameters for the denominators.
        under = below.without[:, None] if above.without.ndim > below.without.ndim else below.without
        return np.asarray(above.value / below.value), np.asarray(above.without / under)


def _student(confidence: float, replicates: int) -> float:
    from scipy import stats

    return float(stats.t.ppf(0.5 + 0.5 * confidence, replicates - 1))


def _spread(without: Floats) -> Floats:
    """Standard deviation of the index by the jackknife."""
    r = without.shape[0]
    return np.asarray(np.sqrt((r - 1) / r * np.sum((without - without.mean(axis=0)) ** 2, axis=0)))


def _typical(values: Floats, confidence: float) -> tuple[Floats, Floats]:
    """Ends of Hartigan's interval for the center of independent, symmetric values (R, ...).

    The rank is rarely a whole number; the ends are interpolated between two ranks.
    """
    weights = _subsets(values.shape[0])
    rank = 0.5 * (1.0 - confidence) * (len(weights) + 1)
    k, part = math.floor(rank), rank - math.floor(rank)
    ranks = [k - 1, k, len(weights) - 1 - k, len(weights) - k]
    flat = values.reshape(values.shape[0], -1)
    ends = np.empty((2, flat.shape[1]))
    step = 4096  # columns at a time, to limit the memory of the means
    for first in range(0, flat.shape[1], step):
        # Rows next to each other in memory are sorted in half the time of a partition.
        means = np.sort(np.ascontiguousarray((weights @ flat[:, first : first + step]).T), axis=1)[:, ranks].T
        ends[0, first : first + step] = (1.0 - part) * means[0] + part * means[1]
        ends[1, first : first + step] = (1.0 - part) * means[3] + part * means[2]
    shape = values.shape[1:]
    return ends[0].reshape(shape), ends[1].reshape(shape)


@lru_cache(maxsize=8)
def _subsets(count: int) -> Floats:
    """Weights (B, count) of the means of all subsets that are not empty, or of a random choice of them."""
    if 2**count <= _MAX_SUBSETS:
        numbers = np.arange(1, 2**count, dtype=np.int64)
        member = (numbers[:, None] >> np.arange(count)) & 1
    else:
        candidates = np.random.default_rng(count).integers(0, 2, (4 * _MAX_SUBSETS, count))
        candidates = np.unique(candidates[candidates.any(axis=1)], axis=0)
        order = np.random.default_rng(count).permutation(len(candidates))
        member = candidates[order[: _MAX_SUBSETS - 1]]
    return np.asarray(member / member.sum(axis=1, keepdims=True), dtype=np.float64)

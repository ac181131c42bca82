"""Shares with intervals from independent replicates, by leaving out one at a time.

What disturbs a share in one replicate are the interactions that happen to fall on somebody's lines there. In
most replicates that is little and in some it is much, so the deviations of the replicates are independent
and symmetric, but their tails are heavy (a kurtosis of 25 to 100 was measured). Student's interval then
holds the truth too often, because the one replicate that is far off widens it as much as it moves the mean.
Hartigan's interval asks for no shape: the means of all subsets of independent, symmetric values fall on
either side of the truth as a fair coin would have it, so that its ends are two of these means, of known rank.

References
----------
Hartigan J.A. (1969), J. Am. Stat. Assoc. 64, 1303 (using subsample values as typical values).
https://doi.org/10.1080/01621459.1969.10501057
Tukey's pseudo-values, and that the jackknife's variance errs on the safe side:
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

_SUBSETS: Final = 1024  # at most so many are looked at, the empty one counted


@dataclass(frozen=True, eq=False)
class Ratio:
    """One half of a share: its value from all replicates, and with each one left out.

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
        """Mean of what each replicate gives, shape (R, ...)."""
        r = values.shape[0]
        return Ratio(values.mean(axis=0), (values.sum(axis=0) - values) / (r - 1))

    def summed(self) -> Ratio:
        """The same summed over time, the last axis."""
        return Ratio(self.value.sum(axis=-1), self.without.sum(axis=-1))


def interval(above: Ratio, below: Ratio, confidence: float) -> tuple[Floats, Floats, Floats]:
    """Share with its interval; all within [0, 1].

    Hartigan's where there are replicates enough for the confidence (6 for 95 %), else Student's.

    Parameters
    ----------
    above, below : Ratio
        Numerator, with an axis of parameters more than the denominator. [same unit]
    confidence : float
        Of the interval. [-]

    Returns
    -------
    tuple of ndarray
        Share, low and high end. [-]
    """
    share, without = _divided(above, below)
    r = without.shape[0]
    if 0.5 * (1.0 - confidence) * 2.0**r < 1.0:
        reach = _student(confidence, r) * _spread(without)
        low, high = share - reach, share + reach
    else:
        pseudo = r * share - (r - 1) * without
        low, high = _typical(pseudo, confidence)
        # The mean of the pseudo-values is not quite the share.
        low, high = np.minimum(low, share), np.maximum(high, share)
    return np.clip(share, 0.0, 1.0), np.clip(low, 0.0, 1.0), np.clip(high, 0.0, 1.0)


def above_zero(above: Ratio, below: Ratio, confidence: float) -> NDArray[np.bool_]:
    """Whether shares are above zero: beyond Student's limit, which heavy tails only make safer.

    Parameters
    ----------
    above, below
        As for `interval`.
    confidence : float
        That it is no chance, of one share. [-]
    """
    share, without = _divided(above, below)
    # One-sided: a share below zero is chance alone.
    reach = _student(2.0 * confidence - 1.0, without.shape[0]) * _spread(without)
    return np.asarray(share - reach > 0.0)


def _divided(above: Ratio, below: Ratio) -> tuple[Floats, Floats]:
    """Shares, and those with each replicate left out."""
    with np.errstate(invalid="ignore", divide="ignore"):
        # Two axes more in front: parameters for the denominators.
        under = below.without[:, None] if above.without.ndim > below.without.ndim else below.without
        return np.asarray(above.value / below.value), np.asarray(above.without / under)


def _student(confidence: float, replicates: int) -> float:
    from scipy import stats

    return float(stats.t.ppf(0.5 + 0.5 * confidence, replicates - 1))


def _spread(without: Floats) -> Floats:
    """Standard deviation of the share by the jackknife."""
    r = without.shape[0]
    return np.asarray(np.sqrt((r - 1) / r * np.sum((without - without.mean(axis=0)) ** 2, axis=0)))


def _typical(values: Floats, confidence: float) -> tuple[Floats, Floats]:
    """Ends of Hartigan's interval for the centre of independent, symmetric values (R, ...).

    The rank is a whole number for few confidences; between two ranks the ends are interpolated.
    """
    weights = _subsets(values.shape[0])
    rank = 0.5 * (1.0 - confidence) * (len(weights) + 1)
    k, part = math.floor(rank), rank - math.floor(rank)
    ranks = [k - 1, k, len(weights) - 1 - k, len(weights) - k]
    flat = values.reshape(values.shape[0], -1)
    ends = np.empty((2, flat.shape[1]))
    step = 4096  # columns at a time, to keep the means small
    for first in range(0, flat.shape[1], step):
        means = np.partition(weights @ flat[:, first : first + step], ranks, axis=0)[ranks]
        ends[0, first : first + step] = (1.0 - part) * means[0] + part * means[1]
        ends[1, first : first + step] = (1.0 - part) * means[3] + part * means[2]
    shape = values.shape[1:]
    return ends[0].reshape(shape), ends[1].reshape(shape)


@lru_cache(maxsize=8)
def _subsets(count: int) -> Floats:
    """Weights (B, count) that give the means of subsets: all that are not empty, or random ones of them."""
    if 2**count <= _SUBSETS:
        numbers = np.arange(1, 2**count, dtype=np.int64)
        member = (numbers[:, None] >> np.arange(count)) & 1
    else:
        drawn = np.random.default_rng(count).integers(0, 2, (4 * _SUBSETS, count))
        drawn = np.unique(drawn[drawn.any(axis=1)], axis=0)
        order = np.random.default_rng(count).permutation(len(drawn))
        member = drawn[order[: _SUBSETS - 1]]
    return np.asarray(member / member.sum(axis=1, keepdims=True), dtype=np.float64)

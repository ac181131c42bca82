"""Shares with intervals from independent replicates, by leaving out one at a time.

References
----------
Efron B., Stein C. (1981), Ann. Stat. 9, 586 (the jackknife variance errs on the safe side).
https://doi.org/10.1214/aos/1176345462
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


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


def interval(above: Ratio, below: Ratio, quantile: float) -> tuple[Floats, Floats, Floats]:
    """Share with its interval, from the spread of the leave-one-out values; all within [0, 1].

    Parameters
    ----------
    above, below : Ratio
        Numerator, with an axis of parameters more than the denominator. [same unit]
    quantile : float
        Half-width of the interval in standard deviations. [-]

    Returns
    -------
    tuple of ndarray
        Share, low and high end. [-]
    """
    with np.errstate(invalid="ignore", divide="ignore"):
        share = above.value / below.value
        # Two axes more in front: parameters for the denominators.
        under = below.without[:, None] if above.without.ndim > below.without.ndim else below.without
        without = above.without / under
    r = without.shape[0]
    spread = np.sqrt((r - 1) / r * np.sum((without - without.mean(axis=0)) ** 2, axis=0))
    low, high = share - quantile * spread, share + quantile * spread
    return np.clip(share, 0.0, 1.0), np.clip(low, 0.0, 1.0), np.clip(high, 0.0, 1.0)

"""Bounded quantities as functions of numbers that are about normal, so that a sampler meets no walls.

Each quantity has the quantile of a beta distribution that the normal distribution has at its number. With the
mean and variance of a sample a beta distribution comes near to what a bounded quantity has after the data:
about normal far from its ends, falling from an end on it, uniform without data.

References
----------
Johnson N.L., Kotz S., Balakrishnan N. (1995), Continuous univariate distributions 2, chapter 25 (moments).
Parno M.D., Marzouk Y.M. (2018), Transport map accelerated Markov chain Monte Carlo, SIAM/ASA J. Uncertainty
Quantification 6, 645. https://doi.org/10.1137/17M1134640
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

#: Smallest distance of a share of a range from its ends. [-]
_NEAREST: Final = 1e-12
#: Exponents of a beta distribution: at least those of the uniform one, and not so large that it is a point.
_EXPONENTS: Final = (1.0, 1e6)
#: Largest normal number. [-]
_FARTHEST: Final = 7.0


@dataclass(frozen=True, eq=False)
class Marginals:
    """Distributions of q quantities, each by itself.

    Attributes
    ----------
    low, high : ndarray, shape (q,)
        Ends of each.
    first, last : ndarray, shape (q,)
        Exponents of the beta distributions at the low and at the high end. [-]
    """

    low: Floats
    high: Floats
    first: Floats
    last: Floats

    @classmethod
    def of_sample(cls, low: Floats, high: Floats, sample: Floats) -> Marginals:
        """Distributions with the means and variances of a sample (n, q).

        Examples
        --------
        >>> sample = np.random.default_rng(1).uniform(2.0, 4.0, (10000, 1))
        >>> marginals = Marginals.of_sample(np.full(1, 2.0), np.full(1, 4.0), sample)
        >>> bool(abs(marginals.first[0] - 1.0) < 0.05), marginals.values(np.zeros(1)).round(1)
        (True, array([3.]))
        """
        share = np.clip((sample - low) / (high - low), _NEAREST, 1.0 - _NEAREST)
        mean, variance = share.mean(axis=0), share.var(axis=0)
        size = mean * (1.0 - mean) / np.maximum(variance, np.finfo(np.float64).tiny) - 1.0
        return cls(low, high, np.clip(mean * size, *_EXPONENTS), np.clip((1.0 - mean) * size, *_EXPONENTS))

    def values(self, numbers: Floats) -> Floats:
        """Quantities of normal numbers (..., q)."""
        return np.asarray(self.low + (self.high - self.low) * self._share(numbers))

    def numbers(self, values: Floats) -> Floats:
        """Normal numbers of quantities (..., q)."""
        from scipy import special

        share = np.clip((values - self.low) / (self.high - self.low), _NEAREST, 1.0 - _NEAREST)
        below = special.betainc(self.first, self.last, share)
        above = special.betaincc(self.first, self.last, share)
        number = np.where(below < 0.5, special.ndtri(below), -special.ndtri(above))
        return np.asarray(np.clip(number, -_FARTHEST, _FARTHEST))

    def stretched(self, numbers: Floats) -> tuple[Floats, Floats, float, Floats]:
        """Quantities of normal numbers (q,), how they follow them, and what this does to a density.

        Returns
        -------
        ndarray, shape (q,)
            Quantities.
        ndarray, shape (q,)
            Their derivatives by the numbers.
        float
            Sum of the logarithms of the derivatives.
        ndarray, shape (q,)
            Derivative of this sum by the numbers.
        """
        from scipy import special

        share = self._share(numbers)
        log_density = (
            special.xlogy(self.first - 1.0, share)
            + special.xlog1py(self.last - 1.0, -share)
            - special.betaln(self.first, self.last)
        )
        log_change = -0.5 * numbers**2 - 0.5 * np.log(2.0 * np.pi) - log_density
        change = np.exp(np.minimum(log_change, 0.0))
        steep = (self.first - 1.0) / share - (self.last - 1.0) / (1.0 - share)
        width = self.high - self.low
        return (
            self.low + width * share,
            width * change,
            float(np.sum(log_change + np.log(width))),
            -numbers - steep * change,
        )

    def _share(self, numbers: Floats) -> Floats:
        """Shares of the ranges (..., q). [-]"""
        from scipy import special

        # From the nearer end, so that no small share is rounded.
        lower = numbers < 0.0
        first, last = np.where(lower, self.first, self.last), np.where(lower, self.last, self.first)
        distance = special.betaincinv(first, last, special.ndtr(-np.abs(numbers)))
        share = np.where(lower, distance, 1.0 - distance)
        return np.asarray(np.clip(share, _NEAREST, 1.0 - _NEAREST))

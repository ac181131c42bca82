"""Coefficients of a joint normal distribution that have ends: positions in ranges, and errors of sensors."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.base.uncertainty import AT_BOUND

Floats = NDArray[np.float64]

LARGEST_ERROR: Final = 2.0
"""Largest error of a sensor, in standard uncertainties: the expanded uncertainty is a limit of error. [-]

Makers state limits of error, within which any value may be and beyond which hardly any is (GUM 4.3.7). A
normal distribution without an end would let a model that is wrong move a sensor as far as it needs.
"""

#: With which the end of an error of a sensor is said to be contradicted. [-]
_CONFIDENCE: Final = 0.95


def ends_of(positions: int, sensors: int, size: int) -> tuple[Floats, Floats]:
    """Return the lowest and the highest value of each coefficient.

    Parameters
    ----------
    positions, sensors : int
        Number of positions, and of errors of sensors, in standard uncertainties, which follow them. [-]
    size : int
        Number of coefficients; the rest has no end. [-]

    Returns
    -------
    tuple of ndarray, shape (size,)

    Examples
    --------
    >>> ends_of(1, 1, 3)
    (array([  0.,  -2., -inf]), array([ 1.,  2., inf]))
    """
    low, high = np.full(size, -math.inf), np.full(size, math.inf)
    low[:positions], high[:positions] = 0.0, 1.0
    last = positions + sensors
    low[positions:last], high[positions:last] = -LARGEST_ERROR, LARGEST_ERROR
    return low, high


def within(precision: Floats, mean: Floats, low: Floats, high: Floats) -> tuple[Floats, float]:
    """Most probable coefficients within bounds, and the rise of minus twice the log density up to them.

    Examples
    --------
    >>> x, rise = within(np.eye(1), np.array([3.0]), np.zeros(1), np.array([2.0]))
    >>> round(float(x[0]), 6), round(rise, 6)
    (2.0, 1.0)
    """
    from scipy import optimize

    root = np.linalg.cholesky(precision).T
    solution = optimize.lsq_linear(root, root @ mean, bounds=(low, high), method="bvls")
    return np.asarray(solution.x), 2.0 * float(solution.cost)


def best_within(
    precision: Floats, mean: Floats, low: Floats, high: Floats, count: int
) -> tuple[Floats, Floats, Floats]:
    """Positions (P,) of the largest density within the bounds, `JointPosterior.beyond` and `unlimited`."""
    from scipy import stats

    ends = np.full(mean.size, -math.inf), np.full(mean.size, math.inf)
    ends[0][: low.size], ends[1][: high.size] = low, high
    x, deviance = within(precision, mean, *ends)
    z = np.asarray(np.clip(x[:count], 0.0, 1.0))
    limited = int(np.isfinite(high).sum())
    beyond, unlimited = np.zeros(count), np.zeros(limited - count)
    significant = float(stats.chi2.ppf(_CONFIDENCE, 1))
    for k in range(limited):
        room = AT_BOUND * (high[k] - low[k])
        if low[k] + room < x[k] < high[k] - room:
            continue
        free = ends[0].copy(), ends[1].copy()
        free[0][k], free[1][k] = -math.inf, math.inf
        better, lower = within(precision, mean, *free)
        if k < count:
            beyond[k] = deviance - lower
        elif deviance - lower > significant:
            unlimited[k - count] = better[k]
    return z, beyond, unlimited


def moments_within(mean: Floats, covariance: Floats, sample: Floats) -> tuple[Floats, Floats]:
    """Mean and covariance of all coefficients when the parameters have those of a sample within bounds."""
    count = sample.shape[1]
    middle, sample_covariance = sample.mean(axis=0), np.atleast_2d(np.cov(sample, rowvar=False))
    gain = np.linalg.solve(covariance[:count, :count], covariance[:count, count:]).T
    conditional_mean, conditional = mean.copy(), covariance.copy()
    conditional_mean[:count] = middle
    conditional_mean[count:] += gain @ (middle - mean[:count])
    change = sample_covariance - covariance[:count, :count]
    conditional[:count, :count] = sample_covariance
    conditional[count:, :count] = gain @ sample_covariance
    conditional[:count, count:] = conditional[count:, :count].T
    conditional[count:, count:] += gain @ change @ gain.T
    return conditional_mean, conditional

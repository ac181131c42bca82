"""Scatter of readings about a smooth course, estimated from a record itself.

What a sensor measures changes smoothly from reading to reading most of the time, its scatter does not. Third
differences of neighbouring readings take away any course that is a parabola over four readings; what is left
while nothing changes is scatter. Where the course is not smooth, its third differences follow each other
otherwise than those of scatter, which tells the two apart.

References
----------
von Neumann J., Kent R.H., Bellinson H.R., Hart B.I. (1941), The mean square successive difference, Annals of
Mathematical Statistics 12, 153. https://doi.org/10.1214/aoms/1177731746
Gasser T., Sroka L., Jennen-Steinmetz C. (1986), Residual variance and residual pattern in nonlinear
regression, Biometrika 73, 625 (differences of neighbours). https://doi.org/10.1093/biomet/73.3.625
JCGM 100:2008 (GUM), F.2.2.1 (resolution of an indication).
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]

#: Readings in a part of the record; the quieter half of the parts is used.
_PART: Final = 24
_FEWEST_PARTS: Final = 4
#: Autocovariance of third differences of independent readings of variance 1, at lags 0 and 1.
_SQUARE: Final = 20.0
_PRODUCT: Final = -15.0
#: Readings are equal to this part of their range.
_EQUAL: Final = 1e-9
#: Relative distance from a whole number that rounding may leave.
_ROUNDED: Final = 1e-4
#: Readings of at most this part of the largest count as those of something that is off.
_OFF: Final = 0.02
#: Least part of a record that is off.
_OFTEN: Final = 0.1


def scatter(readings: ArrayLike) -> float:
    """Estimate the standard deviation of repeated readings from a record of them.

    Parameters
    ----------
    readings : array_like, shape (n,)
        Regular in time; NaN where there is none. [unit]

    Returns
    -------
    float
        At least the resolution of the record over the root of 12; NaN if the record is too short. [unit]

    Examples
    --------
    A daily course of 10 K that is read every quarter of an hour with a scatter of 0.05 K:

    >>> hours = np.arange(0.0, 120.0, 0.25)
    >>> noise = 0.05 * np.random.default_rng(1).standard_normal(hours.size)
    >>> bool(0.045 < scatter(5.0 * np.sin(hours * np.pi / 12.0) + noise) < 0.055)
    True
    """
    x = np.asarray(readings, dtype=np.float64)
    third = np.diff(x, 3)
    usable = third[: third.size - third.size % _PART].reshape(-1, _PART)
    usable = usable[np.isfinite(usable).all(axis=1)]
    if len(usable) < _FEWEST_PARTS:
        return math.nan
    square, product = np.mean(usable**2, axis=1), np.mean(usable[:, 1:] * usable[:, :-1], axis=1)
    quiet = square <= np.median(square)
    # Parts without any change, such as a reading that is below the resolution, say the resolution only.
    variance = min(float(square[quiet].mean()) / _SQUARE, float(product[quiet].mean()) / _PRODUCT)
    return max(math.sqrt(max(variance, 0.0) / _share_of_quiet()), resolution(x) / math.sqrt(12.0))


def zero_reading(readings: ArrayLike) -> float:
    """Find what a meter of a power or a flow reads while what it measures is off.

    Parameters
    ----------
    readings : array_like, shape (n,)
        NaN where there is none; several days or more. [unit]

    Returns
    -------
    float
        Root mean square of the readings of at most 2 % of the largest; NaN if these are fewer than a tenth of
        the record, so that nothing is off for long. [unit]

    Examples
    --------
    >>> zero_reading([0.1, 0.1, 900.0, 1100.0, 0.1]), zero_reading([500.0, 900.0, 1100.0])
    (0.1, nan)
    """
    size = np.abs(np.asarray(readings, dtype=np.float64))
    size = size[np.isfinite(size)]
    off = size[size <= _OFF * size.max()] if size.size else size
    if off.size == 0 or off.size < _OFTEN * size.size or not size.any():
        return math.nan
    return float(math.sqrt(np.mean(off**2)))


def resolution(readings: ArrayLike) -> float:
    """Find the step in which readings are written, of which all their differences are multiples.

    Parameters
    ----------
    readings : array_like, shape (n,)
        NaN where there is none. [unit]

    Returns
    -------
    float
        0 if there is no such step. [unit]

    Examples
    --------
    >>> round(resolution([20.0, 20.1, 20.1, 20.4]), 6), resolution([20.0, 20.1, 20.1234])
    (0.1, 0.0)
    """
    x = np.asarray(readings, dtype=np.float64)
    ordered = np.unique(x[np.isfinite(x)])
    apart = np.diff(ordered)
    apart = apart[apart > _EQUAL * (float(np.ptp(ordered)) if ordered.size else 0.0)]
    if apart.size == 0:
        return 0.0
    steps = apart / apart.min()
    multiples = bool(np.all(np.abs(steps - np.round(steps)) < _ROUNDED * np.round(steps)))
    return float(apart.min()) if multiples else 0.0


def _share_of_quiet() -> float:
    """Mean square of the quieter half of parts of independent readings, over that of all parts. [-]

    The mean square of a part is nearly that of a chi-square distribution whose degrees of freedom are those
    of the correlated differences.
    """
    from scipy import stats

    correlation = np.array([-15.0, 6.0, -1.0]) / _SQUARE
    freedom = _PART / (1.0 + 2.0 * float(np.sum((1.0 - np.arange(1, 4) / _PART) * correlation**2)))
    middle = float(stats.chi2.median(freedom))
    return float(stats.chi2.cdf(middle, freedom + 2.0) / 0.5)

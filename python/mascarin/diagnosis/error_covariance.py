"""Covariance of the errors of a model over a long record, for tests of causes.

The parts are those of the calibration (`mascarin.calibration.errors.discrepancy`): an error that repeats
every day, one that changes from day to day, one that is correlated within the day, and white noise, each with
a covariance between sensors. Two things differ. The error of a day may last for days or weeks: a part of it
is a process whose correlation falls exponentially with time, so that a slow change is no step. And the sizes
are estimated from what remains beside the signatures that a fault of a single sensor would have over the
whole record, as in restricted maximum likelihood: an offset of one sensor does not make an error of the model
out of itself that then explains it.

References
----------
Patterson H.D., Thompson R. (1971), Biometrika 58, 545 (restricted maximum likelihood).
https://doi.org/10.1093/biomet/58.3.545
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration.errors.day_blocks import DayGaussian
from mascarin.calibration.errors.discrepancy import (
    DayData,
    Discrepancy,
    drift_kernel,
    estimate_discrepancy,
    root_of,
)

Floats = NDArray[np.float64]

#: Parts of the variance of a day that last, and their correlation times, which are compared. [-], [d]
_SHARES: Final = (0.5, 0.9)
_PERSISTENCE: Final = (3.0, 10.0, 30.0)
#: Largest number of columns of the process; longer records have one value for several days.
_MOST_COLUMNS: Final = 400
#: Standard deviation about which the weak prior of each part is, as a part of the stated uncertainty.
_PRIOR_SCALE: Final = 0.25


@dataclass(frozen=True, eq=False)
class ErrorCovariance:
    """Sizes of the errors of a model, and how long those of a day last.

    Attributes
    ----------
    sizes : Discrepancy
        Of all parts.
    share : float
        Part of the variance of the error of a day that lasts. [-]
    persistence : float
        Correlation time of that part. [d]
    freedom : float
        Degrees of freedom of the sizes: infinite where they are known. [-]

    Examples
    --------
    >>> one = np.eye(1)
    >>> sizes = Discrepancy(one, one, one, np.ones(1), np.ones(1), 4.0)
    >>> ErrorCovariance(sizes).freedom
    inf
    """

    sizes: Discrepancy
    share: float = 0.0
    persistence: float = 10.0
    freedom: float = math.inf

    def gaussian(self, data: DayData, days: Floats) -> DayGaussian:
        """Return the distribution of the residuals without a cause.

        Parameters
        ----------
        data : DayData
            Gives the effects of what is uncertain.
        days : ndarray, shape (D,)
            Number of each day. [-]
        """
        sizes, grid = self.sizes, data.grid
        kernel = drift_kernel(grid, sizes.correlation_hours)
        block = (
            np.kron(kernel, sizes.drift)
            + np.kron(np.ones_like(kernel), (1.0 - self.share) * sizes.day)
            + np.diag(np.tile(sizes.white, grid.slots))
        )
        shared = [data.effects, data.repeating(root_of(sizes.hour))]
        if self.share:
            shared.append(self._lasting(data, days))
        blocks = np.broadcast_to(block, (grid.days, *block.shape))
        return DayGaussian(blocks, np.concatenate(shared, axis=2), data.present)

    def _lasting(self, data: DayData, days: Floats) -> Floats:
        """Columns of the part that lasts, shape (D, H * S, groups * S). [unit]"""
        together = math.ceil(days.size * data.sensors / _MOST_COLUMNS)
        group = np.arange(days.size) // together
        middle = np.bincount(group, weights=days) / np.bincount(group)
        apart = np.abs(np.subtract.outer(middle, middle))
        root = root_of(np.exp(-apart / self.persistence))[group]
        rows = np.tile(root_of(self.share * self.sizes.day), (data.grid.slots, 1))
        columns = np.einsum("dj,ns->dnjs", root, rows)
        return np.asarray(columns.reshape(days.size, rows.shape[0], -1))

    def draw(self, data: DayData, days: Floats, rng: np.random.Generator) -> Floats:
        """Draw residuals of this distribution, shape (D, H * S). [unit]"""
        gaussian = self.gaussian(data, days)
        root = np.linalg.cholesky(gaussian.blocks[0])
        size = gaussian.present.shape
        shared = gaussian.columns @ rng.standard_normal(gaussian.columns.shape[2])
        residuals = rng.standard_normal(size) @ root.T + shared
        return np.where(gaussian.present, residuals, 0.0)


def estimate_error_covariance(
    data: DayData, days: Floats, broad: Floats, *, scale: Floats, limit: Floats
) -> ErrorCovariance:
    """Estimate the sizes of the errors beside signatures of faults.

    Parameters
    ----------
    data : DayData
        Residuals and the effects of what is uncertain.
    days : ndarray, shape (D,)
        Number of each day. [-]
    broad : ndarray, shape (D, H * S, k)
        Signatures of faults of single sensors over the whole record, for a size that is large. [unit]
    scale : ndarray, shape (S,)
        Stated standard uncertainty of each sensor. [unit]
    limit : ndarray, shape (S,)
        Largest standard deviation of each part. [unit]

    Returns
    -------
    ErrorCovariance
        Sizes and persistence of the largest density.
    """
    beside = replace(data, effects=np.concatenate([data.effects, broad], axis=2))
    sizes = estimate_discrepancy(beside, scale=_PRIOR_SCALE * scale, limit=limit)
    freedom = float(max(days.size - 1, 2))
    options = [ErrorCovariance(sizes, freedom=freedom)]
    if days.size > 2:
        options += [
            ErrorCovariance(sizes, share, length, freedom) for share in _SHARES for length in _PERSISTENCE
        ]
    densities = [covariance.gaussian(beside, days).log_density(data.error) for covariance in options]
    return options[int(np.argmax(densities))]

"""How far blocks of days differ in what they say of the coefficients, beside what independent days would.

Errors of a model depend on the weather, and weather lasts for some days: errors of days in a row are alike. A
posterior that takes them as independent is then too narrow, the more so the more days it has. Blocks that are
longer than the errors last are independent of each other. How much they differ shows by how much the
posterior is too narrow (the ratio of Birge, between blocks; blocks of dependent data: Künsch 1989).

References
----------
Birge R.T. (1932), Phys. Rev. 40, 207. https://doi.org/10.1103/PhysRev.40.207
Künsch H.R. (1989), Annals of Statistics 17, 1217. https://doi.org/10.1214/aos/1176347265
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from mascarin.calibration.errors.day_blocks import DayGaussian, Experiments

Floats = NDArray[np.float64]

#: Fewest blocks whose differences say something.
_FEWEST: Final = 3
#: Directions of the coefficients count of which a block says as much as their prior. [-]
_INFORMED: Final = 1.0


def block_dispersion(gaussian: Experiments, errors: Sequence[Floats], days: float) -> float:
    """Mean square of the differences between blocks of days, over what the distribution expects.

    Parameters
    ----------
    gaussian : Experiments
        Distribution of the values.
    errors : sequence of ndarray, shape (D, n)
        Values of each experiment. [unit]
    days : float
        Length of a block: the correlation time of the errors of days. [d]

    Returns
    -------
    float
        At least 1; 1 where there are fewer than three blocks. [-]

    Examples
    --------
    Four blocks of five days, whose common effect alternates between 2 and -2 where it should be the same:

    >>> from mascarin.calibration.errors.day_blocks import DayGaussian, Experiments
    >>> one = DayGaussian(np.ones((20, 1, 1)), np.ones((20, 1, 1)), np.ones((20, 1), dtype=bool))
    >>> values = np.repeat([2.0, -2.0, 2.0, -2.0], 5)[:, None]
    >>> round(block_dispersion(Experiments([one]), [values], 5.0), 1)  # 10^2 over 5 - 5^2/21
    26.2
    >>> block_dispersion(Experiments([one]), [values], 10.0)
    1.0
    """
    length = max(1, math.ceil(days - 1e-9))
    coefficients, covariance = gaussian.coefficients(errors), gaussian.covariance
    square, count, blocks = 0.0, 0, 0
    for part, values in zip(gaussian.parts, errors, strict=True):
        score, information = _of_days(part, values, coefficients)
        for block in np.array_split(np.arange(len(score)), max(1, len(score) // length)):
            mean = information[block].sum(axis=0)
            expected = mean - mean @ covariance @ mean
            variance, direction = np.linalg.eigh(0.5 * (expected + expected.T))
            informed = variance > _INFORMED
            along = direction.T[informed] @ score[block].sum(axis=0)
            square += float(np.sum(along**2 / variance[informed]))
            count, blocks = count + int(informed.sum()), blocks + 1
    return max(1.0, square / count) if count and blocks >= _FEWEST else 1.0


def _of_days(part: DayGaussian, values: Floats, coefficients: Floats) -> tuple[Floats, Floats]:
    """Derivative (D, q) of the log density of each day by the coefficients, and its precision (D, q, q)."""
    weighted, columns = part.weighted_columns, np.where(part.present[:, :, None], part.columns, 0.0)
    remaining = np.where(part.present, values - columns @ coefficients, 0.0)
    score = np.einsum("dnq,dn->dq", weighted, remaining)
    return score, np.swapaxes(columns, 1, 2) @ weighted

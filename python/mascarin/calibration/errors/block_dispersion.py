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

from mascarin.calibration.errors.day_blocks import summed

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
    >>> level = DayGaussian(np.ones((20, 1, 1)), np.ones((20, 1, 1)), np.ones((20, 1), dtype=bool))
    >>> values = np.repeat([2.0, -2.0, 2.0, -2.0], 5)[:, None]
    >>> round(block_dispersion(Experiments([level]), [values], 5.0), 1)  # 10^2 over 5 - 5^2/21
    26.2
    >>> block_dispersion(Experiments([level]), [values], 10.0)
    1.0
    """
    length = max(1, math.ceil(days - 1e-9))
    blocks = [np.array_split(np.arange(len(part)), max(1, len(part) // length)) for part in errors]
    if sum(map(len, blocks)) < _FEWEST:
        return 1.0
    coefficients, covariance = gaussian.coefficients(errors), gaussian.covariance
    square, count = 0.0, 0
    for part, values, blocks_of_part in zip(gaussian.parts, errors, blocks, strict=True):
        for block in blocks_of_part:
            score, information = _of_block(part, values, coefficients, block)
            expected = information - information @ covariance @ information
            variance, direction = np.linalg.eigh(0.5 * (expected + expected.T))
            informed = variance > _INFORMED
            along = direction.T[informed] @ score
            square += float(np.sum(along**2 / variance[informed]))
            count += int(informed.sum())
    return max(1.0, square / count) if count else 1.0


def _of_block(
    part: DayGaussian, values: Floats, coefficients: Floats, block: NDArray[np.int64]
) -> tuple[Floats, Floats]:
    """Derivative (q,) of the log density of some days by the coefficients, and its precision (q, q). [-]"""
    present = part.present[block]
    weighted, columns = part.weighted_columns[block], np.where(present[:, :, None], part.columns[block], 0.0)
    remaining = np.where(present, values[block] - columns @ coefficients, 0.0)
    score = np.einsum("dnq,dn->q", weighted, remaining)
    return score, summed(columns, weighted)

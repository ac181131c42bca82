"""How alike the errors of a day are to those of the identification, by the days between them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]


def nearness(hours: Floats, identification: Flags, persistence: float) -> Floats:
    """Correlation of the errors of days with those of the nearest day of the identification.

    Parameters
    ----------
    hours : ndarray, shape (n,)
        Local time of all instants, from any midnight. [h]
    identification : ndarray of bool, shape (n,)
        Which of them belong to the identification.
    persistence : float
        Correlation time of the errors of days. [d]

    Returns
    -------
    ndarray, shape (n,)
        [-]

    Examples
    --------
    >>> nearness(np.array([0.0, 24.0, 144.0]), np.array([True, False, False]), 5.0).round(2).tolist()
    [1.0, 0.82, 0.3]
    """
    days = np.floor(np.asarray(hours) / 24.0 + 1e-9)
    of_identification = np.unique(days[identification])
    if not of_identification.size or persistence <= 0.0:
        return np.where(identification, 1.0, 0.0)
    after = np.clip(np.searchsorted(of_identification, days), 1, of_identification.size) - 1
    before_and_after = np.stack(
        [of_identification[after], of_identification[np.minimum(after + 1, of_identification.size - 1)]]
    )
    lag = np.min(np.abs(days - before_and_after), axis=0)
    return np.asarray(np.exp(-lag / persistence))

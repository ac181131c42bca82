"""Values compared with limits: the one rule for comfort, criteria, objectives, validity and quality.

A room that is held at a limit has it to the last bits of its number only: by rounding, half of its hours
would lie outside. A value is beyond a limit where it is by more than 1e-6 of its unit.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, TypeVar

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

T = TypeVar("T")

TOLERANCE: Final = 1e-6
"""How far beyond a limit a value may be and still counts as held at it. [unit of the value]

A thousandth of the last digit that tables show, and far above rounding (2e-16 of the value in
each operation). Not for bounds that are tolerances themselves, such as those of the analytical verification.
"""


def above(values: T, limit: Any) -> Any:
    """Whether values are above a limit; a NaN is not.

    Parameters
    ----------
    values : float or ndarray
        The values, of any kind that can be compared. [unit]
    limit : float or ndarray
        The limit. [unit]

    Returns
    -------
    bool or ndarray of bool
        One for each value.

    Examples
    --------
    >>> above(26.000001, 26.0), above(26.000002, 26.0)
    (False, True)
    """
    return values > limit + TOLERANCE


def below(values: T, limit: Any) -> Any:
    """Whether values are below a limit; a NaN is not.

    Parameters
    ----------
    values : float or ndarray
        The values. [unit]
    limit : float or ndarray
        The limit. [unit]

    Returns
    -------
    bool or ndarray of bool
        One for each value.

    Examples
    --------
    >>> below(20.0 - 4e-15, 20.0), below(19.9, 20.0)
    (False, True)
    """
    return above(_mirrored(values), _mirrored(limit))


def at_most(values: T, limit: Any) -> Any:
    """Whether values are at most a limit; a NaN is not.

    Parameters
    ----------
    values : float or ndarray
        The values. [unit]
    limit : float or ndarray
        The limit. [unit]

    Returns
    -------
    bool or ndarray of bool
        One for each value.

    Examples
    --------
    >>> at_most(0.5 + 1e-16, 0.5), at_most(float("nan"), 0.5)
    (True, False)
    """
    return values <= limit + TOLERANCE


def at_least(values: T, limit: Any) -> Any:
    """Whether values are at least a limit; a NaN is not.

    Parameters
    ----------
    values : float or ndarray
        The values. [unit]
    limit : float or ndarray
        The limit. [unit]

    Returns
    -------
    bool or ndarray of bool
        One for each value.

    Examples
    --------
    >>> at_least(0.6 - 1e-16, 0.6), at_least(0.59, 0.6)
    (True, False)
    """
    return at_most(_mirrored(values), _mirrored(limit))


def _mirrored(values: Any) -> Any:
    """Values with the other sign: what is below a limit is above it there, to the last bit."""
    return -values


def excess(values: Any, limit: Any) -> npt.NDArray[np.float64]:
    """How far values are above a limit; 0 where they are not.

    Parameters
    ----------
    values : float or ndarray
        The values. [unit]
    limit : float or ndarray
        The limit. [unit]

    Returns
    -------
    ndarray
        The distance; NaN where a value is NaN. [unit]

    Examples
    --------
    >>> excess(np.array([25.0, 26.0 + 4e-15, 28.0]), 26.0)
    array([0., 0., 2.])
    """
    beyond = np.asarray(values - limit, dtype=np.float64)
    return np.where(beyond <= TOLERANCE, 0.0, beyond)


def shortfall(values: Any, limit: Any) -> npt.NDArray[np.float64]:
    """How far values are below a limit; 0 where they are not.

    Parameters
    ----------
    values : float or ndarray
        The values. [unit]
    limit : float or ndarray
        The limit. [unit]

    Returns
    -------
    ndarray
        The distance; NaN where a value is NaN. [unit]

    Examples
    --------
    >>> shortfall(np.array([19.0, 20.0 - 4e-15]), 20.0)
    array([1., 0.])
    """
    return excess(_mirrored(values), _mirrored(limit))

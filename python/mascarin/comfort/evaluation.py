"""Values of an index with the limits of comfort, and hours and degree-hours outside of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from mascarin._io.limits import excess, shortfall

Floats = npt.NDArray[np.float64]
Flags = npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Evaluation:
    """An index over time, with its limits of comfort.

    Attributes
    ----------
    values : ndarray, shape (..., times)
        The index; NaN where it is not valid. [unit of the index]
    low, high : ndarray or float
        Limits of comfort; infinite where there is none. [unit of the index]
    outside : mapping of str to ndarray of bool
        Reason -> where the index is not valid for it.
    too_humid : ndarray of bool, or None
        Where the air is too humid for comfort at any temperature.

    Examples
    --------
    >>> Evaluation(np.array([25.0, 29.0]), 20.0, 26.0).excess
    array([0., 3.])
    """

    values: Floats
    low: Floats | float
    high: Floats | float
    outside: Mapping[str, Flags] = field(default_factory=dict)
    too_humid: Flags | None = None

    @property
    def excess(self) -> Floats:
        """How far the index is above the upper limit (positive) or below the lower one (negative), or 0.

        By 1e-6 of the unit or less counts as 0.
        """
        above = excess(self.values, self.high)
        below = 0.0 - shortfall(self.values, self.low)
        # A value may be outside both limits where they cross: only the upper one counts then.
        return np.where(above > 0.0, above, below)


@dataclass(frozen=True, eq=False)
class Discomfort:
    """Time outside the limits of comfort. Arrays have the shape of the values without the axis of time.

    Attributes
    ----------
    hours : ndarray
        Time outside the limits. [h]
    hot_hours, cold_hours, humid_hours : ndarray
        Of it above the upper limit, below the lower one, and too humid; an hour may be both too hot and too
        humid. [h]
    degree_hours : ndarray
        Distance from the limits, summed over time. [K h; PMV h for the PMV]
    hot_degree_hours, cold_degree_hours : ndarray
        Of it above the upper limit and below the lower one. [K h; PMV h for the PMV]
    undefined_hours : ndarray
        Time in which the index is not valid: it is counted neither as comfort nor as discomfort. [h]
    assessed_hours : ndarray
        Occupied time, whether the index is valid or not. [h]
    reasons : mapping of str to ndarray
        Why it is not valid -> time; several reasons may hold at once. [h]

    Examples
    --------
    >>> found = discomfort(Evaluation(np.array([25.0, 29.0]), 20.0, 26.0), np.array([0.5, 0.5]))
    >>> float(found.hours), float(found.degree_hours)
    (0.5, 1.5)
    """

    hours: Floats
    hot_hours: Floats
    cold_hours: Floats
    humid_hours: Floats
    degree_hours: Floats
    hot_degree_hours: Floats
    cold_degree_hours: Floats
    undefined_hours: Floats
    assessed_hours: Floats
    reasons: Mapping[str, Floats]


def discomfort(evaluation: Evaluation, hours: npt.ArrayLike) -> Discomfort:
    """Hours and degree-hours outside the limits of comfort.

    Parameters
    ----------
    evaluation : Evaluation
        Values and limits of an index.
    hours : array_like, shape (times,)
        Time that each value stands for; 0 where the room is empty. [h]

    Returns
    -------
    Discomfort
        For each leading index of the values.

    Examples
    --------
    >>> nan = float("nan")
    >>> found = discomfort(Evaluation(np.array([[19.0, 20.0], [28.0, nan]]), 20.0, 26.0), [1.0, 2.0])
    >>> found.cold_hours, found.hot_degree_hours, found.undefined_hours
    (array([1., 0.]), array([0., 2.]), array([0., 2.]))
    """
    weights = np.asarray(hours, dtype=np.float64)
    valid = ~np.isnan(evaluation.values)
    beyond = np.where(valid, evaluation.excess, 0.0)
    humid = np.zeros_like(valid) if evaluation.too_humid is None else valid & evaluation.too_humid
    hot, cold = beyond > 0.0, beyond < 0.0
    hot_degrees = np.maximum(beyond, 0.0) @ weights
    cold_degrees = -np.minimum(beyond, 0.0) @ weights
    shape = evaluation.values.shape
    return Discomfort(
        hours=(hot | cold | humid) @ weights,
        hot_hours=hot @ weights,
        cold_hours=cold @ weights,
        humid_hours=humid @ weights,
        degree_hours=hot_degrees + cold_degrees,
        hot_degree_hours=hot_degrees,
        cold_degree_hours=cold_degrees,
        undefined_hours=~valid @ weights,
        assessed_hours=np.broadcast_to(weights.sum(), shape[:-1]).copy(),
        reasons={
            reason: np.asarray(np.broadcast_to(where, shape) @ weights)
            for reason, where in evaluation.outside.items()
        },
    )

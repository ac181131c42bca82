"""Water vapour in air: saturation pressure, humidity ratio, relative humidity and dew point, by the engine.

Relative humidity and dew point are those over water, also below 0 degC, as meteorology measures them. A
relative humidity that is read becomes the dew point of the weather, and comes back from the vapour of a room
unchanged.

References
----------
ASHRAE Handbook of Fundamentals 2017, ch. 1, eqs. 6 and 20; written in
``crates/engine/src/physics/psychrometrics.rs``.
WMO-No. 8, Guide to Instruments and Methods of Observation, vol. I, ch. 4 (over water below 0 degC).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
import numpy.typing as npt

from mascarin import _engine

Floats = npt.NDArray[np.float64]

STANDARD_PRESSURE: Final = 101325.0
"""Pressure at sea level [Pa]."""

_DRIEST: Final = 0.1
"""A lower relative humidity is read as this: it has no dew point of use [%]."""


def _each(function: Callable[..., Floats], *given: npt.ArrayLike) -> Floats:
    """A function of the engine for each element of arrays, broadcast against each other."""
    arrays = np.broadcast_arrays(*(np.asarray(one, dtype=np.float64) for one in given))
    flat = (np.ascontiguousarray(one).ravel() for one in arrays)
    return function(*flat).reshape(arrays[0].shape)


def saturation_pressure(temperature: npt.ArrayLike) -> Floats:
    """Pressure of saturated water vapour over water, also below 0 degC.

    Parameters
    ----------
    temperature : array_like
        Temperature. [degC]

    Returns
    -------
    ndarray
        Pressure, with the shape of the temperature. [Pa]

    Examples
    --------
    >>> saturation_pressure([-10.0, 25.0]).round(1).tolist()
    [286.6, 3169.2]
    """
    return _each(_engine.saturation_pressure, temperature)


def vapour_pressure(ratio: npt.ArrayLike, pressure: npt.ArrayLike = STANDARD_PRESSURE) -> Floats:
    """Pressure of the vapour in air with a humidity ratio.

    Parameters
    ----------
    ratio : array_like
        Humidity ratio. [kg/kg]
    pressure : array_like
        Pressure of the moist air. [Pa]

    Returns
    -------
    ndarray
        Pressure of the vapour. [Pa]

    Examples
    --------
    >>> float(vapour_pressure(0.01).round(1))
    1603.4
    """
    return _each(_engine.vapour_pressure, ratio, pressure)


def dew_point(temperature: npt.ArrayLike, relative_humidity: npt.ArrayLike) -> Floats:
    """Dew point over water of air with a relative humidity.

    Parameters
    ----------
    temperature : array_like
        Temperature of the air. [degC]
    relative_humidity : array_like
        Relative humidity, taken as at least 0.1. [%]

    Returns
    -------
    ndarray
        Dew point. [degC]

    Examples
    --------
    >>> dew_point([-10.0, 20.0], [100.0, 50.0]).round(2).tolist()
    [-10.0, 9.27]
    """
    share = np.maximum(np.asarray(relative_humidity, dtype=np.float64), _DRIEST) / 100.0
    return _each(_engine.dew_point, saturation_pressure(temperature) * share)


def humidity_ratio(
    temperature: npt.ArrayLike,
    relative_humidity: npt.ArrayLike,
    pressure: npt.ArrayLike = STANDARD_PRESSURE,
) -> Floats:
    """Mass of water vapour for each mass of dry air.

    Parameters
    ----------
    temperature : array_like
        Temperature of the air. [degC]
    relative_humidity : array_like
        Relative humidity. [%]
    pressure : array_like
        Pressure of the moist air. [Pa]

    Returns
    -------
    ndarray
        Humidity ratio. [kg/kg]

    Examples
    --------
    >>> float(humidity_ratio(26.0, 80.0).round(4))
    0.017
    """
    vapour = saturation_pressure(temperature) * np.asarray(relative_humidity, dtype=np.float64) / 100.0
    return _each(_engine.humidity_ratio, vapour, pressure)


def relative_humidity(
    temperature: npt.ArrayLike, ratio: npt.ArrayLike, pressure: npt.ArrayLike = STANDARD_PRESSURE
) -> Floats:
    """Relative humidity of air with a humidity ratio; above 100 where the air is supersaturated.

    Parameters
    ----------
    temperature : array_like
        Temperature of the air. [degC]
    ratio : array_like
        Humidity ratio. [kg/kg]
    pressure : array_like
        Pressure of the moist air. [Pa]

    Returns
    -------
    ndarray
        Relative humidity. [%]

    Examples
    --------
    >>> float(relative_humidity(26.0, humidity_ratio(30.0, 50.0)).round(1))
    63.1
    """
    return 100.0 * vapour_pressure(ratio, pressure) / saturation_pressure(temperature)


def humidity_of_dew_point(temperature: npt.ArrayLike, dew_point: npt.ArrayLike) -> Floats:
    """Relative humidity of air by its dew point, at most 100.

    Parameters
    ----------
    temperature : array_like
        Temperature of the air. [degC]
    dew_point : array_like
        Dew point. [degC]

    Returns
    -------
    ndarray
        Relative humidity. [%]

    Examples
    --------
    >>> float(humidity_of_dew_point(30.0, 30.0))
    100.0
    """
    return np.minimum(100.0 * saturation_pressure(dew_point) / saturation_pressure(temperature), 100.0)

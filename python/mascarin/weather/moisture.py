"""Water vapour in air: saturation pressure, humidity ratio and relative humidity.

The same form of the saturation pressure over water as for the dew point of a weather file, so that a relative
humidity that is read comes back unchanged.

References
----------
Alduchov & Eskridge 1996, Journal of Applied Meteorology 35(4), 601-609,
doi:10.1175/1520-0450(1996)035<0601:IMFAOS>2.0.CO;2 (within 0.4 % from -40 to 50 degC).
ASHRAE 2021, Handbook Fundamentals, chapter 1 (ratio of the molar masses, 0.621945).
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from mascarin.weather.derive import MAGNUS_B, MAGNUS_C

Floats = npt.NDArray[np.float64]

STANDARD_PRESSURE: Final = 101325.0
"""Pressure at sea level [Pa]."""

_AT_ZERO: Final = 610.94  # Pa
_RATIO: Final = 0.621945  # kg/kg


def saturation_pressure(temperature: npt.ArrayLike) -> Floats:
    """Pressure of saturated water vapour over water.

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
    >>> float(saturation_pressure(25.0).round(0))
    3162.0
    """
    t = np.asarray(temperature, dtype=np.float64)
    return np.asarray(_AT_ZERO * np.exp(MAGNUS_B * t / (MAGNUS_C + t)), dtype=np.float64)


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
    0.0169
    """
    vapour = saturation_pressure(temperature) * np.asarray(relative_humidity, dtype=np.float64) / 100.0
    return np.asarray(_RATIO * vapour / (np.asarray(pressure, dtype=np.float64) - vapour), dtype=np.float64)


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
    w = np.asarray(ratio, dtype=np.float64)
    vapour = w * np.asarray(pressure, dtype=np.float64) / (_RATIO + w)
    return np.asarray(100.0 * vapour / saturation_pressure(temperature), dtype=np.float64)


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

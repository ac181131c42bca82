"""Air of the zones: the same numbers as in the engine.

References
----------
ICAO Doc 7488, Manual of the ICAO Standard Atmosphere (pressure at an altitude).
ASHRAE Handbook of Fundamentals, ch. 1 (specific heat and gas constant of dry air).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mascarin import _engine
from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.building.site import Site

#: Specific heat of dry air [J/(kg K)].
SPECIFIC_HEAT = 1006.0
_GAS_CONSTANT = 287.055  # dry air [J/(kg K)]
_VAPOUR = 1860.0  # specific heat of water vapour [J/(kg K)]
_SEA_LEVEL = 101_325.0  # pressure of the standard atmosphere [Pa]
_STANDARD = 288.15  # 15 degC [K]


def heat_capacity(site: Site) -> float:
    """Heat capacity of a cubic metre of the air in the zones.

    Parameters
    ----------
    site : Site
        The site.

    Returns
    -------
    float
        Density times specific heat, which is that of dry air where none is given. [J/(m3 K)]
    """
    heat = SPECIFIC_HEAT if site.air_specific_heat is None else float(site.air_specific_heat)
    return density(site) * heat


def moist_air(temperature: float, humidity: float, pressure: float) -> tuple[float, float]:
    """Density and specific heat of moist air, for `site.air_density` and `site.air_specific_heat`.

    A mixture of ideal gases; the specific heat is that of a kilogram of the mixture. Relative humidity is
    that over water, also below 0 degC.

    Parameters
    ----------
    temperature : float
        Temperature. [degC]
    humidity : float
        Relative humidity, 0 to 1. [-]
    pressure : float
        Pressure. [Pa]

    Returns
    -------
    tuple of float
        Density [kg/m3] and specific heat [J/(kg K)].

    Raises
    ------
    InputError
        A humidity outside 0 to 1, a temperature outside -45 to 60 degC, a pressure that is not above that of
        the vapour.

    References
    ----------
    ASHRAE Handbook of Fundamentals 2017, ch. 1 (mixture, specific heat of water vapour, eqs. 6 and 20).

    Examples
    --------
    >>> density, heat = moist_air(20, 0.5, 101325)
    >>> round(density, 3), round(heat)
    (1.199, 1012)
    """
    if not -45.0 <= temperature <= 60.0:
        raise InputError(f"temperature: found {temperature:g} degC; expected -45 to 60 degC")
    if not 0.0 <= humidity <= 1.0:
        raise InputError(f"humidity: found {humidity:g}; expected a relative humidity from 0 to 1")
    vapour = humidity * float(_engine.saturation_pressure(np.array([temperature], dtype=np.float64))[0])
    if pressure <= vapour:
        raise InputError(f"pressure: found {pressure:g} Pa; expected a pressure of moist air [Pa]")
    pressures = np.array([[vapour], [pressure]], dtype=np.float64)
    ratio = float(_engine.humidity_ratio(*pressures)[0])
    kelvin = temperature + 273.15
    mass = (pressure - vapour) / (_GAS_CONSTANT * kelvin) * (1.0 + ratio)
    return mass, (SPECIFIC_HEAT + ratio * _VAPOUR) / (1.0 + ratio)


def density(site: Site) -> float:
    """Density of the air in the zones and of the air that enters them.

    Parameters
    ----------
    site : Site
        The site.

    Returns
    -------
    float
        As given, else at 15 degC and the pressure of the standard atmosphere at the altitude. [kg/m3]
    """
    if site.air_density is not None:
        return float(site.air_density)
    pressure = _SEA_LEVEL * (1.0 - 2.25577e-5 * float(site.altitude)) ** 5.25588
    return float(pressure / (_GAS_CONSTANT * _STANDARD))

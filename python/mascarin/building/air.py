"""Air of the zones: the same numbers as in the engine.

References
----------
ICAO Doc 7488, Manual of the ICAO Standard Atmosphere (pressure at an altitude).
ASHRAE Handbook of Fundamentals, ch. 1 (specific heat and gas constant of dry air).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mascarin.building.site import Site

#: Specific heat of dry air [J/(kg K)].
SPECIFIC_HEAT = 1006.0
_GAS_CONSTANT = 287.055  # dry air [J/(kg K)]
_SEA_LEVEL = 101_325.0  # pressure of the standard atmosphere [Pa]
_STANDARD = 288.15  # 15 degC [K]


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

"""Air of the zones of a site: the same numbers as in the engine."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mascarin.physics import AIR_SPECIFIC_HEAT, standard_density

if TYPE_CHECKING:
    from mascarin.building.parts.site import Site


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
    heat = AIR_SPECIFIC_HEAT if site.air_specific_heat is None else float(site.air_specific_heat)
    return density(site) * heat


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
    return standard_density(float(site.altitude))

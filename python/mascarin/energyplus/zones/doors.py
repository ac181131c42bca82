"""Doors of cold rooms, through which a difference of densities drives air both ways."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Final

from mascarin.energyplus.model.context import Context
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject
from mascarin.energyplus.model.schedules import fraction, year
from mascarin.energyplus.zones.zones import Zone
from mascarin.physics import KELVIN

COLD_DOORS: Final = "ZoneRefrigerationDoorMixing"
#: Of the flow through a doorway over ``A sqrt(g H (1 - rho_warm/rho_cold))`` (Gosney and Olama 1975) [-].
_FULL_FLOW: Final = 0.221
#: Doorway flow factor up to a difference of temperatures and above it [-], and that difference [K].
_FLOW_FACTORS: Final = (1.1, 0.8)
_LARGE_DIFFERENCE: Final = 11.0
#: Share of the flow that each protection leaves [-].
_OPEN_SHARE: Final[Mapping[str, float]] = {"none": 1.0, "aircurtain": 0.5, "stripcurtain": 0.1}
#: Of the density of the site (ISO 2533) [K].
_SITE_TEMPERATURE: Final = 288.15


def discharge(cold: float, warm: float, share: float = 1.0) -> float:
    """Discharge coefficient of a door with the flow of EnergyPlus at two temperatures. [-]

    EnergyPlus Engineering Reference, density difference controlled air exchange (Gosney and Olama 1975;
    ASHRAE Refrigeration Handbook 2006, ch. 13): ``0.221 A rho_c F_d F_f sqrt(g H (1 - rho_w/rho_c))`` with
    ``F_d = (2/(1 + (rho_c/rho_w)^(1/3)))^1.5``. A door of a description has
    ``C_d/3 A rho_site sqrt(g H dT/T)``.

    Parameters
    ----------
    cold, warm : float
        Air temperatures of both zones. [degC]
    share : float
        Share of the flow that curtains leave. [-]

    Examples
    --------
    >>> round(discharge(20.0, 20.0), 3)
    0.717
    >>> round(discharge(2.0, 20.0) / discharge(2.0, 20.0, 0.5), 3)
    2.0
    """
    low, high = cold + KELVIN, warm + KELVIN
    density_factor = math.pow(2.0 / (1.0 + math.cbrt(high / low)), 1.5)
    flow_factor = _FLOW_FACTORS[warm - cold > _LARGE_DIFFERENCE]
    density = _SITE_TEMPERATURE / low
    # 1 - rho_w/rho_c is dT/T of the warm zone; the door has the mean of both.
    difference = math.sqrt(0.5 * (low + high) / high)
    return 3.0 * _FULL_FLOW * flow_factor * share * density_factor * density * difference


@reads(COLD_DOORS)
def describe_doors(context: Context, zones: dict[str, Zone], air: Mapping[str, float]) -> None:
    """Enter doors between zones.

    Parameters
    ----------
    context : Context
        The conversion.
    zones : dict of str to Zone
        Zones by the name in the file, in small letters.
    air : mapping of str to float
        Usual temperature of each. [degC]

    Raises
    ------
    InputError
        A zone or a schedule that does not exist.
    """
    for item in context.model.of(COLD_DOORS):
        keys = [_side(context, item, number) for number in (1, 2)]
        area, height = (item.number(f"door_{what}") for what in ("area", "height"))
        area, height = 9.0 if area is None else area, 3.0 if height is None else height
        schedule, most = fraction(context, f"{item.name} open", year(context, item, "schedule_name"))
        if not all(key in zones for key in keys) or area * height * most <= 0.0:
            context.findings.no_effect([item], "a door that is never open", "no air passes")
            continue
        cold, warm = sorted(air[key] for key in keys)
        share = _OPEN_SHARE[item.word("door_protection_type") or "none"]
        door = {
            "width": round(area / height, 9),
            "height": height,
            "discharge": round(discharge(cold, warm, share), 6),
            "open": most,
        }
        path: dict[str, Any] = {"between": [zones[key].name for key in keys], "door": door}
        path |= {} if schedule is None else {"schedule": schedule}
        context.section("air_paths")[context.names.of("air_paths", item.name, item.kind)] = path
        factor = _FLOW_FACTORS[warm - cold > _LARGE_DIFFERENCE]
        context.findings.approximated(
            item,
            "a flow that EnergyPlus changes at a difference of 11 K",
            f"the factor {factor:g} at all times, that of {warm - cold:.1f} K between usual temperatures: "
            f"{'less' if factor < 1.0 else 'more'} air by a third on the other side of 11 K",
        )


def _side(context: Context, item: IdfObject, number: int) -> str:
    """Name of a zone that the door joins, in small letters."""
    keys = (f"zone_or_space_name_{number}", f"zone_{number}_name")
    (zone,) = context.zones_of(item, *keys)[:1]
    return zone.name.casefold()

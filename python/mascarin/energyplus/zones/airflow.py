"""Infiltration, ventilation, and air between zones."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Final

from mascarin.energyplus.envelope.idf_surfaces import IdfOpening, IdfSurface
from mascarin.energyplus.model.context import Context
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject
from mascarin.energyplus.model.schedules import fraction, year
from mascarin.energyplus.zones.doors import COLD_DOORS, describe_doors
from mascarin.energyplus.zones.draughts import Draught, conditioned, density_of, enter_draughts
from mascarin.energyplus.zones.mixing import describe_mixing, design_flow, zones_of
from mascarin.energyplus.zones.network import describe_network
from mascarin.energyplus.zones.zones import Zone
from mascarin.physics import GRAVITY

SIMPLE: Final = (
    "ZoneInfiltration:DesignFlowRate", "ZoneInfiltration:EffectiveLeakageArea",
    "ZoneInfiltration:FlowCoefficient",
    "ZoneVentilation:DesignFlowRate", "ZoneVentilation:WindandStackOpenArea", "ZoneMixing", "ZoneCrossMixing",
    COLD_DOORS,
)  # fmt: skip
#: Effectiveness of an opening for the wind where EnergyPlus finds it by direction: the middle of 0.3 and
#: 0.55 (ASHRAE Handbook of Fundamentals 2017, ch. 16) [-].
_EFFECTIVENESS: Final = 0.425
_ROOM = 293.15
_DISCHARGE, _CW = 0.65, 0.3


@reads(*SIMPLE)
def describe_air(
    context: Context,
    zones: dict[str, Zone],
    surfaces: list[IdfSurface],
    openings: list[IdfOpening],
    air: Mapping[str, float],
) -> None:
    """Enter infiltration, ventilation, mixing and doors of cold rooms.

    Parameters
    ----------
    context : Context
        The conversion.
    zones : dict of str to Zone
        Zones by the name in the file, in small letters.
    surfaces : list of IdfSurface
        Walls, floors and roofs.
    openings : list of IdfOpening
        Windows and doors.
    air : mapping of str to float
        Usual temperature of each zone. [degC]

    Raises
    ------
    InputError
        A zone or schedule that does not exist.
    """
    if _network(context):
        describe_network(context, zones, surfaces, openings)
        return
    draughts: dict[str, list[Draught]] = {key: [] for key in zones}
    for kind, of_object in _DRAUGHTS.items():
        for item in context.model.of(kind):
            for zone in zones_of(context, item, zones):
                draughts[zone.item.name.casefold()] += of_object(context, item, zone, zones)
    for key, zone_draughts in draughts.items():
        enter_draughts(context, zones[key], zone_draughts)
    describe_mixing(context, zones)
    describe_doors(context, zones, air)


@reads("AirflowNetwork:SimulationControl", *SIMPLE)
def _network(context: Context) -> bool:
    """Whether an air flow network replaces infiltration, ventilation and mixing."""
    item = context.model.one("AirflowNetwork:SimulationControl")
    if item is None:
        return False
    control = item.word("airflownetwork_control")
    if control in ("nomultizoneordistribution", ""):
        return False
    if control.startswith("multizonewithdistribution"):
        context.findings.left_out(
            item, "ducts in the network", "rooms, cracks and windows alone: no flow by fans and ducts"
        )
    replaced = context.model.of(*SIMPLE)
    context.findings.no_effect(replaced, "simple air flow", "EnergyPlus replaces it by the air flow network")
    return True


def _design(context: Context, item: IdfObject, zone: Zone, zones: dict[str, Zone]) -> list[Draught]:
    """A design flow with its terms by temperature and wind."""
    keys = ("constant", "temperature", "velocity", "velocity_squared")
    a, b, c, d = (item.number(f"{key}_term_coefficient") or 0.0 for key in keys)
    flow = design_flow(context, item, zone, zones)
    terms = (a, b, c * zone.wind, d * zone.wind**2)
    values = year(context, item, "schedule_name")
    return [Draught(item, flow, terms, values, density=density_of(context, item))]


def _ventilation(context: Context, item: IdfObject, zone: Zone, zones: dict[str, Zone]) -> list[Draught]:
    draughts = [
        part
        for draught in _design(context, item, zone, zones)
        for part in conditioned(context, zone, draught)
    ]
    for draught in draughts:
        _fan(context, zone, draught)
    return draughts


def _fan(context: Context, zone: Zone, air: Draught) -> None:
    """Heat of the fan of supplied air."""
    item = air.item
    if item.word("ventilation_type") not in ("intake", "balanced"):
        return
    rise, efficiency = item.number("fan_pressure_rise") or 0.0, item.number("fan_total_efficiency") or 1.0
    if rise <= 0.0:
        return
    if air.driven or air.control is not None:
        context.findings.approximated(
            item, "heat of the fan", "that of the constant part of the flow, on every condition"
        )
    schedule, most = fraction(context, f"{item.name} flow", air.values)
    power = air.flow * air.terms[0] * most * rise / efficiency
    if power > 0.0:
        gains = context.section("zones")[zone.name].setdefault("gains", {})
        key = context.names.of(f"gains of {zone.name}", f"{item.name} fan")
        gains[key] = {"power": round(power, 6)} | ({} if schedule is None else {"schedule": schedule})


def _open_area(context: Context, item: IdfObject, zone: Zone, _: dict[str, Zone]) -> list[Draught]:
    """``A sqrt((C_w V)^2 + C_d^2 2 g h |dT|/T)``."""
    area = item.needed("opening_area")
    values = year(context, item, "opening_area_fraction_schedule_name")
    effectiveness = item.number("opening_effectiveness")
    if effectiveness is None and area > 0.0:
        context.findings.approximated(
            item, "an effectiveness by wind direction", f"{_EFFECTIVENESS:g} for all directions"
        )
    effective = (_EFFECTIVENESS if effectiveness is None else effectiveness) * zone.wind
    discharge = item.number("discharge_coefficient_for_opening")
    height = item.number("height_difference") or 0.0
    # EnergyPlus Engineering Reference, ventilation by wind and stack with open area.
    through = f"({discharge:.9g})" if discharge is not None else "(0.4 + 0.0045*abs(dT))"
    law = f"sqrt(({effective:.9g}*V)^2 + {2.0 * GRAVITY * height:.9g}*{through}^2*abs(dT)/(Ti + 273.15))"
    opening = {
        "area": area,
        "height": height,
        "discharge": _DISCHARGE if discharge is None else discharge,
        "wind_coefficient": round(min(effective, 1.0), 6),
    }
    draught = Draught(item, area, (0.0,) * 4, values, law=law, opening=opening)
    return list(conditioned(context, zone, draught))


def _leakage(context: Context, item: IdfObject, _: Zone, __: dict[str, Zone]) -> list[Draught]:
    """``A sqrt(C_s |dT| + C_w V^2)``, with the wind of the weather station."""
    flow = item.needed("effective_air_leakage_area") * 1e-3
    stack, wind = item.needed("stack_coefficient"), item.needed("wind_coefficient")
    free = flow * math.sqrt(wind) / _CW
    height = stack * flow**2 * _ROOM / (free**2 * _DISCHARGE**2 * 2.0 * GRAVITY) if free > 0.0 else 0.0
    opening = {"area": free, "height": height, "discharge": _DISCHARGE, "wind_coefficient": _CW}
    law = f"sqrt({stack:.9g}*abs(dT) + {wind:.9g}*V^2)"
    values = year(context, item, "schedule_name")
    return [Draught(item, flow, (0.0,) * 4, values, law=law, opening=opening)]


def _flow_coefficient(context: Context, item: IdfObject, zone: Zone, _: dict[str, Zone]) -> list[Draught]:
    """``c sqrt((C_s |dT|^n)^2 + (C_w (s V)^(2 n))^2)`` (AIM-2), with the wind at the zone."""
    stack, wind = item.needed("stack_coefficient"), item.needed("wind_coefficient")
    exponent = item.number("pressure_exponent") or 0.67
    shelter = item.needed("shelter_factor") * zone.wind
    law = (
        f"sqrt(({stack:.9g}*abs(dT)^{exponent:.9g})^2 + "
        f"({wind:.9g}*({shelter:.9g}*V)^{2.0 * exponent:.9g})^2)"
    )
    values = year(context, item, "schedule_name")
    return [Draught(item, item.needed("flow_coefficient"), (0.0,) * 4, values, law=law)]


#: What is read of each class.
_DRAUGHTS: Final[dict[str, Callable[[Context, IdfObject, Zone, dict[str, Zone]], list[Draught]]]] = {
    "ZoneInfiltration:DesignFlowRate": _design,
    "ZoneInfiltration:EffectiveLeakageArea": _leakage,
    "ZoneInfiltration:FlowCoefficient": _flow_coefficient,
    "ZoneVentilation:DesignFlowRate": _ventilation,
    "ZoneVentilation:WindandStackOpenArea": _open_area,
}

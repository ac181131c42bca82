"""Thermostats and ideal loads."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, Final

from mascarin.energyplus.model.context import Context
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject
from mascarin.energyplus.model.schedules import NEVER_COOLS, NEVER_HEATS, temperature, year
from mascarin.energyplus.model.year import Year, combined, constant
from mascarin.energyplus.zones.draughts import Draught, density_of, enter_beside, limited, ventilate
from mascarin.energyplus.zones.equipment import Plant, replaced
from mascarin.energyplus.zones.gains import people_in
from mascarin.energyplus.zones.radiant import PANELS, Envelope, describe_mats, panel_loads
from mascarin.energyplus.zones.zones import Zone
from mascarin.physics import AIR_SPECIFIC_HEAT

#: Control types: 1 heating, 2 cooling, 3 one set point for both, 4 two set points.
_TYPES: Final = {
    "thermostatsetpoint:singleheating": 1,
    "thermostatsetpoint:singlecooling": 2,
    "thermostatsetpoint:singleheatingorcooling": 3,
    "thermostatsetpoint:dualsetpoint": 4,
}
_SETPOINTS: Final = (
    "ThermostatSetpoint:SingleHeating", "ThermostatSetpoint:SingleCooling",
    "ThermostatSetpoint:SingleHeatingOrCooling", "ThermostatSetpoint:DualSetpoint",
)  # fmt: skip
_HEAT: Final = ("heating_setpoint_temperature_schedule_name", "setpoint_temperature_schedule_name")
_COOL: Final = ("cooling_setpoint_temperature_schedule_name", "setpoint_temperature_schedule_name")
IDEAL: Final = "ZoneHVAC:IdealLoadsAirSystem"
_TEMPLATE: Final = "HVACTemplate:Zone:IdealLoadsAirSystem"
#: Specific heat of dry air, for limits of flow [J/(kg K)].
_AIR_HEAT: Final = AIR_SPECIFIC_HEAT
_AIR_DENSITY: Final = 1.2
#: Temperatures of the zone at which a limit of flow is a limit of power [degC].
#: Air temperature of a zone that its set points allow [degC].
_USUAL: Final = 23.0
#: So far above a heating set point, a zone needs no heat in a step without recovery either: air of 2 changes
#: per hour, 15 K colder, takes 1 to 2 K from the air of a room within a step [K].
_ABOVE_SET_POINT: Final = 1.0
#: Below a cooling set point, the range of an economizer, and one that is too narrow for it. [K]
_BAND: Final = 0.2
_LEAST_BAND: Final = 0.05
#: Difference to outdoors from which an economizer has all of its flow. [K]
_STARTS: Final = 0.1
#: Air changes of an economizer without limit. [1/h]
_MOST_CHANGES: Final = 100.0
_ROOM: Final = {"heating": 20.0, "cooling": 24.0}


@dataclass(frozen=True)
class SetPoints:
    """Set points of a zone over the year; those that never act where it is not conditioned. [degC]

    Attributes
    ----------
    heating, cooling : Year
        The set points.
    """

    heating: Year
    cooling: Year


def describe_conditioning(context: Context, zones: dict[str, Zone], envelope: Envelope) -> None:
    """Enter ideal heating and cooling, and mats in surfaces.

    Parameters
    ----------
    context : Context
        The conversion.
    zones : dict of str to Zone
        Zones by the name in the file, in small letters.
    envelope : Envelope
        What mats lie in.

    Raises
    ------
    InputError
        A thermostat, schedule or system that does not exist.
    """
    set_points = dict(_thermostats(context, zones))
    systems = _systems(context)
    mats = describe_mats(context, zones, systems, envelope)
    for key, zone in zones.items():
        zone_systems = [system for system in systems.get(key, []) if system.name not in mats]
        ideal = [system for system in zone_systems if system.kind == IDEAL]
        points, zone_systems = set_points.get(key), ideal[:1] or zone_systems
        if zone_systems and all(system.kind in PANELS for system in zone_systems):
            # A panel has set points of its own, and needs no thermostat.
            _warm_surfaces(context, zone, panel_loads(context, zone_systems[0], envelope) or {})
        elif points is None and zone_systems and zone_systems[0].kind in (IDEAL, _TEMPLATE):
            context.findings.no_effect(zone_systems, "a system without a thermostat", "it conditions nothing")
        elif points is not None and zone_systems and zone_systems[0].kind in (IDEAL, _TEMPLATE):
            _condition(context, zone, points, zone_systems[0], zones)
        elif points is not None:
            plants = replaced(context, zone, zone_systems)
            if not plants:
                context.findings.no_effect(
                    [zone.item], "a thermostat without a system that heats or cools", "it conditions nothing"
                )
            else:
                _hold(context, zone, points, plants)


def _warm_surfaces(context: Context, zone: Zone, loads: dict[str, tuple[Year, Plant]]) -> None:
    """Loads of water in surfaces."""
    never = {"heating": constant(NEVER_HEATS), "cooling": constant(NEVER_COOLS)}
    points = {which: loads[which][0] if which in loads else idle for which, idle in never.items()}
    _hold(context, zone, SetPoints(**points), {which: plant for which, (_, plant) in loads.items()})


def usual_temperatures(context: Context, zones: dict[str, Zone]) -> dict[str, float]:
    """Temperature of each zone between its set points; a usual one without any. [degC]

    Parameters
    ----------
    context : Context
        The conversion.
    zones : dict of str to Zone
        Zones by the name in the file, in small letters.
    """
    temperatures = dict.fromkeys(zones, _USUAL)
    for key, points in _thermostats(context, zones):
        limits = (
            (points.heating, _USUAL, max),
            (points.cooling, _USUAL, min),
        )
        means = [
            combined(lambda set_point, rule=rule: rule(set_point, _USUAL), set_point_values).mean()
            for set_point_values, _, rule in limits
        ]
        if key in temperatures:
            temperatures[key] = sum(means) - _USUAL
    return temperatures


@reads("ZoneControl:Thermostat", _TEMPLATE, "HVACTemplate:Thermostat")
def _thermostats(context: Context, zones: dict[str, Zone]) -> Iterator[tuple[str, SetPoints]]:
    for item in context.model.of("ZoneControl:Thermostat"):
        points = _set_points(context, item)
        if item.number("temperature_difference_between_cutout_and_setpoint"):
            context.findings.approximated(item, "a cut-out difference", "the set point is held exactly")
        for zone in context.zones_of(item, "zone_or_zonelist_name", "zone_name"):
            yield zone.name.casefold(), points
    for item in context.model.of(_TEMPLATE):
        thermostat = context.model.named(item.text("template_thermostat_name"), "HVACTemplate:Thermostat")
        if thermostat is None:
            continue
        heat = thermostat.number("constant_heating_setpoint")
        cool = thermostat.number("constant_cooling_setpoint")
        set_points = SetPoints(
            year(
                context,
                thermostat,
                "heating_setpoint_schedule_name",
                default=NEVER_HEATS if heat is None else heat,
            ),
            year(
                context,
                thermostat,
                "cooling_setpoint_schedule_name",
                default=NEVER_COOLS if cool is None else cool,
            ),
        )
        for zone in context.zones_of(item, "zone_name"):
            yield zone.name.casefold(), set_points


@reads(*_SETPOINTS)
def _set_points(context: Context, item: IdfObject) -> SetPoints:
    """Set points of the control that is active at each time."""
    kinds: dict[int, IdfObject] = {}
    for k in range(1, 5):
        kind = item.word(f"control_{k}_object_type")
        if kind and kind in _TYPES:
            kinds[_TYPES[kind]] = context.model.require(item, f"control_{k}_name", *_SETPOINTS)
        elif kind:
            raise item.error(
                f"control_{k}_object_type: '{kind}'", f"one of {', '.join(_SETPOINTS)}", "Correct it"
            )
    control = year(context, item, "control_type_schedule_name", default=float(max(kinds, default=0)))
    never = {"heating": constant(NEVER_HEATS), "cooling": constant(NEVER_COOLS)}
    totals = {}
    for which, keys, types in (("heating", _HEAT, (1, 3, 4)), ("cooling", _COOL, (2, 3, 4))):
        total = never[which]
        for number in types:
            if number not in kinds:
                continue
            values = year(context, kinds[number], *keys)
            total = combined(
                lambda set_point, active, other, number=number: (
                    set_point if round(active) == number else other
                ),
                values, control, total,
            )  # fmt: skip
        totals[which] = total
    missing = {round(value) for value in control.values} - {0, *kinds}
    if missing:
        context.findings.left_out(
            item, f"control type {min(missing)} without its set point", "the zone is not conditioned then"
        )
    return SetPoints(totals["heating"], totals["cooling"])


@reads("ZoneHVAC:EquipmentConnections", "ZoneHVAC:EquipmentList", IDEAL, _TEMPLATE)
def _systems(context: Context) -> dict[str, list[IdfObject]]:
    """What heats, cools and ventilates each zone."""
    systems_of_zone: dict[str, list[IdfObject]] = {}
    for item in context.model.of("ZoneHVAC:EquipmentConnections"):
        equipment = context.model.named(
            item.text("zone_conditioning_equipment_list_name"), "ZoneHVAC:EquipmentList"
        )
        rows = [] if equipment is None else equipment.rows("equipment") or _flat_equipment(equipment)
        systems = []
        for row in rows:
            kind = str(row.get("zone_equipment_object_type", ""))
            system = context.model.of_any_class(str(row.get("zone_equipment_name", "")), kind)
            systems += [] if system is None else [system]
        for zone in context.zones_of(item, "zone_name"):
            systems_of_zone[zone.name.casefold()] = systems
    for item in context.model.of(_TEMPLATE):
        for zone in context.zones_of(item, "zone_name"):
            systems_of_zone[zone.name.casefold()] = [item]
    return systems_of_zone


def _flat_equipment(item: IdfObject) -> list[dict[str, Any]]:
    keys = ("zone_equipment_object_type", "zone_equipment_name")
    count = [k for k in range(1, 20) if f"zone_equipment_{k}_object_type" in item.fields]
    return [
        {
            keys[0]: item.text(f"zone_equipment_{k}_object_type"),
            keys[1]: item.text(f"zone_equipment_{k}_name"),
        }
        for k in count
    ]


def _condition(
    context: Context, zone: Zone, points: SetPoints, system: IdfObject, zones: dict[str, Zone]
) -> None:
    """Heating and cooling of one zone by its system."""
    on = year(context, system, "availability_schedule_name", "system_availability_schedule_name")
    plants = {}
    context.systems[system.name] = zone.item.name
    for which in ("heating", "cooling"):
        allowed = year(context, system, f"{which}_availability_schedule_name")
        available = combined(lambda first, second: float(first > 0.0 and second > 0.0), on, allowed)
        plants[which] = Plant(available, _limit(context, system, which))
    _hold(context, zone, points, plants)
    _outdoor_air(context, zone, system, on, zones, points)


def _hold(context: Context, zone: Zone, points: SetPoints, plants: dict[str, Plant]) -> None:
    """Heating and cooling of a zone to its set points, by what there is of both."""
    values = {"heating": points.heating, "cooling": points.cooling}
    for which, never in (("heating", NEVER_HEATS), ("cooling", NEVER_COOLS)):
        plant = plants.get(which)
        values[which] = combined(
            lambda set_point, available, never=never: (
                min(max(set_point, NEVER_HEATS), NEVER_COOLS) if available > 0.0 else never
            ),
            values[which], constant(0.0) if plant is None else plant.available,
        )  # fmt: skip
    crossing = combined(lambda heat, cool: float(heat > cool), values["heating"], values["cooling"])
    if 1.0 in crossing.values:
        context.findings.left_out(
            zone.item,
            "a heating set point above the cooling set point",
            "cooling has the heating set point then",
        )
        values["cooling"] = combined(max, values["heating"], values["cooling"])
    held = context.section("zones")[zone.name]
    for which, never in (("heating", NEVER_HEATS), ("cooling", NEVER_COOLS)):
        if values[which].constant == never:
            continue
        set_point_value = temperature(context, f"{zone.item.name} {which} set point", values[which])
        held[which] = {
            "setpoint": {"schedule": set_point_value} if isinstance(set_point_value, str) else set_point_value
        }
        plant = plants[which]
        if plant.capacity is not None:
            held[which]["capacity"] = round(plant.capacity, 3)
        if plant.radiative > 0.0:
            held[which]["radiative"] = round(plant.radiative, 6)


def _limit(context: Context, system: IdfObject, which: str) -> float | None:
    """Largest power; None without a limit. [W]"""
    word = system.word(f"{which}_limit")
    if word in ("", "nolimit"):
        return None
    kind = "sensible" if which == "heating" else "total"
    limits = []
    if "capacity" in word:
        capacity = system.number(f"maximum_{kind}_{which}_capacity")
        limits += [] if capacity is None else [capacity]
        if capacity is not None and which == "cooling":
            context.findings.approximated(
                system, "a limit of total cooling", "the same limit of sensible cooling"
            )
    if "flowrate" in word:
        flow = system.number(f"maximum_{which}_air_flow_rate")
        extreme = "maximum_heating" if which == "heating" else "minimum_cooling"
        supply = system.needed(f"{extreme}_supply_air_temperature")
        if flow is not None:
            limits.append(flow * _AIR_DENSITY * _AIR_HEAT * abs(supply - _ROOM[which]))
            context.findings.approximated(
                system,
                f"a limit of the flow for {which}",
                f"a limit of the power, that of this flow into air of {_ROOM[which]:g} degC",
            )
    if not limits:
        context.findings.approximated(
            system,
            f"a limit of {which} that EnergyPlus sizes from design days",
            "no limit: the set point is held where the sized system would not hold it",
        )
        return None
    return min(limits)


@reads("DesignSpecification:OutdoorAir")
def _outdoor_air(
    context: Context,
    zone: Zone,
    system: IdfObject,
    on: Year,
    zones: dict[str, Zone],
    points: SetPoints,
) -> None:
    """Outdoor air of the ideal loads as ventilation, whenever the system is available."""
    flow, values = 0.0, constant(1.0)
    named = system.text("design_specification_outdoor_air_object_name")
    if named:
        item = context.model.require(
            system, "design_specification_outdoor_air_object_name", "DesignSpecification:OutdoorAir"
        )
        flow = _outdoor_flow(context, item, zone, zones)
        values = year(context, item, "outdoor_air_schedule_name")
    elif system.kind == _TEMPLATE and system.word("outdoor_air_method") not in ("", "none"):
        flow = _outdoor_flow(context, system, zone, zones)
    if flow <= 0.0:
        return
    if system.word("demand_controlled_ventilation_type") not in ("", "none"):
        context.findings.left_out(
            system, "control by demand", "the flow of outdoor air stays as designed: other loads"
        )
    recovered = 0.0
    if system.word("heat_recovery_type") not in ("", "none"):
        recovered = system.number("sensible_heat_recovery_effectiveness") or 0.0
        context.findings.approximated(
            system,
            "heat recovery",
            "less outdoor air by its effectiveness, while the zone is less than 1 K above its heating set "
            "point or colder than outdoors; air changes are those of the smaller flow then",
        )
    context.findings.approximated(
        system,
        "outdoor air",
        "ventilation of the zone: its heat is in the loads here, and so is not in 'Zone Air System Sensible' "
        "of EnergyPlus but in 'Zone Ideal Loads Supply Air'; loads are sensible",
    )
    active = combined(lambda first, second: second if first > 0.0 else 0.0, on, values)
    # The flow is a volume of standard air (EnergyPlus Engineering Reference, ideal loads).
    air = Draught(
        system, flow, (1.0, 0.0, 0.0, 0.0), active, density=density_of(context, system, usual="standard")
    )
    ventilate(context, zone, air, flow * (1.0 - recovered))
    if recovered > 0.0:
        _bypass(context, zone, replace(air, flow=flow * recovered), points)
    if system.word("outdoor_air_economizer_type") not in ("", "none", "noeconomizer"):
        _economize(context, zone, system, air, points)


def _economize(context: Context, zone: Zone, system: IdfObject, least: Draught, points: SetPoints) -> None:
    """More outdoor air, as much as holds the cooling set point, while it is cooler outdoors.

    EnergyPlus computes the flow that meets the load of a step. A flow that rises from nothing to the largest
    within `_BAND` below the set point comes near to it: the room is colder by less than the band.
    """
    what = "an economizer"
    # EnergyPlus 25.2: `mechanical_outdoor_air.idf` with a cooling set point of 24 degC, 2.4 changes per hour,
    # has 1726 kWh of cooling, 1246 with an economizer of at most 0.3 m3/s, 1105 without limit, 1432 with one
    # of at most 0.3 m3/s that compares enthalpies.
    effect = "more cooling, by 28 to 36 % of it in a small room with 2.4 changes per hour"
    set_point = min(points.cooling.values)
    band = min(_BAND, 0.5 * (set_point - max(points.heating.values)))
    limited_flow = "flowrate" in system.word("cooling_limit")
    most = (system.number("maximum_cooling_air_flow_rate") if limited_flow else None) or (
        _MOST_CHANGES * zone.volume / 3600.0
    )
    active = combined(lambda share, now: share if now == set_point else 0.0, least.values, points.cooling)
    if set_point >= NEVER_COOLS or most <= least.flow or active.constant == 0.0:
        return
    rise = f"min(max((Ti - {set_point - band:.9g})/{band:.9g}, 0), 1)"
    more = replace(least, flow=most - least.flow, values=active, law=f"{rise}*min(max(dT/{_STARTS:g}, 0), 1)")
    if band < _LEAST_BAND or not enter_beside(context, zone, more):
        context.findings.left_out(system, what, f"the flow of outdoor air stays as designed: {effect}")
        return
    context.findings.approximated(
        system,
        "an economizer that follows the load",
        f"a flow that rises within {band:g} K below the cooling set point of {set_point:g} degC while it is "
        "cooler outdoors; 1 to 2 % of the cooling in a small room",
    )
    if "enthalpy" in system.word("outdoor_air_economizer_type"):
        context.findings.approximated(
            system,
            "an economizer by enthalpy",
            "by temperature alone: cooler outdoor air that is moist is used (13 % less cooling in Chicago)",
        )


def _bypass(context: Context, zone: Zone, air: Draught, points: SetPoints) -> None:
    """Air whose heat is not recovered while the zone needs no heat and the outdoor air is cooler."""
    limits = [("difference", constant(0.0))]
    if points.heating.constant != NEVER_HEATS:
        limits.append(("indoor", combined(lambda set_point: set_point + _ABOVE_SET_POINT, points.heating)))
    for part in limited(context, zone, air, limits):
        ventilate(context, zone, part, part.flow)


def _outdoor_flow(context: Context, item: IdfObject, zone: Zone, zones: dict[str, Zone]) -> float:
    """Design flow of outdoor air. [m3/s]"""
    person = item.number("outdoor_air_flow_per_person", "outdoor_air_flow_rate_per_person") or 0.0
    area = (
        item.number("outdoor_air_flow_per_zone_floor_area", "outdoor_air_flow_rate_per_zone_floor_area")
        or 0.0
    )
    zone_flow = item.number("outdoor_air_flow_per_zone", "outdoor_air_flow_rate_per_zone") or 0.0
    changes = item.number("outdoor_air_flow_air_changes_per_hour") or 0.0
    parts = {
        "flow/person": person * people_in(context, zone, zones),
        "flow/area": area * zone.floor,
        "flow/zone": zone_flow,
        "airchanges/hour": changes * zone.volume / 3600.0,
    }
    method = item.word("outdoor_air_method") or "flow/person"
    if method in parts:
        return parts[method]
    if method == "sum":
        return sum(parts.values())
    if method == "maximum":
        return max(parts.values())
    context.findings.left_out(item, f"outdoor air by {method}", "no outdoor air enters by this system")
    return 0.0

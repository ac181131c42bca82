"""Infiltration, ventilation, and air between zones."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

from mascarin.energyplus.model.context import Context
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject
from mascarin.energyplus.model.schedules import fraction, year
from mascarin.energyplus.model.year import Year, combined
from mascarin.energyplus.zones.gains import people_in
from mascarin.energyplus.zones.zones import Zone
from mascarin.physics import GRAVITY

_ZONE_KEYS: Final = (
    "zone_or_zonelist_or_space_or_spacelist_name", "zone_or_zonelist_name", "zone_or_space_name",
    "zone_name",
)  # fmt: skip
SIMPLE: Final = (
    "ZoneInfiltration:DesignFlowRate", "ZoneInfiltration:EffectiveLeakageArea",
    "ZoneVentilation:DesignFlowRate", "ZoneVentilation:WindandStackOpenArea", "ZoneMixing", "ZoneCrossMixing",
)  # fmt: skip
#: Wind speed about which a quadratic effect of the wind is made linear [m/s].
_LINEARIZATION_WIND: Final = 4.0
#: Density of outdoor air over that of the site (15 degC), for a zone at 21 degC: a line in the difference of
#: temperatures from 0 to 30 K through 288.15/(294.15 - dT); a usual value for other terms [-, 1/K].
_DENSE, _DENSER, _USUAL_DENSITY = 288.15 / 294.15, (288.15 / 264.15 - 288.15 / 294.15) / 30.0, 1.035
#: Effectiveness of an opening for the wind where EnergyPlus finds it by direction: the middle of 0.3 and
#: 0.55 (ASHRAE Handbook of Fundamentals 2017, ch. 16) [-].
_EFFECTIVENESS: Final = 0.425
#: Values at which the conditions of natural ventilation never act [degC, K, m/s].
_IDLE: Final = {
    "minimum_indoor_temperature": -100.0,
    "maximum_indoor_temperature": 100.0,
    "delta_temperature": -100.0,
    "minimum_outdoor_temperature": -100.0,
    "maximum_outdoor_temperature": 100.0,
    "maximum_wind_speed": 40.0,
}
_ROOM = 293.15
_DISCHARGE, _CW = 0.65, 0.3


@dataclass(frozen=True)
class Flow:
    """A volume flow of outdoor air ``flow schedule (a + b |dT| + c V + d V^2)``.

    Attributes
    ----------
    item : IdfObject
        The object.
    flow : float
        At a factor of 1. [m3/s]
    terms : tuple of float
        a, b [1/K], c [s/m], d [s2/m2].
    values : Year
        Its schedule.
    """

    item: IdfObject
    flow: float
    terms: tuple[float, float, float, float]
    values: Year


@reads(*SIMPLE)
def describe_air(context: Context, zones: dict[str, Zone]) -> None:
    """Enter infiltration, ventilation and mixing.

    Raises
    ------
    InputError
        A zone or schedule that does not exist.
    """
    if _network(context):
        return
    for item in context.model.of("ZoneInfiltration:DesignFlowRate"):
        for zone in zones_of(context, item, zones):
            _add(context, zone, _flow(context, item, zone, zones, "design_flow_rate_calculation_method"))
    for item in context.model.of("ZoneInfiltration:EffectiveLeakageArea"):
        for zone in zones_of(context, item, zones):
            _leakage(context, item, zone)
    for item in context.model.of("ZoneVentilation:DesignFlowRate"):
        _conditions(context, item, "schedule_name")
        for zone in zones_of(context, item, zones):
            flow = _flow(context, item, zone, zones, "design_flow_rate_calculation_method")
            _add(context, zone, flow)
            _fan(context, item, zone, flow)
    for item in context.model.of("ZoneVentilation:WindandStackOpenArea"):
        _conditions(context, item, "opening_area_fraction_schedule_name")
        for zone in zones_of(context, item, zones):
            _opening(context, item, zone)
    _mixing(context, zones)


def zones_of(context: Context, item: IdfObject, zones: dict[str, Zone]) -> list[Zone]:
    """Zones of an object that are in the description."""
    named = (zones.get(zone.name.casefold()) for zone in context.zones_of(item, *_ZONE_KEYS))
    return [zone for zone in named if zone is not None]


@reads("AirflowNetwork:SimulationControl", *SIMPLE)
def _network(context: Context) -> bool:
    """Whether an air flow network replaces infiltration, ventilation and mixing."""
    item = context.model.one("AirflowNetwork:SimulationControl")
    if item is None:
        return False
    control = item.word("airflownetwork_control")
    if control in ("nomultizoneordistribution", ""):
        return False
    context.findings.left_out(
        item,
        "an air flow network",
        "no outdoor air enters and none passes between zones: zones are warmer, or colder at night",
    )
    replaced = context.model.of(*SIMPLE)
    context.findings.no_effect(replaced, "simple air flow", "EnergyPlus replaces it by the air flow network")
    return True


def _flow(context: Context, item: IdfObject, zone: Zone, zones: dict[str, Zone], method: str) -> Flow:
    word = item.word(method)
    if word in ("flow/area", "flow/floorarea"):
        areas = ("flow_rate_per_floor_area", "flow_rate_per_zone_floor_area", "flow_per_zone_floor_area")
        flow = item.needed(*areas) * zone.floor
    elif word in ("flow/exteriorarea", "flow/exteriorwallarea"):
        area = zone.walls if word == "flow/exteriorwallarea" else zone.outdoors
        flow = item.needed("flow_rate_per_exterior_surface_area", "flow_per_exterior_surface_area") * area
    elif word == "flow/person":
        flow = item.needed("flow_rate_per_person") * people_in(context, zone, zones)
    elif word == "airchanges/hour":
        flow = item.needed("air_changes_per_hour") * zone.volume / 3600.0
    else:
        flow = item.needed("design_flow_rate")
    keys = ("constant", "temperature", "velocity", "velocity_squared")
    terms = [item.number(f"{key}_term_coefficient") or 0.0 for key in keys]
    return Flow(item, flow, (terms[0], terms[1], terms[2], terms[3]), year(context, item, "schedule_name"))


def _add(context: Context, zone: Zone, air: Flow) -> None:
    """Enter a flow: as infiltration, its constant part as ventilation where it has a schedule.

    EnergyPlus takes flows as volumes of outdoor air, Mascarin as volumes at the density of the site. Cold air
    is denser: the part of infiltration by the difference of temperatures holds that.
    """
    constant, stack, wind, squared = air.terms
    if squared:
        context.findings.approximated(
            air.item,
            "a flow with the square of the wind",
            f"a line through its value at {_LINEARIZATION_WIND:g} m/s",
        )
        wind += squared * _LINEARIZATION_WIND
    held, constant_share = context.section("zones")[zone.name], air.values.constant
    changes = air.flow * 3600.0 / zone.volume
    if constant_share is not None:
        dense, denser, usual = _densities(air.item)
        parts = {
            "constant": constant * dense,
            "temperature": stack * usual + constant * denser,
            "wind": wind * zone.wind * usual,
        }
        _infiltrate(held, {key: changes * constant_share * value for key, value in parts.items()})
        return
    if constant:
        schedule, most = fraction(context, f"{air.item.name} flow", air.values)
        _ventilate(context, zone, air.item.name, air.flow * constant * most, schedule)
    if stack or wind:
        mean = air.values.mean()
        context.findings.approximated(
            air.item,
            "a scheduled flow that depends on temperature or wind",
            f"that part has the mean of its schedule, {mean:.2f}, all year",
        )
        parts = {"temperature": stack, "wind": wind * zone.wind}
        _infiltrate(held, {key: changes * mean * value for key, value in parts.items()})


def _densities(item: IdfObject) -> tuple[float, float, float]:
    """Density of the air of a flow over that of the site: at equal temperatures, its rise, a usual one."""
    if item.word("density_basis") in ("standard", "indoor"):
        return 1.0, 0.0, 1.0
    return _DENSE, _DENSER, _USUAL_DENSITY


def _infiltrate(zone: dict[str, Any], parts: dict[str, float]) -> None:
    held = zone.setdefault("infiltration", {})
    for key, value in parts.items():
        if value:
            held[key] = round(held.get(key, 0.0) + value, 8)
    if not held:
        del zone["infiltration"]


def _ventilate(context: Context, zone: Zone, name: str, flow: float, schedule: str | None) -> None:
    if flow <= 0.0:
        return
    held = context.section("zones")[zone.name].setdefault("ventilation", {})
    key = context.names.of(f"ventilation of {zone.name}", name)
    held[key] = {"flow": round(flow, 8)} | ({} if schedule is None else {"schedule": schedule})


def ventilate(context: Context, zone: Zone, name: str, flow: float, values: Year) -> None:
    """Enter ventilation with outdoor air.

    Parameters
    ----------
    context : Context
        The conversion.
    zone : Zone
        The zone.
    name : str
        Name of the flow.
    flow : float
        Flow at a schedule of 1. [m3/s]
    values : Year
        Its schedule.
    """
    schedule, most = fraction(context, f"{name} flow", values)
    _ventilate(context, zone, name, flow * most, schedule)


def _conditions(context: Context, item: IdfObject, schedule: str) -> None:
    """Conditions under which EnergyPlus ventilates; there are none here."""
    if year(context, item, schedule).constant == 0.0:
        return
    active = []
    for key, idle in _IDLE.items():
        limit = item.number(key)
        if item.text(f"{key}_schedule_name") or (limit is not None and abs(limit) < abs(idle)):
            active.append(f"{key.replace('_', ' ')} {'' if limit is None else f'{limit:g}'}".strip())
    if active:
        context.findings.left_out(
            item,
            f"ventilation only at {', '.join(active)}",
            "outdoor air enters at all times: zones are colder when EnergyPlus would not ventilate",
        )


def _fan(context: Context, item: IdfObject, zone: Zone, air: Flow) -> None:
    """Heat of the fan of supplied air."""
    if item.word("ventilation_type") not in ("intake", "balanced"):
        return
    rise, efficiency = item.number("fan_pressure_rise") or 0.0, item.number("fan_total_efficiency") or 1.0
    if rise <= 0.0:
        return
    if any(air.terms[1:]):
        context.findings.approximated(item, "heat of the fan", "that of the constant part of the flow")
    schedule, most = fraction(context, f"{item.name} flow", air.values)
    power = air.flow * air.terms[0] * most * rise / efficiency
    if power > 0.0:
        gains = context.section("zones")[zone.name].setdefault("gains", {})
        key = context.names.of(f"gains of {zone.name}", f"{item.name} fan")
        gains[key] = {"power": round(power, 6)} | ({} if schedule is None else {"schedule": schedule})


def _opening(context: Context, item: IdfObject, zone: Zone) -> None:
    effectiveness = item.number("opening_effectiveness")
    if effectiveness is None:
        context.findings.approximated(
            item, "an effectiveness by wind direction", f"{_EFFECTIVENESS:g} for all directions"
        )
    discharge = item.number("discharge_coefficient_for_opening")
    if discharge is None:
        context.findings.approximated(item, "a discharge coefficient by temperature", "0.65 at all times")
    effective = (_EFFECTIVENESS if effectiveness is None else effectiveness) * zone.wind
    values = year(context, item, "opening_area_fraction_schedule_name")
    schedule, most = fraction(context, f"{item.name} open", values)
    area = item.needed("opening_area") * most
    if area <= 0.0:
        return
    name = context.names.of("openings", item.name)
    context.section("openings")[name] = {
        "zone": zone.name,
        "area": round(area, 8),
        "height": item.number("height_difference") or 0.0,
        "discharge": _DISCHARGE if discharge is None else discharge,
        "wind_coefficient": round(min(effective, 1.0), 6),
    } | ({} if schedule is None else {"schedule": schedule})


def _leakage(context: Context, item: IdfObject, zone: Zone) -> None:
    """``A sqrt(Cs |dT| + Cw V^2)`` as an opening whose flows by wind and buoyancy are those."""
    area = item.needed("effective_air_leakage_area") * 1e-3
    stack, wind = item.needed("stack_coefficient"), item.needed("wind_coefficient")
    values = year(context, item, "schedule_name")
    schedule, most = fraction(context, f"{item.name} flow", values)
    area *= most
    free = area * math.sqrt(wind) * zone.wind / _CW
    if area <= 0.0 or free <= 0.0:
        return
    height = stack * area**2 * _ROOM / (free**2 * _DISCHARGE**2 * 2.0 * GRAVITY)
    context.findings.approximated(
        item, "a leakage area", "an opening with the same flow by wind, and by buoyancy at 20 degC"
    )
    context.section("openings")[context.names.of("openings", item.name)] = {
        "zone": zone.name,
        "area": round(free, 8),
        "height": round(height, 6),
        "discharge": _DISCHARGE,
        "wind_coefficient": _CW,
    } | ({} if schedule is None else {"schedule": schedule})


def _mixing(context: Context, zones: dict[str, Zone]) -> None:
    """Air between zones: in both directions, where EnergyPlus may have one alone."""
    one_way: dict[tuple[str, str], list[tuple[IdfObject, float, Year]]] = {}
    for item in context.model.of("ZoneMixing", "ZoneCrossMixing"):
        sources = context.zones_of(item, "source_zone_or_space_name", "source_zone_name")
        source = zones.get(sources[0].name.casefold())
        if item.number("delta_temperature") or item.text("delta_temperature_schedule_name"):
            context.findings.left_out(
                item, "mixing only at a temperature difference", "it mixes at all times"
            )
        for zone in zones_of(context, item, zones):
            if source is None or source is zone:
                continue
            air = _flow(context, item, zone, zones, "design_flow_rate_calculation_method")
            pair = (zone.name, source.name)
            if item.kind == "ZoneCrossMixing":
                # A pair of objects describes one exchange; each adds to the same flow.
                pair = (min(pair), max(pair))
            one_way.setdefault(pair, []).append((item, air.flow, air.values))
    done: set[tuple[str, str]] = set()
    for (to, origin), flows in one_way.items():
        if (origin, to) in done:
            continue
        done.add((to, origin))
        back = one_way.get((origin, to), [])
        crossed = flows[0][0].kind == "ZoneCrossMixing"
        if not crossed and not _equal(flows, back):
            context.findings.approximated(
                flows[0][0], "air in one direction", "the same flow returns: the source zone feels it, too"
            )
        _path(
            context,
            to,
            origin,
            max((flows, back), key=lambda some: sum(flow for _, flow, _ in some)),
            crossed,
        )


def _equal(flows: list[tuple[IdfObject, float, Year]], back: list[tuple[IdfObject, float, Year]]) -> bool:
    forward_flow, backward_flow = (sum(flow for _, flow, _ in some) for some in (flows, back))
    return abs(forward_flow - backward_flow) <= 1e-6 * max(forward_flow, backward_flow, 1e-12)


def _path(
    context: Context, to: str, source: str, flows: list[tuple[IdfObject, float, Year]], crossed: bool
) -> None:
    rates = [flow for _, flow, _ in flows]
    total = combined(
        lambda *shares: (max if crossed else sum)(f * s for f, s in zip(rates, shares, strict=True)),
        *(values for _, _, values in flows),
    )
    peak = max(total.values)
    if peak <= 0.0:
        return
    schedule, most = fraction(context, f"{flows[0][0].name} flow", combined(lambda v: v / peak, total))
    path: dict[str, Any] = {"between": [to, source], "flow": round(peak * most, 8)}
    name = context.names.of("air_paths", flows[0][0].name)
    context.section("air_paths")[name] = path | ({} if schedule is None else {"schedule": schedule})

"""Air between zones, and the flows that a design gives."""

from __future__ import annotations

from typing import Any, Final

from mascarin.energyplus.model.context import Context
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject
from mascarin.energyplus.model.schedules import fraction, year
from mascarin.energyplus.model.year import Year, combined
from mascarin.energyplus.zones.gains import people_in
from mascarin.energyplus.zones.zones import Zone
from mascarin.physics import AIR_SPECIFIC_HEAT

_ZONE_KEYS: Final = (
    "zone_or_zonelist_or_space_or_spacelist_name", "zone_or_zonelist_name", "zone_or_space_name",
    "zone_name",
)  # fmt: skip

#: Density of air, for the size of an effect [kg/m3].
_AIR_DENSITY: Final = 1.2


def zones_of(context: Context, item: IdfObject, zones: dict[str, Zone]) -> list[Zone]:
    """Zones of an object that are in the description."""
    named = (zones.get(zone.name.casefold()) for zone in context.zones_of(item, *_ZONE_KEYS))
    return [zone for zone in named if zone is not None]


def design_flow(context: Context, item: IdfObject, zone: Zone, zones: dict[str, Zone]) -> float:
    """Flow of an object in a zone by its method of calculation. [m3/s]"""
    word = item.word("design_flow_rate_calculation_method")
    if word in ("flow/area", "flow/floorarea"):
        areas = ("flow_rate_per_floor_area", "flow_rate_per_zone_floor_area", "flow_per_zone_floor_area")
        return item.needed(*areas) * zone.floor
    if word in ("flow/exteriorarea", "flow/exteriorwallarea"):
        area = zone.walls if word == "flow/exteriorwallarea" else zone.outdoors
        return item.needed("flow_rate_per_exterior_surface_area", "flow_per_exterior_surface_area") * area
    if word == "flow/person":
        return item.needed("flow_rate_per_person") * people_in(context, zone, zones)
    if word == "airchanges/hour":
        return item.needed("air_changes_per_hour") * zone.volume / 3600.0
    return item.needed("design_flow_rate")


@reads("ZoneMixing", "ZoneCrossMixing")
def describe_mixing(context: Context, zones: dict[str, Zone]) -> None:
    """Enter air between zones: in both directions, where EnergyPlus may have one alone."""
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
            flow, values = design_flow(context, item, zone, zones), year(context, item, "schedule_name")
            pair = (zone.name, source.name)
            if item.kind == "ZoneCrossMixing":
                # A pair of objects describes one exchange; each adds to the same flow.
                pair = (min(pair), max(pair))
            one_way.setdefault(pair, []).append((item, flow, values))
    done: set[tuple[str, str]] = set()
    for (to, origin), flows in one_way.items():
        if (origin, to) in done:
            continue
        done.add((to, origin))
        back = one_way.get((origin, to), [])
        crossed = flows[0][0].kind == "ZoneCrossMixing"
        if not crossed and not _equal(flows, back):
            heat = sum(flow for _, flow, _ in flows) * AIR_SPECIFIC_HEAT * _AIR_DENSITY
            context.findings.left_out(
                flows[0][0],
                "air in one direction, which nothing replaces in the zone that it comes from",
                f"the same flow returns, and takes {heat:.0f} W for each kelvin between both zones from the "
                "source: where gains differ, both are several kelvins colder or warmer",
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
    path: dict[str, Any] = {"between": [to, source], "flow": round(peak * most, 8), "density": "zone"}
    name = context.names.of("air_paths", flows[0][0].name)
    context.section("air_paths")[name] = path | ({} if schedule is None else {"schedule": schedule})

"""Air between zones, and the flows that a design gives."""

from __future__ import annotations

from dataclasses import dataclass
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
    """Flow of an object in a zone by its method of calculation; 0 where its field is blank. [m3/s]"""
    word = item.word("design_flow_rate_calculation_method")
    size = 1.0
    keys: tuple[str, ...] = ("design_flow_rate",)
    if word in ("flow/area", "flow/floorarea"):
        keys = ("flow_rate_per_floor_area", "flow_rate_per_zone_floor_area", "flow_per_zone_floor_area")
        size = zone.floor
    elif word in ("flow/exteriorarea", "flow/exteriorwallarea"):
        keys = ("flow_rate_per_exterior_surface_area", "flow_per_exterior_surface_area")
        size = zone.walls if word == "flow/exteriorwallarea" else zone.outdoors
    elif word == "flow/person":
        keys, size = ("flow_rate_per_person",), people_in(context, zone, zones)
    elif word == "airchanges/hour":
        keys, size = ("air_changes_per_hour",), zone.volume / 3600.0
    rate = item.number(*keys)
    if rate is None:
        context.findings.approximated(
            item, f"no {keys[0].replace('_', ' ')}", "no flow, as EnergyPlus, which warns of it"
        )
    return (rate or 0.0) * size


@dataclass(frozen=True)
class Mixed:
    """Air of an object from one zone to another.

    Attributes
    ----------
    item : IdfObject
        The object.
    flow : float
        Flow at a schedule of 1. [m3/s]
    values : Year
        Schedule of its fraction. [-]
    """

    item: IdfObject
    flow: float
    values: Year


#: Two zones, and by how much the first has to be warmer, where that is asked for [K].
_Pair = tuple[str, str, float | None]


@reads("ZoneMixing", "ZoneCrossMixing")
def describe_mixing(context: Context, zones: dict[str, Zone]) -> None:
    """Enter air between zones: in both directions, where EnergyPlus may have one alone."""
    flows_by_pair: dict[_Pair, list[Mixed]] = {}
    for item in context.model.of("ZoneMixing", "ZoneCrossMixing"):
        sources = context.zones_of(item, "source_zone_or_space_name", "source_zone_name")
        source = zones.get(sources[0].name.casefold())
        for zone in zones_of(context, item, zones):
            if source is None or source is zone:
                continue
            flow, values = design_flow(context, item, zone, zones), year(context, item, "schedule_name")
            pair = _pair(zone.name, source.name, _difference(context, item))
            if item.kind == "ZoneCrossMixing" and pair[2] is None:
                # A pair of objects describes one exchange; each adds to the same flow.
                pair = (min(pair[:2]), max(pair[:2]), None)
            flows_by_pair.setdefault(pair, []).append(Mixed(item, flow, values))
    done: set[_Pair] = set()
    for pair, flows in flows_by_pair.items():
        opposite = (pair[1], pair[0], pair[2])
        if pair[2] is None and opposite in done:
            continue
        done.add(pair)
        back = flows_by_pair.get(opposite, []) if pair[2] is None else []
        crossed = flows[0].item.kind == "ZoneCrossMixing"
        if not crossed and not _equal(flows, back):
            heat = sum(mixed.flow for mixed in flows) * AIR_SPECIFIC_HEAT * _AIR_DENSITY
            context.findings.left_out(
                flows[0].item,
                "air in one direction, which nothing replaces in the zone that it comes from",
                f"the same flow returns, and takes {heat:.0f} W for each kelvin between both zones from the "
                "source: where gains differ, both are several kelvins colder or warmer",
            )
        larger = max((flows, back), key=lambda some: sum(mixed.flow for mixed in some))
        _path(context, pair, larger, crossed)


@reads("ZoneMixing", "ZoneCrossMixing")
def _difference(context: Context, item: IdfObject) -> float:
    """By how much the source has to be warmer, below zero colder; zero: it always mixes. [K]"""
    if not item.text("delta_temperature_schedule_name"):
        return item.number("delta_temperature") or 0.0
    values = year(context, item, "delta_temperature_schedule_name")
    if values.constant is None:
        context.findings.left_out(
            item, "a temperature difference by schedule", f"its mean is used: {values.mean():.1f} K"
        )
    return values.mean()


def _pair(to: str, source: str, difference: float) -> _Pair:
    """The zones of a flow, the warmer one first where a difference is asked for."""
    if difference == 0.0:
        return to, source, None
    return (source, to, difference) if difference > 0.0 else (to, source, -difference)


def _equal(flows: list[Mixed], back: list[Mixed]) -> bool:
    forward_flow, backward_flow = (sum(mixed.flow for mixed in some) for some in (flows, back))
    return abs(forward_flow - backward_flow) <= 1e-6 * max(forward_flow, backward_flow, 1e-12)


def _path(context: Context, pair: _Pair, flows: list[Mixed], crossed: bool) -> None:
    rates = [mixed.flow for mixed in flows]
    total = combined(
        lambda *shares: (max if crossed else sum)(f * s for f, s in zip(rates, shares, strict=True)),
        *(mixed.values for mixed in flows),
    )
    peak = max(total.values)
    if peak <= 0.0:
        return
    label = flows[0].item.name
    schedule, most = fraction(context, f"{label} flow", combined(lambda v: v / peak, total))
    path: dict[str, Any] = {"between": list(pair[:2]), "flow": round(peak * most, 8), "density": "zone"}
    if pair[2] is not None:
        control = context.names.of("controls", f"{label} warmer", flows[0].item.kind)
        limit = round(min(pair[2], 90.0), 6)
        context.section("controls")[control] = {
            "zone": pair[0],
            "reference_zone": pair[1],
            "difference": {"open": limit, "close": limit},
        }
        path["control"] = control
    name = context.names.of("air_paths", label)
    context.section("air_paths")[name] = path | ({} if schedule is None else {"schedule": schedule})

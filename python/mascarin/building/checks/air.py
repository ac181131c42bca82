"""Rules of the air that fans move: what enters a zone must leave it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Final

from mascarin.building.base.part import fault
from mascarin.building.parts.air.flow_density import ConstantDensity
from mascarin.building.parts.air.vent import LowRise
from mascarin.building.parts.defaults import outlines
from mascarin.building.parts.site_air import density as site_density

if TYPE_CHECKING:
    from pydantic_core import InitErrorDetails

    from mascarin.building.parts.description import Description
    from mascarin.building.parts.envelope.measured_values import Driven
    from mascarin.building.parts.envelope.surface import Surface

#: Largest difference of what enters and what leaves a zone, over the larger of the two [-].
BALANCED: Final = 1e-3

#: Tilts of surfaces that count as walls [deg].
STEEP: Final = (60.0, 120.0)

#: A flow of a zone: its path, its part, and how many cubic metres of the air that is compared a cubic metre
#: of it is: positive where it enters the zone, negative where it leaves.
ZoneFlowAt = tuple[str, "Driven", float]
#: A zone, and the air whose volumes are compared.
ZoneAir = tuple[str, str]


def flows_of_zones(building: Description) -> dict[ZoneAir, list[ZoneFlowAt]]:
    """Flows that fans drive, by the zones that they enter and leave; zones without any are left out.

    What enters and leaves is compared as masses: flows of constant densities as volumes at the density of the
    site, those of air whose density changes among themselves.
    """
    flows: dict[ZoneAir, list[ZoneFlowAt]] = {}

    def add(zone: str, air_of: str, path: str, part: Driven, sign: float) -> None:
        density = getattr(part, "density", None)
        air, ratio = "site", 1.0
        if isinstance(density, ConstantDensity):
            ratio = float(density.constant) / site_density(building.site)
        elif density is not None:
            air = density.kind if density.kind != "zone" else f"zone '{air_of}'"
        flows.setdefault((zone, air), []).append((path, part, sign * ratio))

    for name, unit in building.ventilation_units.items():
        for section, sign in (("supply", 1.0), ("exhaust", -1.0)):
            for zone, flow in getattr(unit, section).items():
                add(zone, zone, f"ventilation_units.{name}.{section}.{zone}", flow, sign)
    for name, path in building.air_paths.items():
        if path.one_way:
            for zone, sign in zip(path.between, (-1.0, 1.0), strict=True):
                add(zone, path.between[0], f"air_paths.{name}", path, sign)
    return flows


def imbalance(flows: Mapping[str, float], air: str = "site") -> str | None:
    """What is wrong with the balance of a zone, in words; None where it balances.

    Parameters
    ----------
    flows : mapping of str to float
        Flows by path; those that leave the zone are negative. [m3/s]
    air : str
        Air whose volumes they are.
    """
    enters = sum(flow for flow in flows.values() if flow > 0.0)
    leaves = -sum(flow for flow in flows.values() if flow < 0.0)
    if abs(enters - leaves) <= BALANCED * max(enters, leaves):
        return None
    parts = ", ".join(f"{path} {flow:+.5g}" for path, flow in flows.items())
    of = "" if air == "site" else f", volumes at 'density: {air.partition(' ')[0]}'"
    return f"{enters:.5g} m3/s of air enters and {leaves:.5g} m3/s leaves ({parts}{of})"


#: What to do about flows that do not balance.
REMEDY: Final = (
    "Correct the flows, add 'air_paths' with 'one_way: true' to or from another zone, or write 'makeup_air: "
    "outdoors' in the zone if the rest comes and goes through leaks, 'makeup_air: vents' if through its "
    "'vents'. Flows with different 'density:' do not balance each other."
)


def air_faults(building: Description) -> Iterator[InitErrorDetails]:
    """Constant flows that do not balance, and parts that nothing uses."""
    flows, joined = flows_of_zones(building), _joined_with_outdoors(building)
    for zone, part in building.zones.items():
        if part.makeup_air is not None and all(zone != moved for moved, _ in flows):
            yield fault(
                ("zones", zone, "makeup_air"),
                "a zone that no fan moves air through",
                "a flow of 'ventilation_units' or a one-way air path",
                "Remove 'makeup_air:'.",
            )
        if part.makeup_air == "vents" and zone not in joined:
            yield fault(
                ("zones", zone, "makeup_air"),
                "'vents' in a zone that no vents join with outdoors",
                "vents from it to outdoors, directly or through other zones",
                "Add an opening under 'vents:', or write 'makeup_air: outdoors'.",
            )
        yield from _bridges(building, zone)
        if part.solar_to_air is not None:
            yield from _solar_to_air(building, zone)
    yield from vent_faults(building)
    for (zone, air), those in flows.items():
        if building.zones[zone].makeup_air is not None:
            continue
        if any(part.column is not None or _schedule(part) is not None for _, part, _ in those):
            continue  # checked over the period of a run
        wrong = imbalance({path: sign * part.number for path, part, sign in those}, air)
        if wrong is not None:
            yield fault(("zones", zone), wrong, "as much air in as out", REMEDY)


def _joined_with_outdoors(building: Description) -> set[str]:
    """Zones from which vents lead outdoors, directly or through other zones."""
    joined = {vent.ends[0] for vent in building.vents.values() if vent.between is None}
    while True:
        ends = [set(vent.ends) for vent in building.vents.values() if joined & set(vent.ends)]
        wider = joined.union(*ends)
        if wider == joined:
            return joined
        joined = wider


def vent_faults(building: Description) -> Iterator[InitErrorDetails]:
    """Openings in surfaces that they cannot be in."""
    for name, vent in building.vents.items():
        if vent.surface is None:
            continue
        surface, location = building.surfaces[vent.surface], ("vents", name, "surface")
        if not surface.outside.outdoors or surface.inside.zone != vent.zone:
            yield fault(
                location,
                f"'{vent.surface}' between {surface.inside.in_words()} and {surface.outside.in_words()}",
                f"a surface between zone '{vent.zone}' and outdoors",
                "Name another surface, or give 'azimuth:' in its place.",
            )
        elif isinstance(vent.pressure, LowRise) and not STEEP[0] <= _tilt(vent.surface, surface) <= STEEP[1]:
            yield fault(
                ("vents", name, "pressure"),
                f"low_rise in '{vent.surface}' of tilt {_tilt(vent.surface, surface):g} deg",
                "a wall: the correlation holds for vertical surfaces",
                "Write 'pressure: {kind: table, coefficients: [-0.6]}' with the coefficients of the roof.",
            )


def _tilt(name: str, surface: Surface) -> float:
    """Tilt of a surface, as given or of its vertices. [deg]"""
    if surface.tilt is None and surface.vertices is not None:
        return float(outlines({name: surface})[name].tilt)
    return float(surface.tilt or 0.0)


def _schedule(part: Driven) -> str | None:
    schedule: str | None = getattr(part, "schedule", None)
    return schedule


def _bridges(building: Description, zone: str) -> Iterator[InitErrorDetails]:
    for name, bridge in building.zones[zone].thermal_bridges.items():
        if bridge.zone == zone:
            yield fault(
                ("zones", zone, "thermal_bridges", name, "zone"),
                f"'{zone}', the zone itself",
                "another zone, or nothing for outdoors",
                "Name the other end.",
            )


def _solar_to_air(building: Description, zone: str) -> Iterator[InitErrorDetails]:
    location = ("zones", zone, "solar_to_air")
    names = {name for name, _ in building.connections.sides(zone)}
    walls = [window.surface for window in building.windows.values() if window.surface in names]
    if not walls:
        yield fault(location, "a zone without windows", "a window through which the sun enters", "Remove it.")
    if any(not building.surfaces[wall].outside.outdoors for wall in walls):
        yield fault(
            location,
            "a zone with a window to another zone",
            "windows to outdoors only",
            "Remove 'solar_to_air:', or describe that window as an opaque surface.",
        )

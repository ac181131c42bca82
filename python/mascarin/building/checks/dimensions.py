"""Whether areas and thermal bridges belong to the same dimensions, and whether a building closes.

Edges count twice where areas are external and psi values internal, and not at all the other way round. A psi
value is converted by ``psi_e = psi_i - sum(U dA) / l`` (EN ISO 10211:2017), where the description states the
areas by which the surfaces at a bridge differ.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from mascarin.building.base.dimensions import SYSTEMS
from mascarin.building.base.part import derived_number, fault, insist
from mascarin.building.checks.u_values import described_u_value
from mascarin.building.parts.envelope.bridge import ThermalBridge
from mascarin.errors import did_you_mean

if TYPE_CHECKING:
    from pydantic_core import InitErrorDetails

    from mascarin.building.base.dimensions import System
    from mascarin.building.parts.air.zone import Zone
    from mascarin.building.parts.description import Description
    from mascarin.building.parts.envelope.surface import Surface

#: Part of the larger of two areas that opposite sides may differ by: internal areas leave partitions out. [-]
_SHARES: Final = {"internal": 0.05, "overall_internal": 0.02, "external": 0.02}
#: Area that opposite sides may differ by. [m2]
_AREA: Final = 0.1
#: Part of a height that zones of one storey may differ by [-].
_HEIGHTS: Final = 0.1
#: Where the sides of a building are: names and directions (east, north).
_OPPOSITE: Final = (("east", "west", 0), ("north", "south", 1))


def words_of(system: str) -> str:
    """A system of dimensions in words."""
    return system.replace("_", " ")


def system_of(building: Description, surface: Surface) -> System | None:
    """Dimensions of the area of a surface; None where they are not stated."""
    if surface.dimensions is not None:
        return surface.dimensions
    return None if building.dimensions is None else building.dimensions.areas


def bridge_system(building: Description, bridge: ThermalBridge) -> str | None:
    """Dimensions that the coefficient of a bridge belongs to; None where they are not stated."""
    if bridge.dimensions is not None:
        return bridge.dimensions
    return None if building.dimensions is None else building.dimensions.bridges


def losing(building: Description, zone: str) -> dict[str, Surface]:
    """Surfaces through which a zone loses heat to anything but other zones, by name."""
    sides = dict(building.connections.sides(zone))
    faced = {name: building.surfaces[name] for name in sides}
    return {
        name: surface
        for name, surface in faced.items()
        if not surface.internal_mass
        and not any(side.closed for side in surface.sides)
        and (surface.outside.zone is None or surface.inside.zone is None)
    }


def dimension_faults(building: Description) -> Iterator[InitErrorDetails]:
    """Bridges of other dimensions than the areas beside them, and conversions that cannot be made."""
    for zone, part in building.zones.items():
        for name, bridge in part.thermal_bridges.items():
            location = ("zones", zone, "thermal_bridges", name)
            if bridge.excess:
                yield from _conversion_faults(building, location, bridge)
                continue
            if bridge.converted is not None:
                yield fault(
                    (*location, "converted"), "a conversion without 'excess'", "none", "Remove 'converted:'."
                )
            system = bridge_system(building, bridge)
            if system not in SYSTEMS:
                continue
            mismatched = {
                name: stated
                for name, surface in losing(building, zone).items()
                if (stated := system_of(building, surface)) is not None and stated != system
            }
            if mismatched:
                name_of, beside = next(iter(mismatched.items()))
                listed = ", ".join(name for name, other in mismatched.items() if other == beside)
                yield fault(
                    location,
                    f"a coefficient of {words_of(str(system))} dimensions beside areas of {words_of(beside)} "
                    f"dimensions ({listed})",
                    "both of the same dimensions: edges count twice or not at all otherwise (EN ISO 13789)",
                    f"Give the areas or the coefficient in the other dimensions and write 'dimensions:' "
                    f"there, or convert the coefficient: 'excess: {{{name_of}: 0.4}}' states by "
                    "how many m2 the area described is larger at this bridge.",
                )


def _conversion_faults(
    building: Description, location: tuple[str, ...], bridge: ThermalBridge
) -> Iterator[InitErrorDetails]:
    system = bridge_system(building, bridge)
    if system not in SYSTEMS:
        yield fault(
            (*location, "excess"),
            "a conversion of a coefficient whose dimensions are not stated or the same in all",
            "the dimensions that psi or chi belongs to",
            "Add 'dimensions: internal' or another one to the bridge.",
        )
    shell = losing(building, location[1])
    for name, area in bridge.excess.items():
        if name not in shell:
            yield fault(
                (*location, "excess", name),
                f"'{name}'",
                "a surface through which this zone loses heat",
                did_you_mean(name, shell) or "Name a surface at this bridge.",
            )
        elif not math.isfinite(area) or abs(area) > float(shell[name].area or 0.0):
            yield fault(
                (*location, "excess", name),
                f"{area:g} m2",
                f"less than the {float(shell[name].area or 0.0):.2f} m2 of '{name}'",
                "Give what its area differs by at this bridge [m2].",
            )
        elif system_of(building, shell[name]) in (None, system):
            yield fault(
                (*location, "excess", name),
                f"an area of '{name}' in {words_of(str(system_of(building, shell[name]) or 'no stated'))} "
                f"dimensions, and a coefficient of {words_of(str(system))} dimensions",
                "two different dimensions, between which a coefficient is converted",
                "Remove 'excess:', or state the dimensions of the area.",
            )


def with_converted_bridges(building: Description) -> dict[str, Zone]:
    """Zones whose bridges have the conversion to the dimensions of the areas: ``-sum(U dA)``.

    Raises
    ------
    ValidationError
        Dimensions are mixed, or a conversion cannot be made.
    """
    insist(*dimension_faults(building))
    zones = dict(building.zones)
    for zone, part in zones.items():
        changed = {
            name: bridge.model_copy(update={"converted": _conversion(building, bridge)})
            for name, bridge in part.thermal_bridges.items()
            if bridge.excess and bridge.converted is None
        }
        if changed:
            zones[zone] = part.model_copy(update={"thermal_bridges": {**part.thermal_bridges, **changed}})
    return zones


def _conversion(building: Description, bridge: ThermalBridge) -> object:
    surfaces = building.surfaces
    heat = sum(described_u_value(building, surfaces[name]) * area for name, area in bridge.excess.items())
    # A bridge that is there several times has the excess of all of them.
    each = -heat / max(float(bridge.number or 1.0), 1e-9)
    return derived_number(ThermalBridge, "converted", each, "EN ISO 10211:2017: -sum(U dA), U as described")


def dimension_lines(building: Description) -> Iterator[str]:
    """Dimensions of areas and bridges, and conversions between them."""
    bridges = {
        f"zones.{zone}.thermal_bridges.{name}": bridge
        for zone, part in building.zones.items()
        for name, bridge in part.thermal_bridges.items()
    }
    stated = building.dimensions is not None or any(s.dimensions for s in building.surfaces.values())
    if not stated:
        if bridges:
            yield "dimensions: not stated; whether areas and thermal bridges belong together is not known"
        return
    areas: dict[str, int] = {}
    for surface in building.surfaces.values():
        if not surface.internal_mass:
            system = words_of(system_of(building, surface) or "not stated")
            areas[system] = areas.get(system, 0) + 1
    said = ", ".join(f"{system} of {count} surfaces" for system, count in areas.items())
    kinds = dict.fromkeys(
        words_of(bridge_system(building, bridge) or "not stated") for bridge in bridges.values()
    )
    beside = f"; thermal bridges {', '.join(kinds)}" if kinds else ""
    yield f"dimensions: areas {said}{beside}"
    for path, bridge in bridges.items():
        if bridge.excess:
            terms = " - ".join(
                f"{described_u_value(building, building.surfaces[name]):.3f} x {area:g}"
                for name, area in bridge.excess.items()
            )
            system = words_of(str(bridge_system(building, bridge)))
            yield (
                f"{path}: {bridge.stated_conductance:.3f} W/K in {system} dimensions, "
                f"converted to {bridge.conductance:.3f} W/K (- {terms}: U [W/(m2 K)] x m2)"
            )


def dimension_warnings(building: Description) -> Iterator[str]:
    """What does not close, in a building that states its dimensions, and coefficients that state none."""
    if building.dimensions is None:
        return
    for zone, part in building.zones.items():
        for name, bridge in part.thermal_bridges.items():
            if bridge_system(building, bridge) is None:
                yield (
                    f"zones.{zone}.thermal_bridges.{name}: the dimensions of its coefficient are not stated, "
                    f"those of the areas are {words_of(building.dimensions.areas)}: write 'dimensions:'"
                )
    yield from _unequal_sides(building)
    for zone in building.zones:
        yield from _unequal_floors(building, zone)
    yield from _unequal_heights(building)


def _differ(building: Description, area: float, opposite_area: float) -> bool:
    share = 0.0 if building.dimensions is None else _SHARES[building.dimensions.areas]
    return abs(area - opposite_area) > max(share * max(area, opposite_area), _AREA)


def _unequal_sides(building: Description) -> Iterator[str]:
    """Sum of area times normal over all surfaces to the surroundings: zero for what closes."""
    shell = [
        surface
        for surface in building.surfaces.values()
        if surface.azimuth is not None and None in (surface.outside.zone, surface.inside.zone)
    ]
    for name, opposite, axis in _OPPOSITE:
        plus, minus = 0.0, 0.0
        for surface in shell:
            angle, tilt = (
                math.radians(float(surface.azimuth or 0.0)),
                math.radians(float(surface.tilt or 0.0)),
            )
            part = math.sin(tilt) * (math.sin(angle), math.cos(angle))[axis] * float(surface.area or 0.0)
            if surface.inside.zone is None:
                part = -part
            plus, minus = plus + max(part, 0.0), minus - min(part, 0.0)
        if min(plus, minus) > _AREA and _differ(building, plus, minus):
            yield (
                f"surfaces: {plus:.2f} m2 face {name} and {minus:.2f} m2 face {opposite}, a difference of "
                f"{plus - minus:+.2f} m2: the facades do not close"
            )


def _level(building: Description, zone: str) -> tuple[float, float]:
    """Area of the floor and of the ceiling of a zone, projected to the horizontal. [m2]"""
    down, up = 0.0, 0.0
    for name, side in building.connections.sides(zone):
        surface = building.surfaces[name]
        if surface.internal_mass:
            continue
        cosine = math.cos(math.radians(float(surface.tilt or 0.0))) * (1.0 if side == "inside" else -1.0)
        part = cosine * float(surface.area or 0.0)
        if abs(cosine) > 1e-6:
            up, down = up + max(part, 0.0), down - min(part, 0.0)
    return down, up


def _unequal_floors(building: Description, zone: str) -> Iterator[str]:
    floor, ceiling = _level(building, zone)
    if min(floor, ceiling) > _AREA and _differ(building, floor, ceiling):
        yield (
            f"zones.{zone}: a floor of {floor:.2f} m2 below a ceiling of {ceiling:.2f} m2, a difference of "
            f"{floor - ceiling:+.2f} m2: they do not close"
        )


def _unequal_heights(building: Description) -> Iterator[str]:
    """Volume over internal floor area: a zone that is higher or lower than most mismatched."""
    heights: dict[str, float] = {}
    for zone, part in building.zones.items():
        floor = _level(building, zone)[0]
        below = [s for s in losing(building, zone).values() if abs(float(s.tilt or 0.0)) > 150.0]
        if floor > _AREA and below and all(system_of(building, s) == "internal" for s in below):
            heights[zone] = float(part.volume or 0.0) / floor
    if len(heights) < 3:
        return
    usual = sorted(heights.values())[len(heights) // 2]
    for zone, height in heights.items():
        if abs(height - usual) > _HEIGHTS * usual:
            volume = float(building.zones[zone].volume or 0.0)
            yield (
                f"zones.{zone}: {volume:.2f} m3 over {volume / height:.2f} m2 of floor is {height:.2f} m "
                f"high, most zones are {usual:.2f} m: a difference of "
                f"{volume - volume / height * usual:+.2f} m3"
            )

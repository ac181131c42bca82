"""Zones: volumes, floor areas, heights, and the heat capacity of their air."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from mascarin.building.parts.site import Wind, wind_factor
from mascarin.energyplus.envelope.idf_surfaces import IdfSurface, floor_area, turned
from mascarin.energyplus.model import geometry as g
from mascarin.energyplus.model.context import Context
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject
from mascarin.errors import InputError

#: Height of a zone of which neither volume nor closed surfaces are known [m].
_USUAL_HEIGHT = 2.5
#: Sum of the vector areas of closed surfaces over the sum of their areas, at most [-].
_CLOSED = 0.01


@dataclass(frozen=True)
class Zone:
    """Sizes of a zone.

    Attributes
    ----------
    item : IdfObject
        The object.
    name : str
        Its name in the description.
    volume, floor : float
        Volume [m3] and floor area [m2].
    outdoors, walls : float
        Areas facing outdoors: all, and walls alone. [m2]
    wind : float
        Wind at the middle of the zone over that at the mast. [-]
    spaces : dict of str to float
        Floor area of its spaces by name in small letters, as far as they have floors. [m2]
    """

    item: IdfObject
    name: str
    volume: float
    floor: float
    outdoors: float
    walls: float
    wind: float
    spaces: dict[str, float] = field(default_factory=dict, compare=False)


def describe_zones(context: Context, surfaces: list[IdfSurface]) -> dict[str, Zone]:
    """Enter all zones that have surfaces.

    Returns
    -------
    dict of str to Zone
        By the name in the file, in small letters.

    Raises
    ------
    InputError
        The file has no zones, or the volume of one is not known.
    """
    items = context.zone_items()
    if not items:
        raise InputError(f"{context.model.file}: found no Zone; expected at least one")
    wind = Wind(**context.sections["site"]["wind"])
    zones = {}
    by_zone: dict[str, list[IdfSurface]] = {}
    facing: dict[str, list[IdfSurface]] = {}
    for surface in surfaces:
        by_zone.setdefault(surface.zone.name.casefold(), []).append(surface)
        if surface.boundary == "zone":
            facing.setdefault(surface.beyond.casefold(), []).append(surface)
    with_masses = {
        zone.name.casefold()
        for mass in context.model.of("InternalMass")
        for zone in _zones_of_mass(context, mass)
    }
    for item in items:
        zone_surfaces = list(by_zone.get(item.name.casefold(), []))
        # EnergyPlus makes the other side of a surface that names a zone: it is one of the zone's own.
        zone_surfaces += [turned(surface, item) for surface in facing.get(item.name.casefold(), [])]
        if not zone_surfaces and item.name.casefold() not in with_masses:
            context.findings.left_out(item, "a zone without surfaces", "it has no counterpart here")
            continue
        if (item.number("multiplier") or 1.0) > 1.0:
            context.findings.approximated(
                item,
                f"a multiplier of {item.number('multiplier'):g}",
                "temperatures and loads are those of one of the zones: multiply its loads",
            )
        name = context.names.of("zones", item.name)
        sizes = _sizes(context, item, zone_surfaces, wind)
        context.section("zones")[name] = {"volume": round(sizes.volume, 6)}
        zones[item.name.casefold()] = sizes
    _capacities(context)
    return zones


def _zones_of_mass(context: Context, mass: IdfObject) -> list[IdfObject]:
    return context.zones_of(mass, "zone_or_zonelist_name", "zone_name", "space_or_spacelist_name")


def _sizes(context: Context, item: IdfObject, zone_surfaces: list[IdfSurface], wind: Wind) -> Zone:
    floor = floor_area(item, zone_surfaces)
    volume = item.number("volume") or 0.0
    ceiling = item.number("ceiling_height") or 0.0
    if volume <= 0.0:
        volume = floor * ceiling if ceiling > 0.0 else _enclosed(floor, zone_surfaces)
    if volume <= 0.01:
        volume = floor * _USUAL_HEIGHT
        if volume <= 0.0:
            raise item.error("no volume", "a volume [m3], or surfaces that enclose it", "Give 'Volume'")
        context.findings.approximated(
            item, "an unknown height", f"{_USUAL_HEIGHT:g} m are used for its volume"
        )
    outer = [surface for surface in zone_surfaces if surface.boundary == "outdoors"]
    heights = (
        np.concatenate([surface.points[:, 2] for surface in zone_surfaces])
        if zone_surfaces
        else np.array([3.0])
    )
    middle = float(0.5 * (heights.min() + heights.max()))
    return Zone(
        item=item,
        name=context.names.of("zones", item.name),
        volume=volume,
        floor=floor,
        outdoors=sum(g.area_of(surface.points) for surface in outer),
        walls=sum(g.area_of(surface.points) for surface in outer if surface.shape == "wall"),
        wind=wind_factor(wind, middle),
        spaces=_spaces(zone_surfaces),
    )


def _spaces(surfaces: list[IdfSurface]) -> dict[str, float]:
    """Floor areas of the spaces that surfaces name. [m2]"""
    areas: dict[str, float] = {}
    for surface in surfaces:
        space = surface.item.word("space_name")
        if space and surface.shape == "floor":
            areas[space] = areas.get(space, 0.0) + g.area_of(surface.points)
    return areas


def _enclosed(floor: float, surfaces: list[IdfSurface]) -> float:
    """Volume between the surfaces of a zone; by floor and height where they do not enclose it. [m3]"""
    outlines = [surface.points for surface in surfaces]
    if not outlines:
        return 0.0
    gap = np.linalg.norm(np.sum([g.normal_of(points) for points in outlines], axis=0))
    if floor <= 0.0 or gap <= _CLOSED * sum(g.area_of(points) for points in outlines):
        return abs(g.signed_volume(outlines))
    heights = {}
    for kind, shapes in (("floor", ("floor",)), ("ceiling", ("roof", "ceiling"))):
        levels = [(g.area_of(s.points), float(s.points[:, 2].mean())) for s in surfaces if s.shape in shapes]
        area = sum(part for part, _ in levels)
        if area > 0.0:
            heights[kind] = sum(part * level for part, level in levels) / area
    corners = np.concatenate(outlines)[:, 2]
    top, bottom = heights.get("ceiling", float(corners.max())), heights.get("floor", float(corners.min()))
    return floor * max(top - bottom, 0.0)


@reads("ZoneCapacitanceMultiplier:ResearchSpecial")
def _capacities(context: Context) -> None:
    """Multipliers of the heat capacity of the air."""
    for item in context.model.of("ZoneCapacitanceMultiplier:ResearchSpecial"):
        factor = item.number("temperature_capacity_multiplier") or 1.0
        if factor == 1.0:
            continue
        named = item.text("zone_or_zonelist_name")
        zones = context.zones_of(item, "zone_or_zonelist_name") if named else context.zone_items()
        for zone in zones:
            name = context.names.of("zones", zone.name)
            if name in context.section("zones"):
                context.section("zones")[name]["capacity_factor"] = factor

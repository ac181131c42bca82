"""Zones: volumes, floor areas, heights, and the heat capacity of their air."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mascarin.building.site import Wind, wind_factor
from mascarin.convert import geometry as g
from mascarin.convert.faces import Face, floor_area
from mascarin.convert.source import Item
from mascarin.convert.work import Work
from mascarin.errors import InputError

#: Height of a zone of which neither volume nor closed surfaces are known [m].
_HEIGHT = 2.5


@dataclass(frozen=True)
class Zone:
    """Sizes of a zone.

    Attributes
    ----------
    item : Item
        The object.
    name : str
        Its name in the description.
    volume, floor : float
        Volume [m3] and floor area [m2].
    outdoors, walls : float
        Areas facing outdoors: all, and walls alone. [m2]
    wind : float
        Wind at the middle of the zone over that at the mast. [-]
    """

    item: Item
    name: str
    volume: float
    floor: float
    outdoors: float
    walls: float
    wind: float


def describe_zones(work: Work, surfaces: list[Face]) -> dict[str, Zone]:
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
    items = work.zone_items()
    if not items:
        raise InputError(f"{work.model.file}: found no Zone; expected at least one")
    wind = Wind(**work.sections["site"]["wind"])
    zones = {}
    for item in items:
        zone_surfaces = [face for face in surfaces if face.zone is item]
        facing = [
            face
            for face in surfaces
            if face.boundary == "zone" and face.beyond.casefold() == item.name.casefold()
        ]
        masses = [mass for mass in work.model.of("InternalMass") if item in _zones_of_mass(work, mass)]
        if not zone_surfaces and not facing and not masses:
            work.findings.left_out(item, "a zone without surfaces", "it has no counterpart here")
            continue
        if (item.number("multiplier") or 1.0) > 1.0:
            work.findings.approximated(
                item,
                f"a multiplier of {item.number('multiplier'):g}",
                "temperatures and loads are those of one of the zones: multiply its loads",
            )
        name = work.names.of("zones", item.name)
        sizes = _sizes(work, item, zone_surfaces, wind)
        work.section("zones")[name] = {"volume": round(sizes.volume, 6)}
        zones[item.name.casefold()] = sizes
    _capacities(work)
    return zones


def _zones_of_mass(work: Work, mass: Item) -> list[Item]:
    return work.zones_of(mass, "zone_or_zonelist_name", "zone_name", "space_or_spacelist_name")


def _sizes(work: Work, item: Item, zone_surfaces: list[Face], wind: Wind) -> Zone:
    floor = floor_area(item, zone_surfaces)
    volume = item.number("volume") or 0.0
    ceiling = item.number("ceiling_height") or 0.0
    if volume <= 0.0:
        volume = floor * ceiling if ceiling > 0.0 else abs(g.signed_volume([face.points for face in zone_surfaces]))
    if volume <= 0.01:
        volume = floor * _HEIGHT
        if volume <= 0.0:
            raise item.error("no volume", "a volume [m3], or surfaces that enclose it", "Give 'Volume'")
        work.findings.approximated(item, "an unknown height", f"{_HEIGHT:g} m are used for its volume")
    outer = [face for face in zone_surfaces if face.boundary == "outdoors"]
    heights = np.concatenate([face.points[:, 2] for face in zone_surfaces]) if zone_surfaces else np.array([3.0])
    middle = float(0.5 * (heights.min() + heights.max()))
    return Zone(
        item=item,
        name=work.names.of("zones", item.name),
        volume=volume,
        floor=floor,
        outdoors=sum(g.area_of(face.points) for face in outer),
        walls=sum(g.area_of(face.points) for face in outer if face.shape == "wall"),
        wind=wind_factor(wind, middle),
    )


def _capacities(work: Work) -> None:
    """Multipliers of the heat capacity of the air."""
    for item in work.model.of("ZoneCapacitanceMultiplier:ResearchSpecial"):
        factor = item.number("temperature_capacity_multiplier") or 1.0
        if factor == 1.0:
            continue
        named = item.text("zone_or_zonelist_name")
        zones = work.zones_of(item, "zone_or_zonelist_name") if named else work.zone_items()
        for zone in zones:
            name = work.names.of("zones", zone.name)
            if name in work.section("zones"):
                work.section("zones")[name]["capacity_factor"] = factor

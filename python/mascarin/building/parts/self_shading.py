"""Surfaces that stand in front of others outdoors."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, NamedTuple

from mascarin.building.base.part import cached_on
from mascarin.building.geometry import InFront
from mascarin.building.parts.defaults import outlines, shade_outlines, window_outlines

if TYPE_CHECKING:
    from mascarin.building.geometry import Polygon
    from mascarin.building.parts.description import Description
    from mascarin.building.parts.envelope.surface import Surface

#: Names in a list before it is cut.
_NAMES = 8
#: Stages of a year of steps of 15 min by SDIRK2.
_YEAR = 2 * 4 * 8760
#: A side of a surface, or the outside of a window.
SideName = tuple[str, str]


def obstructions(building: Description) -> dict[SideName, list[str]]:
    """Surfaces in front of each side outdoors.

    Parameters
    ----------
    building : Description
        The building.

    Returns
    -------
    dict of (name, side) to list of str
        Names of the surfaces of which a part stands in front of the plane of a surface or window, for those
        where there are any. Surfaces between two zones or on the ground stand in front of nothing. A window
        has the surfaces of its wall.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> obstructions(box())
    {}
    """
    return cached_on(building, "_obstructions", lambda: _obstructions(building))


def _obstructions(building: Description) -> dict[SideName, list[str]]:
    if not building.site.self_shading:
        return {}
    polygons = outlines(building.surfaces)
    walls = [name for name in polygons if _can_obstruct(building.surfaces[name])]
    standing = InFront([polygons[name] for name in walls])
    in_front_of = {
        side: [walls[k] for k in standing.of(polygon)] for side, polygon in _outdoors(building, polygons)
    }
    for name in window_outlines(building.windows):
        in_front_of[name, "outside"] = in_front_of.get((building.windows[name].surface, "outside"), [])
    return {side: names for side, names in in_front_of.items() if names}


class ShadePairs(NamedTuple):
    """Pairs of a side or window outdoors and one of the `shades` in front of its plane.

    Attributes
    ----------
    near : int
        Those with corners closer to each other than the root of the area that is shaded, such as slats: their
        shadows often overlap.
    far : int
        The others, such as neighboring buildings.
    """

    near: int = 0
    far: int = 0


def pairs_with_shades(building: Description) -> ShadePairs:
    """Count the pairs with shades.

    Parameters
    ----------
    building : Description
        The building.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> pairs_with_shades(box())
    ShadePairs(near=0, far=0)
    """
    if not building.shades:
        return ShadePairs()
    shades = list(shade_outlines(building.shades).values())
    standing = InFront(shades)
    sides = [polygon for _, polygon in _outdoors(building, outlines(building.surfaces))]
    candidates = [
        _apart(polygon, shades[k]) < math.sqrt(polygon.area)
        for polygon in (*sides, *window_outlines(building.windows).values())
        for k in standing.of(polygon)
    ]
    return ShadePairs(sum(map(int, candidates)), len(candidates) - sum(map(int, candidates)))


def _apart(polygon: Polygon, other: Polygon) -> float:
    """Least distance of two corners. [m]"""
    ways = polygon.points[:, None] - other.points
    return math.sqrt(float((ways * ways).sum(axis=2).min()))


def expected_seconds(
    obstructed: Mapping[SideName, list[str]], stages: int = _YEAR, *, shades: ShadePairs | None = None
) -> float:
    """Processor time of the shadows of a run on a usual machine of 2025 [s].

    Parameters
    ----------
    obstructed : mapping of (name, side) to list of str
        Surfaces in front of each side, from `obstructions`.
    stages : int
        Stages of all steps; those of a year of 15 min by SDIRK2 if not given.
    shades : ShadePairs, optional
        Pairs with shades, from `pairs_with_shades`.

    Returns
    -------
    float
        Measured: 10 ms for what a side sees of sky and ground, 0.035 us for each pair in each stage, half of
        which are at night; 1.4 us for near shades (95 slats before a window and its wall), 0.015 us for far
        ones. [s]

    Examples
    --------
    >>> round(expected_seconds({("south", "outside"): ["east", "west"]}), 4)
    0.0125
    """
    shades = shades or ShadePairs()
    pairs = sum(map(len, obstructed.values()))
    each = 3.5e-8 * pairs + 1.4e-6 * shades.near + 1.5e-8 * shades.far
    return 1e-2 * len(obstructed) + 0.5 * each * stages


def in_words(building: Description) -> str:
    """Say which surfaces shade each other; empty where no side faces sun and sky.

    Parameters
    ----------
    building : Description
        The building.

    Returns
    -------
    str
        Number of pairs and their names, and surfaces without vertices.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> in_words(box())
    'nothing shades: no surface outdoors has vertices'
    """
    sides = [side for surface in building.surfaces.values() for side in surface.sides]
    bare = undrawn(building)
    if not any(side.exposed.sun or side.exposed.sky for side in sides):
        return ""
    shades = pairs_with_shades(building)
    thin = f"; {sum(shades)} pairs with shades" if any(shades) else ""
    if not building.site.self_shading:
        cost = f", about {expected_seconds({}, shades=shades):.1g} s in a year" if any(shades) else ""
        return f"surfaces do not shade each other (site.self_shading: false){thin}{cost}"
    if all(surface.vertices is None for surface in building.surfaces.values()):
        return "nothing shades: no surface outdoors has vertices"
    missing = f"; without vertices, unshaded: {listed(bare)}" if bare else ""
    obstructed = obstructions(building)
    cost = f", about {expected_seconds(obstructed, shades=shades):.1g} s in a year"
    if not obstructed:
        return f"no surface stands in front of another{thin}{cost if any(shades) else ''}{missing}"
    pairs = sum(map(len, obstructed.values()))
    who = listed([f"{name} by {listed(obstacles)}" for (name, _), obstacles in obstructed.items()], "; ")
    return f"{pairs} pairs of surfaces ({who}){thin}{cost}{missing}"


def listed(names: list[str], between: str = ", ") -> str:
    """The first names, and how many more there are."""
    return between.join([*names[:_NAMES], *([f"{len(names) - _NAMES} more"] if len(names) > _NAMES else [])])


def undrawn(building: Description) -> list[str]:
    """Surfaces and windows outdoors without vertices, which nothing shades."""
    surfaces = [
        name
        for name, surface in building.surfaces.items()
        if surface.vertices is None and any(side.outdoors for side in surface.sides)
    ]
    windows = [
        name
        for name, window in building.windows.items()
        if window.vertices is None
        and window.reveal is None
        and window.overhang is None
        and building.surfaces[window.surface].outside.outdoors
    ]
    return surfaces + windows


def _can_obstruct(surface: Surface) -> bool:
    between_zones = all(side.zone is not None for side in surface.sides)
    return not between_zones and all(
        side.ground is None and side.soil is None and side.imposed is None for side in surface.sides
    )


def _outdoors(building: Description, polygons: dict[str, Polygon]) -> Iterator[tuple[SideName, Polygon]]:
    """Sides that see sun or sky, with their outline as seen from outdoors."""
    for name, polygon in polygons.items():
        surface = building.surfaces[name]
        for which, side in (("outside", surface.outside), ("inside", surface.inside)):
            if side.exposed.sun or side.exposed.sky:
                yield (name, which), polygon if which == "outside" else polygon.reversed()

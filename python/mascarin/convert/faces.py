"""Walls, roofs, floors and their openings, whichever class of object describes them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from mascarin.convert import geometry as g
from mascarin.convert.source import Item
from mascarin.convert.work import Work

#: Class of the surfaces that one kind of object describes, and what they face unless the object says it.
_DETAILED: Final = {
    "BuildingSurface:Detailed": "",
    "Wall:Detailed": "wall",
    "RoofCeiling:Detailed": "roof",
    "Floor:Detailed": "floor",
}
_SIMPLE: Final = {
    "Wall:Exterior": ("wall", "outdoors"),
    "Wall:Adiabatic": ("wall", "adiabatic"),
    "Wall:Underground": ("wall", "ground"),
    "Wall:Interzone": ("wall", "surface"),
    "Roof": ("roof", "outdoors"),
    "Ceiling:Adiabatic": ("ceiling", "adiabatic"),
    "Ceiling:Interzone": ("ceiling", "surface"),
    "Floor:GroundContact": ("floor", "ground"),
    "Floor:Adiabatic": ("floor", "adiabatic"),
    "Floor:Interzone": ("floor", "surface"),
}
SURFACES: Final = (*_DETAILED, *_SIMPLE)
_OPENINGS: Final = {
    "Window": ("window", False),
    "Door": ("door", False),
    "GlazedDoor": ("window", False),
    "Window:Interzone": ("window", True),
    "Door:Interzone": ("door", True),
    "GlazedDoor:Interzone": ("window", True),
}
OPENINGS: Final = ("FenestrationSurface:Detailed", *_OPENINGS)


@dataclass(frozen=True)
class Face:
    """A surface of a zone.

    Attributes
    ----------
    item : Item
        The object.
    zone : Item
        Its zone.
    shape : str
        ``wall``, ``floor``, ``roof`` or ``ceiling``.
    boundary, beyond : str
        Boundary condition, in small letters, and the object that it names.
    sun, wind : bool
        Whether it is exposed to sun and to wind.
    points : ndarray, shape (n, 3)
        Corners, counter-clockwise seen from outside. [m]
    """

    item: Item
    zone: Item
    shape: str
    boundary: str
    beyond: str
    sun: bool
    wind: bool
    points: g.Array


@dataclass(frozen=True)
class Opening:
    """A window or an opaque door in a surface.

    Attributes
    ----------
    item : Item
        The object.
    base : Face
        The surface that it is in.
    shape : str
        ``window``, ``door`` or another class in small letters.
    beyond : str
        Name of the same opening in the neighbour zone.
    points : ndarray, shape (n, 3)
        Corners, counter-clockwise seen from outside. [m]
    copies : int
        How many of it there are.
    """

    item: Item
    base: Face
    shape: str
    beyond: str
    points: g.Array
    copies: int


def faces(work: Work) -> list[Face]:
    """All surfaces of the zones.

    Raises
    ------
    InputError
        A surface without a zone, corners or a rectangle that cannot be used.
    """
    rules = g.rules_of(work.model)
    detailed = [_detailed(work, rules, item) for item in work.model.of(*_DETAILED)]
    return detailed + [_simple(work, rules, item) for item in work.model.of(*_SIMPLE)]


def _zone_of(work: Work, item: Item) -> Item:
    if not item.text("zone_name") and item.text("space_name"):
        space = work.model.require(item, "space_name", "Space")
        return work.model.require(space, "zone_name", "Zone")
    if not item.text("zone_name"):
        raise item.error("found no zone", "the name of a Zone in zone_name", "Add it, or remove the surface")
    return work.model.require(item, "zone_name", "Zone")


def _detailed(work: Work, rules: g.Rules, item: Item) -> Face:
    zone = _zone_of(work, item)
    points = g.frame_of(zone, rules, rules.relative).place(g.corners_of(item))
    shape = _DETAILED[item.kind] or item.word("surface_type")
    return Face(
        item=item,
        zone=zone,
        shape=shape or "wall",
        boundary=item.word("outside_boundary_condition") or "outdoors",
        beyond=item.text("outside_boundary_condition_object"),
        sun=item.word("sun_exposure") != "nosun",
        wind=item.word("wind_exposure") != "nowind",
        points=_checked(item, points[::-1] if rules.clockwise else points),
    )


def _simple(work: Work, rules: g.Rules, item: Item) -> Face:
    zone = _zone_of(work, item)
    frame = g.frame_of(zone, rules, rules.rectangles_relative)
    start = np.array([[item.number(f"starting_{axis}_coordinate") or 0.0 for axis in "xyz"]])
    azimuth = (item.number("azimuth_angle") or 0.0) + frame.rotation
    plane = g.plane_of(azimuth, item.needed("tilt_angle"))
    height = item.needed("width" if "width" in item.fields else "height")
    points = g.rectangle(frame.place(start)[0], plane, item.needed("length"), height)
    shape, boundary = _SIMPLE[item.kind]
    outdoors = boundary == "outdoors"
    beyond = item.text("outside_boundary_condition_object")
    return Face(item, zone, shape, boundary, beyond, outdoors, outdoors, _checked(item, points))


def _checked(item: Item, points: g.Array) -> g.Array:
    if len(points) < 3 or g.area_of(points) < 1e-6:
        raise item.error("vertices that enclose no area", "corners once around the surface", "Correct them")
    return points


def openings(work: Work, surfaces: list[Face]) -> list[Opening]:
    """All openings in the surfaces.

    Raises
    ------
    InputError
        An opening in a surface that does not exist, or corners that cannot be used.
    """
    by_name = {face.item.name.casefold(): face for face in surfaces}
    rules = g.rules_of(work.model)
    all_openings = []
    for item in work.model.of(*OPENINGS):
        base = by_name.get(item.word("building_surface_name"))
        if base is None:
            work.model.require(item, "building_surface_name", *SURFACES)
            raise item.error("no surface", "a surface", "Correct building_surface_name")
        all_openings.append(_opening(work, rules, item, base))
    return all_openings


def _opening(work: Work, rules: g.Rules, item: Item, base: Face) -> Opening:
    copies = max(1, round(item.number("multiplier") or 1.0))
    beyond = item.text("outside_boundary_condition_object")
    if item.kind == "FenestrationSurface:Detailed":
        points = g.frame_of(base.zone, rules, rules.relative).place(g.corners_of(item))
        points = points[::-1] if rules.clockwise else points
        shape = {"glassdoor": "window"}.get(item.word("surface_type"), item.word("surface_type"))
    else:
        plane = g.plane_through(base.points)
        along, above = (item.number(f"starting_{axis}_coordinate") or 0.0 for axis in "xz")
        start = g.lower_left(base.points) + along * plane.right + above * plane.up
        points = g.rectangle(start, plane, item.needed("length"), item.needed("height"))
        shape = _OPENINGS[item.kind][0]
    if float(g.normal_of(points) @ g.normal_of(base.points)) < 0.0:
        points = points[::-1]
    return Opening(item, base, shape, beyond, _checked(item, points), copies)


def floor_area(zone: Item, surfaces: list[Face]) -> float:
    """Floor area of a zone: as given, else the sum of its floors. [m2]"""
    entered_area = zone.number("floor_area")
    if entered_area is not None and entered_area > 0.0:
        return entered_area
    floors = (face for face in surfaces if face.zone is zone and face.shape == "floor")
    return sum(g.area_of(face.points) for face in floors)

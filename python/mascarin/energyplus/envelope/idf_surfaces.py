"""Walls, roofs, floors and their openings, whichever class of object describes them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from mascarin.energyplus.model import geometry as g
from mascarin.energyplus.model.context import Context
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject

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
#: Tilt above which EnergyPlus turns a roof or ceiling, and below which it turns a floor [deg].
_VERTICAL: Final = 90.0
#: Difference of view factors that is none, and view factor that is none [-].
_SAME_VIEW: Final = 0.005
_NO_VIEW: Final = 0.001
#: Tilt from which a plane sees the ground alone [deg].
_DOWN: Final = 179.0
OPENINGS: Final = ("FenestrationSurface:Detailed", *_OPENINGS)


@dataclass(frozen=True)
class IdfSurface:
    """A surface of a zone.

    Attributes
    ----------
    item : IdfObject
        The object.
    zone : IdfObject
        Its zone.
    shape : str
        ``wall``, ``floor``, ``roof`` or ``ceiling``.
    boundary, beyond : str
        Boundary condition, in small letters, and the object that it names.
    sun, wind : bool
        Whether it is exposed to sun and to wind.
    points : ndarray, shape (n, 3)
        Corners, counter-clockwise seen from outside. [m]
    ground : float or None
        View factor to the ground, where it is not that of the tilt. [-]
    """

    item: IdfObject
    zone: IdfObject
    shape: str
    boundary: str
    beyond: str
    sun: bool
    wind: bool
    points: g.Array
    ground: float | None = None


@dataclass(frozen=True)
class IdfOpening:
    """A window or an opaque door in a surface.

    Attributes
    ----------
    item : IdfObject
        The object.
    base : IdfSurface
        The surface that it is in.
    shape : str
        ``window``, ``door`` or another class in small letters.
    beyond : str
        Name of the same opening in the neighbour zone.
    points : ndarray, shape (n, 3)
        Corners, counter-clockwise seen from outside. [m]
    copies : int
        How many of it there are.
    ground : float or None
        View factor to the ground, where it is not that of the tilt. [-]
    """

    item: IdfObject
    base: IdfSurface
    shape: str
    beyond: str
    points: g.Array
    copies: int
    ground: float | None = None


@reads(*SURFACES)
def read_surfaces(context: Context) -> list[IdfSurface]:
    """All surfaces of the zones.

    Raises
    ------
    InputError
        A surface without a zone, corners or a rectangle that cannot be used.
    """
    rules = g.rules_of(context)
    detailed = [_detailed(context, rules, item) for item in context.model.of(*_DETAILED)]
    return detailed + [_simple(context, rules, item) for item in context.model.of(*_SIMPLE)]


@reads("Zone", "Space")
def _zone_of(context: Context, item: IdfObject) -> IdfObject:
    if not item.text("zone_name") and item.text("space_name"):
        space = context.model.require(item, "space_name", "Space")
        return context.model.require(space, "zone_name", "Zone")
    if not item.text("zone_name"):
        raise item.error("found no zone", "the name of a Zone in zone_name", "Add it, or remove the surface")
    return context.model.require(item, "zone_name", "Zone")


def _detailed(context: Context, rules: g.Rules, item: IdfObject) -> IdfSurface:
    zone = _zone_of(context, item)
    points = g.frame_of(zone, rules, rules.relative).place(g.corners_of(item))
    shape = _DETAILED[item.kind] or item.word("surface_type") or "wall"
    points = points[::-1] if rules.clockwise else points
    points = _upright(context, item, shape, _checked(item, points))
    outdoors = item.word("outside_boundary_condition") in ("outdoors", "")
    ground = _ground_view(item, points) if outdoors else None
    # No sun reaches what looks down and sees no ground.
    dark = ground is not None and ground <= _NO_VIEW and g.tilt_of(points) >= _DOWN
    return IdfSurface(
        item=item,
        zone=zone,
        shape=shape,
        boundary=item.word("outside_boundary_condition") or "outdoors",
        beyond=item.text("outside_boundary_condition_object"),
        sun=not dark and item.word("sun_exposure") != "nosun",
        wind=item.word("wind_exposure") != "nowind",
        points=points,
        ground=None if dark else ground,
    )


def _ground_view(item: IdfObject, points: g.Array) -> float | None:
    """View factor to the ground that the file states; None where it is that of the tilt. [-]"""
    stated = item.number("view_factor_to_ground")
    by_tilt = 0.5 * (1.0 - math.cos(math.radians(g.tilt_of(points))))
    return None if stated is None or abs(stated - by_tilt) <= _SAME_VIEW else min(max(stated, 0.0), 1.0)


def _simple(context: Context, rules: g.Rules, item: IdfObject) -> IdfSurface:
    zone = _zone_of(context, item)
    frame = g.frame_of(zone, rules, rules.rectangles_relative)
    start = np.array([[item.number(f"starting_{axis}_coordinate") or 0.0 for axis in "xyz"]])
    azimuth = (item.number("azimuth_angle") or 0.0) + frame.rotation
    plane = g.plane_of(azimuth, item.needed("tilt_angle"))
    height = item.needed("width" if "width" in item.fields else "height")
    points = g.rectangle(frame.place(start)[0], plane, item.needed("length"), height)
    shape, boundary = _SIMPLE[item.kind]
    outdoors = boundary == "outdoors"
    beyond = item.text("outside_boundary_condition_object")
    if boundary == "surface" and context.model.of_any_class(beyond, *SURFACES) is None:
        # Such a surface may name a zone in place of a surface.
        boundary = "surface" if context.model.of_any_class(beyond, "Zone") is None else "zone"
        if boundary == "zone" and item.kind == "Ceiling:Interzone":
            context.findings.approximated(
                item,
                f"the zone '{beyond}' as its other side",
                "heat passes to that zone, as EnergyPlus describes it; EnergyPlus 25.2 lets none "
                "through, and gives that zone no floor: about 3 K in two rooms one above the other",
            )
    points = _upright(context, item, shape, _checked(item, points))
    return IdfSurface(item, zone, shape, boundary, beyond, outdoors, outdoors, points)


def _upright(context: Context, item: IdfObject, shape: str, points: g.Array) -> g.Array:
    """Corners of a surface; those of a roof that looks down, or a floor that looks up, turned round."""
    tilt = g.tilt_of(points)
    if (shape in ("roof", "ceiling") and tilt > _VERTICAL) or (shape == "floor" and tilt < _VERTICAL):
        context.findings.approximated(
            item, f"a {shape} with a tilt of {tilt:.0f} deg", "its corners are turned round, as in EnergyPlus"
        )
        return points[::-1]
    return points


def turned(surface: IdfSurface, zone: IdfObject) -> IdfSurface:
    """The other side of a surface, in another zone."""
    shape = {"floor": "ceiling", "ceiling": "floor", "roof": "floor"}.get(surface.shape, surface.shape)
    return replace(surface, zone=zone, shape=shape, beyond=surface.zone.name, points=surface.points[::-1])


def _checked(item: IdfObject, points: g.Array) -> g.Array:
    if len(points) < 3 or g.area_of(points) < 1e-6:
        raise item.error("vertices that enclose no area", "corners once around the surface", "Correct them")
    return points


@reads(*OPENINGS)
def read_openings(context: Context, surfaces: list[IdfSurface]) -> list[IdfOpening]:
    """All openings in the surfaces.

    Raises
    ------
    InputError
        An opening in a surface that does not exist, or corners that cannot be used.
    """
    by_name = {surface.item.name.casefold(): surface for surface in surfaces}
    rules = g.rules_of(context)
    all_openings = []
    for item in context.model.of(*OPENINGS):
        base = by_name.get(item.word("building_surface_name"))
        if base is None:
            context.model.require(item, "building_surface_name", *SURFACES)
            raise item.error("no surface", "a surface", "Correct building_surface_name")
        if base.boundary == "adiabatic":
            raise item.error(
                f"building_surface_name: found '{base.item.name}', which is adiabatic",
                "a surface that heat passes, as in EnergyPlus",
                "Remove the opening, or give the surface another boundary condition",
            )
        opening = _opening(context, rules, item, base)
        if base.boundary.startswith("otherside") and opening.shape in ("window", "glassdoor"):
            raise item.error(
                f"building_surface_name: found '{base.item.name}', whose other side is given",
                "a surface outdoors or between zones, as in EnergyPlus",
                "Remove the window, or give the surface another boundary condition",
            )
        all_openings.append(opening)
    return all_openings


def _opening(context: Context, rules: g.Rules, item: IdfObject, base: IdfSurface) -> IdfOpening:
    copies, ground = max(1, round(item.number("multiplier") or 1.0)), None
    beyond = item.text("outside_boundary_condition_object")
    if item.kind == "FenestrationSurface:Detailed":
        points = g.frame_of(base.zone, rules, rules.relative).place(g.corners_of(item))
        points = points[::-1] if rules.clockwise else points
        if base.boundary == "outdoors":
            ground = _ground_view(item, base.points)
        shape = {"glassdoor": "window"}.get(item.word("surface_type"), item.word("surface_type"))
    else:
        plane = g.plane_through(base.points)
        along, above = (item.number(f"starting_{axis}_coordinate") or 0.0 for axis in "xz")
        start = g.lower_left(base.points) + along * plane.right + above * plane.up
        points = g.rectangle(start, plane, item.needed("length"), item.needed("height"))
        shape = _OPENINGS[item.kind][0]
    if float(g.normal_of(points) @ g.normal_of(base.points)) < 0.0:
        points = points[::-1]
    return IdfOpening(item, base, shape, beyond, _checked(item, points), copies, ground)


def floor_area(zone: IdfObject, surfaces: list[IdfSurface]) -> float:
    """Floor area of a zone: as given, else the sum of its floors. [m2]

    Parameters
    ----------
    zone : IdfObject
        The zone.
    surfaces : list of IdfSurface
        Its surfaces.
    """
    entered_area = zone.number("floor_area")
    if entered_area is not None and entered_area > 0.0:
        return entered_area
    return sum(g.area_of(surface.points) for surface in surfaces if surface.shape == "floor")

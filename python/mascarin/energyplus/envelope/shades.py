"""Overhangs, fins, neighbouring buildings and other shading surfaces."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from mascarin.building.geometry import Polygon
from mascarin.energyplus.envelope.idf_surfaces import SURFACES, IdfOpening, IdfSurface
from mascarin.energyplus.envelope.setbacks import setback, shift_of_shades
from mascarin.energyplus.model import geometry as g
from mascarin.energyplus.model.context import Context
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject
from mascarin.energyplus.model.schedules import SCHEDULES, year
from mascarin.errors import InputError

_DETAILED: Final = ("Shading:Site:Detailed", "Shading:Building:Detailed", "Shading:Zone:Detailed")
_SIMPLE: Final = ("Shading:Site", "Shading:Building")
_ATTACHED: Final = (
    "Shading:Overhang", "Shading:Overhang:Projection", "Shading:Fin", "Shading:Fin:Projection",
)  # fmt: skip
#: Mean transmittance above which a shade is left out rather than taken as opaque [-].
_OPAQUE_BELOW: Final = 0.5


@reads(*_DETAILED, *_SIMPLE, *_ATTACHED)
def describe_shades(context: Context, surfaces: list[IdfSurface], openings: list[IdfOpening]) -> None:
    """Enter all shading surfaces.

    Raises
    ------
    InputError
        A shade of a window or surface that does not exist.
    """
    rules, by_face = (
        g.rules_of(context),
        {surface.item.name.casefold(): surface for surface in surfaces},
    )
    by_opening = {opening.item.name.casefold(): opening for opening in openings}
    for item in context.model.of(*_DETAILED):
        points = _detailed(context, rules, item, by_face, openings)
        if _opaque(context, item):
            _enter(context, item, item.name, points)
    for item in context.model.of(*_SIMPLE):
        _enter(context, item, item.name, _simple(rules, item))
    for kind in _ATTACHED:
        outlines_of = _fins if "Fin" in kind else _overhang
        for item in context.model.of(kind):
            window = by_opening.get(item.word("window_or_door_name"))
            if window is None:
                raise item.error(
                    f"window_or_door_name: found '{item.text('window_or_door_name')}'",
                    "a window or door of the file",
                    "Correct it",
                )
            for name, points in outlines_of(item, window.points + setback(window)):
                _enter(context, item, name, points)
    _reflectances(context)


def _detailed(
    context: Context,
    rules: g.Rules,
    item: IdfObject,
    by_face: dict[str, IdfSurface],
    openings: list[IdfOpening],
) -> g.Array:
    corners = g.corners_of(item)
    if item.kind == "Shading:Site:Detailed":
        return corners
    if item.kind == "Shading:Building:Detailed":
        return g.frame_of(None, rules, rules.relative).place(corners)
    base = by_face.get(item.word("base_surface_name"))
    if base is None:
        context.model.require(item, "base_surface_name", *SURFACES)
        raise item.error("no surface", "a surface", "Correct base_surface_name")
    placed = g.frame_of(base.zone, rules, rules.relative).place(corners)
    return placed + shift_of_shades(base, openings)


def _simple(rules: g.Rules, item: IdfObject) -> g.Array:
    moved = item.kind == "Shading:Building" and rules.rectangles_relative
    frame = g.frame_of(None, rules, moved)
    start = np.array([[item.number(f"starting_{axis}_coordinate") or 0.0 for axis in "xyz"]])
    plane = g.plane_of(
        (item.number("azimuth_angle") or 0.0) + frame.rotation, item.number("tilt_angle") or 0.0
    )
    return g.rectangle(frame.place(start)[0], plane, item.needed("length"), item.needed("height"))


@reads(*SCHEDULES)
def _opaque(context: Context, item: IdfObject) -> bool:
    """Whether a shade is carried over as an opaque one."""
    if not item.text("transmittance_schedule_name"):
        return True
    if context.model.named(item.text("transmittance_schedule_name"), *SCHEDULES) is None:
        context.model.require(item, "transmittance_schedule_name", *SCHEDULES)
    values = year(context, item, "transmittance_schedule_name", default=0.0)
    transmittance = values.constant
    if transmittance == 0.0:
        return True
    mean = values.mean()
    if mean > _OPAQUE_BELOW:
        context.findings.left_out(
            item, f"a transmittance of {mean:.2f}", "it shades nothing: more sun on what it shades"
        )
        return False
    context.findings.left_out(
        item, f"a transmittance of {mean:.2f}", "it is opaque: less sun on what it shades"
    )
    return True


def _enter(context: Context, item: IdfObject, name: str, points: g.Array) -> None:
    points = g.without_repeats(points)
    try:
        Polygon.of(name, g.rounded(points))
    except InputError as error:
        context.findings.left_out(item, str(error).split("; expected")[0], "it shades nothing")
        return
    context.section("shades")[context.names.of("shades", name)] = {"vertices": g.rounded(points)}


def _edges(points: g.Array) -> tuple[g.Plane, g.Array, float, float]:
    """Plane, lower left corner, width and height of a window."""
    plane = g.plane_through(points)
    along, above = points @ plane.right, points @ plane.up
    return plane, g.lower_left(points), float(np.ptp(along)), float(np.ptp(above))


def _overhang(item: IdfObject, points: g.Array) -> Iterator[tuple[str, g.Array]]:
    plane, corner, width, height = _edges(points)
    left_extension, right_extension, above = (
        item.number(key) or 0.0
        for key in (
            "left_extension_from_window_door_width",
            "right_extension_from_window_door_width",
            "height_above_window_or_door",
        )
    )
    depth = _depth(item, "depth", height)
    reach = _leaning(item, "tilt_angle_from_window_door", plane.up, plane.out) * depth
    start = corner - left_extension * plane.right + (height + above) * plane.up
    along = (width + left_extension + right_extension) * plane.right
    if depth > 0.0:
        yield item.name, np.array([start, start + along, start + along + reach, start + reach])


def _fins(item: IdfObject, points: g.Array) -> Iterator[tuple[str, g.Array]]:
    plane, corner, width, height = _edges(points)
    for side, sign, edge in (("left", -1.0, 0.0), ("right", 1.0, width)):
        depth = _depth(item, f"{side}_depth", width)
        if depth <= 0.0:
            continue
        beside = item.number(f"{side}_extension_from_window_door") or 0.0
        top = item.number(f"{side}_distance_above_top_of_window") or 0.0
        below = item.number(f"{side}_distance_below_bottom_of_window") or 0.0
        angle = f"{side}_tilt_angle_from_window_door"
        reach = _leaning(item, angle, sign * plane.right, plane.out) * depth
        start = corner + (edge + sign * beside) * plane.right - below * plane.up
        up = (height + top + below) * plane.up
        yield f"{item.name} {side}", np.array([start, start + up, start + up + reach, start + reach])


def _depth(item: IdfObject, key: str, size: float) -> float:
    """Depth of a shade, given in metres or as a fraction of the height or width of the window. [m]"""
    if not item.kind.endswith("Projection"):
        return item.number(key) or 0.0
    fraction = {
        "depth": "depth_as_fraction_of_window_door_height",
        "left_depth": "left_depth_as_fraction_of_window_door_width",
        "right_depth": "right_depth_as_fraction_of_window_door_width",
    }[key]
    return (item.number(fraction) or 0.0) * size


def _leaning(item: IdfObject, key: str, along: g.Array, out: g.Array) -> g.Array:
    tilt = item.number(key)
    angle = math.radians(90.0 if tilt is None else tilt)
    direction: g.Array = math.cos(angle) * along + math.sin(angle) * out
    return direction


@reads("Building", "ShadingProperty:Reflectance")
def _reflectances(context: Context) -> None:
    building = context.model.one("Building")
    reflects = building is not None and "reflections" in building.word("solar_distribution")
    for item in context.model.of("ShadingProperty:Reflectance"):
        if reflects:
            context.findings.left_out(item, "reflections from it", "less sun on the surfaces that it faces")
        else:
            context.findings.no_effect([item], "reflectance", "EnergyPlus uses it only with reflections")
    if building is not None and reflects:
        context.findings.left_out(
            building, "reflections from surfaces outdoors", "the ground and the sky alone reflect and emit"
        )

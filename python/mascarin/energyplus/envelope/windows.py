"""Windows with their frames, and opaque doors."""

from __future__ import annotations

from typing import Final

import numpy as np

from mascarin.building.geometry import Polygon
from mascarin.energyplus.envelope.blinds import describe_blinds
from mascarin.energyplus.envelope.constructions import construction
from mascarin.energyplus.envelope.convection import ConvectionCoefficients
from mascarin.energyplus.envelope.glazings import construction_of, glazing
from mascarin.energyplus.envelope.idf_surfaces import IdfOpening
from mascarin.energyplus.envelope.materials import skin
from mascarin.energyplus.envelope.setbacks import describe_setback, setback
from mascarin.energyplus.envelope.surfaces import Surfaces
from mascarin.energyplus.model import geometry as g
from mascarin.energyplus.model.context import Context, Section
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject
from mascarin.errors import InputError

_WINDOWS: Final = ("window", "glassdoor")
#: Surface resistances that the U value of a frame contains (ISO 10077) [m2 K/W].
_FILMS: Final = 0.17
#: Largest U value of a frame in a description [W/(m2 K)].
_MAX_FRAME_U_VALUE: Final = 5.8
#: Width [m], U value [W/(m2 K)], absorptance and emissivity [-] of a frame.
FrameData = tuple[float, float, float, float]
#: Area [m2], U value [W/(m2 K)], absorptance and emissivity [-] of dividers.
Bars = tuple[float, float, float, float]
#: Corners of a window whose dividers are counted.
_CORNERS: Final = 4


def describe_openings(
    context: Context, openings: list[IdfOpening], coefficients: ConvectionCoefficients, surfaces: Surfaces
) -> None:
    """Enter all windows, and doors as surfaces of their own.

    Raises
    ------
    InputError
        A construction that does not exist.
    """
    names = {opening.item.name.casefold() for opening in openings}
    doors: dict[str, list[g.Array]] = {}
    for opening in openings:
        if opening.shape == "door":
            doors.setdefault(opening.base.item.name.casefold(), []).append(opening.points)
    for opening in openings:
        if opening.base.item.name.casefold() in surfaces.reversed_names:
            if opening.beyond.casefold() not in names:
                context.findings.left_out(
                    opening.item, "an opening on one side of an interior wall", "the wall has no opening"
                )
            continue
        if opening.shape in _WINDOWS:
            _window(context, opening, coefficients, surfaces, doors)
        elif opening.shape == "door":
            _door(context, opening, coefficients, surfaces)
        else:
            context.findings.left_out(
                opening.item, f"a {opening.shape}", "its wall is opaque there: no daylight and no sun enters"
            )
    describe_blinds(context)


def _window(
    context: Context,
    opening: IdfOpening,
    coefficients: ConvectionCoefficients,
    surfaces: Surfaces,
    doors: dict[str, list[g.Array]],
) -> None:
    item, base = opening.item, opening.base
    wall = surfaces.placed[base.item.name.casefold()]
    outdoors = bool(context.section("surfaces")[wall]["outside"].get("outdoors"))
    if not outdoors and base.boundary not in ("surface", "zone"):
        context.findings.left_out(item, f"a window in a wall to {base.boundary}", "the wall has no window")
        return
    if outdoors and not base.sun:
        context.findings.approximated(item, "a window in a wall without sun", "the sun shines on the window")
    glazed = glazing(context, item, construction_of(context, item))
    if glazed is None:
        return
    frame = _frame_of(context, item) or glazed.frame
    points = g.without_repeats(opening.points + setback(opening))
    free = not any(_overlap(points, door) for door in doors.get(base.item.name.casefold(), []))
    if not free:
        context.findings.approximated(
            item, "a window over a door", "its area alone is taken from the wall, as in EnergyPlus"
        )
    shape = _glazed_shape(
        context,
        opening,
        points,
        (frame, _dividers_of(context, opening)),
        free and surfaces.has_vertices[wall],
    )
    coefficient = coefficients.outside(item, base.zone, "very_smooth")
    tilt = g.tilt_of(base.points)
    window: Section = {"surface": wall, "glazing": glazed.name, **shape}
    if outdoors:
        # EnergyPlus adds long-wave radiation to a combined coefficient on windows, not on walls.
        window["outside"] = {"convection": coefficient.convection}
        window["outside"] |= {} if opening.ground is None else {"ground_view": opening.ground}
    else:
        window["outside"] = {"convection": coefficients.inside(item, base.zone, tilt, window=True)}
    window["inside"] = {"convection": coefficients.inside(item, base.zone, tilt, window=True)}
    context.section("windows")[context.names.of("windows", item.name)] = window


def _glazed_shape(
    context: Context,
    opening: IdfOpening,
    points: g.Array,
    opaque: tuple[FrameData | None, Bars | None],
    has_vertices: bool,
) -> Section:
    """Corners, area and frame of a window; the glass of EnergyPlus lies inside its frame, dividers on it."""
    glass = g.area_of(opening.points)
    shape: Section = {}
    frame, bars = opaque
    outline = points if frame is None else _framed(points, frame[0])
    outer_area = glass if frame is None else g.area_of(outline)
    parts = [] if frame is None else [(outer_area - glass, *frame[1:])]
    parts += [] if bars is None else [bars]
    covered = sum(part[0] for part in parts)
    if covered > 0.0:
        u_value, absorptance, emissivity = (
            sum(part[0] * part[k] for part in parts) / covered for k in (1, 2, 3)
        )
        shape["frame"] = {
            "fraction": round(covered / outer_area, 9),
            "u_value": min(round(u_value, 9), _MAX_FRAME_U_VALUE),
            "absorptance": round(absorptance, 9),
            "emissivity": round(emissivity, 9),
        }
        glass = outer_area
    total = round(glass * opening.copies, 6)
    if not has_vertices or not _accepted(opening, outline):
        if has_vertices:
            context.findings.approximated(
                opening.item, "corners outside of its wall", "its area alone: nothing shades it"
            )
        return {"area": total} | shape
    describe_setback(context, opening, outline)
    shape = {"vertices": g.rounded(outline), **shape}
    if opening.copies > 1:
        context.findings.approximated(
            opening.item,
            f"{opening.copies} windows",
            "one window of their area, with the shadows of the first",
        )
        shape["area"] = total
    return shape


def _accepted(opening: IdfOpening, points: g.Array) -> bool:
    try:
        wall = Polygon.of("wall", g.rounded(g.without_repeats(opening.base.points)))
        return bool(wall.contains(Polygon.of(opening.item.name, g.rounded(points))))
    except InputError:
        return False


def _overlap(first: g.Array, second: g.Array) -> bool:
    try:
        outlines = [Polygon.of("opening", g.rounded(points)) for points in (first, second)]
    except InputError:
        return False
    return bool(outlines[0].overlaps(outlines[1]))


def _framed(points: g.Array, width: float) -> g.Array:
    """A polygon with a strip of a width around it. [m]"""
    normal = g.normal_of(points)
    normal = normal / np.linalg.norm(normal)
    count = len(points)
    moved = []
    for k in range(count):
        before = points[k] - points[k - 1]
        after = points[(k + 1) % count] - points[k]
        sides = [np.cross(edge / np.linalg.norm(edge), normal) for edge in (before, after)]
        # The corner moves so that both edges move outwards by the width.
        moved.append(points[k] + width * (sides[0] + sides[1]) / (1.0 + float(sides[0] @ sides[1])))
    return np.array(moved)


@reads("WindowProperty:FrameAndDivider")
def _frame_of(context: Context, item: IdfObject) -> FrameData | None:
    if not item.text("frame_and_divider_name"):
        return None
    frame = context.model.require(item, "frame_and_divider_name", "WindowProperty:FrameAndDivider")
    width, conductance = frame.number("frame_width") or 0.0, frame.number("frame_conductance")
    if width <= 0.0:
        return None
    if not conductance:
        raise frame.error("a frame without frame_conductance", "a conductance [W/(m2 K)]", "Add it")
    for key in ("frame_outside_projection", "frame_inside_projection", "inside_reveal_depth"):
        if frame.number(key):
            context.findings.approximated(frame, key.replace("_", " "), "it neither shades nor adds surface")
    return (
        width,
        1.0 / (1.0 / conductance + _FILMS),
        frame.number("frame_solar_absorptance") or 0.7,
        frame.number("frame_thermal_hemispherical_emissivity") or 0.9,
    )


@reads("WindowProperty:FrameAndDivider")
def _dividers_of(context: Context, opening: IdfOpening) -> Bars | None:
    """Dividers on the glass: they cover a part of it; None without, or where they are listed."""
    item = opening.item
    if not item.text("frame_and_divider_name"):
        return None
    frame = context.model.require(item, "frame_and_divider_name", "WindowProperty:FrameAndDivider")
    width = frame.number("divider_width") or 0.0
    across, upright = (
        round(frame.number(f"number_of_{way}_dividers") or 0.0) for way in ("horizontal", "vertical")
    )
    if width <= 0.0 or across + upright == 0:
        return None
    conductance = frame.number("divider_conductance")
    if frame.word("divider_type") == "suspended" or len(opening.points) != _CORNERS or not conductance:
        context.findings.left_out(
            item, "dividers", "more sun enters, by their fraction of the glass, and less heat is conducted"
        )
        return None
    edges = [float(np.linalg.norm(opening.points[k + 1] - opening.points[k])) for k in range(2)]
    # The edge that is less steep is the width of the window.
    rises = [abs(float(opening.points[k + 1][2] - opening.points[k][2])) / edges[k] for k in range(2)]
    horizontal, vertical = edges if rises[0] < rises[1] else edges[::-1]
    area = width * (across * horizontal + upright * vertical - across * upright * width)
    for key in ("divider_outside_projection", "divider_inside_projection"):
        if frame.number(key):
            context.findings.approximated(frame, key.replace("_", " "), "it neither shades nor adds surface")
    return (
        min(area, 0.99 * g.area_of(opening.points)),
        1.0 / (1.0 / conductance + _FILMS),
        frame.number("divider_solar_absorptance") or 0.0,
        frame.number("divider_thermal_hemispherical_emissivity") or 0.9,
    )


def _door(
    context: Context, opening: IdfOpening, coefficients: ConvectionCoefficients, surfaces: Surfaces
) -> None:
    """An opaque door: a surface that lies in its wall."""
    wall_name = surfaces.placed[opening.base.item.name.casefold()]
    wall = context.section("surfaces")[wall_name]
    door_construction = construction_of(context, opening.item)
    points = g.without_repeats(opening.points + setback(opening))
    if not surfaces.has_vertices[wall_name] or not _accepted(opening, points):
        context.findings.left_out(
            opening.item, "a door whose wall has no corners here", "it has the construction of the wall"
        )
        return
    if np.any(setback(opening)):
        context.findings.approximated(opening.item, "a door beside the plane of its wall", "in this plane")
    if opening.copies > 1:
        context.findings.left_out(opening.item, f"{opening.copies} doors", "there is one of them")
    sides = {}
    for side, outer in (("outside", True), ("inside", False)):
        film_values = {
            key: value for key, value in skin(context, door_construction, outer).items() if key in wall[side]
        }
        sides[side] = wall[side] | film_values
    if opening.base.boundary == "outdoors":
        coefficient = coefficients.outside(
            opening.item, opening.base.zone, skin(context, door_construction, outer=True)["roughness"]
        )
        sides["outside"]["convection"] = coefficient.convection
        sides["outside"].pop("ground_view", None)
        if opening.ground is not None and "absorptance" in sides["outside"]:
            sides["outside"]["ground_view"] = opening.ground
    cut = bool(wall["outside"].get("adiabatic"))
    context.section("surfaces")[context.names.of("surfaces", opening.item.name)] = {
        "construction": construction(context, door_construction, cut=cut, finite_differences=False),
        "vertices": g.rounded(points),
        **sides,
    }

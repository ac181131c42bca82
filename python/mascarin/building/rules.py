"""What must hold between the parts of a building; each rule yields the faults it finds."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from itertools import takewhile
from typing import TYPE_CHECKING

from mascarin.building.convection import Doe2, Mowitt, Tarp
from mascarin.building.derived import drawn_areas, faces_of, outlines, shade_outlines, window_outlines
from mascarin.building.material import Resistance
from mascarin.building.part import fault
from mascarin.building.schedule import DAYS, Piece
from mascarin.building.surface import NoLongwave, Side
from mascarin.building.window import windows_of
from mascarin.building.zone import GivenSun, TracedSun
from mascarin.building.zone_surfaces import ZoneFace, zone_faces
from mascarin.errors import did_you_mean

if TYPE_CHECKING:
    from pydantic_core import InitErrorDetails

    from mascarin.building.description import Description
    from mascarin.building.geometry import Polygon
    from mascarin.building.window import Window
    from mascarin.building.zone import IdealLoads

Faults = Iterator["InitErrorDetails"]

#: Row sums of given view factors may miss one by this much; the engine closes the rest [-].
VIEW_CLOSURE = 0.05
#: Given shares of the sun may miss one by their rounding; the engine scales them [-].
SHARE_CLOSURE = 0.02


def faults(building: Description) -> Faults:
    """All faults between the parts of a building."""
    yield from _something_to_simulate(building)
    yield from _one_namespace(building)
    yield from _layers_have_what_they_need(building)
    yield from _zones_have_faces(building)
    yield from _emissivities_where_exchange_is(building)
    yield from _films_suit_their_side(building)
    yield from _sensors_inside_walls(building)
    yield from _columns_have_one_meaning(building)
    yield from _view_factors_close(building)
    yield from _schedules_suit_their_use(building)
    yield from _set_points_apart(building)
    yield from _windows_lie_in_walls(building)
    yield from _sun_finds_faces(building)
    yield from _shades_find_faces(building)


def _something_to_simulate(building: Description) -> Faults:
    if not building.surfaces:
        yield fault(
            ("surfaces",), "no surfaces", "at least one surface", "Describe the walls under 'surfaces:'."
        )


def _one_namespace(building: Description) -> Faults:
    sections: dict[str, Mapping[str, object]] = {
        "zones": building.zones,
        "surfaces": building.surfaces,
        "windows": building.windows,
        "sensors": building.sensors,
    }
    owner: dict[str, str] = {}
    for section, named in sections.items():
        for name in named:
            if name in owner:
                yield fault(
                    (section, name),
                    f"'{name}' also under '{owner[name]}:'",
                    "a name that no zone, surface, window or sensor shares",
                    "Rename one: results are called by this name.",
                )
            owner.setdefault(name, section)


def _layers_have_what_they_need(building: Description) -> Faults:
    for name, construction in building.constructions.items():
        for index, layer in enumerate(construction.layers):
            at = ("constructions", name, "layers", index)
            bare = isinstance(building.materials[layer.material], Resistance)
            if not bare and layer.thickness is None:
                yield fault(
                    (*at, "thickness"), "nothing", "thickness of the layer, above 0 [m]", "Add 'thickness:'."
                )
            for key in ("thickness", "nodes"):
                if bare and getattr(layer, key) is not None:
                    yield fault(
                        (*at, key),
                        f"'{key}' of '{layer.material}'",
                        "none: the material is a bare resistance",
                        f"Remove '{key}:', or give the material conductivity, density and specific_heat.",
                    )


def _zones_have_faces(building: Description) -> Faults:
    for zone in building.zones:
        if not faces_of(zone, building.surfaces):
            yield fault(
                ("zones", zone),
                "a zone that no surface faces",
                "at least one side with 'zone: " + zone + "'",
                "Add a surface that faces it, or remove the zone.",
            )


def _sides(building: Description) -> Iterator[tuple[tuple[str, str, str], Side]]:
    for name, surface in building.surfaces.items():
        for which, side in (("outside", surface.outside), ("inside", surface.inside)):
            yield ("surfaces", name, which), side


def _emissivities_where_exchange_is(building: Description) -> Faults:
    for at, side in _sides(building):
        if side.zone is None:
            continue
        exchange = not isinstance(building.zones[side.zone].longwave, NoLongwave)
        if exchange and side.emissivity is None:
            yield fault(
                (*at, "emissivity"),
                "nothing",
                f"long-wave emissivity, above 0 and at most 1 [-]: zone '{side.zone}' exchanges long-wave",
                f"Add 'emissivity:', or write 'longwave: none' in zone '{side.zone}'.",
            )


def _films_suit_their_side(building: Description) -> Faults:
    for at, side in _sides(building):
        if isinstance(side.convection, Tarp | Mowitt) and (side.measured or side.ground):
            yield fault(
                (*at, "convection"),
                f"'{side.convection.kind}' on a side facing {side.faces}",
                "a film that suits an imposed temperature: a number, linear_wind, alamdari_hammond or power",
                "Write the film coefficient of that air.",
            )
        if isinstance(side.convection, Doe2) and not side.outdoors:
            yield fault(
                (*at, "convection"),
                f"'doe2' on a side facing {side.faces}",
                "a film without wind",
                "Write 'tarp', whose buoyant part it has, or a film that suits this side.",
            )
        if isinstance(side.convection, Tarp) and not side.outdoors:
            for key in ("roughness", "perimeter"):
                if getattr(side.convection, key) is not None:
                    yield fault(
                        (*at, "convection", key),
                        f"'{key}' on a side facing {side.faces}",
                        "none: it belongs to the wind's part",
                        f"Remove '{key}:'.",
                    )


def _sensors_inside_walls(building: Description) -> Faults:
    for name, sensor in building.sensors.items():
        layers = building.constructions[building.surfaces[sensor.surface].construction].layers
        thickness = sum(layer.thickness or 0.0 for layer in layers)
        if sensor.depth > thickness * (1.0 + 1e-9):
            yield fault(
                ("sensors", name, "depth"),
                f"{sensor.depth:g} m",
                f"at most {thickness:g} m, the thickness of '{sensor.surface}'",
                "Depth counts from the outside face.",
            )


def _columns_have_one_meaning(building: Description) -> Faults:
    temperatures = {side.measured for _, side in _sides(building)} - {None}
    for at, side in _sides(building):
        if side.irradiance is not None and side.irradiance in temperatures:
            yield fault(
                (*at, "irradiance"),
                f"'{side.irradiance}', which is a measured temperature elsewhere",
                "a column of irradiance [W/m2]",
                "Name the right column.",
            )


def _view_factors_close(building: Description) -> Faults:
    for zone in building.zones:
        given = building.zones[zone].view_factors
        if given is None:
            continue
        names = face_names(zone_faces(zone, building.surfaces, building.windows))
        for row, factors in given.items():
            at = ("zones", zone, "view_factors", row)
            if row not in names:
                yield fault(at, f"'{row}'", "a face of this zone", did_you_mean(row, names))
            for column in factors:
                if column not in names:
                    yield fault(
                        (*at, column), f"'{column}'", "a face of this zone", did_you_mean(column, names)
                    )
            total = sum(factors.values())
            if abs(total - 1.0) > VIEW_CLOSURE:
                yield fault(
                    at,
                    f"a sum of {total:.3f}",
                    "view factors from one face that sum to 1",
                    "Complete the row.",
                )
        for name in names:
            if name not in given:
                yield fault(
                    ("zones", zone, "view_factors"),
                    f"no row '{name}'",
                    "a row for each face",
                    f"Add '{name}:'.",
                )


def face_names(faces: list[ZoneFace]) -> list[str]:
    """Names of the faces of a zone; with the side, or ``frame``, where a part has two."""
    count: Mapping[str, int] = Counter(face.name for face in faces)
    names: list[str] = []
    for face in faces:
        if count[face.name] == 1 or (face.name not in names and face.window is not None):
            names.append(face.name)
        else:
            names.append(f"{face.name}.{'frame' if face.window is not None else face.side}")
    return names


def _windows_lie_in_walls(building: Description) -> Faults:
    if not building.windows:
        return
    drawn = outlines(building.surfaces)
    for name, window in building.windows.items():
        wall, at = building.surfaces[window.surface], ("windows", name)
        if not wall.outside.outdoors or wall.inside.zone is None:
            yield fault(
                (*at, "surface"),
                f"'{window.surface}', from {wall.outside.faces} to {wall.inside.faces}",
                "a wall from outdoors (outside) to a zone (inside)",
                "Put the window into such a wall; sun is followed from outdoors into a zone only.",
            )
        if window.vertices is None:
            continue
        outline = drawn.get(window.surface)
        if outline is None:
            yield fault(
                (*at, "vertices"),
                f"vertices in '{window.surface}', which has none",
                "a wall with vertices",
                "Give the wall vertices, or the window an area.",
            )
            continue
        polygon = window_outlines({name: window})[name]
        if not outline.contains(polygon):
            yield fault((*at, "vertices"), *_outside_its_wall(polygon, outline))
        yield from _beside_the_others(building, name, polygon, drawn)
    for name, surface in building.surfaces.items():
        inside = dict(windows_of(name, building.windows))
        if not inside:
            continue
        gross = float(surface.area or drawn_areas(building.surfaces).get(name, 0.0))
        areas = {one: _window_area(one, window) for one, window in inside.items()}
        if sum(areas.values()) >= gross:
            listed = ", ".join(f"{one} {area:.2f}" for one, area in areas.items())
            yield fault(
                ("windows", max(areas, key=lambda one: areas[one]), "area"),
                f"{sum(areas.values()):.2f} m2 of windows ({listed})",
                f"less than the {gross:.2f} m2 of their wall '{name}'",
                "The area of a wall is gross: its windows lie in it.",
            )


def _beside_the_others(
    building: Description, name: str, polygon: Polygon, walls: dict[str, Polygon]
) -> Faults:
    """A window overlaps no window before it, and no wall but its own and what that lies in."""
    own = walls[building.windows[name].surface]
    before = takewhile(lambda one: one != name, building.windows)
    others = window_outlines({one: building.windows[one] for one in before})
    others |= {wall: outline for wall, outline in walls.items() if not outline.contains(own)}
    for other, outline in others.items():
        if polygon.overlaps(outline):
            yield fault(
                ("windows", name, "vertices"),
                f"a window that overlaps '{other}'",
                "windows, doors and walls side by side",
                "Move its corners.",
            )


def _window_area(name: str, window: Window) -> float:
    if window.area is not None:
        return float(window.area)
    return window_outlines({name: window})[name].area


def _outside_its_wall(window: Polygon, wall: Polygon) -> tuple[str, str, str]:
    off = float(max(abs(wall.height_of(window.points))))
    if float(window.normal @ wall.normal) < 0.0:
        return (
            "corners in the wrong order",
            f"corners counter-clockwise seen from outside, as those of '{wall.name}'",
            "Reverse them.",
        )
    if off > 1e-3:
        return f"a corner {off:.3f} m off the plane of '{wall.name}'", "corners in that plane", "Move it."
    return (
        f"corners outside the outline of '{wall.name}'",
        "a window that lies in its wall",
        "Compare the coordinates of both.",
    )


def _sun_finds_faces(building: Description) -> Faults:
    for zone, definition in building.zones.items():
        faces = zone_faces(zone, building.surfaces, building.windows)
        lit = any(face.window is not None for face in faces)
        sun = definition.sun
        if isinstance(sun, GivenSun):
            yield from _shares_are_whole(zone, sun, [face.name for face in faces if face.surface is not None])
        if sun is not None and not lit:
            yield fault(
                ("zones", zone, "sun"),
                "a zone without windows",
                "a window through which the sun enters",
                "Remove 'sun:'.",
            )
        if isinstance(sun, TracedSun):
            yield from _rays_end_on_faces(zone, faces)
        if not lit or isinstance(sun, GivenSun):
            continue
        for face in faces:
            if face.surface is not None and getattr(face.surface, face.side).absorptance is None:
                yield fault(
                    ("surfaces", face.name, face.side, "absorptance"),
                    "nothing",
                    f"solar absorptance, from 0 to 1 [-]: the sun enters zone '{zone}'",
                    "Add 'absorptance:', or give shares under 'sun:' in the zone.",
                )


def _rays_end_on_faces(zone: str, faces: list[ZoneFace]) -> Faults:
    bare = ", ".join(f"'{face.name}'" for face in faces if face.polygon is None)
    if bare:
        yield fault(
            ("zones", zone, "sun"),
            f"geometry, where {bare} {'have' if ',' in bare else 'has'} no vertices",
            "vertices on every surface and window of the zone: rays end on them",
            "Add 'vertices:', or write 'sun: area'.",
        )


def shaded(building: Description) -> tuple[list[str], list[str]]:
    """Faces outdoors in the sun on which shades act, and those without vertices, on which they cannot."""
    found: tuple[list[str], list[str]] = ([], [])
    for name, surface in building.surfaces.items():
        if surface.outside.sunlit:
            found[surface.vertices is None].append(name)
    for name, window in building.windows.items():
        found[window.vertices is None].append(name)
    return found


def _shades_find_faces(building: Description) -> Faults:
    if not building.shades:
        return
    shade_outlines(building.shades)
    if not shaded(building)[0]:
        yield fault(
            ("shades", next(iter(building.shades))),
            "a shade where no face in the sun has vertices",
            "vertices on the walls and windows that it shades",
            "Add 'vertices:' to them, in the same coordinates.",
        )


def _shares_are_whole(zone: str, sun: GivenSun, names: list[str]) -> Faults:
    at = ("zones", zone, "sun")
    for name in sun.shares:
        if name not in names:
            yield fault(
                (*at, "shares", name), f"'{name}'", "a surface of this zone", did_you_mean(name, names)
            )
    total = float(sum(sun.shares.values()) + sun.lost)
    if abs(total - 1.0) > SHARE_CLOSURE:
        yield fault(
            at, f"shares that sum to {total:.3f}", "shares that, with lost, sum to 1", "Complete them."
        )


def references(building: Description) -> Iterator[tuple[str, tuple[str, ...], str]]:
    """Whatever follows a schedule: its name, where it is named, and the kind that is needed there."""
    for name, zone in building.zones.items():
        at = ("zones", name)
        for section in ("gains", "ventilation"):
            for key, part in getattr(zone, section).items():
                if part.schedule is not None:
                    yield part.schedule, (*at, section, key, "schedule"), "fraction"
        for which, plant in zone.plants.items():
            if plant.setpoint.schedule is not None:
                yield plant.setpoint.schedule, (*at, which, "setpoint", "schedule"), "temperature"
            if plant.schedule is not None:
                yield plant.schedule, (*at, which, "schedule"), "fraction"
    for section, parts in (("air_paths", building.air_paths), ("openings", building.openings)):
        for name, part in parts.items():
            if part.schedule is not None:
                yield part.schedule, (section, name, "schedule"), "fraction"


def _schedules_suit_their_use(building: Description) -> Faults:
    for name, at, needed in references(building):
        kind = building.schedules[name].kind
        if kind != needed:
            yield fault(
                at,
                f"'{name}', a schedule of kind {kind}",
                f"a schedule of kind {needed}",
                f"Name another one, or write 'kind: {needed}' under 'schedules.{name}:'.",
            )


def _set_points_apart(building: Description) -> Faults:
    """Heating above cooling, at some time of a week, would have both work against each other."""
    for name, zone in building.zones.items():
        if len(zone.plants) < 2:
            continue
        heating, cooling = (_week(building, zone.plants[which]) for which in ("heating", "cooling"))
        for (day, heats), (_, cools) in zip(heating, cooling, strict=True):
            crossing = next(_crossings(heats, cools), None)
            if crossing is None:
                continue
            minute, warm, cold = crossing
            yield fault(
                ("zones", name, "heating", "setpoint"),
                f"heating to {warm:g} degC, above cooling to {cold:g} degC, on {day} at "
                f"{int(minute // 60):02d}:{int(minute % 60):02d}",
                "a heating set point at or below the cooling set point at all times",
                "Lower the one or raise the other.",
            )
            break


def _week(building: Description, plant: IdealLoads) -> list[tuple[str, list[Piece]]]:
    """Pieces of the set point on each day of the week, and on holidays; empty for a measured column."""
    if plant.setpoint.schedule is None:
        value = float(plant.setpoint.temperature or 0.0)
        return [(day, [(0.0, 1440.0, value, value)]) for day in (*DAYS, "holidays")]
    schedule = building.schedules[plant.setpoint.schedule]
    days = [(day, schedule.pieces(weekday)) for weekday, day in enumerate(DAYS)]
    return [*days, ("holidays", schedule.pieces(0, holiday=True))]


def _crossings(heating: list[Piece], cooling: list[Piece]) -> Iterator[tuple[float, float, float]]:
    """Minutes of the day at which heating lies above cooling, with both set points."""
    for start, end, first, last in heating:
        for other_start, other_end, other_first, other_last in cooling:
            low, high = max(start, other_start), min(end, other_end)
            for minute in (low, high) if low < high else ():
                warm = first + (last - first) * (minute - start) / (end - start)
                cold = other_first + (other_last - other_first) * (minute - other_start) / (
                    other_end - other_start
                )
                if warm > cold + 1e-9:
                    yield minute, warm, cold

"""A plan of the rooms with the error of each: from the vertices of the floors, else from volumes and facades.

Without vertices a room is a square of its floor area, as if it were 2.5 m high. Its place follows by least
squares from the azimuths of its facades and from its neighbours; then squares that overlap are pushed apart.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from markupsafe import Markup

from mascarin._io import units
from mascarin.figures import text
from mascarin.figures.svg.chart import Array, Svg
from mascarin.pages.study.data.labels import label_of, main_model, period_label
from mascarin.study_document.building import BuildingEntry, SurfaceEntry
from mascarin.study_document.document import StudyDocument

#: Assumed height of a room without vertices. [m]
_STOREY_HEIGHT: Final = 2.5
#: Weight of a wall between rooms beside that of a facade of the same area.
_NEIGHBOR_WEIGHT: Final = 0.4
_MAX_PUSHES: Final = 200
#: Rooms beyond this number would be too small to be labelled.
_MAX_ROOMS: Final = 40
_WIDTH: Final = 560.0
_MARGIN: Final = 34.0
_NO_SURFACE: Final = SurfaceEntry()


@dataclass(frozen=True)
class RoomPlan:
    """Outlines of rooms in a horizontal plane, and walls.

    Attributes
    ----------
    outlines : mapping of str to ndarray, shape (n, 2)
        Corners of each room, east and north. [m]
    exact : bool
        Whether they are those of the floors.
    """

    outlines: Mapping[str, Array]
    exact: bool


def plan(building: BuildingEntry) -> RoomPlan | None:
    """Outlines of the rooms of a building.

    Parameters
    ----------
    building : BuildingEntry
        The building.

    Returns
    -------
    Plan or None
        None for one room or more than 40, rooms without walls between them, and floors above each other.
    """
    names = [zone.name for zone in building.zones]
    if not 2 <= len(names) <= _MAX_ROOMS:
        return None
    floors = _floors(building)
    if set(floors) == set(names):
        return None if _stacked(list(floors.values())) else RoomPlan(floors, exact=True)
    walls = _walls(building, names)
    if not _connected(names, walls):
        return None
    return RoomPlan(_squares(building, names, walls), exact=False)


def _floors(building: BuildingEntry) -> dict[str, Array]:
    """The largest floor of each room."""
    floor_outlines: dict[str, Array] = {}
    largest: dict[str, float] = {}
    for surface in building.surfaces:
        vertices, zone, area = (
            surface.vertices,
            surface.inside,
            (surface.area or 0.0),
        )
        if vertices and (surface.tilt or 0.0) > 150.0 and area > largest.get(zone, 0.0):
            floor_outlines[zone], largest[zone] = np.array(vertices, dtype=np.float64), area
    return floor_outlines


def _stacked(floors: Sequence[Array]) -> bool:
    """Whether floors are at different heights: one plan would show them over each other."""
    heights = [float(floor[:, 2].mean()) for floor in floors]
    return max(heights) - min(heights) > 1.0


def _walls(building: BuildingEntry, names: Sequence[str]) -> list[tuple[str, str, float, float]]:
    """Room, what is behind, azimuth [rad] and area [m2] of the upright walls."""
    walls = []
    for surface in building.surfaces:
        inside, outside = surface.inside, surface.outside
        upright = 45.0 < (surface.tilt or 0.0) < 135.0
        if upright and inside in names and outside != inside:
            azimuth = math.radians(float(surface.azimuth or 0.0))
            walls.append((inside, outside, azimuth, (surface.area or 0.0)))
    return walls


def _connected(names: Sequence[str], walls: Sequence[tuple[str, str, float, float]]) -> bool:
    """Whether walls between rooms join all of them."""
    reached, waiting = {names[0]}, [names[0]]
    while waiting:
        room = waiting.pop()
        for inside, outside, _, _ in walls:
            beyond = {inside: outside, outside: inside}.get(room)
            if beyond is not None and beyond in names and beyond not in reached:
                reached.add(beyond)
                waiting.append(beyond)
    return reached == set(names)


def _squares(
    building: BuildingEntry, names: Sequence[str], walls: Sequence[tuple[str, str, float, float]]
) -> dict[str, Array]:
    """Squares of the floor areas at places that follow from the directions of the walls."""
    volume = {zone.name: float(zone.volume or 0.0) for zone in building.zones}
    half = np.array([0.5 * math.sqrt(max(volume[name], 1.0) / _STOREY_HEIGHT) for name in names])
    index_of = {name: k for k, name in enumerate(names)}
    reach = 0.5 * float(np.sqrt((4.0 * half**2).sum()))
    # Unknown are the eastings, then the northings.
    rows, right = [], []

    def require(weight: float, value: float, *terms: tuple[int, float]) -> None:
        row = np.zeros(2 * len(names))
        for k, factor in terms:
            row[k] += weight * factor
        rows.append(row)
        right.append(weight * value)

    for axis in (0, len(names)):
        require(1.0, 0.0, *((axis + k, 1.0) for k in range(len(names))))
    for inside, outside, azimuth, area in walls:
        room = index_of[inside]
        if outside in index_of:
            # Neighbours are near each other; the azimuth of an inner wall is often left at zero.
            for axis in (0, len(names)):
                require(
                    _NEIGHBOR_WEIGHT * math.sqrt(area),
                    0.0,
                    (axis + room, 1.0),
                    (axis + index_of[outside], -1.0),
                )
        else:
            # The room stands at this side of the building.
            east, north = math.sin(azimuth), math.cos(azimuth)
            require(math.sqrt(area), reach - half[room], (room, east), (len(names) + room, north))
    solution, *_ = np.linalg.lstsq(np.array(rows), np.array(right), rcond=None)
    centres = solution.reshape(2, -1).T
    centres = _apart(centres, half)
    corners = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    return {name: centres[k] + half[k] * corners for k, name in enumerate(names)}


def _apart(centres: Array, half: Array) -> Array:
    """Push squares apart until none overlap."""
    centres = centres.copy()
    for _ in range(_MAX_PUSHES):
        moved = False
        for i in range(len(half)):
            for j in range(i):
                way = centres[i] - centres[j]
                overlap = half[i] + half[j] - np.abs(way)
                axis = int(np.argmin(overlap))
                if overlap[axis] > 1e-3:
                    step = 0.5 * overlap[axis] * (1.0 if way[axis] >= 0.0 else -1.0)
                    centres[i, axis] += step
                    centres[j, axis] -= step
                    moved = True
        if not moved:
            break
    return centres


def plan_drawing(study: StudyDocument) -> tuple[Markup, RoomPlan, str] | None:
    """The plan with the error of the air temperature of each room; north is up.

    Parameters
    ----------
    study : StudyDocument
        The results.

    Returns
    -------
    (Markup, Plan, str) or None
        Drawing, outlines, and the name of the period of the errors.
    """
    building = study.building
    room_plan = plan(building)
    if room_plan is None:
        return None
    period = _period(study)
    outline_points = np.concatenate(list(room_plan.outlines.values()))
    low, high = outline_points[:, :2].min(axis=0), outline_points[:, :2].max(axis=0)
    scale = (_WIDTH - 2.0 * _MARGIN) / max(float((high - low).max()), 1e-6)
    svg = Svg(_WIDTH, float(scale * (high - low)[1]) + 2.0 * _MARGIN)
    left_margin = 0.5 * (_WIDTH - scale * float((high - low)[0]))

    def on_page(points: Array) -> Array:
        """Place on the page. [px]"""
        return np.column_stack(
            [left_margin + scale * (points[:, 0] - low[0]), _MARGIN + scale * (high[1] - points[:, 1])]
        )

    for name, outline in room_plan.outlines.items():
        corners = on_page(outline[:, :2])
        svg.polygon(corners, "room")
        x, y = corners.mean(axis=0)
        shown = [_name(study, name), *_errors(study, name, period)]
        for k, words in enumerate(shown):
            svg.label(float(x), float(y) + 15.0 * (k - 0.5 * (len(shown) - 1)) + 4.0, words,
                      "layer-name" if k == 0 else "tick", "middle")  # fmt: skip
    _openings(svg, building, room_plan, on_page)
    svg.label(_WIDTH - 12.0, 18.0, "N", "small", "middle")
    svg.line(_WIDTH - 12.0, 40.0, _WIDTH - 12.0, 23.0, "arrow")
    label = period_label(study, period) if period else ""
    return svg.markup("Plan of the rooms with the errors of their temperatures"), room_plan, label


def _period(study: StudyDocument) -> str | None:
    """The first period with errors of a room, of those that were not calibrated with."""
    for period in ("corroboration", "blind", "identification"):
        if any(period in periods and periods[period].n for periods in study.sensors.values()):
            return period
    return None


def _name(study: StudyDocument, zone: str) -> str:
    """The label of the sensor of the air where there is one, else the name of the zone."""
    for sensor, info in study.sensor_info.items():
        if info.output == f"{zone}.air_temperature":
            return label_of(study, sensor)
    return text.plain_path(zone)


def _errors(study: StudyDocument, zone: str, period: str | None) -> list[str]:
    """Root mean square error of the air, and mean error of the load, of the main model."""
    model, error_texts = main_model(study), []
    for sensor, info in study.sensor_info.items():
        owner, _, what = info.output.rpartition(".")
        values = study.metrics(sensor, period, model)
        if owner != zone or not values.n:
            continue
        if what == "air_temperature":
            error_texts.append(f"{text.fixed(values.rmse, 2)} {units.difference(info.unit)}")
        elif what in ("net_load", "heating_load", "cooling_load"):
            unit = info.unit if info.states("unit") else "W"
            error_texts.append(f"{values.bias:+.0f} {units.shown(unit)}".replace("-", "−"))
    return error_texts


def _openings(svg: Svg, building: BuildingEntry, room_plan: RoomPlan, on_page: Any) -> None:
    """Windows on their sides of the rooms, and doors between rooms."""
    by_name = {surface.name: surface for surface in building.surfaces}
    for window in building.windows:
        surface = by_name.get(window.surface, _NO_SURFACE)
        outline = room_plan.outlines.get(surface.inside)
        if outline is not None and 45.0 < (surface.tilt or 0.0) < 135.0:
            ends = on_page(_side(outline[:, :2], math.radians(float(surface.azimuth or 0.0))))
            _stroke(svg, ends, "room-window")
    for door in building.doors:
        pair = [room_plan.outlines[str(name)][:, :2] for name in door if str(name) in room_plan.outlines]
        if len(pair) == 2:
            ends = on_page(_between(*pair))
            _stroke(svg, ends, "room-door")


def _stroke(svg: Svg, ends: Array, class_: str) -> None:
    (x1, y1), (x2, y2) = ends.tolist()
    svg.line(x1, y1, x2, y2, class_)


def _between(first_outline: Array, second_outline: Array) -> Array:
    """A short line across the boundary of two outlines, shape (2, 2). [m]"""
    start, end = first_outline.mean(axis=0), second_outline.mean(axis=0)
    way = end - start
    middle = 0.5 * (_leaves(first_outline, start, way) + 1.0 - _leaves(second_outline, end, -way))
    across = 0.3 * way / max(float(np.hypot(*way)), 1e-6)
    return np.array([start + middle * way - across, start + middle * way + across])


def _leaves(outline: Array, start: Array, way: Array) -> float:
    """Where a line from inside leaves an outline for the last time, as a part of its length. [-]"""
    edges = np.roll(outline, -1, axis=0) - outline
    across = way[0] * edges[:, 1] - way[1] * edges[:, 0]
    offset = outline - start
    with np.errstate(divide="ignore", invalid="ignore"):
        along = (offset[:, 0] * edges[:, 1] - offset[:, 1] * edges[:, 0]) / across
        on_edge = (offset[:, 0] * way[1] - offset[:, 1] * way[0]) / across
    crossed = (np.abs(across) > 1e-12) & (on_edge >= 0.0) & (on_edge <= 1.0) & (along > 0.0) & (along <= 1.0)
    return float(along[crossed].max(initial=0.0))


def _side(outline: Array, azimuth: float) -> Array:
    """The middle half of the side that faces a direction, shape (2, 2). [m]"""
    way = np.array([math.sin(azimuth), math.cos(azimuth)])
    following = np.roll(outline, -1, axis=0)
    middle = 0.5 * (outline + following)
    best = int(np.argmax((middle - outline.mean(axis=0)) @ way))
    corner, following_corner = outline[best], following[best]
    return np.array([0.75 * corner + 0.25 * following_corner, 0.25 * corner + 0.75 * following_corner])

"""Places for what a description gives without vertices: rectangles of the right area, facing the right way.

A surface without vertices has an area, a tilt and an azimuth, but no place. Here the surfaces of a zone stand
around its middle, each on the side that it faces. Their position and their shape are schematic.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.building.parts.envelope.surface import Surface
    from mascarin.building.parts.openings.window import Window

Array = npt.NDArray[np.float64]

#: Height of a storey where nothing gives one [m].
_STOREY_HEIGHT: Final = 2.7
#: Distance of the rectangles from the outline of a zone, over its shorter side [-].
_PANEL_GAP: Final = 0.15
#: Directions within this angle count as one [deg].
_DIRECTION_BIN: Final = 15.0
#: Distance between the outlines of two zones, over the shorter side of each [-].
_ROOM_DISTANCE: Final = 0.6
#: Longest side of a zone in the plan [m].
_MAX_LENGTH: Final = 30.0
_RECTANGLE_CORNERS: Final = 4


class _Room(NamedTuple):
    """Height, width to the east and depth to the north of the place in which surfaces stand. [m]"""

    height: float
    width: float
    depth: float

    @property
    def gap(self) -> float:
        """Distance of the rectangles from it. [m]"""
        return _PANEL_GAP * min(self.width, self.depth)


def panels(building: Building) -> dict[str, Array]:
    """Rectangles for the surfaces that have no vertices.

    Parameters
    ----------
    building : Building
        The building.

    Returns
    -------
    dict of str to ndarray, shape (4, 3)
        Corners counter-clockwise as seen from outside, by surface. [m]

    Examples
    --------
    >>> from mascarin.examples import box
    >>> sorted(panels(box()))
    ['facade']
    """
    groups: dict[str, list[str]] = {}
    for name, surface in building.surfaces.items():
        if surface.vertices is None:
            groups.setdefault(home(surface), []).append(name)
    if not groups:
        return {}
    rooms = {zone: _room(building, zone, names) for zone, names in groups.items()}
    vertices = [
        vertex
        for surface_with_vertices in building.surfaces.values()
        for vertex in surface_with_vertices.vertices or ()
    ]
    west = max((float(vertex[0]) for vertex in vertices), default=-2.0) + 2.0
    corners_of: dict[str, Array] = {}
    for zone, floor_middle in _label_positions(rooms).items():
        for name, corners in _around(building, zone, groups[zone], rooms[zone]).items():
            corners_of[name] = corners + floor_middle + np.array([west, 0.0, 0.0])
    return {name: corners_of[name] for name in building.surfaces if name in corners_of}


def home(surface: Surface) -> str:
    """Zone with which a surface is drawn: that of its inside, else that of its outside, else none."""
    return surface.inside.zone or surface.outside.zone or ""


def _label_positions(rooms: Mapping[str, _Room]) -> dict[str, Array]:
    """Middle of the floor of each zone: row by row, from the west and from the north [m]."""
    columns = math.ceil(math.sqrt(len(rooms)))
    floor_middles: dict[str, Array] = {}
    zones, y = list(rooms), 0.0
    for first in range(0, len(zones), columns):
        row = zones[first : first + columns]
        deep = max(rooms[zone].depth + _between(rooms[zone]) for zone in row)
        x = 0.0
        for zone in row:
            wide = rooms[zone].width + _between(rooms[zone])
            floor_middles[zone] = np.array([x + 0.5 * wide, y - 0.5 * deep, 0.0])
            x += wide
        y -= deep
    return floor_middles


def _between(room: _Room) -> float:
    return _ROOM_DISTANCE * min(room.width, room.depth)


def _room(building: Building, zone: str, names: Sequence[str]) -> _Room:
    surfaces = [building.surfaces[name] for name in names]
    flat = [
        float(surface.area or 0.0) for surface in surfaces if not 30.0 < float(surface.tilt or 0.0) < 150.0
    ]
    volume = float(building.zones[zone].volume or 0.0) if zone else 0.0
    height = _STOREY_HEIGHT
    if flat and volume:
        height = min(max(volume / max(flat), 0.5 * _STOREY_HEIGHT), 2.0 * _STOREY_HEIGHT)
    lengths: dict[tuple[float, float], float] = {}
    for surface in surfaces:
        if not surface.internal_mass and 30.0 <= float(surface.tilt or 0.0) <= 150.0:
            direction = _bin(_outward(surface, zone))
            lengths[direction] = lengths.get(direction, 0.0) + float(surface.area or 0.0) / height
    floor = max(flat, default=0.0)
    # Walls that face north or south give the width, those that face east or west the depth.
    width = max((length for direction, length in lengths.items() if _along_north(direction)), default=0.0)
    depth = max((length for direction, length in lengths.items() if not _along_north(direction)), default=0.0)
    width = width or (floor / depth if depth else math.sqrt(floor))
    depth = depth or (floor / width if width and floor else width)
    return _Room(height, *(min(max(extent, 1.0), _MAX_LENGTH) for extent in (width, depth)))


def _along_north(direction: tuple[float, float]) -> bool:
    """Whether a direction is nearer to north or south than to east or west."""
    return abs(math.cos(math.radians(direction[1] * _DIRECTION_BIN))) > math.sqrt(0.5)


def _normal(surface: Surface) -> Array:
    """Unit vector of the outside normal (east, north, up) [-]."""
    tilt, azimuth = math.radians(float(surface.tilt or 0.0)), math.radians(float(surface.azimuth or 0.0))
    flat = math.sin(tilt)
    return np.array([flat * math.sin(azimuth), flat * math.cos(azimuth), math.cos(tilt)])


def _outward(surface: Surface, zone: str) -> Array:
    """Direction out of the zone through a surface [-]."""
    return _normal(surface) if not zone or surface.inside.zone == zone else -_normal(surface)


def _bin(direction: Array) -> tuple[float, float]:
    tilt = round(math.degrees(math.acos(min(1.0, max(-1.0, float(direction[2]))))) / _DIRECTION_BIN)
    if tilt in (0, round(180.0 / _DIRECTION_BIN)):
        return tilt, 0.0
    azimuth = math.degrees(math.atan2(float(direction[0]), float(direction[1])))
    return tilt, round((azimuth % 360.0) / _DIRECTION_BIN) % round(360.0 / _DIRECTION_BIN)


def _around(building: Building, zone: str, names: Sequence[str], room: _Room) -> dict[str, Array]:
    """Corners of the surfaces of a zone about the middle of its floor [m]."""
    sides: dict[tuple[float, float] | None, list[str]] = {}
    for name in names:
        surface = building.surfaces[name]
        direction = None if surface.internal_mass else _bin(_outward(surface, zone))
        sides.setdefault(direction, []).append(name)
    corners_of: dict[str, Array] = {}
    for direction, side in sides.items():
        sizes = [_size(building.surfaces[name], room, alone=len(side) == 1) for name in side]
        gap = 0.04 * min(room.width, room.depth)
        start = -0.5 * (sum(wide for wide, _ in sizes) + gap * (len(side) - 1))
        for name, (wide, high) in zip(side, sizes, strict=True):
            surface = building.surfaces[name]
            normal, out = _normal(surface), _outward(surface, zone)
            along, up = _axes(normal)
            reach = 0.5 * np.array([room.width, room.depth, room.height]) + room.gap
            centre = np.zeros(3) if direction is None else out * reach
            centre = centre + np.array([0.0, 0.0, 0.5 * room.height]) + along * (start + 0.5 * wide)
            half = (0.5 * wide * along, 0.5 * high * up)
            corners_of[name] = np.stack(
                [centre + a * half[0] + b * half[1] for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            )
            start += wide + gap
    return corners_of


def _size(surface: Surface, room: _Room, *, alone: bool) -> tuple[float, float]:
    """Width and height of a rectangle of the area of a surface [m]."""
    area = float(surface.area or 0.0)
    if 30.0 <= float(surface.tilt or 0.0) <= 150.0:
        if area / room.height <= 4.0 * max(room.width, room.depth):
            return area / room.height, room.height
    elif alone and area <= 4.0 * room.width * room.depth:
        return room.width, area / room.width
    return math.sqrt(area), math.sqrt(area)


def _axes(normal: Array) -> tuple[Array, Array]:
    """Two directions in a plane, the first one level; their cross product is the normal [-]."""
    level = np.cross([0.0, 0.0, 1.0], normal)
    length = float(np.linalg.norm(level))
    along = level / length if length > 1e-9 else np.array([1.0, 0.0, 0.0])
    return along, np.cross(normal, along)


def window_panels(wall: Array, windows: Mapping[str, Window], area: float) -> dict[str, Array]:
    """Outlines for windows without vertices, inside the outline of their wall.

    Parameters
    ----------
    wall : ndarray, shape (corners, 3)
        The wall. [m]
    windows : mapping of str to Window
        Its windows without vertices.
    area : float
        Area of the wall with its windows. [m2]

    Returns
    -------
    dict of str to ndarray, shape (corners, 3)
        Side by side in a wall of four corners; else the outline of the wall, made smaller. [m]

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> wall = np.array([[0.0, 0, 0], [4, 0, 0], [4, 0, 3], [0, 0, 3]])
    >>> window_panels(wall, {"w": SimpleNamespace(area=3.0)}, 12.0)["w"][0].tolist()
    [1.0, 0.0, 0.75]
    """
    sizes = {name: min(float(window.area or 0.0) / area, 1.0) for name, window in windows.items()}
    if len(wall) != _RECTANGLE_CORNERS:
        middle = wall.mean(axis=0)
        return {name: middle + math.sqrt(0.9 * size) * (wall - middle) for name, size in sizes.items()}
    share = min(sum(sizes.values()), 0.98)
    high = math.sqrt(share) if share else 1.0
    gap = (1.0 - high) / (len(sizes) + 1)
    outlines, edge = {}, gap
    for name, size in sizes.items():
        wide = size / high
        low, top = 0.5 * (1.0 - high), 0.5 * (1.0 + high)
        ends = ((edge, low), (edge + wide, low), (edge + wide, top), (edge, top))
        outlines[name] = np.stack([_inside(wall, u, v) for u, v in ends])
        edge += wide + gap
    return outlines


def _inside(wall: Array, u: float, v: float) -> Array:
    """Point of a wall of four corners by its parts along the first and along the last side [m]."""
    below, above = (1.0 - u) * wall[0] + u * wall[1], (1.0 - u) * wall[3] + u * wall[2]
    return np.asarray((1.0 - v) * below + v * above)

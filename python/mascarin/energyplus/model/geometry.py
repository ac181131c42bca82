"""Coordinates: global geometry rules, rotation of building and zones, rectangles, polygons."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from mascarin.energyplus.model.handlers import HasModel, reads
from mascarin.energyplus.model.idf import IdfModel, IdfObject

Array = npt.NDArray[np.float64]

#: Corners closer than this are one corner [m].
SAME = 2e-3


@dataclass(frozen=True)
class Rules:
    """How the coordinates of the file are meant.

    Attributes
    ----------
    clockwise : bool
        Whether corners run clockwise seen from outside.
    relative, rectangles_relative : bool
        Whether corners, and starting points of rectangles, are relative to zone and building.
    north : float
        Angle of the building's north from true north, clockwise. [deg]
    """

    clockwise: bool
    relative: bool
    rectangles_relative: bool
    north: float


@reads("GlobalGeometryRules", "Building")
def rules_of(context: HasModel) -> Rules:
    """Read ``GlobalGeometryRules`` and ``Building``."""
    model: IdfModel = context.model
    geometry_rules, building = model.one("GlobalGeometryRules"), model.one("Building")

    def word(key: str) -> str:
        return "" if geometry_rules is None else geometry_rules.word(key)

    return Rules(
        clockwise=word("vertex_entry_direction") == "clockwise",
        relative=word("coordinate_system") in ("relative", ""),
        rectangles_relative=word("rectangular_surface_coordinate_system") in ("relative", ""),
        north=(building.number("north_axis") or 0.0) if building is not None else 0.0,
    )


@dataclass(frozen=True)
class Frame:
    """Coordinates of a zone, or of the building, within true north.

    Attributes
    ----------
    origin : ndarray, shape (3,)
        Origin of the zone in the building. [m]
    turn, north : float
        Rotation of the zone, and of the building, clockwise. [deg]
    """

    origin: Array
    turn: float
    north: float

    def place(self, points: Array) -> Array:
        """Points, shape (n, 3), in true coordinates. [m]"""
        return _turned(_turned(points, self.turn) + self.origin, self.north)

    @property
    def rotation(self) -> float:
        """Rotation of directions, clockwise. [deg]"""
        return self.turn + self.north


TRUE = Frame(np.zeros(3), 0.0, 0.0)


def frame_of(zone: IdfObject | None, rules: Rules, relative: bool) -> Frame:
    """Coordinates in which the corners of a zone's surfaces are given; of the building without a zone."""
    if not relative:
        return TRUE
    if zone is None:
        return Frame(np.zeros(3), 0.0, rules.north)
    origin = np.array([zone.number(f"{axis}_origin") or 0.0 for axis in "xyz"])
    return Frame(origin, zone.number("direction_of_relative_north") or 0.0, rules.north)


def _turned(points: Array, degrees: float) -> Array:
    if degrees % 360.0 == 0.0:
        return points
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    x, y, z = points.T
    return np.column_stack([x * c + y * s, -x * s + y * c, z])


def corners_of(item: IdfObject) -> Array:
    """Corners of a detailed object as they are given, shape (n, 3). [m]

    Raises
    ------
    InputError
        Fewer than three corners, or a corner without three numbers.
    """
    rows = item.rows("vertices")
    keys = ("x", "y", "z")
    corners: list[list[float]] = []
    for number, row in enumerate(rows, start=1):
        values = [row.get(f"vertex_{axis}_coordinate", 0.0) for axis in keys]
        corners.append([_coordinate(item, number, value) for value in values])
    number = 1
    while not rows and any(f"vertex_{number}_{axis}_coordinate" in item.fields for axis in keys):
        values = [item.fields.get(f"vertex_{number}_{axis}_coordinate", 0.0) for axis in keys]
        corners.append([_coordinate(item, number, value) for value in values])
        number += 1
    if len(corners) < 3:
        raise item.error(f"found {len(corners)} vertices", "at least 3", "Give the corners of the surface")
    return np.array(corners)


def _coordinate(item: IdfObject, number: int, value: object) -> float:
    try:
        coordinate = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        coordinate = math.nan
    if not math.isfinite(coordinate):
        raise item.error(f"vertex {number}: found {value!r}", "a coordinate [m]", "Correct the vertex")
    return coordinate


@dataclass(frozen=True)
class Plane:
    """Directions in a surface as it is seen from outside.

    Attributes
    ----------
    right, up, out : ndarray, shape (3,)
        Unit vectors.
    """

    right: Array
    up: Array
    out: Array


def plane_of(azimuth: float, tilt: float) -> Plane:
    """Directions in a surface of a given azimuth and tilt. [deg]"""
    a, t = math.radians(azimuth), math.radians(tilt)
    out = np.array([math.sin(a) * math.sin(t), math.cos(a) * math.sin(t), math.cos(t)])
    right = np.array([-math.cos(a), math.sin(a), 0.0])
    return Plane(right, np.cross(out, right), out)


def rectangle(start: Array, plane: Plane, length: float, height: float) -> Array:
    """Corners of a rectangle from its lower left corner, counter-clockwise seen from outside. [m]"""
    right, up = length * plane.right, height * plane.up
    return np.array([start, start + right, start + right + up, start + up])


def normal_of(points: Array) -> Array:
    """Vector area of a polygon by its right-hand rule, shape (3,). [m2]"""
    x, y, z = 0.0, 0.0, 0.0
    # Plain numbers: many times as fast as arrays for a few corners.
    first, *corners = points.tolist()
    edges = [[a - b for a, b in zip(corner, first, strict=True)] for corner in corners]
    for (ax, ay, az), (bx, by, bz) in pairwise(edges):
        x, y, z = x + ay * bz - az * by, y + az * bx - ax * bz, z + ax * by - ay * bx
    return 0.5 * np.array([x, y, z])


def area_of(points: Array) -> float:
    """Area of a polygon. [m2]"""
    return float(np.linalg.norm(normal_of(points)))


def tilt_of(points: Array) -> float:
    """Angle between the outward normal and the zenith. [deg]"""
    n = normal_of(points)
    return math.degrees(math.acos(max(-1.0, min(1.0, float(n[2] / np.linalg.norm(n))))))


def azimuth_of(points: Array) -> float:
    """Direction of the outward normal, clockwise from north. [deg]"""
    n = normal_of(points)
    return math.degrees(math.atan2(float(n[0]), float(n[1]))) % 360.0


def flat(points: Array) -> dict[str, float]:
    """Area and direction of a polygon, as a description has them without corners. [m2, deg]"""
    geometry = {"area": area_of(points), "tilt": tilt_of(points), "azimuth": azimuth_of(points)}
    return {key: round(value, 5) for key, value in geometry.items()}


def plane_through(points: Array) -> Plane:
    """Directions in the plane of a polygon."""
    return plane_of(azimuth_of(points), tilt_of(points))


def lower_left(points: Array) -> Array:
    """Lower left corner of the rectangle around a polygon, seen from outside, shape (3,). [m]"""
    plane = plane_through(points)
    along, above = points @ plane.right, points @ plane.up
    first = points[0]
    corner: Array = (
        first
        + (along.min() - first @ plane.right) * plane.right
        + (above.min() - first @ plane.up) * plane.up
    )
    return corner


def without_repeats(points: Array) -> Array:
    """A polygon without corners that coincide with the one before or lie on the line of their neighbours."""
    distinct = [p for k, p in enumerate(points) if np.linalg.norm(p - points[k - 1]) >= SAME]
    corners = []
    for k, p in enumerate(distinct):
        before, after = p - distinct[k - 1], distinct[(k + 1) % len(distinct)] - p
        if float(np.linalg.norm(np.cross(before, after))) > 1e-9:
            corners.append(p)
    return np.array(corners).reshape(-1, 3)


def signed_volume(polygons: Sequence[Array]) -> float:
    """Volume that polygons with outward normals enclose. [m3]"""
    if not polygons:
        return 0.0
    middle = np.concatenate(polygons).mean(axis=0)
    total = 0.0
    for points in polygons:
        total += float((points.mean(axis=0) - middle) @ normal_of(points)) / 3.0
    return total


def rounded(points: Array) -> list[list[float]]:
    """Corners as plain numbers, to a micrometre. [m]"""
    return [[round(float(c), 6) + 0.0 for c in point] for point in points]

"""Plane polygons: areas, directions, and whether one is inside another.

Coordinates are in metres with x to the east, y to the north and z up. The vertices of a surface run
counter-clockwise when it is seen from outside, so that the normal by the right-hand rule is the outside
normal. For a zone, every polygon must point *into* the zone: for the inside of a wall this is the reversed
polygon (:meth:`Polygon.reversed`), for an outside the polygon itself.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from mascarin.building.geometry.flat import (
    TOLERANCE,
    cross,
    edges,
    inside,
    middles_of_pieces,
    on_outline,
)
from mascarin.building.geometry.space import (
    Triple,
    dot,
    height,
    subtracted,
    vector_area,
    vector_product,
)
from mascarin.errors import InputError

Array = npt.NDArray[np.float64]

#: An area below this share of the square of its length is a line, for the engine, too [-].
SLENDER = 1e-9
#: Coordinates of a surveyor's grid have 7 digits; squares of larger ones lose the millimetres of a wall [m].
FARTHEST = 1e9


@dataclass(frozen=True)
class Polygon:
    """A simple plane polygon.

    Parameters
    ----------
    name : str
        Name used in messages.
    vertices : sequence of (x, y, z)
        At least three corners; their right-hand rule gives the normal. [m]
    """

    name: str
    vertices: tuple[tuple[float, float, float], ...]

    @classmethod
    def of(cls, name: str, vertices: Sequence[Sequence[float]]) -> Polygon:
        """Make a polygon and check it.

        Parameters
        ----------
        name : str
            Name used in messages.
        vertices : sequence of (x, y, z)
            Corners in order. [m]

        Raises
        ------
        InputError
            Fewer than three corners, a corner without three finite coordinates, corners that coincide, that
            enclose no area, that do not lie in one plane, or edges that cross.
        """
        corners = vertices if isinstance(vertices, tuple) else tuple(vertices)
        try:
            return _checked(name, corners)
        except TypeError:  # lists of coordinates
            return _checked(name, tuple(map(tuple, corners)))

    def _check(self) -> None:
        if len(self.vertices) < 3:
            raise InputError(f"surface '{self.name}': {len(self.vertices)} vertices; expected at least 3")
        for number, (corner, other) in enumerate(edges(self.vertices), start=1):
            length = math.dist(corner, other)
            if length < TOLERANCE:
                following = number % len(self.vertices) + 1
                raise InputError(
                    f"surface '{self.name}': vertices {number} and {following} are {length:.2g} m apart; "
                    f"expected at least {TOLERANCE} m; remove one of them"
                )
        size = max(math.dist(corner, other) for corner, other in edges(self.vertices))
        reach = max(math.dist(corner, self.vertices[0]) for corner in self.vertices)
        if self.area < max(TOLERANCE * size, SLENDER * reach**2):
            raise InputError(
                f"surface '{self.name}': its vertices enclose no area; expected corners once around it"
            )
        middle = [sum(along) / len(self.vertices) for along in zip(*self.vertices, strict=True)]
        offsets = [abs(height(corner, middle, self._unit)) for corner in self.vertices]
        worst = offsets.index(max(offsets))
        if offsets[worst] > TOLERANCE:
            raise InputError(
                f"surface '{self.name}' is not plane: vertex {worst + 1} lies {offsets[worst]:.4f} m off "
                f"the mean plane; expected at most {TOLERANCE} m; correct it or split the surface"
            )
        self._check_simple()

    def _check_simple(self) -> None:
        outline = self.outline
        n = len(outline)
        for i in range(n):
            for j in range(i + 2, n):
                if i == 0 and j == n - 1:
                    continue
                if cross(outline[i], outline[(i + 1) % n], outline[j], outline[(j + 1) % n]):
                    raise InputError(
                        f"surface '{self.name}': edge {i + 1} crosses edge {j + 1}; "
                        "expected the corners in order around the surface"
                    )

    @cached_property
    def points(self) -> Array:
        """Corners, shape (n, 3). [m]"""
        return np.array(self.vertices, dtype=np.float64)

    @cached_property
    def box(self) -> tuple[Triple, Triple]:
        """Least and largest coordinates of the corners. [m]"""
        along = list(zip(*self.vertices, strict=True))
        (x, y, z), (u, v, w) = map(min, along), map(max, along)
        return (x, y, z), (u, v, w)

    @cached_property
    def _vector_area(self) -> Triple:
        return vector_area(self.vertices)

    @cached_property
    def area(self) -> float:
        """Area inside the outline. [m2]"""
        return math.hypot(*self._vector_area)

    @cached_property
    def _unit(self) -> Triple:
        x, y, z = self._vector_area
        return x / self.area, y / self.area, z / self.area

    @cached_property
    def normal(self) -> Array:
        """Unit normal by the right-hand rule, shape (3,). [-]"""
        return np.array(self._unit)

    @cached_property
    def tilt(self) -> float:
        """Angle of the normal from straight up: 0 up, 90 vertical, 180 down. [deg]"""
        east, north, up = self._unit
        return math.degrees(math.atan2(math.hypot(east, north), up))

    @cached_property
    def azimuth(self) -> float:
        """Direction of the normal, clockwise from north, in [0, 360); 0 for a horizontal polygon. [deg]"""
        east, north, _ = self._unit
        if math.hypot(east, north) < 1e-9:
            return 0.0
        angle = math.degrees(math.atan2(east, north)) % 360.0
        return 0.0 if angle > 360.0 - 1e-9 else angle

    @cached_property
    def centroid(self) -> Array:
        """Centre of area, shape (3,). [m]"""
        first = self.vertices[0]
        p = [subtracted(corner, first) for corner in self.vertices]
        weights = [0.5 * dot(vector_product(a, b), self._unit) for a, b in pairwise(p[1:])]
        total = 3.0 * sum(weights)
        return np.array(
            [
                first[k]
                + sum(w * (a[k] + b[k]) for w, (a, b) in zip(weights, pairwise(p[1:]), strict=True)) / total
                for k in range(3)
            ]
        )

    @cached_property
    def perimeter(self) -> float:
        """Length of the outline. [m]"""
        return sum(math.dist(corner, other) for corner, other in edges(self.vertices))

    def reversed(self) -> Polygon:
        """The same outline with the opposite normal."""
        return self._back

    @cached_property
    def _back(self) -> Polygon:
        # Kept: a wall between two zones is seen from both, again and again.
        return Polygon(self.name, self.vertices[::-1])

    def in_plane(self, points: Array) -> Array:
        """Coordinates of points in a right-handed frame of the polygon's plane.

        Parameters
        ----------
        points : array, shape (m, 3)
            Points. [m]

        Returns
        -------
        array, shape (m, 2)
            Coordinates along the first edge and across it. [m]
        """
        coordinates: Array = (points - self.points[0]) @ np.array(self._frame).T
        return coordinates

    @cached_property
    def _frame(self) -> tuple[Triple, Triple]:
        """Unit vectors along the first edge and across it."""
        edge = subtracted(self.vertices[1], self.vertices[0])
        off = dot(edge, self._unit)
        x, y, z = (e - off * n for e, n in zip(edge, self._unit, strict=True))
        length = math.hypot(x, y, z)
        along = (x / length, y / length, z / length)
        return along, vector_product(self._unit, along)

    @cached_property
    def outline(self) -> list[list[float]]:
        """Corners in the frame of `in_plane`. [m]"""
        return self._flat(self)

    def _flat(self, other: Polygon) -> list[list[float]]:
        """Corners of a polygon in the frame of `in_plane`. [m]"""
        first, (along, across) = self.vertices[0], self._frame
        apart = (subtracted(corner, first) for corner in other.vertices)
        return [[dot(point, along), dot(point, across)] for point in apart]

    def above(self, point: Triple) -> float:
        """Signed distance of a point from the plane, positive on the side of the normal. [m]"""
        return height(point, self.vertices[0], self._unit)

    def farthest(self, other: Polygon) -> float:
        """Largest distance of a corner of another polygon from the plane. [m]"""
        return max(abs(height(corner, self.vertices[0], self._unit)) for corner in other.vertices)

    def turned(self, other: Polygon) -> float:
        """Cosine of the angle between the normals. [-]"""
        return dot(self._unit, other._unit)

    def height_of(self, points: Array) -> Array:
        """Signed distances of points from the plane, positive on the side of the normal, shape (m,). [m]"""
        distances: Array = (points - self.points[0]) @ self.normal
        return distances

    def contains(self, other: Polygon) -> bool:
        """Whether another polygon lies in this one: same plane, same normal, inside the outline."""
        if self.turned(other) < 1.0 - 1e-6 or self.farthest(other) > TOLERANCE:
            return False
        corners = self._flat(other)
        if not all(inside(self.outline, point) for point in corners):
            return False
        crossing = any(cross(a, b, c, d) for a, b in edges(self.outline) for c, d in edges(corners))
        return not crossing and other.area < self.area + TOLERANCE * self.perimeter

    def overlaps(self, other: Polygon) -> bool:
        """Whether two polygons in one plane have more in common than edges and corners."""
        if not coplanar(self, other):
            return False
        if self.contains(other) or other.contains(self):
            return True
        own_outline, other_outline = self.outline, self._flat(other)
        return any(
            inside(outline, middle) and not on_outline(outline, middle)
            for outline, cut in ((own_outline, other_outline), (other_outline, own_outline))
            for middle in middles_of_pieces(cut, outline)
        )


@lru_cache(maxsize=1 << 16)
def _checked(name: str, vertices: tuple[Sequence[float], ...]) -> Polygon:
    """Make and check a polygon once: the same polygons are needed many times for one description."""
    corners = []
    for number, vertex in enumerate(vertices, start=1):
        if len(vertex) != 3 or not all(math.isfinite(float(c)) for c in vertex):
            raise InputError(
                f"surface '{name}': vertex {number} is {list(vertex)}; expected three finite coordinates "
                "[x east, y north, z up] in metres"
            )
        if max(abs(float(c)) for c in vertex) > FARTHEST:
            raise InputError(
                f"surface '{name}': vertex {number} is {list(vertex)}; expected coordinates within "
                f"{FARTHEST:g} m of the origin: write them in metres, about a point near the building"
            )
        corners.append((float(vertex[0]), float(vertex[1]), float(vertex[2])))
    polygon = Polygon(name, tuple(corners))
    polygon._check()
    return polygon


def coplanar(a: Polygon, b: Polygon) -> bool:
    """Whether two polygons lie in one plane, whichever way their normals point."""
    return a.farthest(b) < TOLERANCE and abs(a.turned(b)) > 1.0 - 1e-6

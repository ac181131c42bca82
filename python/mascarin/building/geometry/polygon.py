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
from mascarin.errors import InputError

Array = npt.NDArray[np.float64]

#: An area below this share of the square of its length is a line, for the engine, too [-].
SLENDER = 1e-9


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
        corners = []
        for number, vertex in enumerate(vertices, start=1):
            if len(vertex) != 3 or not all(math.isfinite(float(c)) for c in vertex):
                raise InputError(
                    f"surface '{name}': vertex {number} is {list(vertex)}; expected three finite coordinates "
                    "[x east, y north, z up] in metres"
                )
            corners.append((float(vertex[0]), float(vertex[1]), float(vertex[2])))
        return _checked(name, tuple(corners))

    def _check(self) -> None:
        if len(self.vertices) < 3:
            raise InputError(f"surface '{self.name}': {len(self.vertices)} vertices; expected at least 3")
        sides = np.linalg.norm(np.roll(self.points, -1, axis=0) - self.points, axis=1)
        for number, length in enumerate(sides, start=1):
            if length < TOLERANCE:
                following = number % len(self.vertices) + 1
                raise InputError(
                    f"surface '{self.name}': vertices {number} and {following} are {length:.2g} m apart; "
                    f"expected at least {TOLERANCE} m; remove one of them"
                )
        vector = self._vector_area
        size = float(np.max(sides))
        reach = float(np.max(np.linalg.norm(self.points - self.points[0], axis=1)))
        if float(np.linalg.norm(vector)) < max(TOLERANCE * size, SLENDER * reach**2):
            raise InputError(
                f"surface '{self.name}': its vertices enclose no area; expected corners once around it"
            )
        offsets = np.abs((self.points - self.points.mean(axis=0)) @ self.normal)
        worst = int(np.argmax(offsets))
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
    def _vector_area(self) -> Array:
        # Newell: half the sum of the cross products, taken about the first corner for accuracy.
        p = self.points - self.points[0]
        total: Array = 0.5 * np.cross(p, np.roll(p, -1, axis=0)).sum(axis=0)
        return total

    @cached_property
    def area(self) -> float:
        """Area inside the outline. [m2]"""
        return float(np.linalg.norm(self._vector_area))

    @cached_property
    def normal(self) -> Array:
        """Unit normal by the right-hand rule, shape (3,). [-]"""
        unit: Array = self._vector_area / self.area
        return unit

    @cached_property
    def tilt(self) -> float:
        """Angle of the normal from straight up: 0 up, 90 vertical, 180 down. [deg]"""
        up = float(self.normal[2])
        return math.degrees(math.atan2(math.hypot(self.normal[0], self.normal[1]), up))

    @cached_property
    def azimuth(self) -> float:
        """Direction of the normal, clockwise from north, in [0, 360); 0 for a horizontal polygon. [deg]"""
        east, north = float(self.normal[0]), float(self.normal[1])
        if math.hypot(east, north) < 1e-9:
            return 0.0
        angle = math.degrees(math.atan2(east, north)) % 360.0
        return 0.0 if angle > 360.0 - 1e-9 else angle

    @cached_property
    def centroid(self) -> Array:
        """Centre of area, shape (3,). [m]"""
        p = self.points - self.points[0]
        triangles = 0.5 * np.cross(p[1:-1], p[2:]) @ self.normal
        centre: Array = self.points[0] + triangles @ (p[1:-1] + p[2:]) / (3.0 * triangles.sum())
        return centre

    @cached_property
    def perimeter(self) -> float:
        """Length of the outline. [m]"""
        return float(np.linalg.norm(np.roll(self.points, -1, axis=0) - self.points, axis=1).sum())

    def reversed(self) -> Polygon:
        """The same outline with the opposite normal."""
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
        coordinates: Array = (points - self.points[0]) @ self._frame.T
        return coordinates

    @cached_property
    def _frame(self) -> Array:
        """Unit vectors along the first edge and across it, shape (2, 3)."""
        along = self.points[1] - self.points[0]
        along = along - (along @ self.normal) * self.normal
        along = along / np.linalg.norm(along)
        return np.stack([along, np.cross(self.normal, along)])

    @cached_property
    def outline(self) -> list[list[float]]:
        """Corners in the frame of `in_plane`. [m]"""
        corners: list[list[float]] = self.in_plane(self.points).tolist()
        return corners

    def height_of(self, points: Array) -> Array:
        """Signed distances of points from the plane, positive on the side of the normal, shape (m,). [m]"""
        distances: Array = (points - self.points[0]) @ self.normal
        return distances

    def contains(self, other: Polygon) -> bool:
        """Whether another polygon lies in this one: same plane, same normal, inside the outline."""
        if float(self.normal @ other.normal) < 1.0 - 1e-6:
            return False
        if float(np.max(np.abs(self.height_of(other.points)))) > TOLERANCE:
            return False
        corners = self.in_plane(other.points).tolist()
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
        here, there = self.outline, self.in_plane(other.points).tolist()
        return any(
            inside(outline, middle) and not on_outline(outline, middle)
            for outline, cut in ((here, there), (there, here))
            for middle in middles_of_pieces(cut, outline)
        )


@lru_cache(maxsize=1 << 16)
def _checked(name: str, corners: tuple[tuple[float, float, float], ...]) -> Polygon:
    """Check a polygon once: the same polygons are needed many times for one description."""
    polygon = Polygon(name, corners)
    polygon._check()
    return polygon


def coplanar(a: Polygon, b: Polygon) -> bool:
    """Whether two polygons lie in one plane, whichever way their normals point."""
    same_plane = float(np.max(np.abs(a.height_of(b.points)))) < TOLERANCE
    return same_plane and abs(float(a.normal @ b.normal)) > 1.0 - 1e-6

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

from mascarin.errors import InputError

Array = npt.NDArray[np.float64]

#: Distance below which two points, lines or planes of a building are the same [m].
TOLERANCE = 1e-3


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
        edges = np.roll(self.points, -1, axis=0) - self.points
        for number, length in enumerate(np.linalg.norm(edges, axis=1), start=1):
            if length < TOLERANCE:
                following = number % len(self.vertices) + 1
                raise InputError(
                    f"surface '{self.name}': vertices {number} and {following} are {length:.2g} m apart; "
                    f"expected at least {TOLERANCE} m; remove one of them"
                )
        vector = self._vector_area
        size = float(np.max(np.linalg.norm(edges, axis=1)))
        if float(np.linalg.norm(vector)) < TOLERANCE * size:
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
        flat = self.in_plane(self.points)
        n = len(flat)
        for i in range(n):
            for j in range(i + 2, n):
                if i == 0 and j == n - 1:
                    continue
                if _cross_properly(flat[i], flat[(i + 1) % n], flat[j], flat[(j + 1) % n]):
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
        along = self.points[1] - self.points[0]
        along = along - (along @ self.normal) * self.normal
        along = along / np.linalg.norm(along)
        frame = np.stack([along, np.cross(self.normal, along)])
        flat: Array = (points - self.points[0]) @ frame.T
        return flat

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
        outline = self.in_plane(self.points)
        corners = self.in_plane(other.points)
        if not all(_inside(outline, p) for p in corners):
            return False
        crossing = any(
            _cross_properly(a, b, c, d)
            for a, b in zip(outline, np.roll(outline, -1, axis=0), strict=True)
            for c, d in zip(corners, np.roll(corners, -1, axis=0), strict=True)
        )
        return not crossing and other.area < self.area + TOLERANCE * self.perimeter

    def overlaps(self, other: Polygon) -> bool:
        """Whether two polygons in one plane have more in common than edges and corners."""
        if not coplanar(self, other):
            return False
        if self.contains(other) or other.contains(self):
            return True
        here, there = self.in_plane(self.points), self.in_plane(other.points)
        return any(
            _inside(outline, middle) and not _on_outline(outline, middle)
            for outline, cut in ((here, there), (there, here))
            for middle in _pieces(cut, outline)
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


def _turn(a: Array, b: Array, c: Array) -> float:
    """Twice the signed area of the triangle a, b, c in the plane. [m2]"""
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def _cross_properly(a: Array, b: Array, c: Array, d: Array) -> bool:
    return _turn(a, b, c) * _turn(a, b, d) < 0.0 and _turn(c, d, a) * _turn(c, d, b) < 0.0


def _pieces(outline: Array, other: Array) -> list[Array]:
    """Middles of the pieces of the edges of one polygon, cut by the lines of the edges of another."""
    middles = []
    for a, b in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        cuts = [0.0, 1.0]
        for c, d in zip(other, np.roll(other, -1, axis=0), strict=True):
            before, after = _turn(c, d, a), _turn(c, d, b)
            if before * after < 0.0:
                cuts.append(before / (before - after))
        middles += [a + 0.5 * (one + two) * (b - a) for one, two in pairwise(sorted(cuts))]
    return middles


def _on_outline(outline: Array, point: Array) -> bool:
    for a, b in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        along = b - a
        position = min(max(float((point - a) @ along) / float(along @ along), 0.0), 1.0)
        if float(np.linalg.norm(point - a - position * along)) < TOLERANCE:
            return True
    return False


def _inside(outline: Array, point: Array) -> bool:
    """Whether a point lies in a polygon of the plane or within the tolerance of its outline."""
    if _on_outline(outline, point):
        return True
    crossings = 0
    for a, b in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        along = b - a
        if (a[1] > point[1]) != (b[1] > point[1]):
            x = a[0] + (point[1] - a[1]) / along[1] * along[0]
            crossings += int(x > point[0])
    return crossings % 2 == 1

"""Plane polygons and the enclosures they bound: areas, directions, volumes, view factors.

Coordinates are metres with x to the east, y to the north and z up. The vertices of a surface run
counter-clockwise when it is seen from outside, so that the right-hand normal is the outside normal. For what
concerns the air of a zone every face must look *into* the zone: there an inside face is the reversed polygon
(:meth:`Polygon.reversed`), an outside face the polygon itself.

View factors are exact. The exchange area of two polygons that see each other completely is

    A_i F_ij = 1/(2 pi) sum_p sum_q (e_p . e_q) J_pq,   J_pq = int int ln r ds dt

over their edges p and q with unit directions e (Stokes' theorem applied twice; Sparrow 1963). J_pq has a
closed form for parallel, collinear and equal edges. For others the integral along one edge is closed and the
one along the second is taken to round-off by a double-exponential rule, split where the integrand is not
smooth. An edge or a corner shared by two faces, where ln r is singular, is therefore no special case.

References
----------
E. M. Sparrow, "A new and simpler formulation for radiative angle factors", J. Heat Transfer 85(2), 1963,
doi:10.1115/1.3686058.
J. R. Howell, M. P. Menguc, R. Siegel, "Thermal Radiation Heat Transfer", 6th ed., CRC Press, 2015,
doi:10.1201/b18835 (view-factor algebra).
H. Takahasi, M. Mori, "Double exponential formulas for numerical integration", Publ. RIMS 9(3), 1974,
doi:10.2977/prims/1195192451.
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
#: Largest deviation of the row sums of exact view factors of a closed convex zone from one [-].
CLOSURE_LIMIT = 1e-6


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
        """Make a polygon and check that it is one.

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
                        "expected the corners in the order in which one walks around the surface"
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
        """The same outline seen from the other side."""
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
        """Whether two polygons of one plane share more than edges and corners."""
        if not _coplanar(self, other):
            return False
        if self.contains(other) or other.contains(self):
            return True
        here, there = self.in_plane(self.points), self.in_plane(other.points)
        return any(
            _inside(outline, middle) and not _on_outline(outline, middle)
            for outline, cut in ((here, there), (there, here))
            for middle in _pieces(cut, outline)
        )


@lru_cache(maxsize=4096)
def _checked(name: str, corners: tuple[tuple[float, float, float], ...]) -> Polygon:
    """Check a polygon: once, for a description asks for each of its own many times."""
    polygon = Polygon(name, corners)
    polygon._check()
    return polygon


@dataclass(frozen=True)
class OpenEdge:
    """A piece of edge that no second face closes."""

    face: str
    start: tuple[float, float, float]
    end: tuple[float, float, float]

    @property
    def length(self) -> float:
        """Length of the piece. [m]"""
        return math.dist(self.start, self.end)

    def __str__(self) -> str:
        a = ", ".join(f"{c:.3f}" for c in self.start)
        b = ", ".join(f"{c:.3f}" for c in self.end)
        return f"{self.face}: from ({a}) to ({b}), {self.length:.3f} m"


def parents(polygons: Sequence[Polygon]) -> list[int | None]:
    """For every polygon the smallest other one that contains it (a wall for its door), or None.

    Parameters
    ----------
    polygons : sequence of Polygon
        Any surfaces.

    Returns
    -------
    list of int or None
        Index of the direct parent.

    Raises
    ------
    InputError
        Two polygons cover the same area.
    """
    found: list[int | None] = []
    for i, child in enumerate(polygons):
        best: int | None = None
        for j, candidate in enumerate(polygons):
            if i == j or not candidate.contains(child):
                continue
            if child.contains(candidate):
                raise InputError(
                    f"surfaces '{child.name}' and '{candidate.name}' cover the same area; keep one of them"
                )
            if best is None or candidate.area < polygons[best].area:
                best = j
        found.append(best)
    return found


def net_areas(polygons: Sequence[Polygon]) -> Array:
    """Areas without what lies in the polygons as surfaces of their own.

    Parameters
    ----------
    polygons : sequence of Polygon
        Any surfaces.

    Returns
    -------
    array, shape (n,)
        Areas. [m2]

    Raises
    ------
    InputError
        The surfaces in a surface leave nothing of it.
    """
    areas = np.array([p.area for p in polygons])
    net = areas.copy()
    for i, parent in enumerate(parents(polygons)):
        if parent is not None:
            net[parent] -= areas[i]
    for polygon, left in zip(polygons, net, strict=True):
        if left <= 0.0:
            raise InputError(
                f"surface '{polygon.name}': the surfaces in it leave {left:.3f} m2 of {polygon.area:.3f} m2; "
                "expected a rest; give the surfaces side by side instead"
            )
    return net


def open_edges(faces: Sequence[Polygon]) -> list[OpenEdge]:
    """Pieces of edges where a shell of faces is not closed.

    In a closed shell of faces that all look inward every piece of an edge is walked once in either direction.
    Faces that lie in another face are left out: their parent covers them.

    Parameters
    ----------
    faces : sequence of Polygon
        Faces of a zone, all normals into the zone (or all out of it).

    Returns
    -------
    list of OpenEdge
        Empty if the shell is closed within :data:`TOLERANCE`.
    """
    shell = [f for f, parent in zip(faces, parents(faces), strict=True) if parent is None]
    edges = [
        (face.name, face.points[i], face.points[(i + 1) % len(face.points)])
        for face in shell
        for i in range(len(face.points))
    ]
    gaps = []
    for name, start, end in edges:
        gaps += [OpenEdge(name, _triple(a), _triple(b)) for a, b in _uncovered(start, end, edges)]
    return gaps


def _uncovered(
    start: Array, end: Array, edges: Sequence[tuple[str, Array, Array]]
) -> list[tuple[Array, Array]]:
    """Pieces of one edge whose directed cover by all edges on its line does not cancel."""
    length = float(np.linalg.norm(end - start))
    along = (end - start) / length
    pieces: list[tuple[float, float, int]] = []
    for _, a, b in edges:
        if _off_line(a, start, along) > TOLERANCE or _off_line(b, start, along) > TOLERANCE:
            continue
        s, t = float((a - start) @ along), float((b - start) @ along)
        pieces.append((min(s, t), max(s, t), 1 if t > s else -1))
    cuts = sorted({0.0, length, *(c for piece in pieces for c in piece[:2] if 0.0 < c < length)})
    open_pieces = []
    for low, high in pairwise(cuts):
        if high - low <= 2.0 * TOLERANCE:
            continue
        middle = 0.5 * (low + high)
        if sum(sign for a, b, sign in pieces if a < middle < b) > 0:
            open_pieces.append((start + low * along, start + high * along))
    return open_pieces


def volume(faces: Sequence[Polygon]) -> float:
    """Volume enclosed by the faces of a zone (divergence theorem).

    Parameters
    ----------
    faces : sequence of Polygon
        All faces of the zone, normals into the zone. Faces within a face (a door in a wall) may be listed.

    Returns
    -------
    float
        Volume. [m3]

    Raises
    ------
    InputError
        The faces leave gaps, or look out of the zone.
    """
    gaps = open_edges(faces)
    if gaps:
        shown = "; ".join(str(gap) for gap in gaps[:6])
        more = f"; and {len(gaps) - 6} more" if len(gaps) > 6 else ""
        raise InputError(
            f"the faces do not close the zone: {len(gaps)} open edges ({shown}{more}); "
            "expected every edge to be shared by two faces; complete the vertices or give the volume"
        )
    origin = faces[0].points[0]
    total = 0.0
    for face, parent in zip(faces, parents(faces), strict=True):
        if parent is None:
            total -= face.area * float((face.points[0] - origin) @ face.normal) / 3.0
    if total <= 0.0:
        raise InputError(
            f"the faces enclose {total:.3f} m3: their normals point out of the zone; "
            "expected the vertices of every surface counter-clockwise seen from outside"
        )
    return total


def check_convex(faces: Sequence[Polygon]) -> None:
    """Check that every face sees every other one completely.

    Parameters
    ----------
    faces : sequence of Polygon
        Faces of a zone, normals into the zone.

    Raises
    ------
    InputError
        A corner lies behind a face.
    """
    for face in faces:
        for other in faces:
            heights = face.height_of(other.points)
            worst = int(np.argmin(heights))
            if heights[worst] < -TOLERANCE:
                raise InputError(
                    f"the zone is not convex: vertex {worst + 1} of '{other.name}' lies "
                    f"{-heights[worst]:.3f} m behind '{face.name}'; exact view factors need a convex zone; "
                    "split the zone or give its view_factors"
                )


def exchange_areas(faces: Sequence[Polygon]) -> Array:
    """Exchange areas A_i F_ij between the faces of a convex zone.

    A face that lies in another one takes its part from the parent: the row of a wall is that of the whole
    outline less those of its door and windows.

    Parameters
    ----------
    faces : sequence of Polygon
        Faces of a convex zone, normals into the zone.

    Returns
    -------
    array, shape (n, n)
        Symmetric, zero between faces of one plane. [m2]

    Raises
    ------
    InputError
        The zone is not convex.
    """
    check_convex(faces)
    n = len(faces)
    gross = np.zeros((n, n))
    for i in range(n):
        for j in range(i + 1, n):
            gross[i, j] = gross[j, i] = _exchange_area(faces[i], faces[j])
    algebra = np.eye(n)
    for child, parent in enumerate(parents(faces)):
        if parent is not None:
            algebra[parent, child] = -1.0
    net = algebra @ gross @ algebra.T
    symmetric: Array = np.maximum(0.5 * (net + net.T), 0.0)
    return symmetric


def view_factors(faces: Sequence[Polygon]) -> Array:
    """View factors F_ij (from i to j) between the faces of a closed convex zone.

    Parameters
    ----------
    faces : sequence of Polygon
        All faces of the zone, normals into the zone. Faces within a face may be listed.

    Returns
    -------
    array, shape (n, n)
        Rows sum to one within :data:`CLOSURE_LIMIT`; A_i F_ij is symmetric. [-]

    Raises
    ------
    InputError
        The zone is not convex or not closed.
    """
    factors: Array = exchange_areas(faces) / net_areas(faces)[:, None]
    sums = factors.sum(axis=1)
    worst = int(np.argmax(np.abs(sums - 1.0)))
    if abs(sums[worst] - 1.0) > CLOSURE_LIMIT:
        gaps = "; ".join(str(gap) for gap in open_edges(faces)[:4])
        reason = f"open edges: {gaps}" if gaps else "coordinates agree only roughly"
        raise InputError(
            f"the view factors from '{faces[worst].name}' sum to {sums[worst]:.7f}; expected 1 within "
            f"{CLOSURE_LIMIT:g} in a closed zone ({reason}); correct the vertices or give its view_factors"
        )
    return factors


# --- the contour integral --------------------------------------------------------------------------------


def _exchange_area(a: Polygon, b: Polygon) -> float:
    """A F between two polygons that see each other completely. [m2]"""
    if _coplanar(a, b):
        return 0.0
    total = 0.0
    for p0, p1 in _edges(a):
        for q0, q1 in _edges(b):
            cosine = float((p1 - p0) @ (q1 - q0))
            if abs(cosine) > 1e-14 * float(np.linalg.norm(p1 - p0) * np.linalg.norm(q1 - q0)):
                total += cosine * log_integral(p0, p1, q0, q1)
    return max(total / (2.0 * math.pi), 0.0)


def log_integral(p0: Array, p1: Array, q0: Array, q1: Array) -> float:
    """Mean of ln r over two straight edges: the double integral over both, divided by both lengths.

    Parameters
    ----------
    p0, p1, q0, q1 : array, shape (3,)
        Ends of the two edges. [m]

    Returns
    -------
    float
        Mean logarithm of the distance in metres. [-]
    """
    length_p, length_q = float(np.linalg.norm(p1 - p0)), float(np.linalg.norm(q1 - q0))
    e, f = (p1 - p0) / length_p, (q1 - q0) / length_q
    if float(np.linalg.norm(np.cross(e, f))) < 1e-10:
        total = _parallel(q0 - p0, e, math.copysign(1.0, float(e @ f)), length_p, length_q)
    else:
        total = _skew(p0, p1, q0, length_q, e, f)
    return total / (length_p * length_q)


def _parallel(between: Array, e: Array, sign: float, length_p: float, length_q: float) -> float:
    """Double integral of ln r over two parallel edges, from its second antiderivative in u = s - t."""
    offset = float(between @ e)
    d = float(np.linalg.norm(between - offset * e))
    if d < 1e-9 * (length_p + length_q):
        d = 0.0

    def second(u: float) -> float:
        r2 = u * u + d * d
        log = math.log(r2) if r2 > 0.0 else 0.0
        turn = 2.0 * d * u * math.atan2(u, d) if d > 0.0 else 0.0
        return 0.5 * (0.5 * (u * u - d * d) * log - 1.5 * u * u + turn)

    low, high = (offset, offset + length_q) if sign > 0 else (offset - length_q, offset)
    return second(length_p - low) + second(-high) - second(-low) - second(length_p - high)


def _skew(p0: Array, p1: Array, q0: Array, length_q: float, e: Array, f: Array) -> float:
    """Double integral of ln r over two edges that are not parallel.

    Along the first edge the antiderivative of ln sqrt(x^2 + d^2) is elementary; d is the distance of a point
    of the second edge from the line of the first. Along the second edge the result is smooth but for weak
    (x ln x) singularities near the points closest to the ends of the first edge and to its line: it is split
    there.
    """
    normal = np.cross(e, f)
    foot = -float(np.cross(q0 - p0, e) @ normal) / float(normal @ normal)
    inner = (float((p0 - q0) @ f), float((p1 - q0) @ f), foot)
    cuts = np.array(sorted({0.0, length_q, *(t for t in inner if 0.0 < t < length_q)}))
    nodes, weights = _tanh_sinh()
    widths = np.diff(cuts)
    t = (cuts[:-1, None] + widths[:, None] * nodes).ravel()
    from_p0 = (q0 - p0) + t[:, None] * f
    x = from_p0 @ e
    d = np.linalg.norm(from_p0 - x[:, None] * e, axis=1)
    length_p = float((p1 - p0) @ e)
    values = _log_antiderivative(length_p - x, d) + _log_antiderivative(x, d)
    return float(values @ (widths[:, None] * weights).ravel())


def _log_antiderivative(x: Array, d: Array) -> Array:
    """Integral of ln sqrt(x^2 + d^2) over x from 0."""
    r2 = np.maximum(x * x + d * d, 1e-300)
    result: Array = 0.5 * x * np.log(r2) - x + d * np.arctan2(x, d)
    return result


@lru_cache(maxsize=1)
def _tanh_sinh() -> tuple[Array, Array]:
    """Nodes and weights on [0, 1] of the double-exponential rule (Takahasi & Mori 1974)."""
    step = 0.08
    u = step * np.arange(-42, 43)
    inner = 0.5 * math.pi * np.sinh(u)
    nodes = 1.0 / (1.0 + np.exp(-2.0 * inner))
    weights = 0.25 * math.pi * step * np.cosh(u) / np.cosh(inner) ** 2
    return nodes, weights


# --- small helpers --------------------------------------------------------------------------------


def _edges(polygon: Polygon) -> list[tuple[Array, Array]]:
    p = polygon.points
    return [(p[i], p[(i + 1) % len(p)]) for i in range(len(p))]


def _coplanar(a: Polygon, b: Polygon) -> bool:
    same_plane = float(np.max(np.abs(a.height_of(b.points)))) < TOLERANCE
    return same_plane and abs(float(a.normal @ b.normal)) > 1.0 - 1e-6


def _off_line(point: Array, start: Array, along: Array) -> float:
    between = point - start
    return float(np.linalg.norm(between - (between @ along) * along))


def _triple(point: Array) -> tuple[float, float, float]:
    return (float(point[0]), float(point[1]), float(point[2]))


def _turn(a: Array, b: Array, c: Array) -> float:
    """Twice the signed area of the triangle a, b, c in the plane. [m2]"""
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def _cross_properly(a: Array, b: Array, c: Array, d: Array) -> bool:
    return _turn(a, b, c) * _turn(a, b, d) < 0.0 and _turn(c, d, a) * _turn(c, d, b) < 0.0


def _pieces(outline: Array, other: Array) -> list[Array]:
    """Middles of the pieces into which the lines of one polygon's edges cut the edges of another."""
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

"""Exact view factors between the polygons of a convex zone.

The exchange area of two polygons that see each other completely is

    A_i F_ij = 1/(2 pi) sum_p sum_q (e_p . e_q) J_pq,   J_pq = int int ln r ds dt

over their edges p and q with unit directions e (Stokes' theorem applied twice; Sparrow 1963). J_pq has an
analytical solution for parallel, collinear and equal edges. For others the integral along one edge is
analytical, and the one along the second is computed to round-off by a double-exponential rule, split where
the integrand is not smooth. An edge or a corner that two polygons have in common, where ln r is singular,
needs no special treatment.

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
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from mascarin.building.geometry.enclosure import check_convex, net_areas, net_of, open_edges, parents
from mascarin.building.geometry.polygon import Polygon, coplanar
from mascarin.errors import InputError

Array = npt.NDArray[np.float64]
Point = tuple[float, float, float]

#: Largest deviation of the row sums of exact view factors of a closed convex zone from one [-].
CLOSURE_LIMIT = 1e-6


def exchange_areas(polygons: Sequence[Polygon]) -> Array:
    """Exchange areas A_i F_ij between the polygons of a convex zone.

    A polygon that lies in another one is subtracted from it: the row of a wall is that of its whole outline
    minus those of its door and windows.

    Parameters
    ----------
    polygons : sequence of Polygon
        Surfaces of a convex zone, normals into the zone.

    Returns
    -------
    array, shape (n, n)
        Symmetric, zero between polygons in one plane. [m2]

    Raises
    ------
    InputError
        The zone is not convex.
    """
    return _net_exchange(polygons, parents(polygons))


def _net_exchange(polygons: Sequence[Polygon], within: Sequence[int | None]) -> Array:
    check_convex(polygons)
    gross = _gross(_shape(polygons))
    algebra = np.eye(len(polygons))
    for child, parent in enumerate(within):
        if parent is not None:
            algebra[parent, child] = -1.0
    net = algebra @ gross @ algebra.T
    symmetric: Array = np.maximum(0.5 * (net + net.T), 0.0)
    return symmetric


def closed_exchange_areas(polygons: Sequence[Polygon]) -> Array:
    """Exchange areas A_i F_ij between the polygons of a convex zone that is closed.

    Parameters
    ----------
    polygons : sequence of Polygon
        All surfaces of the zone, normals into the zone; also those within another one.

    Returns
    -------
    array, shape (n, n)
        Symmetric; rows sum to the net areas within :data:`CLOSURE_LIMIT`. [m2]

    Raises
    ------
    InputError
        The zone is not convex or not closed.
    """
    within = parents(polygons)
    exchange, areas = _net_exchange(polygons, within), net_of(polygons, within)
    sums = exchange.sum(axis=1) / areas
    worst = int(np.argmax(np.abs(sums - 1.0)))
    if abs(sums[worst] - 1.0) > CLOSURE_LIMIT:
        gaps = "; ".join(str(gap) for gap in open_edges(polygons)[:4])
        reason = f"open edges: {gaps}" if gaps else "the coordinates are not exact"
        raise InputError(
            f"the view factors from '{polygons[worst].name}' sum to {sums[worst]:.7f}; expected 1 within "
            f"{CLOSURE_LIMIT:g} in a closed zone ({reason}); correct the vertices or give its view_factors"
        )
    return exchange


def view_factors(polygons: Sequence[Polygon]) -> Array:
    """View factors F_ij (from i to j) between the polygons of a closed convex zone.

    Parameters
    ----------
    polygons : sequence of Polygon
        All surfaces of the zone, normals into the zone; also those within another one.

    Returns
    -------
    array, shape (n, n)
        Rows sum to one within :data:`CLOSURE_LIMIT`; A_i F_ij is symmetric. [-]

    Raises
    ------
    InputError
        The zone is not convex or not closed.
    """
    factors: Array = closed_exchange_areas(polygons) / net_areas(polygons)[:, None]
    return factors


# --- the contour integral --------------------------------------------------------------------------------


Shape = tuple[tuple[Point, ...], ...]


def _shape(polygons: Sequence[Polygon]) -> Shape:
    """Corners from the first one of all [m]: rooms of one shape are the same wherever they are."""
    x, y, z = polygons[0].vertices[0]
    return tuple(
        tuple((round(u - x, 12), round(v - y, 12), round(w - z, 12)) for u, v, w in polygon.vertices)
        for polygon in polygons
    )


@lru_cache(maxsize=1024)
def _gross(shape: Shape) -> Array:
    """Exchange areas between polygons, none subtracted from another: equal rooms are worked out once. [m2]"""
    polygons = [Polygon("", corners) for corners in shape]
    factors = np.zeros((len(polygons), len(polygons)))
    for i, polygon in enumerate(polygons):
        for j, other in enumerate(polygons[:i]):
            factors[i, j] = factors[j, i] = _exchange_area(other, polygon)
    factors.flags.writeable = False
    return factors


def _exchange_area(a: Polygon, b: Polygon) -> float:
    """A F between two polygons that see each other completely. [m2]"""
    return 0.0 if coplanar(a, b) else _relative_exchange_area(*_shape((a, b)))


@lru_cache(maxsize=16384)
def _relative_exchange_area(a: tuple[Point, ...], b: tuple[Point, ...]) -> float:
    """A F between two polygons given by their corners: equal rooms of a building are worked out once. [m2]"""
    (p0, p1), (q0, q1) = (_edges(np.array(corners)) for corners in (a, b))
    first, second = (index.ravel() for index in np.indices((len(p0), len(q0))))
    p0, p1, q0, q1 = p0[first], p1[first], q0[second], q1[second]
    cosines = np.sum((p1 - p0) * (q1 - q0), axis=1)
    acts = np.abs(cosines) > 1e-14 * _lengths(p1 - p0) * _lengths(q1 - q0)
    integrals = _log_integrals(p0[acts], p1[acts], q0[acts], q1[acts])
    return max(float(cosines[acts] @ integrals) / (2.0 * math.pi), 0.0)


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
    return float(_log_integrals(p0[None], p1[None], q0[None], q1[None])[0])


def _log_integrals(p0: Array, p1: Array, q0: Array, q1: Array) -> Array:
    """The same for pairs of edges, whose ends are the rows."""
    length_p, length_q = _lengths(p1 - p0), _lengths(q1 - q0)
    e, f = (p1 - p0) / length_p[:, None], (q1 - q0) / length_q[:, None]
    parallel = _lengths(np.cross(e, f)) < 1e-10
    totals = np.empty(len(p0))
    along = np.sum(e * f, axis=1)[parallel]
    totals[parallel] = _parallel(
        (q0 - p0)[parallel], e[parallel], along, length_p[parallel], length_q[parallel]
    )
    for k in np.flatnonzero(~parallel):
        totals[k] = _skew(p0[k], p1[k], q0[k], length_q[k], e[k], f[k])
    return totals / (length_p * length_q)


def _parallel(between: Array, e: Array, along: Array, length_p: Array, length_q: Array) -> Array:
    """Double integrals of ln r over parallel edges, from its second antiderivative in u = s - t."""
    offset = np.sum(between * e, axis=1)
    d = _lengths(between - offset[:, None] * e)
    d = np.where(d < 1e-9 * (length_p + length_q), 0.0, d)

    def second(u: Array) -> Array:
        r2 = u * u + d * d
        log = np.log(np.where(r2 > 0.0, r2, 1.0))
        result: Array = 0.5 * (0.5 * (u * u - d * d) * log - 1.5 * u * u + 2.0 * d * u * np.arctan2(u, d))
        return result

    low = np.where(along > 0.0, offset, offset - length_q)
    high = low + length_q
    return second(length_p - low) + second(-high) - second(-low) - second(length_p - high)


def _lengths(vectors: Array) -> Array:
    """Lengths of the rows."""
    lengths: Array = np.sqrt(np.sum(vectors * vectors, axis=1))
    return lengths


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


def _edges(corners: Array) -> tuple[Array, Array]:
    """Begins and ends of the edges of a polygon."""
    return corners, np.roll(corners, -1, axis=0)

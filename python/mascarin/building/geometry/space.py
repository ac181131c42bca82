"""Vectors in space: products, distances from planes, the area that corners enclose.

In plain floats: a polygon has a few corners, for which they are some ten times faster than arrays.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

Triple: TypeAlias = tuple[float, float, float]
"""Three coordinates. [m]"""


def dot(a: Sequence[float], b: Sequence[float]) -> float:
    """Scalar product.

    Parameters
    ----------
    a, b : (x, y, z)
        Vectors. [m]
    """
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def vector_product(a: Sequence[float], b: Sequence[float]) -> Triple:
    """Vector product.

    Parameters
    ----------
    a, b : (x, y, z)
        Vectors. [m]
    """
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def subtracted(a: Sequence[float], b: Sequence[float]) -> Triple:
    """The vector from `b` to `a`.

    Parameters
    ----------
    a, b : (x, y, z)
        Points. [m]
    """
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def height(point: Sequence[float], start: Sequence[float], normal: Sequence[float]) -> float:
    """Signed distance of a point from a plane. [m]

    Parameters
    ----------
    point, start : (x, y, z)
        The point, and one of the plane. [m]
    normal : (x, y, z)
        Unit normal of the plane. [-]
    """
    x, y, z = point
    return (x - start[0]) * normal[0] + (y - start[1]) * normal[1] + (z - start[2]) * normal[2]


def vector_area(corners: Sequence[Triple]) -> Triple:
    """Vector along the normal of a polygon, as long as its area is large. [m2]

    Newell: half the sum of the vector products of neighboring corners, about the first one for accuracy.

    Parameters
    ----------
    corners : sequence of (x, y, z)
        Corners in order. [m]
    """
    x = y = z = 0.0
    a = subtracted(corners[1], corners[0])
    for corner in corners[2:]:
        b = subtracted(corner, corners[0])
        u, v, w = vector_product(a, b)
        x, y, z, a = x + u, y + v, z + w, b
    return 0.5 * x, 0.5 * y, 0.5 * z

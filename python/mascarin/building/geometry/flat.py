"""Outlines in a plane: which points lie inside, which edges cross.

In plain floats: an outline has a few corners, for which they are some ten times faster than arrays.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final, TypeAlias, TypeVar

#: Distance below which two points, lines or planes of a building are the same. [m]
TOLERANCE: Final = 1e-3

Point: TypeAlias = Sequence[float]
"""Two coordinates. [m]"""
Corner = TypeVar("Corner", bound=Sequence[float])


def edges(outline: Sequence[Corner]) -> Iterator[tuple[Corner, Corner]]:
    """Both ends of each edge of an outline.

    Parameters
    ----------
    outline : sequence of (x, y) or (x, y, z)
        Corners in order. [m]
    """
    return zip(outline, [*outline[1:], outline[0]], strict=True)


def turn(a: Point, b: Point, c: Point) -> float:
    """Twice the signed area of the triangle a, b, c. [m2]

    Parameters
    ----------
    a, b, c : (x, y)
        Corners. [m]
    """
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def cross(a: Point, b: Point, c: Point, d: Point) -> bool:
    """Whether the edges from a to b and from c to d cross, not only touch.

    Parameters
    ----------
    a, b, c, d : (x, y)
        Ends of the edges. [m]
    """
    return turn(a, b, c) * turn(a, b, d) < 0.0 and turn(c, d, a) * turn(c, d, b) < 0.0


def on_outline(outline: Sequence[Point], point: Point) -> bool:
    """Whether a point lies within the tolerance of an edge.

    Parameters
    ----------
    outline : sequence of (x, y)
        Corners in order. [m]
    point : (x, y)
        The point. [m]
    """
    x, y = point
    for (ax, ay), (bx, by) in edges(outline):
        dx, dy = bx - ax, by - ay
        position = min(max(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy), 0.0), 1.0)
        if math.hypot(x - ax - position * dx, y - ay - position * dy) < TOLERANCE:
            return True
    return False


def inside(outline: Sequence[Point], point: Point) -> bool:
    """Whether a point lies in an outline or within the tolerance of its edges.

    Parameters
    ----------
    outline : sequence of (x, y)
        Corners in order. [m]
    point : (x, y)
        The point. [m]
    """
    if on_outline(outline, point):
        return True
    x, y = point
    crossings = 0
    for (ax, ay), (bx, by) in edges(outline):
        if (ay > y) != (by > y):
            crossings += ax + (y - ay) / (by - ay) * (bx - ax) > x
    return crossings % 2 == 1


def middles_of_pieces(outline: Sequence[Point], other: Sequence[Point]) -> list[Point]:
    """Middles of the pieces of the edges of one outline, cut by the lines of the edges of another.

    Parameters
    ----------
    outline, other : sequence of (x, y)
        Corners in order. [m]
    """
    middles: list[Point] = []
    for a, b in edges(outline):
        cuts = [0.0, 1.0]
        for c, d in edges(other):
            before, after = turn(c, d, a), turn(c, d, b)
            if before * after < 0.0:
                cuts.append(before / (before - after))
        for begin, two in pairwise(sorted(cuts)):
            share = 0.5 * (begin + two)
            middles.append((a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])))
    return middles

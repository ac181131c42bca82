"""Which polygons stand in front of others."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from mascarin.building.geometry.flat import TOLERANCE
from mascarin.building.geometry.polygon import Array, Polygon

#: Height above a plane per distance from the polygon in it below which a point counts as in the plane:
#: planes are known no better where corners are rounded [-].
_SLOPE = 1e-3


def in_front(polygon: Polygon, obstacles: Sequence[Polygon]) -> list[int]:
    """Polygons of which a part stands on the side of the normal of a polygon.

    Parameters
    ----------
    polygon : Polygon
        The polygon.
    obstacles : sequence of Polygon
        What may stand in front of it; itself and others in its plane do not.

    Returns
    -------
    list of int
        Their positions.

    Examples
    --------
    >>> south = Polygon.of("south", [(0, 0, 0), (4, 0, 0), (4, 0, 3), (0, 0, 3)])
    >>> fin = Polygon.of("fin", [(4, 0, 0), (4, -1, 0), (4, -1, 3), (4, 0, 3)])
    >>> roof = Polygon.of("roof", [(0, 0, 3), (4, 0, 3), (4, 5, 3), (0, 5, 3)])
    >>> in_front(south, [south, fin, roof])
    [1]
    """
    return InFront(obstacles).of(polygon)


class InFront:
    """Polygons that may stand in front of others, kept for several questions.

    Parameters
    ----------
    others : sequence of Polygon
        What may stand in front of a polygon.

    Examples
    --------
    >>> fin = Polygon.of("fin", [(4, 0, 0), (4, -1, 0), (4, -1, 3), (4, 0, 3)])
    >>> InFront([fin]).of(Polygon.of("south", [(0, 0, 0), (4, 0, 0), (4, 0, 3), (0, 0, 3)]))
    [0]
    """

    def __init__(self, obstacles: Sequence[Polygon]) -> None:
        self._others = obstacles
        self._points = np.concatenate([np.zeros((0, 3)), *(other.points for other in obstacles)])
        counts = [len(other.vertices) for other in obstacles]
        self._owners = np.repeat(np.arange(len(obstacles)), counts)

    def of(self, polygon: Polygon) -> list[int]:
        """Positions of those of which a part stands in front of a polygon; see `in_front`."""
        above = polygon.height_of(self._points) > TOLERANCE
        owners, points = self._owners[above], self._points[above]
        high = set(owners[_rising(polygon, points)].tolist())
        for k in sorted(set(owners.tolist()) - high):
            if _rising(polygon, _nearest_point(polygon, self._others[k])).any():
                high.add(k)
        return sorted(high)


def _rising(polygon: Polygon, points: Array) -> npt.NDArray[np.bool_]:
    """Which of some points are too high above a polygon to count as in its plane, shape (m,)."""
    least = np.maximum(_SLOPE * _distances(polygon, points), TOLERANCE)
    higher: npt.NDArray[np.bool_] = polygon.height_of(points) > least
    return higher


def _nearest_point(polygon: Polygon, other: Polygon) -> Array:
    """Points of another polygon above the corners of a polygon or beside them, shape (m, 3). [m]"""
    steep = float(polygon.normal @ other.normal)
    start, along = other.points, np.roll(other.points, -1, axis=0) - other.points
    level = along - np.outer(along @ polygon.normal, polygon.normal)
    long = np.maximum((level * level).sum(axis=1), TOLERANCE**2)
    position = ((polygon.points[:, None] - start) * level).sum(axis=2) / long
    beside: Array = (start + np.clip(position, 0.0, 1.0)[:, :, None] * along).reshape(-1, 3)
    if abs(steep) < _SLOPE:
        return beside
    over = polygon.points - np.outer(other.height_of(polygon.points) / steep, polygon.normal)
    return np.concatenate([beside, over[_distances(other, over) == 0.0]])


def _distances(polygon: Polygon, points: Array) -> Array:
    """Distances of points from a polygon, both seen along its normal, shape (m,). [m]"""
    outline, flat = polygon.in_plane(polygon.points), polygon.in_plane(points)
    along = np.roll(outline, -1, axis=0) - outline
    from_start = flat[:, None] - outline
    position = np.clip((from_start * along).sum(axis=2) / (along * along).sum(axis=1), 0.0, 1.0)
    gaps: Array = np.linalg.norm(from_start - position[:, :, None] * along, axis=2).min(axis=1)
    (x, y), (u, v) = flat.T[:, :, None], outline.T
    ends = np.roll(v, -1)
    crossed = (v > y) != (ends > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        right = u + (y - v) / (ends - v) * along[:, 0] > x
    inside = (crossed & right).sum(axis=1) % 2 == 1
    return np.where(inside, 0.0, gaps)

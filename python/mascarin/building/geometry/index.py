"""Polygons by the boxes around them: which ones can contain or touch another, without comparing all pairs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from mascarin.building.geometry.flat import TOLERANCE
from mascarin.building.geometry.polygon import Polygon


class BoxIndex:
    """Boxes around polygons, along the axes.

    Parameters
    ----------
    polygons : sequence of Polygon
        Any surfaces.

    Examples
    --------
    >>> from mascarin.building.geometry import Polygon
    >>> wall = Polygon.of("wall", [(0, 0, 0), (4, 0, 0), (4, 0, 3), (0, 0, 3)])
    >>> door = Polygon.of("door", [(1, 0, 0), (2, 0, 0), (2, 0, 2), (1, 0, 2)])
    >>> BoxIndex([wall, door]).around(door)
    [0, 1]
    """

    def __init__(self, polygons: Sequence[Polygon]) -> None:
        boxes = np.array([_box(polygon) for polygon in polygons]).reshape(-1, 2, 3)
        self._low, self._high = boxes[:, 0], boxes[:, 1]

    def around(self, polygon: Polygon) -> list[int]:
        """Positions of the polygons whose boxes contain that of a polygon."""
        low, high = _box(polygon)
        # A corner may lie off the plane and outside the outline, by the tolerance each.
        slack = 2.0 * TOLERANCE
        return _true((self._low <= low + slack) & (self._high >= high - slack))

    def touching(self, polygon: Polygon) -> list[int]:
        """Positions of the polygons whose boxes meet that of a polygon."""
        low, high = _box(polygon)
        slack = 2.0 * TOLERANCE
        return _true((self._low <= high + slack) & (self._high >= low - slack))


def _box(polygon: Polygon) -> npt.NDArray[np.float64]:
    return np.stack([polygon.points.min(axis=0), polygon.points.max(axis=0)])


def _true(along_axes: npt.NDArray[np.bool_]) -> list[int]:
    found: list[int] = np.flatnonzero(along_axes.all(axis=1)).tolist()
    return found

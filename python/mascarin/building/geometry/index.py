"""Polygons by the boxes around them: which ones can contain or touch another, without comparing all pairs."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import product
from typing import Final, TypeAlias

from mascarin.building.geometry.flat import TOLERANCE
from mascarin.building.geometry.polygon import Polygon
from mascarin.building.geometry.space import Triple

Box: TypeAlias = tuple[Triple, Triple]
Cell: TypeAlias = tuple[int, ...]

#: Polygons that are compared one by one: a grid pays for more.
_LEAST_BOXES: Final = 24
#: Cells that one box may touch; a larger one is compared with all.
_MOST_CELLS: Final = 64


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
        self._boxes = [polygon.box for polygon in polygons]
        self._all = range(len(polygons))
        # A corner may lie off the plane and outside the outline, by the tolerance each.
        self._slack = 2.0 * TOLERANCE
        self._cells: dict[Cell, list[int]] | None = None
        self._large: list[int] = []
        if len(polygons) > _LEAST_BOXES:
            self._fill_cells()

    def around(self, polygon: Polygon) -> list[int]:
        """Positions of the polygons whose boxes contain that of a polygon."""
        (x, y, z), (u, v, w) = self._widened(polygon.box, -self._slack)
        indices = []
        for k in self._boxes_at((polygon.box[0], polygon.box[0])):
            (a, b, c), (d, e, f) = self._boxes[k]
            if a <= x and b <= y and c <= z and d >= u and e >= v and f >= w:
                indices.append(k)
        return indices

    def touching(self, polygon: Polygon) -> list[int]:
        """Positions of the polygons whose boxes meet that of a polygon."""
        (x, y, z), (u, v, w) = self._widened(polygon.box, self._slack)
        indices = []
        for k in self._boxes_at(polygon.box):
            (a, b, c), (d, e, f) = self._boxes[k]
            if a <= u and b <= v and c <= w and d >= x and e >= y and f >= z:
                indices.append(k)
        return indices

    def _fill_cells(self) -> None:
        """Note each box at the cells of a grid that it touches, or among the large ones."""
        wide = [max(h - w for w, h in zip(low, high, strict=True)) for low, high in self._boxes]
        self._size = sorted(wide)[len(wide) // 2] + 4.0 * self._slack
        cells: dict[Cell, list[int]] = {}
        for k, box in enumerate(self._boxes):
            touched = self._touched(self._widened(box, self._slack))
            if touched is None:
                self._large.append(k)
                continue
            for cell in touched:
                cells.setdefault(cell, []).append(k)
        self._cells = cells

    def _boxes_at(self, box: Box) -> Iterable[int]:
        """Positions of the boxes that can meet a box, in order."""
        if self._cells is None:
            return self._all
        touched = self._touched(box)
        if touched is None:
            return self._all
        indices = set(self._large)
        for cell in touched:
            indices.update(self._cells.get(cell, ()))
        return sorted(indices)

    def _touched(self, box: Box) -> Iterable[Cell] | None:
        """Cells of the grid that a box touches; None if they are many."""
        ways = [
            range(math.floor(low / self._size), math.floor(high / self._size) + 1)
            for low, high in zip(*box, strict=True)
        ]
        return product(*ways) if math.prod(map(len, ways)) <= _MOST_CELLS else None

    @staticmethod
    def _widened(box: Box, by: float) -> Box:
        (x, y, z), (u, v, w) = box
        return (x - by, y - by, z - by), (u + by, v + by, w + by)

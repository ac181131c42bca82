"""Enclosures of polygons: polygons inside others, net areas, gaps between edges, the enclosed volume."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from mascarin.building.geometry.flat import TOLERANCE, edges
from mascarin.building.geometry.index import BoxIndex
from mascarin.building.geometry.polygon import Polygon
from mascarin.errors import InputError

Array = npt.NDArray[np.float64]
Triple = tuple[float, float, float]


@dataclass(frozen=True)
class OpenEdge:
    """A piece of an edge that belongs to one polygon only."""

    polygon: str
    start: tuple[float, float, float]
    end: tuple[float, float, float]

    @property
    def length(self) -> float:
        """Length of the piece. [m]"""
        return math.dist(self.start, self.end)

    def __str__(self) -> str:
        a = ", ".join(f"{c:.3f}" for c in self.start)
        b = ", ".join(f"{c:.3f}" for c in self.end)
        return f"{self.polygon}: from ({a}) to ({b}), {self.length:.3f} m"


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
    parent_of: list[int | None] = []
    index = BoxIndex(polygons)
    for i, child in enumerate(polygons):
        best: int | None = None
        for j in index.around(child):
            candidate = polygons[j]
            if i == j or not candidate.contains(child):
                continue
            if child.contains(candidate):
                raise InputError(
                    f"surfaces '{child.name}' and '{candidate.name}' cover the same area; keep one of them"
                )
            if best is None or candidate.area < polygons[best].area:
                best = j
        parent_of.append(best)
    return parent_of


def net_areas(polygons: Sequence[Polygon]) -> Array:
    """Areas without the other surfaces inside the polygons.

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
    return net_of(polygons, parents(polygons))


def net_of(polygons: Sequence[Polygon], within: Sequence[int | None]) -> Array:
    """Areas without the other surfaces inside the polygons, given the `parents`; see `net_areas`.

    Parameters
    ----------
    polygons : sequence of Polygon
        Any surfaces.
    within : sequence of int or None
        Their direct parents.
    """
    areas = np.array([p.area for p in polygons])
    net = areas.copy()
    for i, parent in enumerate(within):
        if parent is not None:
            net[parent] -= areas[i]
    for polygon, area in zip(polygons, net, strict=True):
        if area <= 0.0:
            raise InputError(
                f"surface '{polygon.name}': the surfaces in it leave {area:.3f} m2 of {polygon.area:.3f} m2; "
                "expected more than 0; describe the surfaces side by side instead"
            )
    return net


def open_edges(polygons: Sequence[Polygon]) -> list[OpenEdge]:
    """Pieces of edges where the polygons do not enclose a volume.

    Where polygons that all point inward enclose a volume, every piece of an edge occurs once in each
    direction. Polygons that lie in another one are left out.

    Parameters
    ----------
    polygons : sequence of Polygon
        Surfaces of a zone, all normals into the zone (or all out of it).

    Returns
    -------
    list of OpenEdge
        Empty if the volume is closed within :data:`TOLERANCE`.
    """
    return _gaps([f for f, parent in zip(polygons, parents(polygons), strict=True) if parent is None])


def _gaps(shell: Sequence[Polygon]) -> list[OpenEdge]:
    """The open edges of polygons of which none lies in another one."""
    owners = [(polygon.name, *edge) for polygon in shell for edge in edges(polygon.vertices)]
    # Most edges are covered by one that runs from end to start between the same corners.
    backwards = Counter((end, start) for _, start, end in owners)
    forwards = Counter((start, end) for _, start, end in owners)
    unmatched = [owner for owner in owners if forwards[owner[1:]] != 1 or backwards[owner[1:]] != 1]
    if not unmatched:
        return []
    starts, ends = (np.array([owner[k] for owner in owners]) for k in (1, 2))
    gaps = []
    for name, start, end in unmatched:
        pieces = _uncovered(np.array(start), np.array(end), starts, ends)
        gaps += [OpenEdge(name, _triple(a), _triple(b)) for a, b in pieces]
    return gaps


def _uncovered(start: Array, end: Array, starts: Array, ends: Array) -> list[tuple[Array, Array]]:
    """Pieces of one edge that the edges on its line do not cover once in each direction."""
    length = float(np.linalg.norm(end - start))
    along = (end - start) / length
    (off_a, places_a), (off_b, places_b) = (_by_line(points, start, along) for points in (starts, ends))
    on_line = (off_a <= TOLERANCE) & (off_b <= TOLERANCE)
    pieces: list[tuple[float, float, int]] = [
        (min(s, t), max(s, t), 1 if t > s else -1)
        for s, t in zip(places_a[on_line].tolist(), places_b[on_line].tolist(), strict=True)
    ]
    cuts = sorted({0.0, length, *(c for piece in pieces for c in piece[:2] if 0.0 < c < length)})
    open_pieces = []
    for low, high in pairwise(cuts):
        if high - low <= 2.0 * TOLERANCE:
            continue
        middle = 0.5 * (low + high)
        if sum(sign for a, b, sign in pieces if a < middle < b) > 0:
            open_pieces.append((start + low * along, start + high * along))
    return open_pieces


def _order_error(reversed_surfaces: Sequence[str]) -> InputError:
    names = ", ".join(reversed_surfaces)
    return InputError(
        f"the vertices of {names} are in the reverse order of the other surfaces; expected the vertices of "
        f"every surface counter-clockwise seen from outside; reverse the order of those of {names}"
    )


def volume(polygons: Sequence[Polygon]) -> float:
    """Volume enclosed by the surfaces of a zone (divergence theorem).

    Parameters
    ----------
    polygons : sequence of Polygon
        All surfaces of the zone, normals into the zone; also those within another one (a door in a wall).

    Returns
    -------
    float
        Volume. [m3]

    Raises
    ------
    InputError
        There are gaps between the polygons, or they point out of the zone.
    """
    within = parents(polygons)
    shell = [polygon for polygon, parent in zip(polygons, within, strict=True) if parent is None]
    gaps = _gaps(shell)
    wrong = _reversed(polygons) if gaps else []
    if wrong:
        raise _order_error(wrong)
    if gaps:
        shown = "; ".join(str(gap) for gap in gaps[:6])
        more = f"; and {len(gaps) - 6} more" if len(gaps) > 6 else ""
        raise InputError(
            f"the surfaces do not enclose the zone: {len(gaps)} open edges ({shown}{more}); "
            "expected every edge to belong to two surfaces; complete the vertices or give the volume"
        )
    total = _signed_volume(polygons[0], shell)
    if total <= 0.0:
        raise InputError(
            f"the surfaces enclose {total:.3f} m3: their normals point out of the zone; "
            "expected the vertices of every surface counter-clockwise seen from outside; reverse the order "
            "of "
            "the vertices of every surface"
        )
    return total


def _signed_volume(first: Polygon, shell: Sequence[Polygon]) -> float:
    """Volume from the polygons that lie in no other one, about a corner of one of them."""
    origin, total = first.vertices[0], 0.0
    for polygon in shell:
        total += polygon.area * polygon.above(origin) / 3.0
    return total


def _reversed(polygons: Sequence[Polygon]) -> list[str]:
    """Names of the polygons whose reversal closes the volume; none if reversal is not what is wrong.

    Two polygons that share an edge point to the same side of the shell if they run along it in opposite
    directions. From the first one on, each neighbour is turned until it does.
    """
    turned = {0: False}
    edges = [
        [(_triple(p.points[i]), _triple(p.points[(i + 1) % len(p.points)])) for i in range(len(p.points))]
        for p in polygons
    ]
    pending = [0]
    while pending:
        index = pending.pop()
        for other in range(len(polygons)):
            if other in turned:
                continue
            same = any(_meet(a, b, c, d) for a, b in edges[index] for c, d in edges[other])
            opposite = any(_meet(a, b, d, c) for a, b in edges[index] for c, d in edges[other])
            if same != opposite:
                turned[other] = turned[index] != same
                pending.append(other)
    for wrong in ({k for k, turn in turned.items() if turn}, {k for k, turn in turned.items() if not turn}):
        mended = [p.reversed() if k in wrong else p for k, p in enumerate(polygons)]
        if 0 < len(wrong) < len(polygons):
            shell = [p for p, parent in zip(mended, parents(mended), strict=True) if parent is None]
            if not _gaps(shell) and _signed_volume(mended[0], shell) > 0.0:
                return [polygons[k].name for k in sorted(wrong)]
    return []


def _meet(a: Triple, b: Triple, c: Triple, d: Triple) -> bool:
    """Whether two edges run from the same point to the same point."""
    return math.dist(a, c) <= TOLERANCE and math.dist(b, d) <= TOLERANCE


def check_convex(polygons: Sequence[Polygon]) -> None:
    """Check that no polygon hides a part of another one.

    Parameters
    ----------
    polygons : sequence of Polygon
        Surfaces of a zone, normals into the zone.

    Raises
    ------
    InputError
        A corner is behind a polygon, or the vertices of one are in the reverse order.
    """
    corners = np.concatenate([polygon.points for polygon in polygons])
    for polygon in polygons:
        if float(np.min(polygon.height_of(corners))) >= -TOLERANCE:
            continue
        for other in polygons:
            heights = polygon.height_of(other.points)
            worst = int(np.argmin(heights))
            if heights[worst] < -TOLERANCE:
                if wrong := _reversed(polygons):
                    raise _order_error(wrong)
                raise InputError(
                    f"the zone is not convex: vertex {worst + 1} of '{other.name}' lies "
                    f"{-heights[worst]:.3f} m behind '{polygon.name}'; exact view factors need a convex "
                    "zone; split the zone or give its view_factors"
                )


def _by_line(points: Array, start: Array, along: Array) -> tuple[Array, Array]:
    """Distances of points, shape (m, 3), from a line, and their places along it. [m]"""
    between = points - start
    positions = between @ along
    return np.linalg.norm(between - positions[:, None] * along, axis=1), positions


def _triple(point: Array) -> tuple[float, float, float]:
    return (float(point[0]), float(point[1]), float(point[2]))

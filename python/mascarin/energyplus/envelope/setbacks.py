"""Windows and doors that lie behind or in front of the plane of their wall.

In a description an opening lies in its wall. One that is set back is moved into the plane of the wall, with
four sides of its reveal standing out as shades, and shades that belong to it or to its wall move out with it:
what stands in front of the glass keeps its place relative to it.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from mascarin.building.geometry import TOLERANCE
from mascarin.energyplus.envelope.idf_surfaces import IdfOpening, IdfSurface
from mascarin.energyplus.model import geometry as g
from mascarin.energyplus.model.context import Context

#: Cosine of the angle up to which a window counts as parallel to its wall [-].
_PARALLEL: Final = 1.0 - 1e-6


def setback(opening: IdfOpening) -> g.Array:
    """How far the plane of the wall is from an opening, along its normal; shape (3,). [m]

    Parameters
    ----------
    opening : Opening
        The opening; zeros where it lies in its wall, or is not parallel to it.
    """
    out, opening_normal = (g.normal_of(points) for points in (opening.base.points, opening.points))
    out, opening_normal = out / np.linalg.norm(out), opening_normal / np.linalg.norm(opening_normal)
    depth = float((opening.base.points.mean(axis=0) - opening.points.mean(axis=0)) @ out)
    if float(out @ opening_normal) < _PARALLEL or abs(depth) <= TOLERANCE:
        return np.zeros(3)
    moved: g.Array = depth * out
    return moved


def outward(opening: IdfOpening) -> float:
    """Depth of an opening behind its wall, negative in front of it. [m]"""
    return float(setback(opening) @ g.normal_of(opening.base.points)) / g.area_of(opening.base.points)


def shift_of_shades(base: IdfSurface, openings: list[IdfOpening]) -> g.Array:
    """How far shades of a wall move out: as its deepest window; shape (3,). [m]"""
    outer_openings = [opening for opening in openings if opening.base is base and outward(opening) > 0.0]
    return setback(max(outer_openings, key=outward)) if outer_openings else np.zeros(3)


def describe_setback(context: Context, opening: IdfOpening, outline: g.Array) -> None:
    """Note an opening that is moved, and enter the sides of its reveal.

    Parameters
    ----------
    context : Context
        The conversion.
    opening : Opening
        The opening.
    outline : ndarray, shape (n, 3)
        Its corners in the plane of the wall. [m]
    """
    move, depth = setback(opening), outward(opening)
    if depth == 0.0:
        return
    if depth < 0.0:
        context.findings.approximated(
            opening.item,
            f"{-depth:.3f} m in front of its wall",
            "in the plane of the wall, with the shadows there",
        )
        return
    context.findings.approximated(
        opening.item,
        f"{depth:.3f} m behind the plane of its wall",
        "in this plane, with a reveal that stands out; shades of its wall stand out by as much more",
    )
    if opening.base.boundary != "outdoors":
        return
    for k, corner in enumerate(outline):
        after = outline[(k + 1) % len(outline)]
        name = context.names.of("shades", f"{opening.item.name} reveal {k + 1}")
        corners = np.array([corner, after, after + move, corner + move])
        context.section("shades")[name] = {"vertices": g.rounded(corners)}

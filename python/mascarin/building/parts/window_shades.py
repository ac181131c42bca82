"""Reveals and overhangs of windows: thin shades that act on their window alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mascarin.building.parts.defaults import window_outlines

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mascarin.building.parts.description import Description

Corners = list[list[float]]


class WindowShades(NamedTuple):
    """What stands before a window, and its outline where it has no vertices.

    Attributes
    ----------
    shades : list of corners
        Thin polygons. [m]
    outline : list of points
        Corners of a window that is described by its area: a rectangle of the height of its gaps, in
        coordinates that only its own shades share. Empty where it has vertices. [m]
    """

    shades: list[Corners]
    outline: Corners


def window_shades(building: Description, name: str) -> WindowShades | None:
    """Reveal and overhang of a window; None where it has neither.

    Parameters
    ----------
    building : Description
        The building.
    name : str
        Name of the window.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> [window_shades(box(), name) for name in box().windows][:1]
    []
    """
    window = building.windows[name]
    if window.reveal is None and window.overhang is None:
        return None
    wall = building.surfaces[window.surface]
    across, up, outward = _axes(float(wall.tilt or 0.0), float(wall.azimuth or 0.0))
    polygon = window_outlines({name: window}).get(name)
    if polygon is None:
        height = float(window.cavity_height or 0.0)
        width = float(window.area or 0.0) / height
        flat = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)]
        points = np.array([u * across + v * up for u, v in flat])
    else:
        points = np.asarray(polygon.vertices, float)
    shades = []
    reveal = float(window.reveal or 0.0)
    if window.reveal is not None:
        ends = np.roll(points, -1, axis=0)
        shades += [
            [start, end, end + reveal * outward, start + reveal * outward]
            for start, end in zip(points, ends, strict=True)
        ]
    if window.overhang is not None:
        depth, gap, extension = (
            float(getattr(window.overhang, key)) for key in ("depth", "gap", "extension")
        )
        ends_across = ((points @ across).min() - extension, (points @ across).max() + extension)
        level, plane = (points @ up).max() + gap, (points @ outward).mean() + reveal
        edge = [u * across + level * up + plane * outward for u in ends_across]
        shades.append([edge[0], edge[1], edge[1] + depth * outward, edge[0] + depth * outward])
    outline = [] if polygon is not None else points.tolist()
    return WindowShades([np.asarray(shade).tolist() for shade in shades], outline)


def _axes(tilt: float, azimuth: float) -> tuple[NDArray[np.float64], ...]:
    """Unit vectors along a wall to the right as seen from outside, up along it, and out of it."""
    t, a = np.radians([tilt, azimuth])
    outward = np.array([np.sin(t) * np.sin(a), np.sin(t) * np.cos(a), np.cos(t)])
    across = np.array([-np.cos(a), np.sin(a), 0.0])
    return across, np.cross(outward, across), outward

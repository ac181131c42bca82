"""What is seen of polygons from a point: solid angles, and angle factors of a small plane at that point."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mascarin.building.geometry.polygon import Polygon

    Array = npt.NDArray[np.float64]


def solid_angle(polygon: Polygon, point: Sequence[float]) -> float:
    """Solid angle of a polygon seen from a point, negative where it is seen from behind.

    The sum over the triangles of a fan, each by the formula of Van Oosterom and Strackee; exact for every
    simple polygon, because parts of triangles outside of it cancel.

    Parameters
    ----------
    polygon : Polygon
        Its normal shows its front.
    point : (x, y, z)
        Where it is seen from, not on the polygon. [m]

    Returns
    -------
    float
        Solid angle. [sr]

    References
    ----------
    Van Oosterom & Strackee 1983, IEEE Trans. Biomed. Eng. BME-30(2), 125-126, doi:10.1109/TBME.1983.325207.

    Examples
    --------
    The top of a cube from its middle is a sixth of the sphere:

    >>> from mascarin.building.geometry import Polygon
    >>> top = Polygon.of("top", [[0, 0, 1], [0, 1, 1], [1, 1, 1], [1, 0, 1]])
    >>> round(solid_angle(top, (0.5, 0.5, 0.5)) / (4 * math.pi), 12)
    0.166666666667
    """
    corners = polygon.points - np.asarray(point, dtype=np.float64)
    units = corners / np.linalg.norm(corners, axis=1)[:, None]
    a, b, c = units[0], units[1:-1], units[2:]
    triple = np.cross(b, c) @ a
    below = 1.0 + b @ a + c @ a + np.sum(b * c, axis=1)
    # Corners of a polygon that faces the point turn clockwise around it.
    return float(-2.0 * np.arctan2(triple, below).sum())


def plane_factor(polygon: Polygon, point: Sequence[float], direction: Sequence[float]) -> float:
    """Angle factor from a small plane at a point to a polygon: the part above the plane, by its outline.

    Parameters
    ----------
    polygon : Polygon
        Its normal shows its front.
    point : (x, y, z)
        Where the plane is, not on the polygon. [m]
    direction : (x, y, z)
        Unit normal of the plane. [-]

    Returns
    -------
    float
        Angle factor; negative where the polygon is seen from behind. [-]

    References
    ----------
    Howell, Menguc & Siegel 2010, Thermal Radiation Heat Transfer, 5th ed., section 5.5 (contour integration).

    Examples
    --------
    The top of a cube from the middle of its floor (configuration B-3 of Howell's catalogue, four times):

    >>> from mascarin.building.geometry import Polygon
    >>> top = Polygon.of("top", [[0, 0, 1], [0, 1, 1], [1, 1, 1], [1, 0, 1]])
    >>> round(plane_factor(top, (0.5, 0.5, 0.0), (0, 0, 1)), 6)
    0.239456
    """
    up = np.asarray(direction, dtype=np.float64)
    corners = _above(polygon.points - np.asarray(point, dtype=np.float64), up)
    if len(corners) < 3:
        return 0.0
    after = np.roll(corners, -1, axis=0)
    across = np.cross(corners, after)
    length = np.linalg.norm(across, axis=1)
    angle = np.arctan2(length, np.sum(corners * after, axis=1))
    has_length = length > 0.0
    along = across[has_length] @ up / length[has_length]
    return float(-(angle[has_length] @ along) / (2.0 * math.pi))


def _above(corners: Array, up: Array) -> Array:
    """The part of an outline above the plane through the origin (Sutherland & Hodgman 1974)."""
    heights = corners @ up
    visible: list[Array] = []
    for k, height in enumerate(heights):
        before = heights[k - 1]
        if (height > 0.0) != (before > 0.0):
            share = before / (before - height)
            visible.append(corners[k - 1] + share * (corners[k] - corners[k - 1]))
        if height > 0.0:
            visible.append(corners[k])
    return np.array(visible).reshape(-1, 3)

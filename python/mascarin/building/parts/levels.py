"""Heights of surfaces in zones whose air is stratified."""

from __future__ import annotations

import numpy as np

from mascarin.building.parts.description import Description
from mascarin.building.parts.zone_surfaces import ZoneSurface, floors
from mascarin.errors import InputError

#: Upward component of a normal from which on a side is a ceiling: 60 degrees from the vertical. [-]
_CEILING = 0.5


def levels(building: Description, zone: str) -> tuple[list[float], float]:
    """Heights of the surfaces of a zone above its middle, and its height. [m]

    From vertices: the centroid above the middle between the lowest and the highest corner. A surface without
    vertices stands in the middle, as a floor at the floor, or as a ceiling at the ceiling; the height of a
    zone without any vertices is its volume over the area of its floor.

    Parameters
    ----------
    building : Description
        The building.
    zone : str
        Name of the zone.

    Returns
    -------
    list of float
        In the order of the surfaces of the zone.
    float
        From floor to ceiling.

    Raises
    ------
    InputError
        A zone without vertices and without a floor.
    """
    surfaces = building.connections.of(zone)
    on_floor = floors(surfaces)
    heights = [item.polygon.points[:, 2] for item in surfaces if item.polygon is not None]
    corners = np.concatenate(heights) if heights else np.zeros(1)
    low, high = float(corners.min()), float(corners.max())
    if high - low <= 0.0:
        area = sum(item.area for item, floor in zip(surfaces, on_floor, strict=True) if floor)
        if area <= 0.0:
            raise InputError(
                f"zones.{zone}.air_gradient: found no vertices and no floor in this zone; expected its "
                "height. Give its surfaces vertices, or describe its floor (a surface of tilt 180)"
            )
        low, high = 0.0, float(building.zones[zone].volume or 0.0) / area
    middle, height = 0.5 * (low + high), high - low

    def level(item: ZoneSurface, floor: bool) -> float:
        if item.polygon is not None:
            return float(item.polygon.centroid[2]) - middle
        if floor:
            return -0.5 * height
        return 0.5 * height if _is_ceiling(item) else 0.0

    return [level(item, floor) for item, floor in zip(surfaces, on_floor, strict=True)], height


def _is_ceiling(item: ZoneSurface) -> bool:
    """Whether a surface without vertices faces down into the zone."""
    if item.surface is None or item.surface.internal_mass:
        return False
    upward = float(np.cos(np.radians(float(item.surface.tilt or 0.0))))
    return (upward if item.side == "inside" else -upward) >= _CEILING

"""Surfaces of a zone: opaque surfaces, glass of windows, frames; in the order of the engine."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mascarin.building.derived import outlines, sides_of_zone, window_outlines
from mascarin.building.window import opaque_area

if TYPE_CHECKING:
    from mascarin.building.geometry import Polygon
    from mascarin.building.surface import Surface
    from mascarin.building.window import Window


#: Largest angle between a floor and the horizontal [deg].
_FLOOR = 30.0


@dataclass(frozen=True)
class ZoneSurface:
    """One surface of a zone.

    Attributes
    ----------
    name : str
        Name of the surface or window.
    side : str
        ``outside`` or ``inside``.
    area : float
        Area without windows, or without the frame. [m2]
    share : float
        Fraction of the area of the polygon: less than 1 for glass and frame of a framed window. [-]
    polygon : Polygon or None
        Outline as seen from the zone; None without vertices.
    surface, window : Surface and Window
        One of the two: what it is a part of.
    """

    name: str
    side: str
    area: float
    share: float
    polygon: Polygon | None
    surface: Surface | None
    window: Window | None


def surfaces_of_zone(
    zone: str, surfaces: Mapping[str, Surface], windows: Mapping[str, Window]
) -> list[ZoneSurface]:
    """Surfaces of a zone: opaque surfaces, then the glass of windows, then their frames."""
    sides = sides_of_zone(zone, surfaces)
    which = dict(sides)
    seen = {name: window for name, window in windows.items() if window.surface in which}
    drawn = outlines({name: surfaces[name] for name, _ in sides}) | window_outlines(seen)

    def polygon(name: str, side: str) -> Polygon | None:
        found = drawn.get(name)
        return found if found is None or side == "outside" else found.reversed()

    found = [
        ZoneSurface(
            name,
            side,
            opaque_area(name, float(surfaces[name].area or 0.0), windows),
            1.0,
            polygon(name, side),
            surfaces[name],
            None,
        )
        for name, side in sides
    ]
    parts = [(name, window, 1.0 - frame_fraction(window)) for name, window in seen.items()]
    parts += [
        (name, window, frame_fraction(window)) for name, window in seen.items() if window.frame is not None
    ]
    for name, window, share in parts:
        area = share * float(window.area or 0.0)
        side = which[window.surface]
        found.append(ZoneSurface(name, side, area, share, polygon(name, side), None, window))
    return found


def floors(seen: list[ZoneSurface]) -> list[bool]:
    """Which surfaces of a zone are its floor: those that face up within 30 deg, without internal mass."""

    def floor(item: ZoneSurface) -> bool:
        if item.surface is None or item.surface.internal_mass:
            return False
        if item.surface.tilt is None and item.polygon is not None:
            return item.polygon.tilt <= _FLOOR
        tilt = float(item.surface.tilt or 0.0)
        return (tilt if item.side == "outside" else 180.0 - tilt) <= _FLOOR

    return [floor(item) for item in seen]


def frame_fraction(window: Window) -> float:
    """Fraction of the frame in the area of a window [-]."""
    return 0.0 if window.frame is None else float(window.frame.fraction)


def closed(seen: list[ZoneSurface]) -> bool:
    """Whether all surfaces of a zone have an outline."""
    return bool(seen) and all(item.polygon is not None for item in seen)

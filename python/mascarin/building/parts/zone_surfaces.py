"""Surfaces of a zone: opaque surfaces, glass of windows, frames; in the order of the engine."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mascarin.building.parts.defaults import outlines, sides_by_zone, window_outlines

if TYPE_CHECKING:
    from mascarin.building.geometry import Polygon
    from mascarin.building.parts.envelope.surface import Surface
    from mascarin.building.parts.openings.window import Window


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


class Connections:
    """Which surfaces and windows belong to which zone and wall: found once, not for each zone again.

    Parameters
    ----------
    surfaces, windows : mapping
        All of a building.
    """

    def __init__(self, surfaces: Mapping[str, Surface], windows: Mapping[str, Window]) -> None:
        self._surfaces = surfaces
        self._sides = sides_by_zone(surfaces)
        self._windows: dict[str, dict[str, Window]] = {}
        for name, window in windows.items():
            self._windows.setdefault(window.surface, {})[name] = window
        self._order = {name: index for index, name in enumerate(windows)}
        self._seen: dict[str, tuple[ZoneSurface, ...]] = {}

    def sides(self, zone: str) -> Sequence[tuple[str, str]]:
        """Surfaces of a zone as (surface, side), in the order of the description, outside before inside."""
        return self._sides.get(zone, ())

    def windows_in(self, surface: str) -> Mapping[str, Window]:
        """Windows in a wall, by name."""
        return self._windows.get(surface, {})

    def of(self, zone: str) -> tuple[ZoneSurface, ...]:
        """Surfaces of a zone: opaque surfaces, then the glass of windows, then their frames."""
        if zone not in self._seen:
            self._seen[zone] = tuple(self._find(zone))
        return self._seen[zone]

    def _find(self, zone: str) -> Iterator[ZoneSurface]:
        sides, surfaces = self.sides(zone), self._surfaces
        which = dict(sides)
        by_name = {name: window for wall in which for name, window in self.windows_in(wall).items()}
        windows = {name: by_name[name] for name in sorted(by_name, key=self._order.__getitem__)}
        polygons = outlines({name: surfaces[name] for name, _ in sides}) | window_outlines(windows)

        def polygon(name: str, side: str) -> Polygon | None:
            outline = polygons.get(name)
            return outline if outline is None or side == "outside" else outline.reversed()

        for name, side in sides:
            area = float(surfaces[name].area or 0.0)
            area -= sum(float(window.area or 0.0) for window in self.windows_in(name).values())
            yield ZoneSurface(name, side, area, 1.0, polygon(name, side), surfaces[name], None)
        parts = [(name, window, 1.0 - frame_fraction(window)) for name, window in windows.items()]
        framed = [(name, window) for name, window in windows.items() if window.frame is not None]
        parts += [(name, window, frame_fraction(window)) for name, window in framed]
        for name, window, share in parts:
            area, side = share * float(window.area or 0.0), which[window.surface]
            yield ZoneSurface(name, side, area, share, polygon(name, side), None, window)


def floors(surfaces: Sequence[ZoneSurface]) -> list[bool]:
    """Which surfaces of a zone are its floor: those that face up within 30 deg, without internal mass."""

    def floor(item: ZoneSurface) -> bool:
        if item.surface is None or item.surface.internal_mass:
            return False
        if item.surface.tilt is None and item.polygon is not None:
            return item.polygon.tilt <= _FLOOR
        tilt = float(item.surface.tilt or 0.0)
        return (tilt if item.side == "outside" else 180.0 - tilt) <= _FLOOR

    return [floor(item) for item in surfaces]


def frame_fraction(window: Window) -> float:
    """Fraction of the frame in the area of a window [-]."""
    return 0.0 if window.frame is None else float(window.frame.fraction)


def closed(surfaces: Sequence[ZoneSurface]) -> bool:
    """Whether all surfaces of a zone have an outline."""
    return bool(surfaces) and all(item.polygon is not None for item in surfaces)


def surface_names(surfaces: Sequence[ZoneSurface]) -> list[str]:
    """Names of the surfaces of a zone; with the side, or ``frame``, where a part has two."""
    count: Mapping[str, int] = Counter(item.name for item in surfaces)
    names: list[str] = []
    for item in surfaces:
        if count[item.name] == 1 or (item.name not in names and item.window is not None):
            names.append(item.name)
        else:
            names.append(f"{item.name}.{'frame' if item.window is not None else item.side}")
    return names

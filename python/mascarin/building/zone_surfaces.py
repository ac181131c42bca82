"""The faces that a zone sees: surfaces, the glass of windows, their frames; in the order of the engine."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mascarin.building.derived import faces_of, outlines, window_outlines
from mascarin.building.window import opaque_area

if TYPE_CHECKING:
    from mascarin.building.geometry import Polygon
    from mascarin.building.surface import Surface
    from mascarin.building.window import Window


@dataclass(frozen=True)
class ZoneFace:
    """A face of a zone.

    Attributes
    ----------
    name : str
        Name of the surface or window.
    side : str
        ``outside`` or ``inside``.
    area : float
        Its own area, without the windows in it, or without the frame. [m2]
    share : float
        Share of the polygon's own area: less than 1 for the glass and the frame of a framed window. [-]
    polygon : Polygon or None
        Outline, as seen from the zone; none where there are no vertices.
    surface, window : Surface and Window
        What it belongs to: one of the two.
    """

    name: str
    side: str
    area: float
    share: float
    polygon: Polygon | None
    surface: Surface | None
    window: Window | None


def zone_faces(zone: str, surfaces: Mapping[str, Surface], windows: Mapping[str, Window]) -> list[ZoneFace]:
    """Faces of a zone: of surfaces, of the glass of windows, of their frames."""
    sides = faces_of(zone, surfaces)
    inside = [name for name, side in sides if side == "inside"]
    seen = {name: window for name, window in windows.items() if window.surface in inside}
    drawn = outlines({name: surfaces[name] for name, _ in sides}) | window_outlines(seen)

    def polygon(name: str, side: str) -> Polygon | None:
        found = drawn.get(name)
        return found if found is None or side == "outside" else found.reversed()

    found = [
        ZoneFace(
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
    parts = [(name, window, 1.0 - frame_share(window)) for name, window in seen.items()]
    parts += [
        (name, window, frame_share(window)) for name, window in seen.items() if window.frame is not None
    ]
    for name, window, share in parts:
        area = share * float(window.area or 0.0)
        found.append(ZoneFace(name, "inside", area, share, polygon(name, "inside"), None, window))
    return found


def frame_share(window: Window) -> float:
    """Share of the frame in the area of a window [-]."""
    return 0.0 if window.frame is None else float(window.frame.fraction)


def closed(faces: list[ZoneFace]) -> bool:
    """Tell whether every face of a zone has an outline."""
    return bool(faces) and all(face.polygon is not None for face in faces)

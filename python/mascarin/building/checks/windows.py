"""How windows must fit into their walls; each rule yields the errors it finds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import takewhile
from typing import TYPE_CHECKING

from mascarin.building.base.part import Location, fault
from mascarin.building.checks.air import STEEP
from mascarin.building.parts.air.zone import GivenSun
from mascarin.building.parts.defaults import drawn_areas, outlines, window_outlines
from mascarin.building.parts.envelope.convection import ConvectionLaw

if TYPE_CHECKING:
    from pydantic_core import InitErrorDetails

    from mascarin.building.geometry import Polygon
    from mascarin.building.parts.description import Description
    from mascarin.building.parts.openings.window import Window

Faults = Iterator["InitErrorDetails"]


def windows_lie_in_walls(building: Description) -> Faults:
    """Errors of windows: in walls that take none, outside of their wall, over each other, too large."""
    if not building.windows:
        return
    wall_outlines, glazed = outlines(building.surfaces), window_outlines(building.windows)
    outdoors = _Drawn(list(wall_outlines.items()), list(glazed.items()))
    for name, window in building.windows.items():
        wall, location = building.surfaces[window.surface], ("windows", name)
        if wall.inside.zone is None or not (wall.outside.outdoors or wall.outside.zone) or wall.internal_mass:
            yield fault(
                (*location, "surface"),
                f"'{window.surface}', from {wall.outside.faces} to {wall.inside.faces}",
                "a wall from outdoors (outside) to a zone (inside), or between two zones",
                "Put the window into such a wall.",
            )
        elif wall.outside.zone is not None:
            yield from _between_zones(building, location, window)
        tilt = outlines({"": wall})[""].tilt if wall.vertices is not None else float(wall.tilt or 0.0)
        if window.overhang is not None and not STEEP[0] <= tilt <= STEEP[1]:
            yield fault(
                (*location, "overhang"),
                f"an overhang of a window of tilt {tilt:g} deg",
                f"a window of {STEEP[0]:g} to {STEEP[1]:g} deg, which has an upper edge",
                "Describe what shades it under 'shades:', with vertices.",
            )
        if window.vertices is None:
            continue
        outline = wall_outlines.get(window.surface)
        if outline is None:
            yield fault(
                (*location, "vertices"),
                f"vertices in '{window.surface}', which has none",
                "a wall with vertices",
                "Give the wall vertices, or the window an area.",
            )
            continue
        polygon = glazed[name]
        if not outline.contains(polygon):
            yield fault((*location, "vertices"), *_outside_of_its_wall(polygon, outline))
        for other in outdoors.overlapping(polygon, outline):
            yield fault(
                (*location, "vertices"),
                f"a window that overlaps '{other}'",
                "windows, doors and walls that do not overlap",
                "Move its corners.",
            )
    yield from _walls_are_larger_than_their_windows(building, glazed)


def _between_zones(building: Description, location: Location, window: Window) -> Faults:
    """What has no effect on a window between two zones, and what says nothing of it."""
    wall, outside = building.surfaces[window.surface], window.outside
    for key in ("sky_view", "ground_view", "height", "longwave", "irradiance", "behind_obstacles"):
        if getattr(outside, key) is not None:
            yield fault(
                (*location, "outside", key),
                f"'{key}' of a window between two zones",
                "only what has an effect on this side",
                f"Remove '{key}:': it has no effect here.",
            )
    for key in ("reveal", "overhang"):
        if getattr(window, key) is not None:
            yield fault(
                (*location, key),
                f"'{key}' of a window between two zones",
                "only what has an effect on this window",
                f"Remove '{key}:': no sky shines on it.",
            )
    if window.blind is not None:
        yield fault(
            (*location, "blind"),
            "a blind of a window between two zones",
            "a blind of a window to outdoors",
            "Remove it, or give the window a glazing with its properties.",
        )
    film = outside.convection
    if isinstance(film, ConvectionLaw) and film.row.sides == "outdoors":
        yield fault(
            (*location, "outside", "convection"),
            f"'{film.row.kind}' on a side facing a zone",
            "a coefficient without wind",
            "Write 'tarp' or 'iso15099', or another coefficient without wind.",
        )
    for side in wall.sides:
        if isinstance(building.zones[str(side.zone)].sun, GivenSun):
            yield fault(
                ("zones", str(side.zone), "sun"),
                f"given shares, which say nothing of the window '{location[-1]}' to another zone",
                "area, floor or geometry",
                "Write 'sun: area' or another model that finds the sun on this window.",
            )


def _walls_are_larger_than_their_windows(building: Description, glazed: Mapping[str, Polygon]) -> Faults:
    areas_in: dict[str, dict[str, float]] = {}
    for window_name, window in building.windows.items():
        area = glazed[window_name].area if window.area is None else float(window.area)
        areas_in.setdefault(window.surface, {})[window_name] = area
    wall_areas = drawn_areas(building.surfaces)
    for name, surface in building.surfaces.items():
        areas = areas_in.get(name)
        if areas is None:
            continue
        gross = float(surface.area or wall_areas.get(name, 0.0))
        if sum(areas.values()) >= gross:
            listed = ", ".join(f"{window_name} {area:.2f}" for window_name, area in areas.items())
            yield fault(
                ("windows", max(areas, key=lambda window_name: areas[window_name]), "area"),
                f"{sum(areas.values()):.2f} m2 of windows ({listed})",
                f"less than the {gross:.2f} m2 of their wall '{name}'",
                "The area of a wall includes its windows.",
            )


class _Drawn:
    """Walls and windows with vertices, found by their place."""

    def __init__(self, walls: list[tuple[str, Polygon]], windows: list[tuple[str, Polygon]]) -> None:
        from mascarin.building.geometry import BoxIndex

        self._parts, self._walls = [*walls, *windows], len(walls)
        self._index = BoxIndex([polygon for _, polygon in self._parts])

    def overlapping(self, window: Polygon, wall: Polygon) -> list[str]:
        """Windows before a window, then walls beside the one it is in, that it overlaps."""
        touched = self._index.touching(window)
        before = takewhile(
            lambda entry: entry[1] is not window, (self._parts[k] for k in touched if k >= self._walls)
        )
        walls = (self._parts[k] for k in touched if k < self._walls)
        candidates = [*before, *((name, entry) for name, entry in walls if not entry.contains(wall))]
        return [name for name, entry in candidates if window.overlaps(entry)]


def _outside_of_its_wall(window: Polygon, wall: Polygon) -> tuple[str, str, str]:
    off = float(max(abs(wall.height_of(window.points))))
    if float(window.normal @ wall.normal) < 0.0:
        return (
            "corners in the wrong order",
            f"corners counter-clockwise seen from outside, as those of '{wall.name}'",
            "Reverse them.",
        )
    if off > 1e-3:
        return f"a corner {off:.3f} m off the plane of '{wall.name}'", "corners in that plane", "Move it."
    return (
        f"corners outside the outline of '{wall.name}'",
        "a window inside its wall",
        "Compare the coordinates of both.",
    )

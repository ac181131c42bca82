"""Measured irradiances of surfaces and windows, and what stands in front of them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from mascarin.building.base.part import cached_on, fault
from mascarin.building.parts.defaults import outlines, shade_outlines, window_outlines
from mascarin.building.parts.self_shading import SideName, listed, obstructions

if TYPE_CHECKING:
    from pydantic_core import InitErrorDetails

    from mascarin.building.geometry import Polygon
    from mascarin.building.parts.description import Description
    from mascarin.building.parts.envelope.surface import Side
    from mascarin.building.parts.openings.window import WindowOutside


def takes_part(side: Side | WindowOutside) -> bool:
    """Whether obstacles take their part of the measured irradiance of a side outdoors."""
    return bool(side.outdoors) and side.irradiance is not None and not side.behind_obstacles


def obstructed(building: Description) -> dict[SideName, list[str]]:
    """What takes its part of the measured irradiance of each side.

    Parameters
    ----------
    building : Description
        The building.

    Returns
    -------
    dict of (name, side) to list of str
        Names of surfaces and shades in front of each surface or window whose measured irradiance is that of
        the free plane, and `horizon`; sides with nothing in front are left out.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> obstructed(box())
    {}
    """
    return cached_on(building, "_obstructed", lambda: _obstructed(building))


def _obstructed(building: Description) -> dict[SideName, list[str]]:
    free = [(side_name, side) for side_name, side in _measured(building) if takes_part(side)]
    if not free:
        return {}
    horizon = ["horizon"] if building.site.horizon else []
    walls, shades = obstructions(building), _shades(building)
    obstacles = {
        side_name: [
            *walls.get(side_name, []),
            *shades.get(side_name, []),
            *_window_shades(building, side_name[0]),
            *horizon,
        ]
        for side_name, _ in free
    }
    return {side_name: names for side_name, names in obstacles.items() if names}


def _window_shades(building: Description, name: str) -> list[str]:
    """Reveal and overhang of a window."""
    window = building.windows.get(name)
    return (
        [] if window is None else [key for key in ("reveal", "overhang") if getattr(window, key) is not None]
    )


def paths(building: Description) -> set[str]:
    """Paths of the sides of `obstructed`."""
    return cached_on(building, "_obstructed_paths", lambda: _paths(building))


def _paths(building: Description) -> set[str]:
    names = obstructed(building)
    return {path for path, side_name, _ in _sides(building) if side_name in names}


def measured_lines(building: Description) -> Iterator[str]:
    """Say what acts on each measured irradiance.

    Parameters
    ----------
    building : Description
        The building.

    Yields
    ------
    str
        A line for each surface or window outdoors with a measured irradiance.
    """
    taken = obstructed(building)
    for side_name, side in _measured(building):
        where = f"measured irradiance: {side_name[0]}, {side_name[1]}, by column {side.irradiance}"
        if side.behind_obstacles:
            yield f"{where}, behind its obstacles: used as it is"
        elif side_name in taken:
            yield (
                f"{where}, of the free plane: {listed(taken[side_name])} "
                f"take{_s(taken[side_name])} a part of beam and diffuse radiation, which are split as in "
                "the climate"
            )
        else:
            yield f"{where}: nothing stands in front of it"


def directions_are_known(building: Description) -> Iterator[InitErrorDetails]:
    """Errors of surfaces whose measured irradiance a horizon obstructs, and whose direction is not given."""
    if not building.site.horizon:
        return
    for name, surface in building.surfaces.items():
        tilt = float(surface.tilt or 0.0)
        unknown = surface.azimuth is None or (surface.azimuth.derived and surface.vertices is None)
        acts = any(takes_part(side) for side in surface.sides)
        if unknown and acts and 0.0 < tilt < 180.0:
            yield fault(
                ("surfaces", name, "azimuth"),
                "nothing, where the horizon takes its part of a measured irradiance",
                "azimuth of the outside normal, clockwise from north [deg]",
                "Add 'azimuth:', or 'behind_obstacles: true' beside 'irradiance:'.",
            )


def _s(names: list[str]) -> str:
    return "s" if len(names) == 1 else ""


def _measured(building: Description) -> Iterator[tuple[SideName, Side | WindowOutside]]:
    for _, side_name, side in _sides(building):
        if side.outdoors and side.irradiance is not None:
            yield side_name, side


def _sides(building: Description) -> Iterator[tuple[str, SideName, Side | WindowOutside]]:
    for name, surface in building.surfaces.items():
        yield f"surfaces.{name}.outside", (name, "outside"), surface.outside
        yield f"surfaces.{name}.inside", (name, "inside"), surface.inside
    for name, window in building.windows.items():
        if building.surfaces[window.surface].outside.outdoors:
            yield f"windows.{name}.outside", (name, "outside"), window.outside


def _shades(building: Description) -> dict[SideName, list[str]]:
    """Shades in front of each side with vertices."""
    if not building.shades:
        return {}
    from mascarin.building.geometry import InFront

    standing, names = InFront(list(shade_outlines(building.shades).values())), list(building.shades)
    walls, panes = outlines(building.surfaces), window_outlines(building.windows)
    polygons: dict[SideName, Polygon] = {(name, "outside"): outline for name, outline in walls.items()}
    polygons |= {(name, "inside"): outline.reversed() for name, outline in walls.items()}
    polygons |= {(name, "outside"): outline for name, outline in panes.items()}
    return {side_name: [names[k] for k in standing.of(polygon)] for side_name, polygon in polygons.items()}

"""Zones in which people can be, and cavities between layers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from mascarin.building.building import Building

#: A zone that is thinner is a cavity: a ventilated gap, a double facade, a plenum. [m]
LEAST_DEPTH: Final = 0.6


def rooms(building: Building) -> list[str]:
    """Names of the zones that are no cavities.

    A cavity is thinner than `LEAST_DEPTH`: its volume over its largest surface. Where all zones are thin, all
    are rooms.

    Parameters
    ----------
    building : Building
        The building.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> rooms(box())
    ['room']
    """
    names = [name for name in building.zones if _depth(building, name) >= LEAST_DEPTH]
    return names or list(building.zones)


def lived_in(building: Building) -> list[str]:
    """Names of the rooms in which people live: those with a window, an internal gain, heating or cooling.

    Where no room has any of them, all rooms.

    Parameters
    ----------
    building : Building
        The building.

    Examples
    --------
    >>> from mascarin import load
    >>> from mascarin.examples import FOLDER
    >>> lived_in(load(FOLDER / "reunion_house" / "building.yaml"))
    ['living', 'bedroom']
    """
    with_window = {building.surfaces[window.surface].inside.zone for window in building.windows.values()}
    names = [
        name
        for name in rooms(building)
        if name in with_window
        or building.zones[name].gains
        or building.zones[name].heating is not None
        or building.zones[name].cooling is not None
    ]
    return names or rooms(building)


def _depth(building: Building, zone: str) -> float:
    """Volume over the largest surface of a zone [m]; infinite where one is not stated."""
    volume = building.zones[zone].volume
    areas = [
        float(surface.area)
        for surface in building.surfaces.values()
        if surface.area is not None
        and not surface.internal_mass
        and zone in (surface.inside.zone, surface.outside.zone)
    ]
    return float(volume) / max(areas) if volume is not None and areas else float("inf")

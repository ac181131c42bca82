"""Constant set points of heating and cooling in a zone: equal ones are one parameter, others do not cross."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mascarin.building.description import Description
    from mascarin.building.number import Number


def tied_set_points(building: Description) -> dict[str, str]:
    """Set points that vary together because heating and cooling of a zone have the same one.

    Parameters
    ----------
    building : Description
        The building.

    Returns
    -------
    dict of str to str
        Path of each such set point -> path of the one that has its value, in both directions.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> tied_set_points(box())
    {}
    """
    found: dict[str, str] = {}
    for heating, cooling, warm, cold in _constant(building):
        if warm == cold:
            found |= {heating: cooling, cooling: heating}
    return found


def cut_ranges(building: Description) -> dict[str, tuple[float, float]]:
    """Default ranges of set points that would cross.

    They end in the middle between the two set points, or where the given range of the other one begins.

    Parameters
    ----------
    building : Description
        The building.

    Returns
    -------
    dict of str to (float, float)
        Path -> range. A range that the description gives is left as it is. [degC]
    """
    found = {}
    for heating, cooling, warm, cold in _constant(building):
        if warm == cold or warm.plausible[1] <= cold.plausible[0]:
            continue
        middle = 0.5 * (float(warm) + float(cold))
        if warm.range is None:
            top = middle if cold.range is None else max(float(warm), cold.plausible[0])
            found[heating] = (warm.plausible[0], min(warm.plausible[1], top))
        if cold.range is None:
            bottom = middle if warm.range is None else min(float(cold), warm.plausible[1])
            found[cooling] = (max(cold.plausible[0], bottom), cold.plausible[1])
    return found


def _constant(building: Description) -> Iterator[tuple[str, str, Number, Number]]:
    """Paths and values of heating and cooling in zones where both set points are numbers."""
    for name, zone in building.zones.items():
        if zone.heating is None or zone.cooling is None:
            continue
        warm, cold = zone.heating.setpoint.temperature, zone.cooling.setpoint.temperature
        if warm is not None and cold is not None:
            yield (
                f"zones.{name}.heating.setpoint.temperature",
                f"zones.{name}.cooling.setpoint.temperature",
                warm,
                cold,
            )

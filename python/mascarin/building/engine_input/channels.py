"""Columns of the forcing that a building refers to."""

from __future__ import annotations

from mascarin.building.convection import measured_column
from mascarin.building.description import Description
from mascarin.building.rules import references


def channels(building: Description) -> list[str]:
    """Measured columns that a building refers to, in the order of the description."""
    sides = [side for surface in building.surfaces.values() for side in surface.sides]
    columns = [
        column
        for side in sides
        for column in (side.measured, side.irradiance, measured_column(side.convection))
    ]
    panes = (side for window in building.windows.values() for side in (window.outside, window.inside))
    columns += [measured_column(side.convection) for side in panes]
    return list(dict.fromkeys(column for column in columns if column is not None))


def measured_columns(building: Description) -> list[str]:
    """Measured columns that a building needs, those of its schedules included."""
    scheduled = (building.schedules[name].column for name in used_schedules(building))
    return list(dict.fromkeys([*channels(building), *(column for column in scheduled if column is not None)]))


def used_schedules(building: Description) -> list[str]:
    """Names of the schedules that are used in the building, in the order of the description."""
    used = {name for name, _, _ in references(building)}
    return [name for name in building.schedules if name in used]

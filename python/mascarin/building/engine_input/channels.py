"""Columns of the forcing that a building refers to."""

from __future__ import annotations

from mascarin.building.engine_input.series_users import courses
from mascarin.building.parts.description import Description
from mascarin.building.parts.envelope.convection import measured_column


def channels(building: Description) -> list[str]:
    """Measured columns that a building refers to as they are, in the order of the description."""
    sides = [side for surface in building.surfaces.values() for side in surface.sides]
    columns = [
        column
        for side in sides
        for column in (
            side.measured if isinstance(side.measured, str) else None,
            side.irradiance,
            measured_column(side.convection),
        )
    ]
    panes = (side for window in building.windows.values() for side in (window.outside, window.inside))
    columns += [measured_column(side.convection) for side in panes]
    columns += [window.outside.irradiance for window in building.windows.values()]
    return list(dict.fromkeys(column for column in columns if column is not None))


def measured_columns(building: Description) -> list[str]:
    """Measured columns that a building needs, those of its schedules and other courses included."""
    columns = channels(building)
    for course in courses(building).values():
        columns += course.columns
    return list(dict.fromkeys(columns))

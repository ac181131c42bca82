"""Measured irradiances of the planes of a building, for a comparison with the sun."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mascarin.weather.checks.plane_check import on_grid, plane_warnings
from mascarin.weather.checks.plane_shift import MeasuredPlane

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.building.parts.envelope.surface import Surface
    from mascarin.tables.record import Record
    from mascarin.weather import Climate, Measurements


def warnings_of_planes(
    building: Building, climate: Climate, measurements: Measurements | None
) -> tuple[str, ...]:
    """Compare the measured irradiances of tilted planes with the sun, beside the global one.

    A building that states a clock for its weather is not compared: it has the clock it should have.

    Parameters
    ----------
    building : Building
        Its surfaces and windows name the columns.
    climate : Climate
        As read, with a measured global irradiance.
    measurements : Measurements or None
        Other measured columns; those of the same rows as the weather are compared.

    Returns
    -------
    tuple of str
        Warnings.

    Raises
    ------
    InputError
        They do not follow the sun.
    """
    record = climate.record
    if not record.check_sun or not record.measured("global_horizontal") or _moves_the_clock(building):
        return ()
    planes = measured_planes(building, climate, measurements)
    return plane_warnings(record, planes, float(building.site.latitude), float(building.site.longitude))


def measured_planes(
    building: Building, climate: Climate, measurements: Measurements | None
) -> list[MeasuredPlane]:
    """Planes outdoors whose direction is known and whose irradiance was measured in the rows of the weather.

    Parameters
    ----------
    building : Building
        Its surfaces and windows name the columns.
    climate : Climate
        The weather; its columns are looked at first.
    measurements : Measurements or None
        Other measured columns.
    """
    planes: dict[tuple[str, float, float], MeasuredPlane] = {}
    outsides: list[tuple[Surface, str | None, bool]] = [
        (surface, surface.outside.irradiance, bool(surface.outside.outdoors))
        for surface in building.surfaces.values()
    ]
    for window in building.windows.values():
        wall = building.surfaces[window.surface]
        outsides.append((wall, window.outside.irradiance, bool(wall.outside.outdoors)))
    kind_of_global = climate.record.kinds["global_horizontal"]
    for surface, name, outdoors in outsides:
        azimuth, tilt = surface.azimuth, surface.tilt
        if name is None or azimuth is None or tilt is None or not outdoors:
            continue
        if azimuth.derived and surface.vertices is None:
            continue
        source = _record_with(name, climate.record, None if measurements is None else measurements.record)
        rows = None if source is None else _rows_of(source, name, climate.record)
        if source is None or rows is None:
            continue
        values = on_grid(rows, source.kinds.get(name, "instant"), kind_of_global)
        albedo = float(building.site.ground_reflectance)
        planes[name, float(azimuth), float(tilt)] = MeasuredPlane(
            name, values, float(azimuth), float(tilt), albedo
        )
    return list(planes.values())


def _moves_the_clock(building: Building) -> bool:
    weather = building.weather
    if weather is None:
        return False
    return float(weather.clock) != 0.0 or any(float(c.clock) != 0.0 for c in weather.columns.values())


def _record_with(name: str, weather: Record, measured: Record | None) -> Record | None:
    return next((r for r in (weather, measured) if r is not None and name in r.columns), None)


def _rows_of(source: Record, name: str, weather: Record) -> npt.NDArray[np.float64] | None:
    """A column in the rows of the weather; none where steps or stamps differ."""
    if source.grid.interval != weather.grid.interval:
        return None
    late = (weather.grid.start - source.grid.start) / weather.grid.interval
    first = round(late)
    if abs(late - first) > 1e-6:
        return None
    rows = np.arange(weather.grid.count) + first
    inside = (rows >= 0) & (rows < source.grid.count)
    values = source.columns[name][np.clip(rows, 0, source.grid.count - 1)]
    return np.where(inside, values, np.nan)

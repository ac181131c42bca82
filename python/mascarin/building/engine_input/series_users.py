"""Courses over time that a building uses: its schedules, and columns that are used directly."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from mascarin.building.base.time_series import ColumnCourse, temperature_course
from mascarin.building.soil.courses import SoilCourse, soil_courses

if TYPE_CHECKING:
    from mascarin.building.parts.air.schedule import Schedule
    from mascarin.building.parts.description import Description

Use = tuple[str, tuple[str, ...], str]


def schedule_uses(building: Description) -> Iterator[Use]:
    """Every use of a schedule: its name, the place, and the kind that is needed there."""
    for name, zone in building.zones.items():
        location = ("zones", name)
        for section in ("gains", "ventilation"):
            for key, part in getattr(zone, section).items():
                if part.schedule is not None:
                    yield part.schedule, (*location, section, key, "schedule"), "fraction"
        if zone.infiltration.schedule is not None:
            yield zone.infiltration.schedule, (*location, "infiltration", "schedule"), "fraction"
        if zone.mixing_air_change is not None and zone.mixing_air_change.schedule is not None:
            yield zone.mixing_air_change.schedule, (*location, "mixing_air_change", "schedule"), "fraction"
        if zone.air_gradient is not None and zone.air_gradient.schedule is not None:
            yield zone.air_gradient.schedule, (*location, "air_gradient", "schedule"), "fraction"
        for which, loads in zone.loads.items():
            if loads.setpoint.schedule is not None:
                yield loads.setpoint.schedule, (*location, which, "setpoint", "schedule"), "temperature"
            if loads.schedule is not None:
                yield loads.schedule, (*location, which, "schedule"), "fraction"
    for name, surface in building.surfaces.items():
        for which, side in (("outside", surface.outside), ("inside", surface.inside)):
            if side.heat_flux is not None and side.heat_flux.schedule is not None:
                flux_location = ("surfaces", name, which, "heat_flux", "schedule")
                yield side.heat_flux.schedule, flux_location, "fraction"
            if side.scheduled is not None:
                yield side.scheduled, ("surfaces", name, which, "scheduled"), "temperature"
    yield from _of_heat_sources(building)
    for section in ("air_paths", "openings", "vents"):
        for name, part in getattr(building, section).items():
            if part.schedule is not None:
                yield part.schedule, (section, name, "schedule"), "fraction"
    for name, window in building.windows.items():
        if window.blind is not None and window.blind.schedule is not None:
            yield window.blind.schedule, ("windows", name, "blind", "schedule"), "fraction"
    yield from _of_units(building)
    yield from _of_humidity(building)


def _of_humidity(building: Description) -> Iterator[Use]:
    if building.humidity is None:
        return
    for name, zone in building.humidity.zones.items():
        location = ("humidity", "zones", name)
        for key, gain in zone.gains.items():
            if gain.schedule is not None:
                yield gain.schedule, (*location, "gains", key, "schedule"), "fraction"
        for which, plant in zone.plants.items():
            if plant.schedule is not None:
                yield plant.schedule, (*location, which, "schedule"), "fraction"
            key, setpoint = plant.setpoint
            if setpoint.schedule is not None:
                yield setpoint.schedule, (*location, which, key, "schedule"), setpoint.SCHEDULED


def _of_heat_sources(building: Description) -> Iterator[Use]:
    for name, source in building.heat_sources.items():
        path, driven = source.driven
        schedule = getattr(driven, "schedule", None)
        if schedule is not None:
            yield schedule, ("heat_sources", name, *path.split("."), "schedule"), "fraction"
        for path_of_temperature, temperature in source.temperatures.items():
            if temperature.schedule is not None:
                location = ("heat_sources", name, *path_of_temperature.split("."), "schedule")
                yield temperature.schedule, location, "temperature"


def _of_units(building: Description) -> Iterator[Use]:
    for name, unit in building.ventilation_units.items():
        location = ("ventilation_units", name)
        for section, flows in (("supply", unit.supply), ("exhaust", unit.exhaust)):
            for zone, flow in flows.items():
                if flow.schedule is not None:
                    yield flow.schedule, (*location, section, zone, "schedule"), "fraction"
        if unit.temperature is not None and unit.temperature.schedule is not None:
            yield unit.temperature.schedule, (*location, "temperature", "schedule"), "temperature"


def column_courses(building: Description) -> Iterator[tuple[ColumnCourse, tuple[str, ...]]]:
    """Every course that is taken from columns directly, and the place that names it."""
    for name, zone in building.zones.items():
        location = ("zones", name)
        for key, gain in zone.gains.items():
            if gain.course is not None:
                yield gain.course, (*location, "gains", key, "column")
        if zone.mixing_air_change is not None and zone.mixing_air_change.course is not None:
            yield zone.mixing_air_change.course, (*location, "mixing_air_change", "column")
        if zone.air_gradient is not None and zone.air_gradient.course is not None:
            yield zone.air_gradient.course, (*location, "air_gradient", "column")
        for which, loads in zone.loads.items():
            if loads.setpoint.column is not None:
                yield temperature_course(loads.setpoint.column), (*location, which, "setpoint", "column")
        for key, bridge in zone.thermal_bridges.items():
            if bridge.measured is not None:
                yield temperature_course(bridge.measured), (*location, "thermal_bridges", key, "measured")
    for name, surface in building.surfaces.items():
        for which, side in (("outside", surface.outside), ("inside", surface.inside)):
            if side.heat_flux is not None and side.heat_flux.course is not None:
                yield side.heat_flux.course, ("surfaces", name, which, "heat_flux", "column")
            if isinstance(side.measured, tuple):
                yield temperature_course(side.measured), ("surfaces", name, which, "measured")
    for name, path in building.air_paths.items():
        if path.course is not None:
            yield path.course, ("air_paths", name, "column")
    for name, unit in building.ventilation_units.items():
        for section, flows in (("supply", unit.supply), ("exhaust", unit.exhaust)):
            for zone_name, flow in flows.items():
                if flow.course is not None:
                    yield flow.course, ("ventilation_units", name, section, zone_name, "column")
        if unit.temperature is not None and unit.temperature.column is not None:
            yield (
                temperature_course(unit.temperature.column),
                ("ventilation_units", name, "temperature", "column"),
            )
    yield from _columns_of_heat_sources(building)
    for name, control in building.controls.items():
        if control.rain is not None:
            yield control.rain.course, ("controls", name, "rain", "column")
    for name, vapour in (building.humidity.zones if building.humidity is not None else {}).items():
        for key, released in vapour.gains.items():
            if released.course is not None:
                yield released.course, ("humidity", "zones", name, "gains", key, "column")
        for which, plant in vapour.plants.items():
            key, setpoint = plant.setpoint
            if setpoint.measured is not None:
                yield setpoint.measured, ("humidity", "zones", name, which, key, "column")


def _columns_of_heat_sources(building: Description) -> Iterator[tuple[ColumnCourse, tuple[str, ...]]]:
    for name, source in building.heat_sources.items():
        path, driven = source.driven
        if driven.course is not None:
            yield driven.course, ("heat_sources", name, *path.split("."), "column")
        for path_of_temperature, temperature in source.temperatures.items():
            if temperature.column is not None:
                location = ("heat_sources", name, *path_of_temperature.split("."), "column")
                yield temperature_course(temperature.column), location


def courses(building: Description) -> dict[str, Schedule | ColumnCourse | SoilCourse]:
    """Courses over time of a building by name: used schedules, those from columns directly, those of soil."""
    used = {name for name, _, _ in schedule_uses(building)}
    by_channel: dict[str, Schedule | ColumnCourse | SoilCourse] = {
        name: schedule for name, schedule in building.schedules.items() if name in used
    }
    by_channel |= {course.name: course for course, _ in column_courses(building)}
    return by_channel | {course.name: course for course in soil_courses(building)}

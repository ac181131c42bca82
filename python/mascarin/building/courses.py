"""Quantities over time that a building takes from measured columns, without a schedule of their own."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal

from mascarin.building.schedule_uses import schedule_uses

if TYPE_CHECKING:
    from mascarin.building.description import Description
    from mascarin.building.schedule import Schedule

CourseKind = Literal["temperature", "power", "flow"]

#: Units that a column may have, by what it means: the factor to the unit of the engine.
POWER_UNITS: Final[Mapping[str, float]] = {"W": 1.0, "kW": 1000.0}
FLOW_UNITS: Final[Mapping[str, float]] = {"m3/s": 1.0, "m3/h": 1.0 / 3600.0, "L/s": 1e-3}
_UNITS: Final[Mapping[str, Mapping[str, float]]] = {
    "temperature": {"degC": 1.0},
    "power": POWER_UNITS,
    "flow": FLOW_UNITS,
}


@dataclass(frozen=True)
class ColumnCourse:
    """A measured column, or the mean of several, as a course over time.

    Attributes
    ----------
    kind : str
        What it is: a temperature is used with its value at an instant, a power or flow with its mean over a
        step.
    columns : tuple of str
        Names of the columns; their mean is used.
    unit : str
        Unit of the columns.

    Examples
    --------
    >>> ColumnCourse("flow", ("supply",), "m3/h").name
    'supply [m3/h]'
    """

    kind: CourseKind
    columns: tuple[str, ...]
    unit: str

    @property
    def name(self) -> str:
        """The columns and their unit."""
        mean = "mean of " if len(self.columns) > 1 else ""
        return f"{mean}{' and '.join(self.columns)} [{self.unit}]"

    @property
    def scale(self) -> float:
        """Factor from the unit of the columns to that of the engine."""
        return _UNITS[self.kind][self.unit]


def temperature_course(columns: str | tuple[str, ...]) -> ColumnCourse:
    """Course of a measured temperature, or of the mean of several."""
    return ColumnCourse("temperature", (columns,) if isinstance(columns, str) else columns, "degC")


def column_courses(building: Description) -> Iterator[tuple[ColumnCourse, tuple[str, ...]]]:
    """Every course that is taken from columns directly, and the place that names it."""
    for name, zone in building.zones.items():
        at = ("zones", name)
        for key, gain in zone.gains.items():
            if gain.course is not None:
                yield gain.course, (*at, "gains", key, "column")
        for which, loads in zone.loads.items():
            if loads.setpoint.column is not None:
                yield temperature_course(loads.setpoint.column), (*at, which, "setpoint", "column")
        for key, bridge in zone.thermal_bridges.items():
            if bridge.measured is not None:
                yield temperature_course(bridge.measured), (*at, "thermal_bridges", key, "measured")
    for name, surface in building.surfaces.items():
        for which, side in (("outside", surface.outside), ("inside", surface.inside)):
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


def courses(building: Description) -> dict[str, Schedule | ColumnCourse]:
    """Courses over time of a building by name: its used schedules, then those taken from columns directly."""
    used = {name for name, _, _ in schedule_uses(building)}
    found: dict[str, Schedule | ColumnCourse] = {
        name: schedule for name, schedule in building.schedules.items() if name in used
    }
    return found | {course.name: course for course, _ in column_courses(building)}

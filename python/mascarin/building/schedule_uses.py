"""Where the schedules of a building are used."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mascarin.building.description import Description

Use = tuple[str, tuple[str, ...], str]


def schedule_uses(building: Description) -> Iterator[Use]:
    """Every use of a schedule: its name, the place, and the kind that is needed there."""
    for name, zone in building.zones.items():
        at = ("zones", name)
        for section in ("gains", "ventilation"):
            for key, part in getattr(zone, section).items():
                if part.schedule is not None:
                    yield part.schedule, (*at, section, key, "schedule"), "fraction"
        for which, loads in zone.loads.items():
            if loads.setpoint.schedule is not None:
                yield loads.setpoint.schedule, (*at, which, "setpoint", "schedule"), "temperature"
            if loads.schedule is not None:
                yield loads.schedule, (*at, which, "schedule"), "fraction"
    for section, parts in (("air_paths", building.air_paths), ("openings", building.openings)):
        for name, part in parts.items():
            if part.schedule is not None:
                yield part.schedule, (section, name, "schedule"), "fraction"
    yield from _of_units(building)


def _of_units(building: Description) -> Iterator[Use]:
    for name, unit in building.ventilation_units.items():
        at = ("ventilation_units", name)
        for section, flows in (("supply", unit.supply), ("exhaust", unit.exhaust)):
            for zone, flow in flows.items():
                if flow.schedule is not None:
                    yield flow.schedule, (*at, section, zone, "schedule"), "fraction"
        if unit.temperature is not None and unit.temperature.schedule is not None:
            yield unit.temperature.schedule, (*at, "temperature", "schedule"), "temperature"

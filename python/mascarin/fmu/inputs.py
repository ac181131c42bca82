"""What can be an input of a unit: weather, schedules and measured columns, which a run takes from tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.building.base.time_series import ColumnCourse
from mascarin.building.engine_input.series_users import courses
from mascarin.building.soil.courses import SoilCourse
from mascarin.errors import InputError, did_you_mean
from mascarin.simulation.checks.flow_balance import require_balanced_flows
from mascarin.simulation.preparation.prepare import limits_of_columns
from mascarin.weather.records.channels import BY_NAME, CHANNELS, COEFFICIENTS, IRRADIANCES, TEMPERATURES
from mascarin.weather.schedules import LIMITS_OF_COURSES

if TYPE_CHECKING:
    from mascarin.simulation import Simulation

#: The sun follows from the time, and the global radiation from its parts.
_WEATHER: Final = CHANNELS[:9]
_GLOBAL: Final = ("direct_normal", "diffuse_horizontal")
_UNITS: Final = {
    "fraction": "-",
    "temperature": "degC",
    "power": "W",
    "heat_flux": "W/m2",
    "water_flow": "kg/s",
    "flow": "m3/s",
    "air_change": "1/h",
    "temperature_gradient": "K/m",
    "vapour": "kg/s",
    "rain": "mm/h",
    "relative_humidity": "-",
    "humidity_ratio": "kg/kg",
}
_COLUMN_UNITS: Final = {TEMPERATURES: "degC", IRRADIANCES: "W/m2", COEFFICIENTS: "W/(m2 K)"}


@dataclass(frozen=True)
class Channel:
    """A channel of the forcing that can be an input.

    Attributes
    ----------
    name : str
        Name of the input, such as ``weather.air_temperature`` or ``schedules.heating``.
    position : int
        Position in the forcing.
    unit : str
        Its unit.
    low, high : float
        Limits. [unit]
    description : str
        What it is.
    """

    name: str
    position: int
    unit: str
    low: float
    high: float
    description: str


def channels_of(simulation: Simulation) -> list[Channel]:
    """Every channel of a run that can be an input."""
    return [*_weather(simulation), *_tables(simulation)]


def _weather(simulation: Simulation) -> list[Channel]:
    channels = []
    for position, name in enumerate(_WEATHER):
        if np.isnan(simulation.compiled.forcing[..., position]).any():
            continue  # the run does without it
        channel = BY_NAME[name]
        # Measured irradiances may be a little below zero at night.
        low = 0.0 if name in _GLOBAL else channel.low
        channels.append(
            Channel(f"weather.{name}", position, channel.unit, low, channel.high, channel.description)
        )
    return channels


def _tables(simulation: Simulation) -> list[Channel]:
    """Schedules and measured columns."""
    by_name = courses(simulation.building)
    columns = simulation.channels[: len(simulation.channels) - len(by_name)]
    limits = limits_of_columns(simulation.building)
    first = len(CHANNELS)
    channels = []
    for position, column in enumerate(columns, start=first):
        low, high = limits[column]
        unit = _COLUMN_UNITS[low, high]
        channels.append(Channel(f"columns.{column}", position, unit, low, high, f"measured column {column}"))
    taken = {channel.name for channel in channels}
    for position, (name, course) in enumerate(by_name.items(), start=first + len(columns)):
        if isinstance(course, SoilCourse):
            continue  # what the soil remembers of the weather is no input
        low, high = LIMITS_OF_COURSES[course.kind]
        if isinstance(course, ColumnCourse):
            short = f"columns.{' and '.join(course.columns)}"
            full_name = f"columns.{name}" if short in taken else short
            words = f"measured: {name}"
        else:
            full_name, words = f"schedules.{name}", f"schedule {name}, {course.kind}"
        taken.add(full_name)
        channels.append(Channel(full_name, position, _UNITS[course.kind], low, high, words))
    return channels


def chosen_inputs(simulation: Simulation, patterns: Sequence[str]) -> list[Channel]:
    """The channels that fit patterns, in the order of the forcing.

    Raises
    ------
    InputError
        A pattern fits none; or a flow could differ from the other flows of its zone.
    """
    all_channels = channels_of(simulation)
    names = [channel.name for channel in all_channels]
    for pattern in patterns:
        if not any(fnmatchcase(name, pattern) for name in names):
            raise InputError(
                f"--input: found '{pattern}', expected one of the inputs of this building or a pattern such "
                f"as 'weather.*'; it has {', '.join(names)}. {did_you_mean(pattern, names)} A number in the "
                "building is a parameter: to make it an input, give a schedule or a column in its place"
            )
    chosen = [
        channel for channel in all_channels if any(fnmatchcase(channel.name, word) for word in patterns)
    ]
    for channel in chosen:
        _require_free(simulation, channel)
    return chosen


def global_follows(inputs: Sequence[Channel]) -> bool:
    """Whether the global radiation has to be calculated from its parts, because one of them is an input."""
    return any(channel.position == CHANNELS.index(name) for channel in inputs for name in _GLOBAL)


def _require_free(simulation: Simulation, channel: Channel) -> None:
    """Refuse a flow that has to balance others: the engine takes balanced flows for granted.

    Flows are linear in each channel, so that two other values show whether they balance for all.
    """
    if channel.position < len(CHANNELS):
        return
    for value in (0.0, 1.0):
        forcing = simulation.compiled.forcing[:1].copy()
        forcing[..., channel.position] = value
        try:
            require_balanced_flows(
                simulation.building,
                forcing,
                simulation.channels,
                simulation.compiled.start + simulation.compiled.edges,
                simulation.times.zone,
            )
        except InputError as error:
            raise InputError(
                f"--input: '{channel.name}' drives a flow of air that other flows of its zone must balance, "
                f"which an input cannot promise. Give the zone makeup_air, or leave this input out. ({error})"
            ) from None

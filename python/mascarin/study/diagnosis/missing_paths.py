"""Heat flows that a building may have and its model does not, and measured inputs that may be wrong."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np

from mascarin.building.engine_input.series_users import courses
from mascarin.simulation.preparation.weather_inputs import corrected_forcing
from mascarin.tables.forcing_blocks import ForcingBlocks
from mascarin.weather.instruments.column_errors import RIGHT, SUN, ColumnError
from mascarin.weather.records.channels import CHANNELS, RADIATION

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.simulation.simulation import Simulation
    from mascarin.study.context.context import StudyContext

    Array = npt.NDArray[np.float64]
    Candidate = tuple[Literal["gain", "offset", "clock"], str, str, ColumnError, float, str]

#: Sizes of missing heat flows: an air change [1/h], and a thermal bridge per area of the zone [W/(m2 K)].
_AIR_CHANGE: Final = 0.5
_BRIDGE: Final = 0.1
#: Sizes of errors of inputs: gains of radiation and wind [-], offset of temperatures [K], clock [s].
_RADIATION: Final = 0.05
_WIND: Final = 0.1
_OFFSET: Final = 0.5
_CLOCK: Final = 900.0
#: Name of the thermal bridge that is tried.
_NAME: Final = "missing_path"


@dataclass(frozen=True, eq=False)
class InputFault:
    """An error of a measured input of the model.

    Attributes
    ----------
    what : str
        ``gain``, ``offset`` or ``clock``.
    subject : str
        Which input.
    forcing : ndarray
        Forcing of the model if the input were right: without the error. [unit of each channel]
    scale : float
        Size of the error that is undone. [unit]
    unit : str
        Of the size.
    """

    what: Literal["gain", "offset", "clock"]
    subject: str
    forcing: Array
    scale: float
    unit: str


def missing_paths(building: Building) -> Iterator[tuple[str, str, dict[str, Any], float, str, float]]:
    """Heat flows that the model of a building may lack, one at a time.

    Parameters
    ----------
    building : Building
        As described.

    Yields
    ------
    tuple of str, str, dict, float, str and float
        Zone, what it is, changes as `Building.replace` takes them, size, its unit, and the smallest size: no
        more air can be too much than there is.
    """
    for name, zone in building.zones.items():
        constant = float(zone.infiltration.constant)
        change = {f"zones.{name}.infiltration.constant": constant + _AIR_CHANGE}
        yield name, "air change with outdoors", change, _AIR_CHANGE, "1/h", -constant
        area = sum(
            float(surface.area)
            for surface in building.surfaces.values()
            if name in (surface.inside.zone, surface.outside.zone) and surface.area is not None
        )
        size = round(_BRIDGE * area, 3)
        if size > 0.0:
            bridge = {"chi": size, "number": 1}
            yield (
                name,
                "thermal bridge to outdoors",
                {f"zones.{name}.thermal_bridges.{_NAME}": bridge},
                size,
                "W/K",
                -math.inf,
            )


def input_errors(setup: StudyContext, simulation: Simulation, vector: Array) -> Iterator[InputFault]:
    """Errors of measured inputs, one at a time: radiation, outdoor air, wind, temperatures of boundaries.

    They are the errors that a building may state under ``weather``, beside those that it states.

    Parameters
    ----------
    setup : StudyContext
        Its measurements tell which channels were measured.
    simulation : Simulation
        The model.
    vector : ndarray, shape (P,)
        Its parameter vector. [unit of each]

    Yields
    ------
    InputFault
        Only of inputs that are not constant.
    """
    forcing = simulation.compiled.forcing_at(vector)
    inputs = simulation.compiled.inputs
    present_errors, clock = ({}, 0.0) if inputs is None else inputs.errors(vector[inputs.positions])
    candidates = list(_candidates(setup, simulation, forcing))
    schedules = len(courses(simulation.building))
    corrected = corrected_forcing(
        simulation.building, setup.climate, simulation.channels[: len(simulation.channels) - schedules],
        [*dict.fromkeys((*present_errors, *(column for _, _, column, _, _, _ in candidates)))],
        times=simulation.times, scheme=simulation.scheme, measurements=setup.inputs.driving,
    )  # fmt: skip
    for what, subject, column, error, scale, unit in candidates:
        before = present_errors.get(column, RIGHT)
        after = ColumnError(
            before.gain * error.gain, before.offset * error.gain + error.offset, before.clock + error.clock
        )
        without = corrected.at(forcing, present_errors, {**present_errors, column: after}, (clock, clock))
        yield InputFault(what, subject, np.asarray(without), scale, unit)


def _candidates(setup: StudyContext, simulation: Simulation, forcing: Array) -> Iterator[Candidate]:
    """What may be wrong, and what would make it right: fault, subject, column, error, size and its unit."""
    late = ColumnError(clock=-_CLOCK)
    if np.any(forcing[:, :, [CHANNELS.index(name) for name in RADIATION]]):
        gain = ColumnError(gain=1.0 / (1.0 + _RADIATION))
        yield "gain", "solar radiation", SUN, gain, 100.0 * _RADIATION, "%"
        yield "clock", "solar radiation", SUN, late, _CLOCK / 60.0, "min"
    warm = ColumnError(offset=-_OFFSET)
    yield "offset", "air_temperature", "air_temperature", warm, _OFFSET, "K"
    yield "clock", "air_temperature", "air_temperature", late, _CLOCK / 60.0, "min"
    if np.ptp(forcing[:, :, CHANNELS.index("wind_speed")]) > 0.0:
        gain = ColumnError(gain=1.0 / (1.0 + _WIND))
        yield "gain", "wind_speed", "wind_speed", gain, 100.0 * _WIND, "%"
    temperatures = _boundaries(simulation.building)
    for channel in simulation.channels:
        if channel in temperatures and channel in setup.inputs.driving.data:
            yield "offset", channel, channel, warm, _OFFSET, "K"


def simulated_with(setup: StudyContext, simulation: Simulation, forcing: Array, vector: Array) -> Array:
    """Series with another forcing, shape (n, S); NaN where the model cannot be run. [unit of each sensor]"""
    sensors = len(setup.observation.names)
    run = replace(simulation.compiled, forcing_blocks=ForcingBlocks.of(forcing), inputs=None)
    records = run.ensemble(vector[None]).records[0]
    return np.asarray(setup.observation.simulated(simulation.index, records[:, :sensors]))


def _boundaries(building: Building) -> set[str]:
    """Columns that are measured temperatures of boundaries."""
    sides = (side for surface in building.surfaces.values() for side in (surface.outside, surface.inside))
    return {column for side in sides for column in side.measured_columns}

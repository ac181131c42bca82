"""Heat flows that a building may have and its model does not, and measured inputs that may be wrong."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np

from mascarin.weather.records.channels import CHANNELS, RADIATION, UNITS

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.simulation.simulation import Simulation
    from mascarin.study.context.context import StudyContext

    Array = npt.NDArray[np.float64]

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


def missing_paths(building: Building) -> Iterator[tuple[str, str, dict[str, Any], float, str]]:
    """Heat flows that the model of a building may lack, one at a time.

    Parameters
    ----------
    building : Building
        As described.

    Yields
    ------
    tuple of str, str, dict, float and str
        Zone, what it is, changes as `Building.replace` takes them, size and its unit.
    """
    for name, zone in building.zones.items():
        constant = float(zone.infiltration.constant)
        change = {f"zones.{name}.infiltration.constant": constant + _AIR_CHANGE}
        yield name, "air change with outdoors", change, _AIR_CHANGE, "1/h"
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
            )


def input_errors(setup: StudyContext, simulation: Simulation) -> Iterator[InputFault]:
    """Errors of measured inputs, one at a time: radiation, outdoor air, wind, temperatures of boundaries.

    Parameters
    ----------
    setup : StudyContext
        Its measurements tell which channels were measured.
    simulation : Simulation
        The model.

    Yields
    ------
    InputFault
        Only of inputs that are not constant.
    """
    forcing = simulation.compiled.forcing
    sun = [CHANNELS.index(name) for name in RADIATION]
    if np.any(forcing[:, :, sun]):
        scaled = forcing.copy()
        scaled[:, :, sun] /= 1.0 + _RADIATION
        yield InputFault("gain", "solar radiation", scaled, 100.0 * _RADIATION, "%")
        yield InputFault("clock", "solar radiation", _earlier(forcing, sun, simulation), _CLOCK / 60.0, "min")
    air = CHANNELS.index("air_temperature")
    yield InputFault("offset", "air_temperature", _added(forcing, air), _OFFSET, "K")
    yield InputFault("clock", "air_temperature", _earlier(forcing, [air], simulation), _CLOCK / 60.0, "min")
    wind = CHANNELS.index("wind_speed")
    if np.ptp(forcing[:, :, wind]) > 0.0:
        scaled = forcing.copy()
        scaled[:, :, wind] /= 1.0 + _WIND
        yield InputFault("gain", "wind_speed", scaled, 100.0 * _WIND, "%")
    temperatures = _boundaries(simulation.building)
    for k, channel in enumerate(simulation.channels, start=len(UNITS)):
        if channel in temperatures and channel in setup.inputs.driving.data:
            yield InputFault("offset", channel, _added(forcing, k), _OFFSET, "K")


def simulated_with(setup: StudyContext, simulation: Simulation, forcing: Array, vector: Array) -> Array:
    """Series with another forcing, shape (n, S); NaN where the model cannot be run. [unit of each sensor]"""
    sensors = len(setup.observation.names)
    run = replace(simulation.compiled, forcing=forcing)
    records = run.ensemble(vector[None]).records[0]
    return np.asarray(setup.observation.simulated(simulation.index, records[:, :sensors]))


def _added(forcing: Array, channel: int) -> Array:
    changed = forcing.copy()
    changed[:, :, channel] -= _OFFSET
    return changed


def _earlier(forcing: Array, channels: list[int], simulation: Simulation) -> Array:
    """Forcing whose channels come earlier: what a clock that is late has delayed."""
    changed = forcing.copy()
    steps = np.arange(len(forcing), dtype=np.float64)
    moved = np.clip(steps + _CLOCK / simulation.step_seconds, 0.0, len(forcing) - 1.0)
    for channel in channels:
        for stage in range(forcing.shape[1]):
            changed[:, stage, channel] = np.interp(moved, steps, forcing[:, stage, channel])
    return changed


def _boundaries(building: Building) -> set[str]:
    """Columns that are measured temperatures of boundaries."""
    sides = (side for surface in building.surfaces.values() for side in (surface.outside, surface.inside))
    return {column for side in sides for column in side.measured_columns}

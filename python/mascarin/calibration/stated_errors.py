"""Errors of sensors as users state them, and the calibration of a building together with them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Final, Protocol

import numpy as np

from mascarin._io.durations import seconds_of
from mascarin.calibration.joint_estimation import estimate_jointly
from mascarin.calibration.joint_posterior import ErrorStatement
from mascarin.calibration.sensor_errors import SensorError
from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.calibration.result import Calibration
    from mascarin.calibration.search_options import SearchOptions
    from mascarin.simulation.simulation import Simulation
    from mascarin.validation.observation import Observation
    from mascarin.validation.sensors import Sensor, SensorUncertainty

#: Largest standard deviation of each part of the error of the model, relative to the range of the sensor. [-]
LIMIT: Final = 0.1
#: Correlation time of the errors of days. [d]
PERSISTENCE: Final = 5.0
#: Shortest period from which errors of days can be estimated. [h]
MIN_HOURS: Final = 48.0


class States(Protocol):
    """What a sensor states of its errors; see `SensorError`."""

    @property
    def offset(self) -> float | None:
        """Standard uncertainty of a constant. [unit]"""
        ...

    @property
    def common(self) -> float:
        """The same of a constant that several sensors share. [unit]"""
        ...

    @property
    def gain(self) -> float:
        """The same of a gain. [-]"""
        ...

    @property
    def reference(self) -> float:
        """Reading at which a gain has no effect. [unit]"""
        ...

    @property
    def clock(self) -> str | float | None:
        """The same of the clock."""
        ...

    @property
    def repeatability(self) -> float | None:
        """Standard deviation of repeated readings. [unit]"""
        ...


def shared_errors(sensor: States, stated: SensorUncertainty) -> SensorError:
    """Errors that all readings of a sensor share.

    A stated uncertainty without an ``offset`` counts as one: datasheets state the accuracy, of which the
    repeatability is the smaller part.

    Parameters
    ----------
    sensor : States
        What it states.
    stated : SensorUncertainty
        Standard uncertainty of a reading.
    """
    offset = stated.absolute if sensor.repeatability is None else 0.0
    if sensor.repeatability is not None and stated.absolute > sensor.repeatability:
        offset = math.sqrt(stated.absolute**2 - sensor.repeatability**2)
    return SensorError(
        offset=offset if sensor.offset is None else sensor.offset,
        common=sensor.common,
        gain=sensor.gain if sensor.gain else stated.relative,
        reference=sensor.reference,
        clock=0.0 if sensor.clock is None else seconds_of(sensor.clock),
    )


def require_supported(method: str, cost: str, hours: float) -> None:
    """Refuse a calibration that cannot estimate errors of sensors.

    Raises
    ------
    InputError
        Another cost than ``nll``, the method ``emcee``, or less than two days.
    """
    if method == "emcee":
        raise InputError(
            "method: found emcee with errors of sensors, which it would not sample; expected a method that "
            "finds a minimum, such as least-squares: the errors are estimated from there. Or leave offset, "
            "common, gain, clock and depth of the sensors out"
        )
    if cost != "nll":
        raise InputError(
            f"cost: found {cost} with errors of sensors, expected nll, the likelihood that weighs them; "
            "write cost nll, or leave offset, common, gain, clock and depth of the sensors out"
        )
    if hours < MIN_HOURS:
        raise InputError(
            f"period: found {hours:g} h with errors of sensors, expected at least {MIN_HOURS:g} h: errors "
            "that change from day to day are estimated; make it longer, or leave offset, common, gain, "
            "clock and depth of the sensors out"
        )


def with_sensor_errors(
    fit: Calibration,
    simulation: Simulation,
    observation: Observation,
    sensors: Mapping[str, Sensor],
    options: SearchOptions,
) -> Calibration:
    """Estimate parameters again, together with the errors of the sensors and of the model.

    Parameters
    ----------
    fit : Calibration
        Without errors.
    simulation : Simulation
        The model, its outputs those of the sensors.
    observation : Observation
        The measured series.
    sensors : mapping of str to Sensor
        What each states.
    options : SearchOptions
        Kind of derivatives.

    Raises
    ------
    InputError
        A depth of a sensor that is not inside a wall.
    SolverError
        The model cannot be simulated near the estimates.
    """
    errors = tuple(
        shared_errors(sensor, sensor.uncertainty(output.unit, f"sensors: {name}"))
        for (name, sensor), output in zip(sensors.items(), simulation.outputs, strict=True)
    )
    local = observation.times.tz_localize(None)
    hours = np.asarray((local - local[0].normalize()).total_seconds() / 3600.0, dtype=np.float64)
    depths = depth_paths(simulation, sensors)
    limit = np.array([max(LIMIT * sensor.span, 1e-9) for sensor in fit.problem.sensors])
    stated = ErrorStatement(errors, hours, observation.interval, limit, PERSISTENCE, tuple(depths))
    further = np.zeros((*observation.measured.shape, len(depths)))
    if depths:
        _, slopes = simulation.jacobian_vector(list(depths), simulation.vector(fit.values))
        for k, uncertainty in enumerate(depths.values()):
            further[..., k] = uncertainty * observation.simulated(simulation.index, slopes[k])
    return estimate_jointly(fit, stated, options, further)[0]


def depth_paths(simulation: Simulation, sensors: Mapping[str, Sensor]) -> dict[str, float]:
    """Standard uncertainty of the depth of each sensor that states one, by path. [m]

    Raises
    ------
    InputError
        The sensor is not one of the building, inside a wall.
    """
    uncertainty_of_depth = {}
    for (name, sensor), output in zip(sensors.items(), simulation.outputs, strict=True):
        if sensor.depth is None:
            continue
        probe = output.name.split(".")[0]
        if output.kind != "sensor" or probe not in simulation.building.sensors:
            raise InputError(
                f"sensors: {name}: found a depth for {output.name}, which is not inside a wall; expected a "
                "sensor of the building (sensors), such as probe.temperature. Leave depth out"
            )
        uncertainty_of_depth[f"sensors.{probe}.depth"] = sensor.depth
    return uncertainty_of_depth

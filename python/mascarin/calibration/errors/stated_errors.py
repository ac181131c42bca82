"""Errors of sensors as users state them, and the calibration of a building together with them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mascarin._io.durations import seconds_of
from mascarin.calibration.errors.joint_estimation import estimate_jointly
from mascarin.calibration.errors.linear_estimation import ErrorStatement
from mascarin.calibration.errors.posterior_checks import judged
from mascarin.calibration.errors.sensor_errors import SensorError
from mascarin.errors import InputError
from mascarin.measurements.scatter import scatter, zero_reading

if TYPE_CHECKING:
    from mascarin.calibration.base.result import Calibration
    from mascarin.calibration.base.search_options import SearchOptions
    from mascarin.measurements.observation import Observation
    from mascarin.measurements.sensor import Sensor
    from mascarin.measurements.uncertainty import SensorUncertainty
    from mascarin.simulation.simulation import Simulation

Floats = NDArray[np.float64]

#: Largest standard deviation of each part of the error of the model, relative to the range of the sensor. [-]
LIMIT: Final = 0.1
#: Correlation time of the errors of days. [d]
PERSISTENCE: Final = 5.0
#: Shortest period from which errors of days can be estimated. [h]
MIN_HOURS: Final = 48.0
#: Units in which zero does not say that something is off.
_WITHOUT_ZERO: Final = frozenset({"degC", "%", "-"})
#: Stated offset, in readings at zero, from which the record contradicts it.
_MOST_AT_ZERO: Final = 3.0


def only_scatter(sensor: Sensor) -> bool:
    """Whether a sensor says that its readings share no error: ``offset: 0``, or a repeatability alone.

    Parameters
    ----------
    sensor : Sensor
        What it states.

    Examples
    --------
    >>> from mascarin.measurements import Sensor
    >>> only_scatter(Sensor("T", standard_uncertainty=0.1, offset=0.0)), only_scatter(Sensor("T"))
    (True, False)
    """
    if sensor.common or sensor.gain or sensor.clock is not None:
        return False
    if sensor.offset is not None:
        return sensor.offset == 0.0
    stated = sensor.expanded_uncertainty is not None or sensor.standard_uncertainty is not None
    return sensor.repeatability is not None and not stated


def shared_errors(sensor: Sensor, stated: SensorUncertainty, random: float = math.nan) -> SensorError:
    """Errors that all readings of a sensor share.

    A stated uncertainty without an ``offset`` has two parts: the scatter of the readings, and an offset that
    they share, which has the rest. A datasheet that states an accuracy of 0.3 K does not say that readings
    scatter by 0.3 K.

    Parameters
    ----------
    sensor : Sensor
        What it states.
    stated : SensorUncertainty
        Standard uncertainty of a reading.
    random : float
        Scatter of the record, see `mascarin.measurements.scatter`; NaN if it is not known, and all of the
        uncertainty is then an offset. A stated ``repeatability`` takes its place. [unit]

    Examples
    --------
    >>> from mascarin.measurements.sensor import Sensor
    >>> from mascarin.measurements.uncertainty import SensorUncertainty
    >>> shared_errors(Sensor("T", standard_uncertainty=0.5), SensorUncertainty(0.5), random=0.3).offset
    0.4
    """
    scatters = sensor.repeatability if sensor.repeatability is not None else random
    random_and_common = math.hypot(scatters if math.isfinite(scatters) else 0.0, sensor.common)
    offset = math.sqrt(max(stated.absolute**2 - random_and_common**2, 0.0))
    return SensorError(
        offset=offset if sensor.offset is None else sensor.offset,
        common=sensor.common,
        gain=sensor.gain if sensor.gain else stated.relative,
        reference=sensor.reference,
        clock=0.0 if sensor.clock is None else seconds_of(sensor.clock),
    )


def reason_not_to_estimate(method: str, cost: str, hours: float) -> str | None:
    """Say why a calibration cannot estimate errors of sensors; None if it can.

    Parameters
    ----------
    method, cost : str
        Of the calibration.
    hours : float
        Length of the period. [h]

    Examples
    --------
    >>> reason_not_to_estimate("least-squares", "nll", 24.0)
    'the period has 24 h, less than the 48 h from which errors of days can be estimated'
    """
    if method == "emcee":
        return "the method emcee does not sample them"
    if cost != "nll":
        return f"the cost {cost} does not weigh them"
    if hours < MIN_HOURS:
        return (
            f"the period has {hours:g} h, less than the {MIN_HOURS:g} h from which errors of days can be "
            "estimated"
        )
    return None


def counted_as_scatter(reason: str) -> str:
    """Return the warning of a calibration whose stated uncertainties count as scatter, for a reason.

    Examples
    --------
    >>> counted_as_scatter("the cost sd does not weigh them").partition(",")[0]
    'the stated uncertainty of the sensors counts as scatter from reading to reading'
    """
    return (
        "the stated uncertainty of the sensors counts as scatter from reading to reading, although most of "
        f"that of a datasheet is an offset: errors of sensors are not estimated here, for {reason}. The "
        "intervals are too narrow if a sensor has an offset; write offset: 0 for sensors without one"
    )


def require_errors(posterior: str, reason: str | None, where: str) -> None:
    """Refuse to sample a posterior without errors of sensors and model.

    Parameters
    ----------
    posterior : str
        ``linearized`` or ``sampled``.
    reason : str or None
        Why these errors are not estimated; None if they are.
    where : str
        Name of the option.

    Raises
    ------
    InputError
        It is to be sampled, and the errors are not estimated.

    Examples
    --------
    >>> require_errors("linearized", "the method emcee does not sample them", "posterior")
    """
    if posterior == "sampled" and reason is not None:
        raise InputError(
            f"{where}: found sampled, expected linearized, because errors of sensors and model are not "
            f"estimated here: {reason}. Leave it out, or correct that"
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
        shared_errors(sensor, sensor.uncertainty(output.unit, f"sensors: {name}"), scatter(readings))
        for (name, sensor), output, readings in zip(
            sensors.items(), simulation.outputs, observation.measured.T, strict=True
        )
    )
    local = observation.times.tz_localize(None)
    hours = np.asarray((local - local[0].normalize()).total_seconds() / 3600.0, dtype=np.float64)
    depths = depth_paths(simulation, sensors)
    limit = np.array([max(LIMIT * sensor.span, 1e-9) for sensor in fit.problem.sensors])
    stated = ErrorStatement(errors, hours, observation.interval, limit, PERSISTENCE, tuple(depths))

    def effects_of_depths(values: Floats) -> Floats:
        effects = np.zeros((*observation.measured.shape, len(depths)))
        if depths:
            parameters = dict(zip(fit.problem.paths, values.tolist(), strict=True))
            _, slopes = simulation.jacobian_vector(list(depths), simulation.vector(parameters))
            for k, uncertainty in enumerate(depths.values()):
                effects[..., k] = uncertainty * observation.simulated(simulation.index, slopes[k])
        return effects

    estimates, joint = estimate_jointly(fit, stated, options, effects_of_depths)
    days = [f"{day:%Y-%m-%d}" for day in local.normalize().unique()]
    estimates = judged(estimates, joint, sizes_of(list(sensors), errors), days)
    contradicted = (
        beside_zero(name, output.unit, error, readings)
        for name, output, error, readings in zip(
            sensors, simulation.outputs, errors, observation.measured.T, strict=True
        )
    )
    return replace(estimates, warnings=(*estimates.warnings, *filter(None, contradicted)))


def beside_zero(name: str, unit: str, error: SensorError, readings: ArrayLike) -> str | None:
    """Say that a meter reads zero while all is off, although an offset is stated for it.

    Most of the uncertainty that a sensor states counts as an offset. The error of a meter of power or flow is
    mostly in proportion to its reading; an offset that it does not have takes what parameters should explain.

    Parameters
    ----------
    name, unit : str
        Of the sensor.
    error : SensorError
        What its readings share.
    readings : array_like, shape (n,)
        Its record. [unit]

    Returns
    -------
    str or None
        None if the record does not rest at zero, or does not contradict the offset.

    Examples
    --------
    >>> heating = [0.1, 0.1, 900.0, 1100.0]
    >>> beside_zero("power", "W", SensorError(offset=50.0), heating).partition(",")[0]
    'power: the record reads 0.1 W where all is off'
    >>> beside_zero("power", "W", SensorError(gain=0.02), heating) is None
    True
    """
    zero = math.nan if unit in _WITHOUT_ZERO else zero_reading(readings)
    if not math.isfinite(zero) or error.offset <= _MOST_AT_ZERO * zero:
        return None
    return (
        f"{name}: the record reads {zero:.2g} {unit} where all is off, and an offset of {error.offset:.3g} "
        f"{unit} (standard uncertainty) follows from what is stated: write offset: {zero:.2g}, with "
        "repeatability for what scatters and relative for an error in proportion to the reading"
    )


def sizes_of(names: Sequence[str], errors: Sequence[SensorError]) -> dict[str, float]:
    """Return the standard uncertainty of each error of sensors, by its name in a joint distribution.

    Examples
    --------
    >>> sizes_of(["room"], [SensorError(offset=0.15)])
    {'room offset': 0.15}
    """
    sizes = {
        f"{name} {what}": getattr(error, what)
        for name, error in zip(names, errors, strict=True)
        for what in ("offset", "gain", "clock")
        if getattr(error, what)
    }
    common = max((error.common for error in errors), default=0.0)
    return sizes | ({"common offset": common} if common else {})


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

"""Calibration of a building by measurements, in one call."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin._io.arguments import kind_of, mapping_of, require_type
from mascarin._io.durations import seconds_of
from mascarin.building.parameters.ties import expanded
from mascarin.calibration.base.building_problem import fit_parameter, problem_of
from mascarin.calibration.base.cost import CostName
from mascarin.calibration.base.problem import FitParameter
from mascarin.calibration.base.result import Calibration
from mascarin.calibration.base.search_options import MethodName, SearchOptions
from mascarin.calibration.errors.stated_errors import (
    counted_as_scatter,
    depth_paths,
    only_scatter,
    reason_not_to_estimate,
    require_errors,
    require_supported,
    with_sensor_errors,
)
from mascarin.calibration.methods.search import solve
from mascarin.errors import InputError
from mascarin.linear_algebra import one_thread
from mascarin.measurements.observation import observe
from mascarin.measurements.sensor import Sensor
from mascarin.measurements.uncertainty import SensorUncertainty
from mascarin.progress import ProgressOption
from mascarin.simulation.nominal import of_nominal
from mascarin.simulation.preparation.options import Scheme, TimeLike
from mascarin.simulation.simulation import Simulation
from mascarin.weather import Measurements

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.building import Building
    from mascarin.simulation.checks.warning_kinds import RunWarning
    from mascarin.simulation.preparation.initial import Initial
    from mascarin.weather import Climate

#: Keys of a sensor that say how a study compares it.
_OF_STUDIES: Final = frozenset(["sum", "mean", "use", "periods"])

CONSTANT: Final = ("stuck", "forward_filled")
"""Kinds of suspicious values of the quality check in which a sensor repeats one value."""

MAX_CONSTANT_SHARE: Final = 0.5
"""Largest part of a period over which a sensor may repeat one value. [-]"""


@one_thread()
def calibrate(
    building: Building,
    climate: Climate,
    measurements: Measurements,
    *,
    sensors: Mapping[str, str | Sensor],
    vary: Sequence[str | FitParameter] | Mapping[str, tuple[float, float] | FitParameter],
    parameters: Mapping[str, float] | None = None,
    start: TimeLike | None = None,
    end: TimeLike | None = None,
    step: str | float = "15min",
    scheme: Scheme = "sdirk2",
    initial: Initial = "repeat",
    first_period: str | float = "1d",
    warm_up: str | float = "3d",
    method: MethodName = "least-squares",
    cost: CostName = "nll",
    options: SearchOptions | None = None,
    seed: int = 0,
    record: str | Path | None = None,
    progress: ProgressOption = None,
) -> Calibration:
    r"""Estimate parameters of a building from measurements.

    Parameters
    ----------
    building : Building
        The building.
    climate : Climate
        The weather.
    measurements : Measurements
        The measured table; sensors and measured boundaries are columns of it.
    sensors : mapping of str to str or Sensor
        Output of the model -> column of the table, or `Sensor` with its uncertainty. The key of a sensor with
        an ``output`` of its own is its name. A sensor in degC without uncertainty has an expanded uncertainty
        of 0.5 degC; every other unit needs one. Its uncertainty is that of an offset, less the scatter of the
        record, unless the sensor states ``offset`` or ``repeatability``; ``offset=0`` means none. Offsets and
        what ``common``, ``gain``, ``clock`` and ``depth`` state are estimated together with the parameters
        and the errors of the model, as in a study. This needs the cost ``nll``, two days, and a method other
        than ``emcee``; otherwise what is stated is refused, and what is not is said in the warnings.
    vary : sequence of str or FitParameter, or mapping of str to (float, float) or FitParameter
        Parameters to estimate by path, within the ranges of the building, with bounds (low, high), or from
        `fit_parameter` with start, scale and prior. A path with ``*`` stands for all that it matches, which
        vary as one where the building ties them. [unit of each]
    parameters : mapping of str to float, optional
        Values by path that replace those of the building. [unit of each]
    start, end : str, datetime or pandas.Timestamp, optional
        Period that is compared, local time of the climate unless an offset is given; the whole climate after
        the warm-up when absent.
    step : str or float
        Time step, such as ``15min`` or seconds. [s]
    scheme : str
        ``sdirk2``, ``linearly-implicit``, ``backward-euler`` or ``apparent-capacity``, see `Simulation`.
    initial : ``"repeat"``, float, mapping, GivenStart or MeasuredStart
        Initial state, see `Simulation`. [degC]
    first_period : str or float
        Length of the period that is repeated. [s]
    warm_up : str or float
        Length of the run before `start`, which is not compared. [s]
    method, cost, options, seed, record
        See `solve`.
    progress : bool or callable, optional
        Shows progress, see `solve`.

    Returns
    -------
    Calibration
        Estimates with their uncertainty; its ``building`` is the calibrated building.

    Raises
    ------
    InputError
        Anything that cannot be used, before the first run.
    SolverError
        The model cannot be simulated at the start, or no search ended where it can.

    Examples
    --------
    A wall is simulated with a known conductivity; its noisy inside temperature serves as measurement, and the
    conductivity is estimated from it.

    >>> import pandas as pd
    >>> import mascarin as mc
    >>> from mascarin.verification.analytical import setup
    >>> wall = setup.building(
    ...     "materials: {board: {conductivity: 0.2, density: 800, specific_heat: 1000}}\n"
    ...     "constructions: {wall: {layers: [{material: board, thickness: 0.05}]}}\n"
    ...     "surfaces: {w: {construction: wall, area: 1, tilt: 90, outside: {measured: air, convection: 20}, "
    ...     "inside: {adiabatic: true}}}"
    ... )
    >>> hours = np.arange(97)
    >>> climate = setup.climate(3600.0, {"air": 20.0 + 5.0 * np.sin(hours * np.pi / 12.0)})
    >>> path, output = "materials.board.conductivity", "w.inside_temperature"
    >>> run = mc.simulate(wall.replace({path: 0.3}), climate, step="1h", outputs=[output])
    >>> noise = 0.05 * np.random.default_rng(1).normal(size=len(run.records))
    >>> table = pd.DataFrame({"T": run.records[:, 0] + noise}, index=run.index)
    >>> logger = mc.Measurements.from_table(table, timezone="UTC")
    >>> found = calibrate(
    ...     wall,
    ...     climate,
    ...     logger,
    ...     sensors={output: Sensor("T", standard_uncertainty=0.05)},
    ...     vary={path: (0.1, 0.5)},
    ...     step="1h",
    ...     warm_up="1d",
    ... )
    >>> bool(found.low[0] < 0.3 < found.high[0])
    True
    >>> found.building.parameter(path).value == found.values[path]
    True
    """
    from mascarin.simulation.preparation.prepare import in_climate  # needs pydantic

    _require_types(measurements, sensors, vary, record)
    vary = _written_out(building, vary)
    paths = [p if isinstance(p, str) else p.path for p in vary]
    chosen = in_climate(building, climate, parameters=parameters, varied=paths)
    named = {name: s if isinstance(s, Sensor) else Sensor(s) for name, s in sensors.items()}
    free = _parameters(chosen, vary)
    lead, begin = _beginning(climate, start, warm_up)
    simulation = Simulation(
        chosen,
        climate,
        step=step,
        start=begin - lead,
        end=end,
        outputs=[sensor.output or name for name, sensor in named.items()],
        scheme=scheme,
        initial=initial, first_period=first_period, measurements=measurements,
        ranges={parameter.path: (parameter.lower, parameter.upper) for parameter in free},
    )  # fmt: skip
    _require_varying(measurements, named, begin, simulation.end)
    errors, not_estimated = _estimates_errors(simulation, named, method, cost, begin)
    _require_sampled(options, errors, not_estimated)
    observation = observe(simulation, measurements, named, begin)
    all_samples = np.ones(len(observation.times), dtype=np.bool_)
    fit = solve(
        problem_of(simulation, observation, all_samples, free, _uncertainties(simulation, named)),
        method=method,
        cost=cost,
        seed=seed,
        options=options,
        record=None if record is None else Path(record),
        progress=progress,
    )
    if errors:
        fit = with_sensor_errors(fit, simulation, observation, named, options or SearchOptions())
    notes = (*not_estimated, *fit.warnings, *_said_of_the_run(simulation, fit))
    return replace(fit, nominal_building=chosen, times=observation.times, warnings=notes)


def _said_of_the_run(simulation: Simulation, fit: Calibration) -> list[RunWarning]:
    """Warnings of the run at the estimates."""
    estimates = dict(fit.values)
    vectors = simulation.varied(list(estimates), np.array([[*estimates.values()]]))
    said = of_nominal(simulation, vectors[0])
    return [line.after("the run at the estimates") for line in said]


def _beginning(
    climate: Climate, start: TimeLike | None, warm_up: str | float
) -> tuple[pd.Timedelta, pd.Timestamp]:
    """Length of the warm-up, and the first instant that is compared."""
    import pandas as pd

    from mascarin.tables.timezones import moment

    lead = pd.Timedelta(seconds=seconds_of(warm_up, "warm_up"))
    return lead, climate.index[0] + lead if start is None else moment(start, climate.grid.zone, "start")


def _estimates_errors(
    simulation: Simulation, sensors: Mapping[str, Sensor], method: str, cost: str, start: pd.Timestamp
) -> tuple[bool, list[str]]:
    """Whether errors of sensors are estimated, and why not where they should be.

    What a sensor states and cannot be estimated is refused.
    """
    hours = (simulation.end - start).total_seconds() / 3600.0
    if any(sensor.states_errors for sensor in sensors.values()):
        require_supported(method, cost, hours)
        depth_paths(simulation, sensors)
        return True, []
    if all(only_scatter(sensor) for sensor in sensors.values()):
        return False, []
    reason = reason_not_to_estimate(method, cost, hours)
    return reason is None, [] if reason is None else [counted_as_scatter(reason)]


def _require_sampled(options: SearchOptions | None, errors: bool, not_estimated: Sequence[str]) -> None:
    """Refuse to sample a posterior where errors of sensors are not estimated."""
    reason = None if errors else (*not_estimated, "all sensors state that they have none")[0]
    require_errors("linearized" if options is None else options.posterior, reason, "options: posterior")


def _require_types(measurements: object, sensors: object, vary: object, record: object) -> None:
    """Refuse arguments of other types, and sensors and parameters that are not given by name."""
    require_type(
        "measurements",
        measurements,
        Measurements,
        "mascarin.Measurements; Measurements.from_table reads them",
    )
    if record is not None:
        require_type("record", record, (str, Path), "the path of a file")
    columns = mapping_of("sensors", sensors, "columns by output: {'room.air_temperature': 'column'}")
    if not columns:
        raise InputError("sensors: found none, expected at least one: {'room.air_temperature': 'column'}")
    for name, sensor in columns.items():
        require_type(f"sensors: {name}", sensor, (str, Sensor), "the name of a column, or a Sensor")
        of_studies = sorted(_OF_STUDIES & sensor.model_fields_set) if isinstance(sensor, Sensor) else []
        if of_studies:
            raise InputError(
                f"sensors: {name}: found {', '.join(of_studies)}, expected keys that a calibration "
                "alone reads: leave it out, or write a study (mascarin.Study)"
            )
    paths = "a list of paths or a mapping to (low, high)"
    if isinstance(vary, str) or not isinstance(vary, Iterable):
        raise InputError(f"vary: found {kind_of(vary)}, expected {paths}")
    for entry in vary:
        require_type("vary", entry, (str, FitParameter), f"{paths}; an entry is a path or a FitParameter")


def _uncertainties(simulation: Simulation, sensors: Mapping[str, Sensor]) -> dict[str, SensorUncertainty]:
    """Standard uncertainty of each sensor, in the unit of its output."""
    return {
        name: sensor.uncertainty(output.unit, f"sensors: {name}")
        for (name, sensor), output in zip(sensors.items(), simulation.outputs, strict=True)
    }


def _written_out(
    building: Building,
    vary: Sequence[str | FitParameter] | Mapping[str, tuple[float, float] | FitParameter],
) -> Sequence[str | FitParameter] | Mapping[str, tuple[float, float] | FitParameter]:
    """The same with every path with ``*`` replaced by those that it matches, unless they are tied."""
    if isinstance(vary, Mapping):
        return {
            expanded_path: bounds
            for path, bounds in vary.items()
            for expanded_path in expanded(building, [path])
        }
    return [entry for p in vary for entry in (expanded(building, [p]) if isinstance(p, str) else [p])]


def _parameters(
    building: Building,
    vary: Sequence[str | FitParameter] | Mapping[str, tuple[float, float] | FitParameter],
) -> list[FitParameter]:
    """Parameters to estimate, from paths, bounds or `FitParameter`."""
    if not isinstance(vary, Mapping):
        return [p if isinstance(p, FitParameter) else fit_parameter(building, p) for p in vary]
    return [
        bounds if isinstance(bounds, FitParameter) else fit_parameter(building, path, bounds)
        for path, bounds in vary.items()
    ]


def _require_varying(
    measurements: Measurements, sensors: Mapping[str, Sensor], start: pd.Timestamp, end: pd.Timestamp
) -> None:
    """Refuse a sensor that repeats one value over most of the period."""
    constant_parts = [part for part in measurements.quality() if part.kind in CONSTANT]
    for name, sensor in sensors.items():
        for part in constant_parts:
            shared = (min(end, part.end) - max(start, part.start)).total_seconds()
            if part.channel in sensor.columns and shared > MAX_CONSTANT_SHARE * (end - start).total_seconds():
                raise InputError(
                    f"{measurements.file}: sensor '{name}', column {part.channel}: "
                    f"{part.kind.replace('_', '-')} from {part.start:%Y-%m-%d %H:%M} to "
                    f"{part.end:%Y-%m-%d %H:%M} ({part.detail}), over most of the period; expected a "
                    "sensor that measures: leave it out, mask these values, or choose another period"
                )

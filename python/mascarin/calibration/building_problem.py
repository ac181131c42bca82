"""Calibration of a building: its parameters and sensors as a problem on arrays."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal, Protocol

import numpy as np

from mascarin.calibration.cost import CostName
from mascarin.calibration.fit import Fit
from mascarin.calibration.problem import CalibrationProblem, FitParameter, FitSensor
from mascarin.calibration.rules import MethodName, Rules
from mascarin.calibration.search import solve
from mascarin.errors import InputError
from mascarin.simulation.simulation import Simulation
from mascarin.validation.observation import Observation, observe
from mascarin.weather.times import seconds_of

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

    from mascarin.building import Building
    from mascarin.simulation.options import TimeLike
    from mascarin.weather import Climate, Measurements

    Array = npt.NDArray[np.float64]
    Flags = npt.NDArray[np.bool_]

#: A sensor's band is read as 95 % of a normal distribution.
_BAND: Final = 1.96
#: What the quality check calls a sensor that repeats itself, and the part of a period from which it is dead.
DEAD: Final = ("stuck", "forward_filled")
MOST_DEAD: Final = 0.5


@dataclass(frozen=True)
class Sensor:
    """A measured series that one output of the model stands for.

    Attributes
    ----------
    output : str
        Output of the model.
    column : str or sequence of str
        Column of the measured table, or several whose mean is taken.
    uncertainty : float
        Half-width of the 95 % band. [unit of the output]
    relative : float
        Further half-width as a share of the measured value. [-]
    """

    output: str
    column: str | Sequence[str]
    uncertainty: float = 0.5
    relative: float = 0.0

    @property
    def columns(self) -> tuple[str, ...]:
        """The columns it is made of."""
        return (self.column,) if isinstance(self.column, str) else tuple(self.column)


class Certain(Protocol):
    """A sensor as far as its uncertainty goes."""

    @property
    def uncertainty(self) -> float:
        """Half-width of the 95 % band. [unit]"""
        ...

    @property
    def relative(self) -> float:
        """Further half-width as a share of the measured value. [-]"""
        ...


def fit_parameter(
    building: Building,
    path: str,
    bounds: tuple[float | None, float | None] = (None, None),
    prior: float | None = None,
    *,
    start: float | None = None,
    scale: Literal["linear", "log"] = "linear",
) -> FitParameter:
    """A parameter of a building as something to fit.

    Parameters
    ----------
    building : Building
        Gives value, unit, limits and range.
    path : str
        Path of the parameter.
    bounds : pair of float or None
        Lowest and highest value; those of the parameter's range where None. [unit]
    prior : float, optional
        Standard deviation of a normal prior about the building's value. [unit]
    start : float, optional
        Where the search begins; the building's value when absent. [unit]
    scale : str
        ``linear`` or ``log``: how distances are measured in the search.

    Raises
    ------
    InputError
        Unknown or structural path, or bounds outside of what the parameter can be.
    """
    parameter = building.parameter(path)
    if parameter.structural:
        raise InputError(
            f"{path}: is structural ({parameter.reason}) and cannot be fitted; choose another parameter"
        )
    low, high = (
        given if given is not None else own
        for given, own in zip(bounds, (parameter.low, parameter.high), strict=True)
    )
    return FitParameter(
        path=parameter.path,
        lower=low,
        upper=high,
        nominal=parameter.value,
        unit=parameter.unit,
        limits=(parameter.lower, parameter.upper),
        prior=None if prior is None else (parameter.value, prior),
        start=start,
        scale=scale,
    )


def problem_of(
    simulation: Simulation,
    observation: Observation,
    use: Flags,
    parameters: Sequence[FitParameter],
    sensors: Mapping[str, Certain],
    weight: float = 1.0,
) -> CalibrationProblem:
    """A simulation and its measured series as a calibration problem.

    Parameters
    ----------
    simulation : Simulation
        Its outputs are those of the observation's sensors, in their order.
    observation : Observation
        Measured series.
    use : ndarray of bool, shape (n,)
        Instants to compare.
    parameters : sequence of FitParameter
        What is found.
    sensors : mapping of str to Certain
        The sensors that take part, with the half-widths of their 95 % bands.
    weight : float
        How much each sample counts. [-]
    """
    positions = [simulation.position(parameter.path) for parameter in parameters]
    columns = [s for s, name in enumerate(observation.names) if name in sensors]
    rows = np.flatnonzero(use)

    def model(x: Array) -> Array:
        vectors = np.tile(simulation.vector({}), (len(x), 1))
        vectors[:, positions] = x
        records, _, _ = simulation.ensemble(vectors)
        return observation.simulated(simulation.index, records)[:, rows][:, :, columns]

    def slopes(x: Array) -> Array:
        vector = simulation.vector({})
        vector[positions] = x
        _, by_parameter = simulation.jacobian_vector([p.path for p in parameters], vector)
        # Instants and means are linear in the records, and so are their slopes.
        seen = observation.simulated(simulation.index, by_parameter)[:, rows][:, :, columns]
        return np.moveaxis(seen, 0, -1)

    met = tuple(
        FitSensor(
            observation.names[s],
            observation.measured[rows, s],
            uncertainty=sensors[observation.names[s]].uncertainty / _BAND,
            relative=sensors[observation.names[s]].relative / _BAND,
            unit=simulation.outputs[s].unit,
            weight=weight,
        )
        for s in columns
    )
    return CalibrationProblem(
        tuple(parameters),
        met,
        model,
        identity=simulation.identity,
        step=observation.interval,
        slopes=slopes,
    )


def calibrate(
    building: Building,
    climate: Climate,
    measurements: Measurements,
    *,
    parameters: Sequence[str | FitParameter] | Mapping[str, tuple[float, float]],
    sensors: Mapping[str, Sensor] | Mapping[str, str],
    start: TimeLike,
    end: TimeLike,
    step: str | float = "15min",
    lead: str | float = "3d",
    scheme: Literal["sdirk2", "backward-euler", "apparent-capacity"] = "sdirk2",
    method: MethodName = "least-squares",
    cost: CostName = "nll",
    rules: Rules | None = None,
    seed: int = 0,
    record: str | Path | None = None,
    progress: Callable[[int, float], object] | None = None,
) -> Fit:
    """Fit parameters of a building to measurements.

    Parameters
    ----------
    building : Building
        The building.
    climate : Climate
        The weather.
    measurements : Measurements
        The measured table; sensors and measured boundaries are columns of it.
    parameters : sequence of str or FitParameter, or mapping of str to (float, float)
        Paths to fit, with bounds or with the building's own ranges; from `fit_parameter` with start, scale
        and prior. [unit of each]
    sensors : mapping
        Name -> `Sensor`, or output -> column for the usual uncertainty of 0.5 degC.
    start, end : str, datetime or pandas.Timestamp
        Period that is compared.
    step : str or float
        Time step. [s]
    lead : str or float
        Run before `start`. [s]
    scheme, method, cost, rules, seed, record, progress
        As in `Simulation` and `solve`.

    Returns
    -------
    Fit
        Estimates with their uncertainty.

    Raises
    ------
    InputError
        Anything that cannot be used, before anything is run.
    """
    import pandas as pd

    from mascarin.weather.timezones import moment

    named = {
        name: given if isinstance(given, Sensor) else Sensor(name, given) for name, given in sensors.items()
    }
    if isinstance(parameters, Mapping):
        free = [fit_parameter(building, path, span) for path, span in parameters.items()]
    else:
        free = [p if isinstance(p, FitParameter) else fit_parameter(building, p) for p in parameters]
    begin = moment(start, climate.grid.zone, "start")
    _require_alive(measurements, named, begin, moment(end, climate.grid.zone, "end"))
    simulation = Simulation(
        building,
        climate,
        step=step,
        start=begin - pd.Timedelta(seconds=seconds_of(lead, "lead")),
        end=end,
        outputs=[sensor.output for sensor in named.values()],
        scheme=scheme,
        measurements=measurements,
        ranges={parameter.path: (parameter.lower, parameter.upper) for parameter in free},
    )
    observation = observe(simulation, measurements, named, begin)
    use = np.ones(len(observation.times), dtype=np.bool_)
    return solve(
        problem_of(simulation, observation, use, free, named),
        method=method,
        cost=cost,
        seed=seed,
        rules=rules,
        record=None if record is None else Path(record),
        progress=progress,
    )


def _require_alive(
    measurements: Measurements, sensors: Mapping[str, Sensor], start: pd.Timestamp, end: pd.Timestamp
) -> None:
    """Refuse a sensor that repeats itself over most of the period."""
    stretches = [stretch for stretch in measurements.quality() if stretch.kind in DEAD]
    for name, sensor in sensors.items():
        for stretch in stretches:
            shared = (min(end, stretch.end) - max(start, stretch.start)).total_seconds()
            if stretch.channel in sensor.columns and shared > MOST_DEAD * (end - start).total_seconds():
                raise InputError(
                    f"{measurements.file}: sensor '{name}', column {stretch.channel}: "
                    f"{stretch.kind.replace('_', '-')} from {stretch.start:%Y-%m-%d %H:%M} to "
                    f"{stretch.end:%Y-%m-%d %H:%M} ({stretch.detail}), over most of the period; expected a "
                    "sensor that measures: leave it out, mask the stretch, or choose another period"
                )

"""Runs and derivatives that the diagnosis needs, stored one by one, at the instants of the comparison."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.building.outputs.output import Output
from mascarin.errors import InputError, SolverError
from mascarin.progress import reporting
from mascarin.sensitivity.building_analysis import factors_of
from mascarin.study.context.step_cache import kept
from mascarin.study.diagnosis.other_laws import changed
from mascarin.study.steps.parameter_effects import Effects

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.calibration import Calibration
    from mascarin.progress import ProgressOption
    from mascarin.simulation.simulation import Simulation
    from mascarin.study.context.context import StudyContext
    from mascarin.study.context.storage import Workspace

    Array = npt.NDArray[np.float64]

#: Largest number of values of the derivatives that are kept: longer records are averaged.
MOST_VALUES: Final = 4_000_000
#: Standard deviation of the prior of a parameter that is not calibrated. [ranges]
PRIOR: Final = 0.25
#: The same for a calibrated parameter without a prior.
_WIDE: Final = 0.5
#: Neighbours of a zone's air thermometer: what radiation makes it read.
_RADIANT: Final = "mean_radiant_temperature"


class SeriesStore:
    """Arrays in the folder of the study, by what they depend on.

    Parameters
    ----------
    workspace : Workspace
        The folder.
    """

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace

    def array(self, key: object, make: Callable[[], Array]) -> Array:
        """The stored array of a key, or a new one, which is stored."""
        return kept(self._workspace, ("diagnosis", key), make)

    def value(self, key: object, make: Callable[[], Any]) -> Any:
        """The same for plain values, as JSON."""

        def encoded() -> Array:
            text = json.dumps(make())
            return np.frombuffer(text.encode(), dtype=np.uint8).astype(np.float64)

        stored = self.array(("value", key), encoded)
        return json.loads(bytes(stored.astype(np.uint8)).decode())


class DiagnosisModel:
    """The fitted model, its parameters in ranges, and its series at averaged instants of the comparison.

    Parameters
    ----------
    setup : StudyContext
        The study.
    simulation : Simulation
        The fitted model over the whole record.
    fit : Calibration
        Its calibration.
    store : SeriesStore
        Intermediate results.
    progress : bool, callable or None
        Where the progress of many runs is shown.
    """

    def __init__(
        self,
        setup: StudyContext,
        simulation: Simulation,
        fit: Calibration,
        store: SeriesStore,
        progress: ProgressOption = None,
    ) -> None:
        self.setup, self.simulation, self.store = setup, simulation, store
        self._progress = progress
        self._others: dict[tuple[str, str], Simulation | None] = {}
        self.sensors = len(setup.observation.names)
        self.fitted = {parameter.path: parameter for parameter in fit.problem.parameters}
        factors = {factor.path: factor for factor in _factors(simulation.building)}
        self.paths = [*self.fitted, *(path for path in factors if path not in self.fitted)]
        self.range = {path: (factor.low, factor.high) for path, factor in factors.items()}
        self.range |= {path: (p.lower, p.upper) for path, p in self.fitted.items()}
        values = setup.observation.measured.size * (len(self.paths) + self.sensors)
        self.group = max(1, math.ceil(values / MOST_VALUES))
        self.interval = setup.observation.interval * self.group
        self.measured = self.averaged(setup.observation.measured)
        local = setup.observation.times.tz_localize(None)
        since = np.asarray((local - local[0].normalize()).total_seconds() / 3600.0, dtype=np.float64)
        #: Local time of all instants, from the midnight before the first. [h]
        self.hours: Array = self.averaged(since[:, None])[:, 0]

    def averaged(self, series: Array) -> Array:
        """Means over groups of samples, shape (..., n, S) -> (..., n // group, S)."""
        if self.group == 1:
            return series
        count = series.shape[-2] // self.group
        cut = series[..., : count * self.group, :]
        return np.asarray(cut.reshape(*series.shape[:-2], count, self.group, -1).mean(axis=-2))

    def sampled(self, simulation: Simulation, records: Array) -> Array:
        """Outputs of the sensors at the instants that are compared, shape (..., n, S)."""
        return self.averaged(self.setup.observation.simulated(simulation.index, records))

    def series(self, vector: Array, simulation: Simulation | None = None) -> Array:
        """Simulated series, shape (n, S). [unit of each]"""
        run = simulation or self.simulation

        def make() -> Array:
            return np.asarray(self.sampled(run, run.run_vector(vector).records[:, : self.sensors]))

        return self.store.array(("run", run.identity, self.group, vector.tobytes()), make)

    def fine(self, vector: Array) -> Array:
        """Simulated series at every instant of the comparison, shape (n, S). [unit of each]"""
        run = self.simulation

        def make() -> Array:
            records = run.run_vector(vector).records[:, : self.sensors]
            return np.asarray(self.setup.observation.simulated(run.index, records))

        return self.store.array(("fine", run.identity, vector.tobytes()), make)

    def slopes(self, vector: Array, *, all_paths: bool) -> Array:
        """Derivatives by the calibrated parameters, and by the others, in ranges. [unit of each]

        Parameters
        ----------
        vector : ndarray
            Parameter vector. [unit of each]
        all_paths : bool
            Whether the others are asked for.

        Returns
        -------
        ndarray, shape (P, n, S)
            In the order of `paths`: exact ones, then differences of runs (zero where a run failed).
        """
        run, fitted = self.simulation, list(self.fitted)

        def exact() -> Array:
            _, slopes = run.jacobian_vector(fitted, vector)
            width = np.array([self.range[p][1] - self.range[p][0] for p in fitted])
            return np.asarray(self.sampled(run, slopes[..., : self.sensors]) * width[:, None, None])

        key = ("slopes", run.identity, self.group, vector.tobytes(), tuple(fitted))
        fitted_slopes = self.store.array(key, exact) if fitted else np.zeros((0, *self.measured.shape))
        if not all_paths or len(self.paths) == len(fitted):
            return fitted_slopes
        other_slopes = np.zeros((len(self.paths) - len(fitted), *fitted_slopes.shape[1:]))
        row_of = {path: k for k, path in enumerate(self.paths[len(fitted) :])}
        effects = Effects(self.setup, run, self.fine(vector), vector)
        with reporting(self._progress, "effects of all parameters") as report:
            for path, effect in effects.each(report):
                if path in row_of:
                    other_slopes[row_of[path]] = self.averaged(effect)
        return np.concatenate([fitted_slopes, other_slopes])

    def priors(self, paths: Sequence[str], vector: Array) -> tuple[Array, Array, Array]:
        """Centre, precision and limits of the changes of parameters from a vector. [ranges]"""
        center, precision, limits = [], [], []
        for path in paths:
            (low, high), value = self.range[path], self.simulation.value_in(vector, path)
            width = high - low
            parameter = self.fitted.get(path)
            if parameter is None:
                mean, sd = self.simulation.value_in(self.simulation.values, path), PRIOR
            elif parameter.prior is None:
                mean, sd = 0.5 * (low + high), _WIDE
            else:
                mean, sd = parameter.prior[0], parameter.prior[1] / width
            center.append((mean - value) / width)
            precision.append(sd**-2)
            limits.append((min(0.0, (low - value) / width), max(0.0, (high - value) / width)))
        return np.array(center), np.array(precision), np.array(limits).reshape(-1, 2)

    def other(self, building: Building, further: Sequence[str] = ()) -> Simulation | None:
        """Another building over the same record; None where it cannot be compiled."""
        try:
            return self.setup.models.of_building(building, further)
        except InputError:
            return None

    def of_form(self, form: tuple[str, str], changes: dict[str, Any], vector: Array) -> Array:
        """Series with another form of the model, shape (n, S); one NaN where it cannot be built or run."""

        def make() -> Array:
            if form not in self._others:
                other = changed(self.simulation.building, changes)
                self._others[form] = None if other is None else self.other(other)
            run, nothing = self._others[form], np.full(1, np.nan)
            try:
                return nothing if run is None else self.series(self.transferred(vector, run), run)
            except SolverError:
                return nothing

        # Before the model is compiled: a study that goes on does not compile all forms again.
        return self.store.array(("form", self.simulation.identity, self.group, form, vector.tobytes()), make)

    def transferred(self, vector: Array, other: Simulation) -> Array:
        """The parameter vector of another building with the values of the calibrated parameters it has."""
        paths = {parameter.path for parameter in other.building.parameters()}
        values = {path: self.simulation.value_in(vector, path) for path in self.fitted if path in paths}
        return other.vector(values)

    def neighbours(self, vector: Array) -> dict[int, dict[str, Array]]:
        """Series of other places near each sensor: the next interfaces and surfaces, air or radiation.

        By sensor, then by name; shape (n,). [degC]
        """
        names = places_near(self.simulation.building, self.simulation.outputs[: self.sensors])
        recorded = list(dict.fromkeys(name for neighbours in names.values() for name in neighbours))
        if not recorded:
            return {}
        shown = {output.name for output in self.simulation.outputs[: self.sensors]}
        run = self.other(self.simulation.building, [name for name in recorded if name not in shown])
        if run is None:
            return {}
        columns = {output.name: k for k, output in enumerate(run.outputs)}
        positions = [columns[name] for name in recorded]

        def make() -> Array:
            records = run.run_vector(
                run.vector(dict(zip(self.simulation.paths, vector, strict=True)))
            ).records
            observation = self.setup.observation
            sampled = [observation.sampled(run.index, records[:, k]) for k in positions]
            return self.averaged(np.stack(sampled, axis=-1))

        try:
            means = self.store.array(("near", run.identity, self.group, vector.tobytes()), make)
        except (SolverError, InputError):
            return {}
        series = dict(zip(recorded, means.T, strict=True))
        return {s: {name: series[name] for name in neighbours} for s, neighbours in names.items()}


def places_near(building: Building, outputs: Sequence[Output]) -> dict[int, list[str]]:
    """Names of the outputs of places next to those of sensors, by position of the sensor.

    Parameters
    ----------
    building : Building
        The building.
    outputs : sequence of Output
        What the sensors are compared with.
    """
    names = {output.name for output in building.outputs()}
    surfaces, zones = list(building.surfaces), list(building.zones)
    neighbours_of: dict[int, list[str]] = {}
    for s, output in enumerate(outputs):
        neighbours: list[str] = []
        if output.kind == "air_temperature" and output.zone is not None:
            neighbours = [f"{zones[output.zone]}.{_RADIANT}"]
        elif output.unit == "degC" and output.surface is not None and output.surface < len(surfaces):
            name = surfaces[output.surface]
            layers = len(building.constructions[building.surfaces[name].construction].layers)
            interfaces = [
                f"{name}.outside_temperature",
                *(f"{name}.interface_{k}_temperature" for k in range(1, layers)),
                f"{name}.inside_temperature",
            ]
            if output.name in interfaces:
                position = interfaces.index(output.name)
                neighbours = [interfaces[k] for k in (position - 1, position + 1) if 0 <= k < len(interfaces)]
                zone = building.surfaces[name].inside.zone if position == layers else None
                zone = building.surfaces[name].outside.zone if position == 0 else zone
                neighbours += [f"{zone}.air_temperature"] if zone is not None else []
        elif output.kind == "sensor" and output.sensor is not None:
            name = building.sensors[list(building.sensors)[output.sensor]].surface
            neighbours = [f"{name}.outside_temperature", f"{name}.inside_temperature"]
        neighbours_of[s] = [output_name for output_name in neighbours if output_name in names]
    return {s: adjacent for s, adjacent in neighbours_of.items() if adjacent}


def _factors(building: Building) -> list:  # type: ignore[type-arg]
    try:
        return factors_of(building)
    except InputError:
        return []

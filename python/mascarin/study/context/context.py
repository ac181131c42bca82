"""The parts of a study that its steps share: periods, models and measured series."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin import __version__
from mascarin._io.durations import seconds_of
from mascarin.building.parameters.ties import expanded, with_ties
from mascarin.errors import InputError
from mascarin.simulation.preparation.initial import Initial, MeasuredStart
from mascarin.simulation.simulation import Simulation
from mascarin.study.context.calibration import problem
from mascarin.study.context.error_rule import estimates_errors
from mascarin.study.context.forms import Choice, Forms, label
from mascarin.study.context.periods import Timeline
from mascarin.study.context.phase_change import melting_layers
from mascarin.study.file.description import IdentificationPlan, StudyFile
from mascarin.study.file.free_parameters import fit_parameters
from mascarin.study.file.patterns import ties_of
from mascarin.tables.timezones import moment
from mascarin.validation.comparison import Metrics, compare
from mascarin.validation.observation import Observation, observe

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

    from mascarin.building import Building
    from mascarin.building.parameters.parameter import Parameter
    from mascarin.calibration import CalibrationProblem
    from mascarin.simulation.preparation.options import TimeLike
    from mascarin.simulation.results import Results
    from mascarin.study.context.storage import Workspace
    from mascarin.study.file.description import Free, StudyPlan, Variant
    from mascarin.study.file.field_types import Duration
    from mascarin.study.file.locations import Places
    from mascarin.study.file.opening import Inputs
    from mascarin.tables.grid import Grid
    from mascarin.tables.quality import Stretch
    from mascarin.validation.criteria import Criterion
    from mascarin.weather import Climate, Measurements

    Flags = npt.NDArray[np.bool_]

#: Standard deviation of the prior of a parameter of a law that replaces another one. [ranges]
_PRIOR: Final = 0.25

Scores = dict[str, dict[str, Metrics]]
"""Metrics by sensor and period."""


class Setup:
    """Inputs of a study with its periods, its models and its measured series.

    Models are compiled when they are first used, and only once.

    Parameters
    ----------
    inputs : Inputs
        What was read.
    """

    def __init__(self, inputs: Inputs) -> None:
        self.sources: Inputs = inputs
        self.plan: StudyPlan = inputs.plan
        self.building: Building = inputs.building
        self.climate: Climate = inputs.climate
        #: To compare with, masked by the plan; the inputs of the model are `sources.driving`.
        self.measurements: Measurements = inputs.measurements
        self.quality: list[Stretch] = inputs.quality
        self.places: Places = inputs.places
        self.criteria: tuple[Criterion, ...] = inputs.plan.criteria
        #: Where results of steps are kept; None while nothing is written.
        self.workspace: Workspace | None = None

    def __getstate__(self) -> dict[str, Any]:
        """The inputs; models and series are made again where they are needed."""
        return {"sources": self.sources}

    def __setstate__(self, state: dict[str, Any]) -> None:
        Setup.__init__(self, state["sources"])

    @contextmanager
    def keeping(self, workspace: Workspace) -> Iterator[None]:
        """Keep results of steps in a folder while something is computed."""
        self.workspace = workspace
        try:
            yield
        finally:
            self.workspace = None

    @property
    def path(self) -> Path:
        """The study file.

        Raises
        ------
        InputError
            The study was made of objects.
        """
        if self.sources.path is None:
            raise InputError(
                f"study '{self.plan.name}': made of objects, expected one of a file; write it with "
                "to_yaml('study.yaml') and open it with Study.from_yaml('study.yaml')"
            )
        return self.sources.path

    @property
    def file(self) -> StudyFile:
        """Plan of the study.

        Raises
        ------
        InputError
            The study was made of objects.
        """
        _ = self.path
        assert isinstance(self.plan, StudyFile)  # noqa: S101 (what comes from a file is one)
        return self.plan

    def leaves_out(self, stretch: Stretch) -> bool:
        """Whether suspicious values are left out of all comparisons: of sensors, of the masked kinds."""
        sensors = {column for sensor in self.plan.sensors.values() for column in sensor.columns}
        return stretch.kind in self.plan.quality.mask and stretch.channel in sensors

    # --- periods ----------------------------------------------------------------------------------------

    @cached_property
    def timeline(self) -> Timeline:
        """Periods of the study and of its sensors."""
        return Timeline(self.plan, self.climate.grid.zone, self.places)

    @cached_property
    def identification(self) -> tuple[pd.Timestamp, pd.Timestamp]:
        """Start of the first and end of the last identification period."""
        return self.timeline.identification()

    @cached_property
    def start(self) -> pd.Timestamp:
        """Start of the run: that of the warm-up, else of the record."""
        span = self.timeline.warm_up()
        return span.start if span is not None else self.record[0]

    @cached_property
    def compared_from(self) -> pd.Timestamp:
        """First instant that is compared."""
        span = self.timeline.warm_up()
        return span.end if span is not None else self.start

    @cached_property
    def record(self) -> tuple[pd.Timestamp, pd.Timestamp]:
        """Start and end of the time that weather and measurements both cover."""
        import pandas as pd

        first, last = max(grid.start for grid in self._grids), min(grid.end for grid in self._grids)
        zone = self.climate.grid.zone
        return (
            pd.Timestamp(first, unit="s", tz="UTC").tz_convert(zone),
            pd.Timestamp(last, unit="s", tz="UTC").tz_convert(zone),
        )

    @property
    def _grids(self) -> list[Grid]:
        return [self.measurements.grid] + ([] if self.climate.grid.periodic else [self.climate.grid])

    @cached_property
    def moment_of_end(self) -> pd.Timestamp | None:
        """End of the record to use, as the study gives it."""
        given = self.plan.periods.end
        with self.places.blame("periods", "end"):
            return None if given is None else moment(given, self.climate.grid.zone, "end")

    @cached_property
    def end(self) -> pd.Timestamp:
        """End of the run: that of the study, else of the record, a whole number of steps after the start."""
        import pandas as pd

        # Instants at the very end of a table have no value to interpolate to.
        interval = max(grid.interval for grid in self._grids)
        last = self.record[1] - pd.Timedelta(seconds=interval)
        if self.moment_of_end is not None:
            last = min(last, self.moment_of_end)
        return self.start + self._whole_steps((last - self.start).total_seconds())

    def _whole_steps(self, seconds: float, length: Duration | None = None) -> pd.Timedelta:
        """The longest whole number of steps in so much time; steps of the study, or of another length."""
        import pandas as pd

        step = seconds_of(length or self.plan.step)
        return pd.Timedelta(seconds=step * math.floor(seconds / step + 1e-9))

    @cached_property
    def used(self) -> dict[str, Flags]:
        """Values of each period, shape (n, S); those that were not measured or are excluded included."""
        return self.timeline.used(self.observation)

    @cached_property
    def during(self) -> dict[str, Flags]:
        """Instants of each period, those in which some sensor is in it, shape (n,)."""
        return {period: np.asarray(use.any(axis=1)) for period, use in self.used.items()}

    @cached_property
    def rows(self) -> Flags:
        """Instants from the first to the last that are used to identify, shape (n,)."""
        used = [s for s, sensor in enumerate(self.plan.sensors.values()) if sensor.use]
        at = np.flatnonzero(self.used["identification"][:, used].any(axis=1))
        found = np.zeros(len(self.observation.times), dtype=np.bool_)
        if at.size:
            found[at[0] : at[-1] + 1] = True
        return found

    def _simulate(
        self,
        building: Building,
        start: TimeLike,
        end: TimeLike,
        further: Sequence[str] = (),
        step: Duration | None = None,
    ) -> Simulation:
        """A model that records the outputs of the sensors, then further outputs."""
        return Simulation(
            building,
            self.climate,
            step=step or self.plan.step,
            start=start,
            end=end,
            outputs=[*(sensor.output for sensor in self.plan.sensors.values()), *further],
            scheme=self.plan.scheme,
            initial=self.initial,
            measurements=self.sources.driving,
            ranges=self._ranges(building),
        )

    def over_record(self, building: Building, further: Sequence[str] = ()) -> Simulation:
        """A model of any building over the whole record, with the outputs of the sensors and further ones."""
        return self._simulate(building, self.start, self.end, further)

    @cached_property
    def initial(self) -> Initial:
        """Initial state of the runs; sensors with `use: false` are not used for it."""
        if self.plan.initial != "measured":
            return self.plan.initial
        columns: dict[str, list[str]] = {}
        for sensor in self.plan.sensors.values():
            if sensor.use:
                columns.setdefault(self.building.output(sensor.output).name, []).extend(sensor.columns)
        return MeasuredStart(self.measurements, columns)

    def building_of(self, variant: str | None) -> Building:
        """The building of a variant; the study's own for None."""
        if variant is None:
            return self.building
        if variant in self._further:
            combined = self._further[variant]
            with self.places.blame("alternatives"):
                building = self.building.replace(combined.changes)
                return with_ties(building, ties_of(combined.parameters))
        own = self.plan.variants[variant]
        with self.places.blame("variants", variant, "changes"):
            building = self.building.replace(own.changes)
        with self.places.blame("variants", variant, "parameters"):
            return with_ties(building, ties_of(own.parameters))

    @cached_property
    def forms(self) -> Forms:
        """Alternatives of the study."""
        return Forms(self.plan, self.building, self.places)

    @cached_property
    def _further(self) -> dict[str, Variant]:
        """Variants that are combinations of alternatives, by name."""
        return {}

    def variant_of(self, choice: Choice) -> str | None:
        """Name of the variant for a choice of alternatives; None for the building as described."""
        if not choice:
            return None
        name = f"alternative {label(choice)}"
        if name not in self._further:
            self._further[name] = self.forms.variant(choice)
        return name

    @property
    def estimates_errors(self) -> bool:
        """Whether errors of sensors and model are estimated together with the parameters."""
        return self.plan.identification is not None and estimates_errors(self.plan, self.hours)

    @cached_property
    def hours(self) -> float:
        """Length of all identification periods together. [h]"""
        return float(np.count_nonzero(self.during["identification"]) * self.observation.interval / 3600.0)

    def whole(self, variant: str | None = None) -> Simulation:
        """A model over the whole record, with the state of its phase-change layers."""
        building = self.building_of(variant)
        seen = {building.output(sensor.output).name for sensor in self.plan.sensors.values()}
        states = [name for layer in melting_layers(building) for name in layer.outputs if name not in seen]
        return self._once(("whole", variant), lambda: self._simulate(building, self.start, self.end, states))

    def short(self, variant: str | None = None) -> Simulation:
        """A model over the warm-up and the identification period."""
        import pandas as pd

        building, (first, last) = self.building_of(variant), self.identification
        start = first - pd.Timedelta(seconds=self.lead_seconds)
        end = start + self._whole_steps((min(last, self.end) - start).total_seconds())
        return self._once(("short", variant), lambda: self._simulate(building, start, end))

    @property
    def step_of_many(self) -> Duration:
        """Time step of the runs in which all parameters vary."""
        given = None if self.plan.sensitivity is None else self.plan.sensitivity.step
        return given or self.plan.step

    def varied(self) -> tuple[Simulation, float]:
        """A model over warm-up and identification with the step of many runs; length of the warm-up. [s]"""
        step, (first, last) = self.step_of_many, self.identification
        lead = self._whole_steps(self.lead_seconds, step)
        end = first + self._whole_steps((min(last, self.end) - first).total_seconds(), step)
        if step == self.plan.step:
            return self.short(), lead.total_seconds()
        start = first - lead
        made = self._once(("varied", None), lambda: self._simulate(self.building, start, end, step=step))
        return made, lead.total_seconds()

    def coarse(self, simulation: Simulation) -> Simulation:
        """The model of a simulation over the whole record with the step of many runs."""
        step = self.step_of_many
        if step == self.plan.step:
            return simulation
        end = self.start + self._whole_steps((self.end - self.start).total_seconds(), step)
        return self._once(
            ("coarse", simulation.identity),
            lambda: self._simulate(simulation.building, self.start, end, step=step),
        )

    def _once(self, key: tuple[str, str | None], make: Callable[[], Simulation]) -> Simulation:
        if key not in self._simulations:
            self._simulations[key] = make()
        return self._simulations[key]

    @cached_property
    def _simulations(self) -> dict[tuple[str, str | None], Simulation]:
        return {}

    def _ranges(self, building: Building) -> dict[str, tuple[float, float]]:
        """Ranges of the parameters; the mesh is chosen once, for the whole ranges."""
        ranges = {p.path: (p.low, p.high) for p in building.parameters() if not p.structural}
        if self.plan.sensitivity is not None:
            for pattern, span in self.plan.sensitivity.ranges.items():
                for known in (
                    self.building.parameter(one).path for one in expanded(self.building, [pattern])
                ):
                    if known in ranges:
                        low, high = ranges[known]
                        ranges[known] = (min(low, span[0]), max(high, span[1]))
        sought = self.plan.identification
        for free in [] if sought is None else fit_parameters(self.building, sought):
            if free.path in ranges:
                ranges[free.path] = (free.lower, free.upper)
        return ranges

    @cached_property
    def simulation(self) -> Simulation:
        """The nominal model over the whole record."""
        return self.whole()

    def problem(self, variant: str | None = None) -> CalibrationProblem:
        """The calibration problem of the building as described or of a variant."""
        return problem(
            self.short(variant),
            self.observation,
            self.rows,
            self.used["identification"],
            self.plan.sensors,
            self.plan_of(variant),
        )

    @property
    def sought(self) -> IdentificationPlan:
        """The identification of the study.

        Raises
        ------
        InputError
            The study has none.
        """
        if self.plan.identification is None:
            raise InputError(
                f"{self.places.at('identification')}: found nothing, expected parameters to identify: "
                "add identification: {parameters: {...}}, or use 'mascarin validate' for the comparison "
                "alone, or 'mascarin sensitivity' for the sensitivity analysis"
            )
        return self.plan.identification

    @property
    def candidates(self) -> list[str | None]:
        """What may become the fitted model; None is the building as described."""
        return [None, *(name for name, variant in self.plan.variants.items() if variant.candidate)]

    def plan_of(self, variant: str | None) -> IdentificationPlan:
        """What is identified in a variant: the study's parameters that it has, and its own."""
        plan = self.sought
        if variant is None:
            return plan
        known = {parameter.path: parameter for parameter in self.building_of(variant).parameters()}
        own = self._further.get(variant) or self.plan.variants[variant]
        shared = {
            path: _stated_for(known[self.building.parameter(path).path], free, own)
            for path, free in plan.parameters.items()
            if not own.alone and self.building.parameter(path).path in known
        }
        every = {
            one: free
            for path, free in own.parameters.items()
            for one in expanded(self.building_of(variant), [path])
        }
        return plan.model_copy(update={"parameters": shared | every})

    @cached_property
    def observation(self) -> Observation:
        """Measured series on the instants of the comparison; what is excluded counts as not measured."""
        found = observe(self.simulation, self.measurements, self.plan.sensors, self.compared_from)
        excluded = self.timeline.excluded(found)
        if not excluded.any():
            return found
        return replace(found, measured=np.where(excluded, np.nan, found.measured))

    @cached_property
    def lead_seconds(self) -> float:
        """Length of the warm-up before the identification period, limited by the record. [s]"""
        available = (self.identification[0] - self.start).total_seconds()
        plan = self.plan.identification
        wanted = IdentificationPlan.model_fields["lead"].default if plan is None else plan.lead
        lead = min(seconds_of(wanted, "lead"), available)
        return self._whole_steps(lead).total_seconds()

    def scores(self, results: Results) -> Scores:
        """Metrics of a run by sensor and period."""
        simulated = self.observation.simulated(results.index, results.records)
        return {
            name: {
                period: compare(
                    self.observation.measured[:, s],
                    simulated[:, s],
                    use=use[:, s],
                    unit=results.outputs[s].unit,
                )
                for period, use in self.used.items()
            }
            for s, name in enumerate(self.observation.names)
        }

    def inputs(self) -> dict[str, Any]:
        """Version and hashes that identify this study; work on others is not continued."""
        found = self.sources.hashes
        return {
            "mascarin_version": __version__,
            "study": found["study"],
            "building": found["building"],
            "model": self.simulation.identity,
            "measurements": found["measurements"],
            "climate": found["climate"],
        }


def _stated_for(parameter: Parameter, free: Free | None, variant: Variant) -> Free | None:
    """What a study states of a parameter, for a variant that may have replaced the part that it belongs to.

    A number of the same name in another law has its own range; its prior is as wide, relative to the range,
    as priors usually are.
    """
    replaced = any(
        parameter.path.startswith(f"{path}.") and not isinstance(value, int | float)
        for path, value in variant.changes.items()
    )
    if free is None or not replaced:
        return free
    prior = None if free.prior is None else _PRIOR * (parameter.high - parameter.low)
    return free.model_copy(update={"low": None, "high": None, "start": None, "prior": prior})

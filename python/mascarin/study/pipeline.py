"""The five steps of the method: compare, find what matters, identify, compare again, corroborate."""

from __future__ import annotations

import hashlib
import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin import __version__
from mascarin.building import Building, load
from mascarin.calibration import CalibrationProblem, Fit, Profile, profiles
from mascarin.errors import InputError
from mascarin.progress import Progress
from mascarin.simulation.initial import Initial, MeasuredStart
from mascarin.simulation.options import TimeLike
from mascarin.simulation.results import Results
from mascarin.simulation.simulation import Simulation
from mascarin.study.calibration_step import fit_parameters, identify, independent_weight, problem
from mascarin.study.description import IdentificationPlan, SensitivityPlan, StudyFile, Variant, read_study
from mascarin.study.effects import Effects
from mascarin.study.inputs import filled, find, open_climate, open_measurements, require_one_clock
from mascarin.study.locations import Faults, Places
from mascarin.study.phase_change import melting_layers
from mascarin.study.prediction_intervals import Band, answers, band, band_words
from mascarin.study.sensitivity_step import factors, screen
from mascarin.study.storage import Workspace
from mascarin.validation.criteria import Criterion, Verdict, judge
from mascarin.validation.error_sources import Shortfall, shortfall
from mascarin.validation.metrics import Metrics, compare
from mascarin.validation.observation import PERIODS, Observation, observe
from mascarin.validation.residuals import Examination, diagnose, examine
from mascarin.weather import Climate, Measurements
from mascarin.weather.files import file_hash
from mascarin.weather.quality import mask
from mascarin.weather.times import seconds_of
from mascarin.weather.timezones import moment

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

    from mascarin.sensitivity import Sensitivity
    from mascarin.weather.grid import Grid
    from mascarin.weather.quality import Stretch

    Flags = npt.NDArray[np.bool_]

#: Channels that a residual is held against, by words.
DRIVERS: Final = {
    "outdoor air": "air_temperature",
    "sun": "global_horizontal",
    "wind": "wind_speed",
}
#: Fewer samples than this are not examined.
FEWEST_EXAMINED: Final = 24
#: Effects of parameters are kept for so many values at most.
MOST_EFFECTS: Final = 20_000_000
#: Half-width of a normal distribution's 95 % in standard deviations.
NORMAL_95: Final = 1.96

Scores = dict[str, dict[str, Metrics]]
"""Metrics by sensor and period."""


@dataclass(frozen=True, eq=False)
class ModelRun:
    """One model of the study over the whole record.

    Attributes
    ----------
    label : str
        What it is called.
    simulation : Simulation
        What was run.
    results : Results
        Its series and ledger.
    scores : dict
        Metrics by sensor and period.
    fit : Fit or None
        How its parameters were found.
    note : str
        What it is.
    """

    label: str
    simulation: Simulation
    results: Results
    scores: Scores
    fit: Fit | None = None
    note: str = ""


@dataclass(frozen=True, eq=False)
class Findings:
    """Everything a study found.

    Attributes
    ----------
    nominal, fitted : ModelRun
        The model before and after the identification.
    variants : dict of str to ModelRun
        Other model choices.
    sensitivity : Sensitivity or None
        Which parameters matter.
    fit : Fit
        The identification.
    verdicts : dict of str to list of Verdict
        Criteria of the nominal and of the fitted model.
    examinations : dict of str to Examination
        What is left of each sensor on the blind days, after the identification.
    diagnosis : list of str
        The same in words.
    aims : list of Verdict
        What one would have liked to reach, and whether the fitted model does.
    rest : Shortfall or None
        What would take the rest of the error away on the blind days, of the sensors that show enough there;
        None where none does.
    band : Band
        What the fitted model foresees of every sensor, and how often that held.
    profiles : list of Profile
        Of every parameter, where the study asks for them.
    quality : list of Stretch
        Suspicious stretches of the measured columns.
    seconds : float
        Time the study took. [s]
    """

    nominal: ModelRun
    fitted: ModelRun
    variants: dict[str, ModelRun]
    sensitivity: Sensitivity | None
    fit: Fit
    examinations: dict[str, Examination]
    diagnosis: list[str]
    aims: list[Verdict]
    rest: Shortfall | None
    band: Band
    profiles: list[Profile]
    verdicts: dict[str, list[Verdict]]
    quality: list[Stretch]
    seconds: float = field(default=0.0)

    @property
    def passed(self) -> bool:
        """Whether the fitted model keeps every criterion."""
        return all(verdict.passed for verdict in self.verdicts["fitted"])


class Study:
    """A study file with its inputs opened and checked.

    Parameters
    ----------
    path : str or Path
        The study file.

    Raises
    ------
    InputError
        Anything that cannot be used, before anything is run.
    """

    def __init__(self, path: str | Path) -> None:
        from mascarin.study.checking import check, names

        self.path = Path(path)
        self.file: StudyFile = read_study(self.path)
        self.places = Places(self.path)
        beside, blame = self.path.parent, self.places.blame
        with blame("building"):
            described = find(self.file.building, beside)
        self.building_hash = file_hash(described)
        as_described = load(described)
        with blame("set"):
            self.building: Building = as_described.replace(self.file.set)
        faults = Faults()
        names(self, faults)
        with faults.kept():
            require_one_clock(self.file, self.places)
        with faults.kept():
            self.climate: Climate = open_climate(self.file.climate, beside, self.building, self.places)
        with faults.kept():
            read = open_measurements(self.file, beside, self.building, self.places, Places(described))
        faults.tell(self.path)
        self.quality: list[Stretch] = read.quality() + self._weather_quality()
        self.measurements: Measurements = self._masked(self._filled(read))
        self.criteria: tuple[Criterion, ...] = self.file.criteria
        # Everything that can be refused is refused here, before the first run.
        check(self)

    def _weather_quality(self) -> list[Stretch]:
        """Suspicious stretches of weather that was measured, unless it stands in the measurements' table."""
        weather = self.file.climate.measured
        if weather is None or weather.table == self.file.measurements.table:
            return []
        return self.climate.quality()

    def _filled(self, read: Measurements) -> Measurements:
        longest = self.file.measurements.fill_gaps
        return read if longest is None else filled(read, self.building, longest)

    def _masked(self, read: Measurements) -> Measurements:
        kinds = self.file.quality.mask
        if not kinds:
            return read
        sensors = {column for sensor in self.file.sensors.values() for column in sensor.columns}
        chosen = [stretch for stretch in self.quality if stretch.channel in sensors]
        return read.masked(mask(read.data, chosen, list(kinds)))

    # --- periods ----------------------------------------------------------------------------------------

    def _moment(self, text: str, what: str) -> pd.Timestamp:
        with self.places.blame("periods", what):
            return moment(text, self.climate.grid.zone, what)

    def span(self, name: str) -> tuple[pd.Timestamp, pd.Timestamp] | None:
        """Start and end of a period as the study gives it."""
        span = getattr(self.file.periods, name)
        return None if span is None else self._moments(span, name)

    def _moments(self, span: tuple[str, str], name: str) -> tuple[pd.Timestamp, pd.Timestamp]:
        return self._moment(span[0], name), self._moment(span[1], name)

    @cached_property
    def identification(self) -> tuple[pd.Timestamp, pd.Timestamp]:
        """Start and end of the identification period."""
        return self._moments(self.file.periods.identification, "identification")

    @cached_property
    def start(self) -> pd.Timestamp:
        """Start of the run: that of the warm-up, else of the record."""
        span = self.span("warm_up")
        return span[0] if span is not None else self.record[0]

    @cached_property
    def compared_from(self) -> pd.Timestamp:
        """First instant that is compared."""
        span = self.span("warm_up")
        return span[1] if span is not None else self.start

    @cached_property
    def record(self) -> tuple[pd.Timestamp, pd.Timestamp]:
        """What climate and measurements both cover."""
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
        given = self.file.periods.end
        return None if given is None else self._moment(given, "end")

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

    def _whole_steps(self, seconds: float) -> pd.Timedelta:
        """The longest whole number of steps in so much time."""
        import pandas as pd

        step = seconds_of(self.file.step)
        return pd.Timedelta(seconds=step * math.floor(seconds / step + 1e-9))

    @cached_property
    def during(self) -> dict[str, Flags]:
        """Instants of each period, shape (n,).

        `blind` holds every instant that the identification did not see and that is not in the named
        corroboration period; where that leaves nothing, it is the corroboration period itself.
        """
        seen = self.observation.during(*self.identification)
        held = self.span("corroboration")
        named = ~seen & (
            self.observation.during(*held)
            if held is not None
            else np.asarray(self.observation.times >= self.identification[1])
        )
        rest = ~seen & ~named
        return dict(zip(PERIODS, (seen, named, rest if rest.any() else named), strict=True))

    # --- runs -------------------------------------------------------------------------------------------

    def _simulate(
        self, building: Building, start: TimeLike, end: TimeLike, further: Sequence[str] = ()
    ) -> Simulation:
        """A model that records what the sensors see, then further outputs."""
        return Simulation(
            building,
            self.climate,
            step=self.file.step,
            start=start,
            end=end,
            outputs=[*(sensor.output for sensor in self.file.sensors.values()), *further],
            scheme=self.file.scheme,
            initial=self.initial,
            measurements=self.measurements,
            ranges=self._ranges(building),
        )

    @cached_property
    def initial(self) -> Initial:
        """What runs start from; sensors that are only shown say nothing of it."""
        if self.file.initial != "measured":
            return self.file.initial
        columns: dict[str, list[str]] = {}
        for sensor in self.file.sensors.values():
            if sensor.use:
                columns.setdefault(self.building.output(sensor.output).name, []).extend(sensor.columns)
        return MeasuredStart(self.measurements, columns)

    def building_of(self, variant: str | None) -> Building:
        """The building of a variant; the study's own for None."""
        if variant is None:
            return self.building
        with self.places.blame("variants", variant, "changes"):
            return self.building.replace(self.file.variants[variant].changes)

    def whole(self, variant: str | None = None) -> Simulation:
        """A model over the whole record, with the state of its phase-change layers."""
        building = self.building_of(variant)
        seen = {building.output(sensor.output).name for sensor in self.file.sensors.values()}
        states = [name for layer in melting_layers(building) for name in layer.outputs if name not in seen]
        return self._once(("whole", variant), lambda: self._simulate(building, self.start, self.end, states))

    def short(self, variant: str | None = None) -> Simulation:
        """A model over the lead and the identification period."""
        import pandas as pd

        building, (first, last) = self.building_of(variant), self.identification
        start = first - pd.Timedelta(seconds=self.lead_seconds)
        end = start + self._whole_steps((min(last, self.end) - start).total_seconds())
        return self._once(("short", variant), lambda: self._simulate(building, start, end))

    def _once(self, key: tuple[str, str | None], make: Callable[[], Simulation]) -> Simulation:
        if key not in self._simulations:
            self._simulations[key] = make()
        return self._simulations[key]

    @cached_property
    def _simulations(self) -> dict[tuple[str, str | None], Simulation]:
        return {}

    def _ranges(self, building: Building) -> dict[str, tuple[float, float]]:
        """Ranges that parameters move in: the mesh is chosen once, for their worst end."""
        ranges = {p.path: (p.low, p.high) for p in building.parameters() if not p.structural}
        if self.file.sensitivity is not None:
            for path, span in self.file.sensitivity.ranges.items():
                known = self.building.parameter(path).path
                if known in ranges:
                    low, high = ranges[known]
                    ranges[known] = (min(low, span[0]), max(high, span[1]))
        sought = self.file.identification
        for free in [] if sought is None else fit_parameters(self.building, sought):
            if free.path in ranges:
                ranges[free.path] = (free.lower, free.upper)
        return ranges

    @cached_property
    def simulation(self) -> Simulation:
        """The nominal model over the whole record."""
        return self.whole()

    def problem(self, variant: str | None = None) -> CalibrationProblem:
        """What is to be identified, and on what."""
        return problem(
            self.short(variant),
            self.observation,
            self.during["identification"],
            self.file.sensors,
            self.plan_of(variant),
        )

    @property
    def sought(self) -> IdentificationPlan:
        """What is to be identified.

        Raises
        ------
        InputError
            The study says nothing of it.
        """
        if self.file.identification is None:
            raise InputError(
                f"{self.places.at('identification')}: found nothing, expected which parameters to identify: "
                "add identification: {parameters: {...}}, or ask for the comparison alone with "
                "'mascarin validate', or for what matters with 'mascarin sensitivity'"
            )
        return self.file.identification

    def plan_of(self, variant: str | None) -> IdentificationPlan:
        """What is identified in a variant: the study's parameters that it has, and its own."""
        plan = self.sought
        if variant is None:
            return plan
        known = {parameter.path for parameter in self.building_of(variant).parameters()}
        own = self.file.variants[variant]
        shared = {
            path: free
            for path, free in plan.parameters.items()
            if not own.alone and self.building.parameter(path).path in known
        }
        return plan.model_copy(update={"parameters": shared | own.parameters})

    @cached_property
    def observation(self) -> Observation:
        """Measured series on the instants of the comparison."""
        return observe(self.simulation, self.measurements, self.file.sensors, self.compared_from)

    @cached_property
    def lead_seconds(self) -> float:
        """Length of the run before the identification period, as long as the record allows. [s]"""
        available = (self.identification[0] - self.start).total_seconds()
        plan = self.file.identification
        wanted = IdentificationPlan.model_fields["lead"].default if plan is None else plan.lead
        lead = min(seconds_of(wanted, "lead"), available)
        return self._whole_steps(lead).total_seconds()

    def scores(self, results: Results) -> Scores:
        """Metrics of a run by sensor and period."""
        simulated = self.observation.simulated(results.index, results.records)
        return {
            name: {
                period: compare(
                    self.observation.measured[:, s], simulated[:, s], use=use, unit=results.outputs[s].unit
                )
                for period, use in self.during.items()
            }
            for s, name in enumerate(self.observation.names)
        }

    def inputs(self) -> dict[str, Any]:
        """What makes this study: version, hashes and seeds."""
        return {
            "mascarin_version": __version__,
            "study": file_hash(self.path),
            "building": self.building_hash,
            "model": self.simulation.identity,
            "measurements": self.measurements.sha256,
            "climate": self.climate.sha256,
        }

    def run(self, out: str | Path, *, quiet: bool = False) -> Findings:
        """Go through the five steps.

        Parameters
        ----------
        out : str or Path
            Folder for the results and for unfinished work: a study that was killed goes on from there.
        quiet : bool
            No progress on stderr.

        Returns
        -------
        Findings
            Also written to the folder: study.json, tables, figures and the report.
        """
        from mascarin.study.outputs import write_all

        _ = self.sought
        with Workspace(Path(out), self.inputs()) as workspace:
            findings = self._found(workspace, Teller(quiet))
            write_all(self, findings, workspace)
            workspace.drop("sensitivity")
        return findings

    def _found(self, workspace: Workspace, tell: Teller) -> Findings:
        """The five steps."""
        began = time.monotonic()
        nominal = self.nominal()
        plan = self.file.sensitivity
        sensitivity = None if plan is None else self.screened(plan, workspace, tell)
        fitted, fit = self.fitted(workspace, tell)
        variants = self._varied(workspace, tell)
        verdicts = self.judged(nominal, fitted)
        examinations = self._examined(fitted)
        rest = self._rest(fitted, fit, tell)
        foreseen = band(self, fitted, fit, answers(self, fitted, fit))
        return Findings(
            nominal,
            fitted,
            variants,
            sensitivity,
            fit,
            examinations,
            [*self._too_few(), *band_words(self, foreseen), *diagnose(examinations.values())],
            judge(self.file.aims, fitted.scores, where=f"{self.path}: aims"),
            rest,
            foreseen,
            self.profiled(fit, tell),
            verdicts,
            self.quality,
            time.monotonic() - began,
        )

    def _compared(
        self, label: str, simulation: Simulation, values: Any, fit: Fit | None, note: str
    ) -> ModelRun:
        results = simulation.run_vector(values)
        return ModelRun(label, simulation, results, self.scores(results), fit, note)

    def nominal(self) -> ModelRun:
        """The model as described, over the whole record."""
        return self._compared("nominal", self.simulation, self.simulation.values, None, "as described")

    def judged(self, *runs: ModelRun) -> dict[str, list[Verdict]]:
        """The criteria, model by model."""
        where = f"{self.path}: criteria"
        return {run.label: judge(self.criteria, run.scores, where=where) for run in runs}

    def screened(self, plan: SensitivityPlan, workspace: Workspace, tell: Teller) -> Sensitivity:
        """Which parameters matter on the days of the identification.

        Parameters
        ----------
        plan : SensitivityPlan
            What varies, and how often.
        workspace : Workspace
            Keeps the runs.
        tell : Teller
            Shows progress.
        """
        with tell.about("sensitivity") as progress:
            return screen(
                self.short(),
                plan,
                factors(self.building, plan),
                self.lead_seconds,
                self.observation.names,
                workspace,
                progress,
            )

    def fitted(self, workspace: Workspace, tell: Teller) -> tuple[ModelRun, Fit]:
        """The model after the identification, and how its parameters were found.

        Where the study names candidates, the identification period chooses between them as well.
        """
        runs = {name: self.candidate(name, workspace, tell) for name in self.candidates}
        chosen = min(runs, key=lambda name: runs[name][1].cost)
        run, fit = runs[chosen]
        note = "after the identification, frozen on all other days"
        if len(runs) > 1:
            what = "the building as described" if chosen is None else f"'{chosen}'"
            note += f"; of {len(runs)} candidates {what} has the lowest cost on the identification period"
        return replace(run, label="fitted", note=note), fit

    def profiled(self, fit: Fit, tell: Teller) -> list[Profile]:
        """Profile likelihoods, where the study asks for them."""
        if not self.sought.profiles:
            return []
        with tell.about("profiles") as progress:
            found = profiles(fit)
            progress.update(len(found), len(found))
        return found

    @property
    def candidates(self) -> list[str | None]:
        """What may become the fitted model; None is the building as described."""
        return [None, *(name for name, variant in self.file.variants.items() if variant.candidate)]

    def candidate(self, name: str | None, workspace: Workspace, tell: Teller) -> tuple[ModelRun, Fit]:
        """A variant, or the building as described for None, identified once."""
        if name not in self._identifications:
            note = "the building as described" if name is None else self._note(name)
            label = "as described" if name is None else name
            self._identifications[name] = self._identified(label, name, workspace, tell, note)
        return self._identifications[name]

    @cached_property
    def _identifications(self) -> dict[str | None, tuple[ModelRun, Fit]]:
        return {}

    def _varied(self, workspace: Workspace, tell: Teller) -> dict[str, ModelRun]:
        """Other model choices; among them the building as described, where a candidate was better."""
        found = {}
        if len(self.candidates) > 1:
            base, fit = self.candidate(None, workspace, tell)
            if any(self.candidate(n, workspace, tell)[1].cost < fit.cost for n in self.candidates[1:]):
                found[base.label] = base
        for name, variant in self.file.variants.items():
            found[name] = self._variant(name, variant, workspace, tell)
        return found

    def _note(self, name: str) -> str:
        variant = self.file.variants[name]
        return variant.note or ", ".join(f"{path}: {value}" for path, value in variant.changes.items())

    def _identified(
        self, label: str, variant: str | None, workspace: Workspace, tell: Teller, note: str
    ) -> tuple[ModelRun, Fit]:
        with tell.about(f"identification ({label})") as progress:
            fit = identify(
                self.short(variant),
                self.problem(variant),
                self.sought,
                record=workspace.path(f"evaluations-{_safe(label)}.jsonl"),
                progress=_searching(progress),
            )
        whole = self.whole(variant)
        return self._compared(label, whole, whole.vector(fit.values), fit, note), fit

    def _variant(self, name: str, variant: Variant, workspace: Workspace, tell: Teller) -> ModelRun:
        if variant.identify:
            return self.candidate(name, workspace, tell)[0]
        simulation = self.whole(name)
        return self._compared(name, simulation, simulation.values, None, self._note(name))

    def drivers(self) -> dict[str, npt.NDArray[np.float64]]:
        """What acts on the building, at the instants of the comparison, by words for the report."""
        run = self.simulation
        return {
            word: self.observation.sampled(run.index, run.weather(channel))
            for word, channel in DRIVERS.items()
            if np.ptp(run.weather(channel)) > 0.0
        }

    @cached_property
    def _blind_values(self) -> dict[str, int]:
        """How many values each sensor has on the blind days."""
        count = np.isfinite(self.observation.measured[self.during["blind"]]).sum(axis=0)
        return dict(zip(self.observation.names, count.tolist(), strict=True))

    @property
    def _telling(self) -> dict[str, int]:
        """Sensors with values enough on the blind days to say what is left of them, and their columns."""
        enough = (count >= FEWEST_EXAMINED for count in self._blind_values.values())
        return {name: s for s, (name, use) in enumerate(zip(self._blind_values, enough, strict=True)) if use}

    def _too_few(self) -> list[str]:
        """Sensors of which nothing can be said, in words."""
        return [
            f"{name}: {count} values on the blind days are too few to say what is left or what would take it "
            f"away; {FEWEST_EXAMINED} at least are needed."
            for name, count in self._blind_values.items()
            if count < FEWEST_EXAMINED
        ]

    def _examined(self, run: ModelRun) -> dict[str, Examination]:
        """What is left of each sensor on the blind days."""
        observation, local = self.observation, self.observation.times.tz_localize(None)
        simulated = observation.simulated(run.results.index, run.results.records)
        hour = np.asarray(local.hour + local.minute / 60.0, dtype=np.float64)
        return {
            name: examine(
                observation.measured[:, s],
                simulated[:, s],
                step=observation.interval,
                hour=hour,
                drivers=self.drivers(),
                use=self.during["blind"],
                sensor=name,
                unit=run.results.outputs[s].unit,
            )
            for name, s in self._telling.items()
        }

    def _rest(self, run: ModelRun, fit: Fit, tell: Teller) -> Shortfall | None:
        """What would take the rest of the error away on the blind days."""
        observation, blind = self.observation, self.during["blind"].copy()
        if not self._telling:
            return None
        error = observation.simulated(run.results.index, run.results.records) - observation.measured
        effects = Effects(run.simulation, run.results, run.simulation.vector(fit.values))
        # Of a long record every other instant, or every third, says the same.
        values = int(blind.sum()) * len(observation.names) * effects.count
        blind &= np.arange(blind.size) % max(1, math.ceil(values / MOST_EFFECTS)) == 0
        with tell.about("what is left") as progress:
            found = effects.found(observation, blind, progress.update)
        local = observation.times.tz_localize(None)
        columns = list(self._telling.values())
        return shortfall(
            {name: error[blind, s] for name, s in self._telling.items()},
            {path: effect[:, columns] for path, effect in found.items()},
            uncertainty=[self.file.sensors[name].uncertainty / NORMAL_95 for name in self._telling],
            room=effects.room,
            days=np.asarray((local[blind] - local[0]).days),
            weight=independent_weight(self.sought, observation.interval),
        )


class Teller:
    """Makes progress lines, or silent ones.

    Parameters
    ----------
    quiet : bool
        Whether they are silent.
    """

    def __init__(self, quiet: bool) -> None:
        self._quiet = quiet

    def about(self, label: str) -> Progress:
        """The line of one piece of work."""
        import io

        return Progress(label, stream=io.StringIO() if self._quiet else None)


def _searching(progress: Progress) -> Callable[[int, float], object]:
    """Evaluations of a search as progress: how many there will be is not known before."""

    def report(done: int, lowest: float) -> None:
        progress.update(done, 0, f"{done} evaluations, lowest cost {lowest:.6g}")

    return report


def _safe(name: str) -> str:
    """A short file name that no two labels share."""
    return hashlib.sha256(name.encode()).hexdigest()[:12]


def scores_of(runs: Mapping[str, ModelRun]) -> dict[str, dict[str, dict[str, Metrics]]]:
    """Metrics as sensor -> period -> model."""
    found: dict[str, dict[str, dict[str, Metrics]]] = {}
    for label, run in runs.items():
        for sensor, periods in run.scores.items():
            for period, metrics in periods.items():
                found.setdefault(sensor, {}).setdefault(period, {})[label] = metrics
    return found

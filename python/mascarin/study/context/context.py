"""What the steps of a study share: its inputs, periods, models and measured series."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from mascarin import __version__
from mascarin.calibration.base.joined_problem import joined
from mascarin.measurements.observation import Observation, observe
from mascarin.study.context.calibration import problem
from mascarin.study.context.error_rule import estimates_errors
from mascarin.study.context.models import StudyModels
from mascarin.study.context.periods import StudyPeriods
from mascarin.study.context.variants import Variants
from mascarin.validation.comparison import Metrics, compare

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.calibration import CalibrationProblem
    from mascarin.simulation.results import Results
    from mascarin.study.context.storage import Workspace
    from mascarin.study.file.description import StudyPlan
    from mascarin.study.file.locations import Places
    from mascarin.study.file.study_inputs import StudyInputs
    from mascarin.tables.quality import Stretch
    from mascarin.weather import Climate, Measurements

    Flags = npt.NDArray[np.bool_]

Scores = dict[str, dict[str, Metrics]]
"""Metrics by sensor and period."""


class StudyContext:
    """What is given to the steps of a study.

    Parameters
    ----------
    inputs : StudyInputs
        What was read.

    Attributes
    ----------
    inputs : StudyInputs
        What was read; its parts are attributes of the context, too.
    periods : StudyPeriods
        When the study runs and what it compares.
    variants : Variants
        The building as described and in its variants.
    models : StudyModels
        Simulations of them.
    workspace : Workspace or None
        Where results of steps are kept; None while nothing is written.
    """

    def __init__(self, inputs: StudyInputs) -> None:
        self.inputs: StudyInputs = inputs
        self.plan: StudyPlan = inputs.plan
        self.building: Building = inputs.building
        self.climate: Climate = inputs.climate
        #: To compare with, masked by the plan; the inputs of the model are `inputs.driving`.
        self.measurements: Measurements = inputs.measurements
        self.quality: list[Stretch] = inputs.quality
        self.places: Places = inputs.places
        self.periods: StudyPeriods = StudyPeriods(inputs)
        self.variants: Variants = Variants(inputs)
        self.models: StudyModels = StudyModels(inputs, self.periods, self.variants)
        self.workspace: Workspace | None = None
        #: Other experiments that are identified together with this one.
        self.together: dict[str, StudyContext] = {
            name: StudyContext(other) for name, other in inputs.together.items()
        }
        #: The study that this one is identified together with, if it is not the first of them.
        self.first: StudyContext | None = None
        for other in self.together.values():
            other.first = self

    @property
    def experiments(self) -> dict[str, StudyContext]:
        """All experiments that are identified together, this one first."""
        return {self.inputs.experiment: self, **self.together}

    def __getstate__(self) -> dict[str, Any]:
        """The inputs; models and series are made again where they are needed."""
        return {"inputs": self.inputs}

    def __setstate__(self, state: dict[str, Any]) -> None:
        StudyContext.__init__(self, state["inputs"])

    @contextmanager
    def keeping(self, workspace: Workspace) -> Iterator[None]:
        """Keep results of steps in a folder while something is computed."""
        contexts = self.experiments.values()
        for context in contexts:
            context.workspace = workspace
        try:
            yield
        finally:
            for context in contexts:
                context.workspace = None

    @cached_property
    def observation(self) -> Observation:
        """Measured series on the instants of the comparison; what is excluded counts as not measured."""
        series = observe(
            self.models.nominal, self.measurements, self.plan.sensors, self.periods.compared_from
        )
        excluded = self.periods.timeline.excluded(series)
        if not excluded.any():
            return series
        return replace(series, measured=np.where(excluded, np.nan, series.measured))

    @cached_property
    def used(self) -> dict[str, Flags]:
        """Values of each period, shape (n, S); those that were not measured or are excluded included."""
        return self.periods.timeline.used(self.observation)

    @cached_property
    def during(self) -> dict[str, Flags]:
        """Instants of each period, those in which some sensor is in it, shape (n,)."""
        return {period: np.asarray(use.any(axis=1)) for period, use in self.used.items()}

    @cached_property
    def rows(self) -> Flags:
        """Instants from the first to the last that are used to identify, shape (n,)."""
        used = [s for s, sensor in enumerate(self.plan.sensors.values()) if sensor.use]
        instants = np.flatnonzero(self.used["identification"][:, used].any(axis=1))
        rows = np.zeros(len(self.observation.times), dtype=np.bool_)
        if instants.size:
            rows[instants[0] : instants[-1] + 1] = True
        return rows

    @cached_property
    def hours(self) -> float:
        """Length of all identification periods together. [h]"""
        return float(np.count_nonzero(self.during["identification"]) * self.observation.interval / 3600.0)

    @property
    def estimates_errors(self) -> bool:
        """Whether errors of sensors and model are estimated together with the parameters."""
        if self.first is not None:
            return self.first.estimates_errors
        hours = sum(context.hours for context in self.experiments.values())
        return any(
            context.plan.identification is not None and estimates_errors(context.plan, hours)
            for context in self.experiments.values()
        )

    def problem(self, variant: str | None = None) -> CalibrationProblem:
        """The calibration problem of the building as described or of a variant, of all experiments."""
        if not self.together:
            return self._own_problem(variant)
        own_paths = {path for context in self.experiments.values() for path in context.inputs.own_paths}
        problems = {name: context._own_problem(variant) for name, context in self.experiments.items()}
        return joined(problems, own_paths=own_paths)

    def _own_problem(self, variant: str | None) -> CalibrationProblem:
        """The calibration problem of this experiment alone."""
        return problem(
            self.models.for_calibration(variant),
            self.observation,
            self.rows,
            self.used["identification"],
            self.plan.sensors,
            self.variants.plan_of(variant),
        )

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

    def identity(self) -> dict[str, Any]:
        """Version and hashes that identify this study; work on others is not continued."""
        hashes = self.inputs.hashes
        return {
            "mascarin_version": __version__,
            "study": hashes["study"],
            "building": hashes["building"],
            "model": self.models.nominal.identity,
            "measurements": hashes["measurements"],
            "climate": hashes["climate"],
        }

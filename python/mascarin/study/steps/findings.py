"""The results of the steps of a study, as data."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.calibration.errors.pseudo_bma_weights import pseudo_bma_weights, used_form, within_reach
from mascarin.study.context.forms import Choice, label
from mascarin.study_document.comparison import MetricValues

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.calibration import Calibration, Profile
    from mascarin.calibration.errors.joint_posterior import JointPosterior
    from mascarin.calibration.errors.posterior_checks import Contradiction
    from mascarin.diagnosis.error_sources import ErrorSources
    from mascarin.diagnosis.hypotheses import Diagnosis
    from mascarin.sensitivity import Sensitivity
    from mascarin.simulation.results import Results
    from mascarin.simulation.simulation import Simulation
    from mascarin.study.context.context import Scores, StudyContext
    from mascarin.study.steps.derived_quantities import DerivedQuantity
    from mascarin.study.steps.error_model import Unknowns
    from mascarin.study_document.comparison import TransferEntry
    from mascarin.tables.quality import Stretch
    from mascarin.validation.comparison import Metrics
    from mascarin.validation.criteria import Verdict
    from mascarin.validation.days import DayChoice
    from mascarin.validation.residuals import ResidualAnalysis

    Array = npt.NDArray[np.float64]

#: Forms with less weight are left out of the combination. [-]
LEAST_WEIGHT: Final = 0.01


@dataclass(frozen=True, eq=False)
class ModelRun:
    """One model of the study over the whole record.

    Attributes
    ----------
    label : str
        Its name.
    simulation : Simulation
        What was run.
    results : Results
        Its series and energy balance.
    scores : dict
        Metrics by sensor and period.
    fit : Calibration or None
        Its calibration, if it was calibrated.
    note : str
        What it is.
    """

    label: str
    simulation: Simulation
    results: Results
    scores: Scores
    fit: Calibration | None = None
    note: str = ""


@dataclass(frozen=True, eq=False)
class FormFit:
    """One form of the model with its calibration.

    Attributes
    ----------
    choice : tuple
        Parts and forms that differ from the building as described.
    run : ModelRun
        The calibrated model.
    fit : Calibration
        The calibration, with the errors.
    joint : JointPosterior
        Parameters and errors together.
    unknown : Unknowns
        Numbers that are not estimated.
    together : mapping of str to FormFit
        Other experiments that were identified together with this one.
    """

    choice: Choice
    run: ModelRun
    fit: Calibration
    joint: JointPosterior
    unknown: Unknowns
    together: Mapping[str, FormFit] = field(default_factory=dict)

    @property
    def label(self) -> str:
        """Name in tables."""
        return label(self.choice)

    @property
    def complexity(self) -> tuple[int, int]:
        """Free numbers, and parts that differ from the building as described. [-]"""
        return len(self.fit.problem.parameters), len(self.choice)


@dataclass(frozen=True, eq=False)
class Combination:
    """Calibrated forms of the model and their weights.

    Attributes
    ----------
    forms : tuple of FormFit
        The one that is used first, then those with the largest weights.
    weights : ndarray
        Of each; their sum is 1. [-]
    """

    forms: tuple[FormFit, ...]
    weights: Array

    def of_experiment(self, name: str) -> Combination:
        """The same for another experiment that was identified together with this one."""
        return Combination(tuple(form.together[name] for form in self.forms), self.weights)

    @staticmethod
    def of(forms: list[FormFit]) -> Combination:
        """Weigh forms by the days left out of their calibration; the one to use comes first."""
        by_day = np.array([form.joint.by_day for form in forms])
        weights = pseudo_bma_weights(by_day)
        used = used_form(by_day, weights, [form.complexity for form in forms])
        order = [used, *(int(k) for k in np.argsort(-weights, kind="stable") if k != used)]
        return Combination(tuple(forms[k] for k in order), weights[order])

    @property
    def by_day(self) -> Array:
        """Log density of each day left out, by form, shape (K, D). [-]"""
        return np.array([form.joint.by_day for form in self.forms])

    @property
    def alike(self) -> list[tuple[FormFit, float]]:
        """Other forms that the identification does not tell from the one that is used, and their weights."""
        near = within_reach(self.by_day, self.weights, 0)
        pairs = zip(self.forms, self.weights.tolist(), near.tolist(), strict=True)
        return [(form, weight) for k, (form, weight, same) in enumerate(pairs) if same and k]

    @property
    def kept(self) -> list[tuple[FormFit, float]]:
        """Forms with a noticeable weight, and their weights, whose sum is 1."""
        pairs = list(zip(self.forms, self.weights.tolist(), strict=True))
        found = [pairs[0], *(pair for pair in pairs[1:] if pair[1] >= LEAST_WEIGHT)]
        total = sum(weight for _, weight in found)
        return [(form, weight / total) for form, weight in found]


@dataclass(frozen=True, eq=False)
class PredictionIntervals:
    """95 % prediction intervals of the calibrated model.

    Attributes
    ----------
    confidence : float
        Nominal coverage. [-]
    half_width : ndarray, shape (n, S)
        Half-width at each instant. [unit of each sensor]
    parameters, error : ndarray, shape (n, S) and (S,)
        The two standard deviations of which it consists: that of the estimates, propagated to each instant,
        and that of the model error in the identification period. [unit of each sensor]
    coverage : dict of str to ndarray, shape (S,)
        Part of the measured values inside the interval, by period; NaN where nothing was measured. [-]
    center : ndarray, shape (n, S)
        Middle of the interval minus the fitted series: estimated errors of sensor and model, and the distance
        of other forms of the model; 0 where none are estimated. [unit of each sensor]
    factor : float
        By which they were made wider for what contradicts the model; infinite where they are not stated. [-]
    elsewhere : bool
        Whether bands of other houses, seasons and phases follow from them: not where the calibrated model is
        farther from its own data than the description.
    """

    confidence: float
    half_width: Array
    parameters: Array
    error: Array
    coverage: dict[str, Array]
    center: Array
    factor: float = 1.0
    elsewhere: bool = True

    @property
    def stated(self) -> bool:
        """Whether the intervals are to be used."""
        return bool(np.isfinite(self.factor))


@dataclass(frozen=True, eq=False)
class Findings:
    """The results of all steps of a study.

    Attributes
    ----------
    context : StudyContext
        The study.
    nominal, fitted : ModelRun
        The model before and after the calibration.
    variants : dict of str to ModelRun
        Other choices of model.
    sensitivity : Sensitivity or None
        The sensitivity analysis, if the study has one.
    calibration : Calibration
        The calibration.
    criteria : dict of str to list of Verdict
        Criteria of the nominal and of the fitted model.
    aims : list of Verdict
        Desired limits, and whether the fitted model meets them.
    residuals : dict of str to ResidualAnalysis
        Analysis of the residuals of each sensor on the blind days.
    error_sources : ErrorSources or None
        Parameters that would explain the remaining error on the blind days; None where too few values exist.
    diagnosis : Diagnosis
        Causes of the difference between the fitted model and the measurements: data, parameters, forms.
    days : DayChoice
        How far each day is outside of what the identification has excited, and which to use next.
    prediction_intervals : PredictionIntervals
        Prediction intervals of the fitted model, with their coverage.
    profiles : list of Profile
        Profile likelihood of every parameter, if the study asks for it.
    notes : list of str
        Diagnosis of the residuals in words.
    quality : list of Stretch
        Suspicious values of the measured columns.
    seconds : float
        Run time. [s]
    combination : Combination or None
        Forms of the model with their weights, where errors of sensors and model are estimated.
    contradictions : list of Contradiction
        By what the calibrated model contradicts its own data or what is known; read them first.
    derived : list of DerivedQuantity
        Heat loss, capacity, time constant and U values of the calibrated building, with intervals.
    transfer : dict of str to TransferEntry
        Other houses, seasons and phases with the estimates.
    """

    context: StudyContext
    nominal: ModelRun
    fitted: ModelRun
    variants: dict[str, ModelRun]
    sensitivity: Sensitivity | None
    calibration: Calibration
    criteria: dict[str, list[Verdict]]
    aims: list[Verdict]
    residuals: dict[str, ResidualAnalysis]
    error_sources: ErrorSources | None
    diagnosis: Diagnosis
    days: DayChoice
    prediction_intervals: PredictionIntervals
    profiles: list[Profile]
    notes: list[str]
    quality: list[Stretch]
    seconds: float = field(default=0.0)
    combination: Combination | None = None
    contradictions: list[Contradiction] = field(default_factory=list)
    derived: list[DerivedQuantity] = field(default_factory=list)
    transfer: dict[str, TransferEntry] = field(default_factory=dict)

    @property
    def passed(self) -> bool:
        """Whether the fitted model meets every criterion."""
        return all(verdict.passed for verdict in self.criteria["fitted"])

    @property
    def models(self) -> dict[str, ModelRun]:
        """All models by name: ``nominal``, ``fitted`` and the variants."""
        return {"nominal": self.nominal, "fitted": self.fitted, **self.variants}

    def runs(self) -> Iterator[ModelRun]:
        """All models, one after the other."""
        yield from self.models.values()


def scores_of(runs: Mapping[str, ModelRun]) -> dict[str, dict[str, dict[str, Metrics]]]:
    """Metrics as sensor -> period -> model."""
    found: dict[str, dict[str, dict[str, Metrics]]] = {}
    for model, run in runs.items():
        for sensor, periods in run.scores.items():
            for period, metrics in periods.items():
                found.setdefault(sensor, {}).setdefault(period, {})[model] = metrics
    return found


def metric_values(metrics: Metrics) -> MetricValues:
    """Metrics as the results of a study hold them."""
    return MetricValues(**metrics.to_dict())

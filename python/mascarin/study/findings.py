"""The results of the steps of a study, as data."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from mascarin.calibration import Calibration, Profile
    from mascarin.sensitivity import Sensitivity
    from mascarin.simulation.results import Results
    from mascarin.simulation.simulation import Simulation
    from mascarin.study.setup import Scores, Setup
    from mascarin.validation.causes import Diagnosis
    from mascarin.validation.comparison import Metrics
    from mascarin.validation.criteria import Verdict
    from mascarin.validation.days import DayChoice
    from mascarin.validation.error_sources import ErrorSources
    from mascarin.validation.residuals import ResidualAnalysis
    from mascarin.weather.quality import Stretch

    Array = npt.NDArray[np.float64]


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
    """

    confidence: float
    half_width: Array
    parameters: Array
    error: Array
    coverage: dict[str, Array]


@dataclass(frozen=True, eq=False)
class Findings:
    """The results of all steps of a study.

    Attributes
    ----------
    setup : Setup
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
    """

    setup: Setup
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
    for label, run in runs.items():
        for sensor, periods in run.scores.items():
            for period, metrics in periods.items():
                found.setdefault(sensor, {}).setdefault(period, {})[label] = metrics
    return found

"""The calibrated model of a study with its prediction intervals."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from mascarin.linear_algebra import one_thread
from mascarin.study.context.step_cache import kept
from mascarin.study.steps.model_averaging import combined_intervals, estimates_of
from mascarin.study.steps.prediction_intervals import prediction_intervals, slopes
from mascarin.study.steps.predictive_checks import contradictions, with_doubt

if TYPE_CHECKING:
    from mascarin.calibration import Calibration, Profile
    from mascarin.calibration.errors.posterior_checks import Contradiction
    from mascarin.study.context.context import StudyContext
    from mascarin.study.steps.findings import Combination, ModelRun, PredictionIntervals
    from mascarin.study.steps.model_runs import ModelRuns


@dataclass(frozen=True, eq=False)
class Calibrated:
    """The calibrated model, how it was found, and what it predicts.

    Attributes
    ----------
    run : ModelRun
        The model over the whole record.
    fit : Calibration
        Estimates and their intervals.
    intervals : PredictionIntervals
        Where measured values are expected.
    profiles : list of Profile
        Profile likelihoods, if the study asks for them.
    combination : Combination or None
        Forms of the model, where errors of sensors and model are estimated.
    contradictions : list of Contradiction
        By what the model contradicts its own data or what is known.
    """

    run: ModelRun
    fit: Calibration
    intervals: PredictionIntervals
    profiles: list[Profile]
    combination: Combination | None
    contradictions: list[Contradiction]

    @staticmethod
    def judged(
        study: StudyContext,
        run: ModelRun,
        fit: Calibration,
        intervals: PredictionIntervals,
        profiles: list[Profile],
        combination: Combination | None,
    ) -> Calibrated:
        """The calibrated model, its intervals as wide as what contradicts it requires."""
        found = contradictions(study, run, fit, intervals, combination)
        fit, intervals = with_doubt(study, run, fit, intervals, found)
        return Calibrated(replace(run, fit=fit), fit, intervals, profiles, combination, found)


@one_thread()
def calibrated(study: StudyContext, runs: ModelRuns) -> Calibrated:
    """Calibrate the model of a study: with the errors of sensors and model, if it states any.

    Parameters
    ----------
    study : StudyContext
        The study.
    runs : ModelRuns
        Its models.
    """
    if not study.estimates_errors:
        run, fit = runs.fitted()
        intervals = prediction_intervals(study, run, fit, slopes(study, run, fit))
        return Calibrated.judged(study, run, fit, intervals, runs.profiled(fit), None)
    found = runs.combination()
    best = found.forms[0]
    known = (best.fit.problem, best.fit.trace, best.fit.nominal_building)
    key = [(form.label, form.fit.x.tolist()) for form in found.forms]
    fit = kept(study.workspace, ("estimates", key), lambda: estimates_of(study, found), known)
    intervals = kept(study.workspace, ("intervals", key), lambda: combined_intervals(study, found))
    note = "after the calibration; its parameters are the same on all other days"
    if len(found.forms) > 1:
        note += f"; of {len(found.forms)} forms '{best.label}' is used, "
        note += f"with {100.0 * found.weights[0]:.0f} % of the weight by days left out of the identification"
    run = replace(best.run, label="fitted", fit=fit, note=note)
    return Calibrated.judged(study, run, fit, intervals, runs.profiled(runs.plain()), found)

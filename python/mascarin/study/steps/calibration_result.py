"""The calibrated model of a study with its prediction intervals."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from mascarin._io.numbers import in_percent
from mascarin.calibration.errors.posterior_checks import widening, with_wider_intervals
from mascarin.linear_algebra import one_thread
from mascarin.study.carried.bands import daily_means, day_numbers
from mascarin.study.carried.calibrated_building import OtherNumbers, SensorRecord, with_posterior
from mascarin.study.context.step_cache import kept
from mascarin.study.file.description import DiscrepancyPlan
from mascarin.study.steps.model_averaging import combined_intervals, estimates_of
from mascarin.study.steps.prediction_intervals import prediction_intervals, slopes
from mascarin.study.steps.predictive_checks import contradictions, with_doubt
from mascarin.study.steps.residuals import DRIVERS
from mascarin.study.steps.sky_error import sky_effect

if TYPE_CHECKING:
    from collections.abc import Mapping

    from mascarin.building import Building
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
    together : dict of str to Calibrated
        The other experiments that were identified together with this one.
    """

    run: ModelRun
    fit: Calibration
    intervals: PredictionIntervals
    profiles: list[Profile]
    combination: Combination | None
    contradictions: list[Contradiction]
    together: dict[str, Calibrated] = field(default_factory=dict)

    @staticmethod
    def judged(
        study: StudyContext,
        run: ModelRun,
        fit: Calibration,
        intervals: PredictionIntervals,
        profiles: list[Profile],
        combination: Combination | None,
        together: Mapping[str, Calibrated] | None = None,
    ) -> Calibrated:
        """The calibrated model, its intervals as wide as what contradicts it requires.

        What contradicts it in another experiment makes the intervals of the parameters wider, too.
        """
        doubts = contradictions(study, run, fit, intervals, combination)
        _, intervals = with_doubt(study, run, fit, intervals, doubts)
        known = {doubt.text for doubt in doubts}
        for name, other in (together or {}).items():
            doubts += [
                replace(doubt, text=f"{name}: {doubt.text}")
                for doubt in other.contradictions
                if doubt.text not in known
            ]
        if any(doubt.kind == "fit" for doubt in doubts):
            intervals = replace(intervals, elsewhere=False)
        factor = widening(doubts)
        if factor > 1.0:
            fit = with_wider_intervals(fit, factor)
        return Calibrated(
            replace(run, fit=fit), fit, intervals, profiles, combination, doubts, dict(together or {})
        )


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
        others = {}
        for name, (run, fit) in runs.together().items():
            context = study.together[name]
            intervals = prediction_intervals(context, run, fit, slopes(context, run, fit))
            others[name] = Calibrated.judged(context, run, fit, intervals, [], None)
        run, fit = runs.fitted()
        intervals = prediction_intervals(study, run, fit, slopes(study, run, fit))
        return Calibrated.judged(study, run, fit, intervals, runs.profiled(fit), None, others)
    combination = runs.combination()
    others = {
        name: _combined(study.together[name], combination.of_experiment(name), []) for name in study.together
    }
    return _combined(study, combination, runs.profiled(runs.plain()), others)


def _combined(
    study: StudyContext,
    combination: Combination,
    profiles: list[Profile],
    together: Mapping[str, Calibrated] | None = None,
) -> Calibrated:
    """The calibrated model of an experiment from its forms."""
    best = combination.forms[0]
    known = (best.fit.problem, best.fit.trace, best.fit.nominal_building)
    key: list[object] = [(form.label, form.fit.x.tolist()) for form in combination.forms]
    if study.first is not None:
        key.append(study.inputs.experiment)
    fit = kept(study.workspace, ("estimates", key), lambda: estimates_of(study, combination), known)
    intervals = kept(study.workspace, ("intervals", key), lambda: combined_intervals(study, combination))
    note = "after the calibration; its parameters are the same on all other days"
    if len(combination.forms) > 1:
        note += f"; of {len(combination.forms)} forms '{best.label}' is used, "
        weight = in_percent(float(combination.weights[0]))
        note += f"with {weight} of the weight by days left out of the identification"
    run = replace(best.run, label="fitted", fit=fit, note=note)
    return Calibrated.judged(study, run, fit, intervals, profiles, combination, together)


def building_with_posterior(
    study: StudyContext,
    run: ModelRun,
    fit: Calibration,
    intervals: PredictionIntervals,
    combination: Combination | None,
) -> Building:
    """The calibrated building with its posterior, for calibrated.yaml.

    Parameters
    ----------
    study : StudyContext
        The study.
    run, fit, intervals, combination
        As for `Calibrated`.
    """
    observation, days = study.observation, day_numbers(study.observation.times)
    used = study.during["identification"]
    weather = {}
    for channel in DRIVERS.values():
        values = observation.sampled(run.results.index, run.simulation.weather(channel))
        if np.ptp(values[np.isfinite(values)]) > 0.0:
            means = daily_means(np.where(used, values, np.nan), days)
            weather[channel] = means[np.isfinite(means)]
    joint, numbers = None, None
    if combination is not None:
        joint, unknown = combination.forms[0].joint, combination.forms[0].unknown
        numbers = OtherNumbers(
            tuple(number.path for number in unknown.numbers),
            np.array([number.uncertainty for number in unknown.numbers]),
            unknown.directions,
        )
    return with_posterior(
        fit,
        joint,
        numbers,
        _sensor_records(study, run, fit, intervals, combination),
        weather,
        study=study.plan.name,
        days=int(np.unique(days[used]).size),
        stated=intervals.stated and intervals.elsewhere,
    )


def _sensor_records(
    study: StudyContext,
    run: ModelRun,
    fit: Calibration,
    intervals: PredictionIntervals,
    combination: Combination | None,
) -> list[SensorRecord]:
    """Sensors of the identification with the errors of the model, as wide as the bands of the report."""
    observation, used = study.observation, study.used["identification"]
    simulated = observation.simulated(run.results.index, run.results.records)
    limit = (study.inputs.calibration_plan.discrepancy or DiscrepancyPlan()).limit
    wider = intervals.factor if intervals.stated else 1.0
    vector = run.simulation.vector(fit.values)
    sky = sky_effect(study, run.simulation, vector, fit.problem.paths) if combination is not None else None
    records = []
    for k, sensor in enumerate(fit.problem.sensors):
        s = observation.names.index(sensor.name)
        squares = np.array([0.0, intervals.error[s] ** 2, 0.0])
        if combination is not None:
            joint = combination.forms[0].joint
            errors, factor = joint.error_covariances, wider * joint.days_left_out(fit.confidence)[k]
            independent = errors.independent[k]
            squares = np.array([errors.hour[k, k], errors.new_day[k] - independent, independent])
            squares = factor**2 * np.maximum(squares, 0.0)
            if sky is not None:
                squares[1] += float(np.mean(sky[:, s] ** 2))
        repeating, daily, independent = np.sqrt(squares).tolist()
        output = study.building.output(study.plan.sensors[sensor.name].output)
        series = simulated[used[:, s], s]
        records.append(
            SensorRecord(
                sensor.name,
                output.name,
                output.unit,
                series,
                limit * sensor.span,
                repeating,
                daily,
                independent,
            )
        )
    return records

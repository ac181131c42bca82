"""Forms of the model combined: estimates with the spread between them, and prediction intervals.

Each form is calibrated together with the errors of sensors and model. Its weight is that of its predictions
of days left out of the identification. The prediction of all forms together is a mixture of normal
distributions; its mean and variance are given.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from mascarin.calibration.errors.nearness import nearness
from mascarin.calibration.errors.pseudo_bma_weights import weighted_quantiles
from mascarin.study.context.forms import comparable
from mascarin.study.steps.error_model import (
    effects_of_sensors,
    effects_of_unknowns,
    local_hours,
    persistence_of,
    used_sensors,
)
from mascarin.study.steps.findings import PredictionIntervals
from mascarin.study.steps.prediction_intervals import coverage_of, slopes
from mascarin.study.steps.sky_error import sky_effect

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.calibration import Calibration
    from mascarin.study.context.context import StudyContext
    from mascarin.study.steps.findings import Combination, FormFit

    Array = npt.NDArray[np.float64]


def estimates_of(study: StudyContext, found: Combination) -> Calibration:
    """The calibration of the best form, its intervals with the spread between forms.

    A parameter of which another form has one of the same meaning has the interval of both together. The
    interval always contains the estimate of the best form, which may be on the end of its range.
    """
    best = found.forms[0]
    fit = best.fit
    low, high, tail = fit.low.copy(), fit.high.copy(), 0.5 * (1.0 - fit.confidence)
    for i, parameter in enumerate(fit.problem.parameters):
        samples, weights = [], []
        for form, weight in found.kept:
            paths = form.fit.problem.paths
            if parameter.path in paths and comparable(
                parameter.path, best.choice, form.choice, study.variants.forms
            ):
                k = paths.index(parameter.path)
                other = form.fit.problem.parameters[k]
                samples.append(np.array([other.value(v) for v in form.joint.widened()[:, k]]))
                weights.append(weight)
        ends = weighted_quantiles(samples, np.array(weights), np.array([tail, 1.0 - tail]))
        low[i], high[i] = min(ends[0], fit.x[i]), max(ends[1], fit.x[i])
    method = fit.uncertainty_method
    if len(found.kept) > 1:
        method += f"; {len(found.kept)} forms of the model, weighed by days left out of the identification"
    return replace(fit, low=low, high=high, uncertainty_method=method)


@dataclass(frozen=True, eq=False)
class FormPrediction:
    """What one form predicts.

    Attributes
    ----------
    difference : ndarray, shape (n, S)
        Expected measured minus simulated value. [unit of each sensor]
    variance : ndarray, shape (n, S)
        Of parameters, sensors, errors that repeat, and what is `stated`. [unit^2]
    parameters : ndarray, shape (n, S)
        Of the estimated parameters alone. [unit^2]
    stated : ndarray, shape (n, S)
        Of what the identification does not tell: other numbers of the building, the sky of other weather.
        It is as large as sources say, whatever the days. [unit^2]
    new_day, independent : ndarray, shape (S,)
        Of what differs on each day, and of the part of it that differs from value to value. [unit^2]
    """

    difference: Array
    variance: Array
    parameters: Array
    stated: Array
    new_day: Array
    independent: Array


def combined_intervals(study: StudyContext, found: Combination) -> PredictionIntervals:
    """Prediction intervals of all forms together.

    The interval is about the expected reading: the simulated value of the fitted model, plus the estimated
    errors of sensor and model, plus the distance of the other forms from it.
    """
    from scipy import stats

    observation, hours = study.observation, local_hours(study)
    shape = observation.measured.shape
    mean, square, of_parameters = np.zeros(shape), np.zeros(shape), np.zeros(shape)
    effects: dict[str, Array] = {}
    near = nearness(hours, np.any(study.used["identification"], axis=1), persistence_of(study))
    new_day, known = np.zeros(shape[1]), np.zeros(shape)
    fitted = observation.simulated(found.forms[0].run.results.index, found.forms[0].run.results.records)
    for form, weight in found.kept:
        prediction = _predicted(study, form, (hours, near), effects)
        simulated = observation.simulated(form.run.results.index, form.run.results.records)
        expected = simulated + prediction.difference
        mean += weight * expected
        square += weight * (prediction.variance + prediction.new_day + (expected - fitted) ** 2)
        of_parameters += weight * prediction.parameters
        new_day += weight * prediction.new_day
        known += weight * (prediction.independent + prediction.stated)
    center = mean - fitted
    variance = np.maximum(square - center**2, 0.0)
    confidence = found.forms[0].fit.confidence
    # What differs from value to value is known from many values, and some numbers from sources; all else from
    # few days.
    shared = found.forms[0].joint.quantile(confidence) ** 2 * np.maximum(variance - known, 0.0)
    half = np.sqrt(shared + float(stats.norm.ppf(0.5 + 0.5 * confidence)) ** 2 * known)
    used = [observation.names.index(name) for name in used_sensors(study)]
    half[:, used] *= found.forms[0].joint.days_left_out(confidence, near)
    misses = fitted + center - observation.measured
    coverage = {period: coverage_of(misses, half, use) for period, use in study.used.items()}
    return PredictionIntervals(confidence, half, np.sqrt(of_parameters), np.sqrt(new_day), coverage, center)


def _predicted(
    study: StudyContext, form: FormFit, when: tuple[Array, Array], effects: dict[str, Array]
) -> FormPrediction:
    """What a form predicts; sensors that are not used have an error of their own size.

    `when`: local time [h] and `nearness` of each instant.
    """
    hours, near = when
    slope = np.moveaxis(slopes(study, form.run, form.fit), 0, -1)
    joint, count = form.joint, slope.shape[2]
    columns = [study.observation.names.index(name) for name in used_sensors(study)]
    base = form.run.simulation.vector(form.fit.values)
    simulated = study.observation.simulated(form.run.results.index, form.run.results.records)
    further, stated = _not_estimated(study, form, base, near, effects)
    errors = np.concatenate([effects_of_sensors(study, simulated), further], axis=2)
    difference, variance = np.zeros(slope.shape[:2]), stated.copy()
    parameters = np.einsum("tsp,pq,tsq->ts", slope, joint.covariance[:count, :count], slope, optimize=True)
    used = joint.effects(slope[:, columns], errors[:, columns], hours)
    difference[:, columns], of_used = joint.predicted(used, form.fit.problem.positions(form.fit.x))
    variance[:, columns] += of_used
    new_day, independent = np.zeros(slope.shape[1]), np.zeros(slope.shape[1])
    new_day[columns] = joint.error_covariances.new_day
    independent[columns] = joint.error_covariances.independent
    seen = study.used["identification"]
    for s in range(new_day.size):
        if s not in columns:
            misses = (simulated - study.observation.measured)[seen[:, s], s]
            new_day[s] = float(np.nanmean(misses**2)) if np.isfinite(misses).any() else np.nan
            variance[:, s] += parameters[:, s]
    return FormPrediction(difference, variance, np.maximum(parameters, 0.0), stated, new_day, independent)


def _not_estimated(
    study: StudyContext, form: FormFit, base: Array, near: Array, effects: dict[str, Array]
) -> tuple[Array, Array]:
    """Effects (n, S, K) of what is not estimated, and the variance (n, S) that the identification leaves."""
    # Effects of one form serve all others that have the same numbers: they only give the width.
    missing = [number for number in form.unknown.numbers if number.path not in effects]
    if missing:
        own = effects_of_unknowns(study, study.observation, form.run.simulation, base, missing)
        effects |= {number.path: own[:, :, k] for k, number in enumerate(missing)}
    every = np.zeros((*study.observation.measured.shape, len(form.unknown.numbers)))
    for k, number in enumerate(form.unknown.numbers):
        every[:, :, k] = effects[number.path]
    further = every @ form.unknown.directions
    remaining = np.maximum(np.sum(every**2, axis=2) - np.sum(further**2, axis=2), 0.0)
    sky = sky_effect(study, form.run.simulation, base, form.fit.problem.paths)
    if sky is not None:
        # The estimates contain the error of the days of the identification.
        remaining += sky**2 * (1.0 - near**2)[:, None]
    return further, remaining

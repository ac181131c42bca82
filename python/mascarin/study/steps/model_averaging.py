"""Forms of the model combined: estimates with the spread between them, and prediction intervals.

Each form is calibrated together with the errors of sensors and model. Its weight is that of its predictions
of days left out of the identification. The prediction of all forms together is a mixture of normal
distributions; its mean and variance are given.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from mascarin.calibration.errors.joint_posterior import nearness
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
    new_day, noise = np.zeros(shape[1]), np.zeros(shape[1])
    fitted = observation.simulated(found.forms[0].run.results.index, found.forms[0].run.results.records)
    for form, weight in found.kept:
        about, variance, parameters, own, white = _predicted(study, form, hours, effects)
        simulated = observation.simulated(form.run.results.index, form.run.results.records)
        there = simulated + about
        mean += weight * there
        square += weight * (variance + own + (there - fitted) ** 2)
        of_parameters += weight * parameters
        new_day += weight * own
        noise += weight * white
    center = mean - fitted
    variance = np.maximum(square - center**2, 0.0)
    confidence = found.forms[0].fit.confidence
    # What differs from value to value is known from many values, all else from few days.
    shared = found.forms[0].joint.quantile(confidence) ** 2 * np.maximum(variance - noise, 0.0)
    half = np.sqrt(shared + float(stats.norm.ppf(0.5 + 0.5 * confidence)) ** 2 * noise)
    used = [observation.names.index(name) for name in used_sensors(study)]
    near = nearness(hours, np.any(study.used["identification"], axis=1), persistence_of(study))
    half[:, used] *= found.forms[0].joint.days_left_out(confidence, near)
    misses = fitted + center - observation.measured
    coverage = {period: coverage_of(misses, half, use) for period, use in study.used.items()}
    return PredictionIntervals(confidence, half, np.sqrt(of_parameters), np.sqrt(new_day), coverage, center)


def _predicted(
    study: StudyContext, form: FormFit, hours: Array, effects: dict[str, Array]
) -> tuple[Array, Array, Array, Array, Array]:
    """Expected measured minus simulated value, its variance, that of the parameters, of a day, of a value.

    Shapes (n, S), (n, S), (n, S), (S,) and (S,); sensors that are not used have an error of their own size.
    """
    slope = np.moveaxis(slopes(study, form.run, form.fit), 0, -1)
    joint, count = form.joint, slope.shape[2]
    named = used_sensors(study)
    columns = [study.observation.names.index(name) for name in named]
    base = form.run.simulation.vector(form.fit.values)
    # Effects of one form serve all others that have the same numbers: they only give the width.
    missing = [number for number in form.unknown.numbers if number.path not in effects]
    if missing:
        own_effects = effects_of_unknowns(study, study.observation, form.run.simulation, base, missing)
        effects |= {number.path: own_effects[:, :, k] for k, number in enumerate(missing)}
    every = np.zeros((*slope.shape[:2], len(form.unknown.numbers)))
    for k, number in enumerate(form.unknown.numbers):
        every[:, :, k] = effects[number.path]
    further = every @ form.unknown.directions
    simulated = study.observation.simulated(form.run.results.index, form.run.results.records)
    known = np.concatenate([effects_of_sensors(study, simulated), further], axis=2)
    z = form.fit.problem.positions(form.fit.x)
    about, variance = np.zeros(slope.shape[:2]), np.zeros(slope.shape[:2])
    own, white = np.zeros(slope.shape[1]), np.zeros(slope.shape[1])
    parameters = np.einsum("tsp,pq,tsq->ts", slope, joint.covariance[:count, :count], slope, optimize=True)
    used = joint.effects(slope[:, columns], known[:, columns], hours)
    about[:, columns], variance[:, columns] = joint.predicted(used, z)
    # What the identification does not tell of these numbers remains as uncertain as it was.
    variance += np.maximum(np.sum(every**2, axis=2) - np.sum(further**2, axis=2), 0.0)
    own[columns], white[columns] = joint.error_covariances.new_day, joint.error_covariances.independent
    seen = study.used["identification"]
    for s in range(own.size):
        if s not in columns:
            misses = (simulated - study.observation.measured)[seen[:, s], s]
            own[s] = float(np.nanmean(misses**2)) if np.isfinite(misses).any() else np.nan
            variance[:, s] += parameters[:, s]
    return about, variance, np.maximum(parameters, 0.0), own, white

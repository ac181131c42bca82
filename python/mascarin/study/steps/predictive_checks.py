"""Checks of the calibrated model of a study before its results are shown, and what they do to intervals."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin._io.numbers import in_percent
from mascarin.calibration.errors.posterior_checks import (
    Contradiction,
    of_errors,
    of_estimates,
    of_fit,
    widening,
    with_wider_intervals,
)
from mascarin.calibration.errors.stated_errors import beside_zero, counted_as_scatter
from mascarin.study.context.error_rule import all_scatter, reason_of
from mascarin.study.steps.error_model import local_hours, scatter_of, sensor_errors, stated_sizes
from mascarin.study.steps.model_runs import nominal
from mascarin.study.steps.prediction_intervals import coverage_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from mascarin.calibration import Calibration
    from mascarin.study.context.context import StudyContext
    from mascarin.study.steps.findings import Combination, ModelRun, PredictionIntervals

#: Part of its own data that a nominal interval of 95 % has to contain.
_LEAST_COVERAGE: Final = 0.88
#: The same on other days, below which the periods differ.
_LEAST_ELSEWHERE: Final = 0.8
#: Ratio of the scatter of a record to the uncertainty stated, from which the statement is contradicted.
_SCATTERS: Final = 1.5
_FEW_DAYS: Final = 3


def contradictions(
    study: StudyContext,
    run: ModelRun,
    fit: Calibration,
    intervals: PredictionIntervals,
    found: Combination | None,
) -> list[Contradiction]:
    """Everything by which the calibrated model contradicts its own data, or what is known.

    Parameters
    ----------
    study : StudyContext
        The study.
    run : ModelRun
        The calibrated model.
    fit : Calibration
        Its calibration.
    intervals : PredictionIntervals
        Its prediction intervals.
    found : Combination or None
        Forms of the model, where errors are estimated.
    """
    all_found = [*_coverage(study, run, intervals)]
    if found is not None:
        joint, names = found.forms[0].joint, [sensor.name for sensor in fit.problem.sensors]
        all_found += of_errors(joint, names, stated_sizes(study), _days(study))
    all_found += of_estimates(fit.problem.parameters, fit.x, _reasons(study, fit))
    all_found += _fit(study, run, fit)
    all_found += _periods(study, intervals)
    return [*all_found, *statements(study)]


def statements(study: StudyContext) -> list[Contradiction]:
    """What the study states that its data contradict, or that says nothing; known before the first run.

    Parameters
    ----------
    study : StudyContext
        The study; nothing is run.
    """
    checks = (_scatters, _zeros, _twins, _few_days, _priors, _not_estimated)
    return [contradiction for check in checks for contradiction in check(study)]


def with_doubt(
    study: StudyContext,
    run: ModelRun,
    fit: Calibration,
    intervals: PredictionIntervals,
    found: Sequence[Contradiction],
) -> tuple[Calibration, PredictionIntervals]:
    """Intervals as wide as the contradictions require.

    Parameters
    ----------
    study, run, fit, intervals
        As for `contradictions`.
    found : sequence of Contradiction
        From it.

    Returns
    -------
    Calibration, PredictionIntervals
        Parameters have the whole range, and bands are infinite, where nothing is to be stated.
    """
    factor = widening(found)
    if factor > 1.0:
        fit = with_wider_intervals(fit, factor)
    bands = widening([one for one in found if one.kind == "coverage"])
    if bands == 1.0 and math.isfinite(factor):
        return fit, intervals
    # Bands stay finite, so that curves can be drawn; the report says that they are not stated.
    half = intervals.half_width * max([1.0, *(one.factor for one in found if one.kind == "coverage")])
    misses = _misses(study, run) + intervals.center
    coverage = {period: coverage_of(misses, half, use) for period, use in study.used.items()}
    stated = bands if math.isfinite(factor) else math.inf
    return fit, replace(intervals, half_width=half, coverage=coverage, factor=stated)


def _misses(study: StudyContext, run: ModelRun) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    observation = study.observation
    return observation.simulated(run.results.index, run.results.records) - observation.measured


def _fit(study: StudyContext, run: ModelRun, fit: Calibration) -> list[Contradiction]:
    """Whether the calibration improved what it was made with."""
    stated = {
        sensor.name: math.sqrt(float(np.mean(sensor.sigma[sensor.mask] ** 2)))
        for sensor in fit.problem.sensors
        if sensor.name in run.scores and sensor.mask.any()
    }
    described, calibrated = (
        {name: scores[name]["identification"].rmse for name in stated}
        for scores in (nominal(study).scores, run.scores)
    )
    return of_fit(described, calibrated, stated)


def _coverage(study: StudyContext, run: ModelRun, intervals: PredictionIntervals) -> Iterator[Contradiction]:
    """Identification data outside of their own bands."""
    misses, use = _misses(study, run) + intervals.center, study.used["identification"]
    for s, name in enumerate(study.observation.names):
        share = float(intervals.coverage["identification"][s])
        if not study.plan.sensors[name].use or not share < _LEAST_COVERAGE:
            continue
        ratio = np.abs(misses[:, s] / intervals.half_width[:, s])[use[:, s]]
        factor = float(np.quantile(ratio[np.isfinite(ratio)], intervals.confidence))
        yield Contradiction(
            "coverage",
            name,
            f"{name}: the {100.0 * intervals.confidence:g} % band contains {in_percent(share)} of the "
            "values of the identification, from which it was made",
            factor,
        )


def _periods(study: StudyContext, intervals: PredictionIntervals) -> Iterator[Contradiction]:
    """Other days on which the bands do not hold."""
    for period in ("corroboration", "blind"):
        if period == "blind" and np.array_equal(study.during["blind"], study.during["corroboration"]):
            continue
        for s, name in enumerate(study.observation.names):
            share = float(intervals.coverage[period][s])
            if share < _LEAST_ELSEWHERE:
                yield Contradiction(
                    "period",
                    name,
                    f"{name}: the {100.0 * intervals.confidence:g} % band contains {in_percent(share)} "
                    f"of the values of the {period} days: they differ from the identification, and the band "
                    "does not hold there",
                )


def _reasons(study: StudyContext, fit: Calibration) -> dict[str, str]:
    """Reasons of estimates on a bound, those of the study first."""
    reasons = dict(fit.on_bound)
    for path, free in study.inputs.calibration_plan.parameters.items():
        if path in reasons and free is not None and free.at_bound:
            reasons[path] = f"on its bound, {free.at_bound}"
    return reasons


def _days(study: StudyContext) -> list[str]:
    """Dates of the days of the identification, as the joint distribution has them."""
    hours = local_hours(study)[study.rows]
    first = study.observation.times[0].tz_localize(None).normalize()
    numbers = np.unique(np.floor(hours / 24.0 + 1e-9).astype(int))
    import pandas as pd

    return [f"{first + pd.Timedelta(days=int(day)):%Y-%m-%d}" for day in numbers]


def _scatters(study: StudyContext) -> Iterator[Contradiction]:
    """Sensors whose record scatters by more than they state."""
    for name, sensor in study.plan.sensors.items():
        unit = study.building.output(sensor.output).unit
        stated, random = sensor.uncertainty(unit, f"sensors.{name}").absolute, scatter_of(study, name)
        if math.isfinite(random) and random > _SCATTERS * stated > 0.0:
            yield Contradiction(
                "statement",
                name,
                f"{name}: the readings scatter by {random:.2g} {unit.replace('degC', 'K')}, more than the "
                "standard "
                f"uncertainty of {stated:.2g} that is stated: state what the sensor has, or mask what is "
                "no reading",
            )


def _zeros(study: StudyContext) -> Iterator[Contradiction]:
    """Meters that read zero while all is off, although an offset is stated for them."""
    if not study.estimates_errors:
        return
    names = list(study.plan.sensors)
    for name, error, readings in zip(
        names, sensor_errors(study, names), study.observation.measured.T, strict=True
    ):
        unit = study.building.output(study.plan.sensors[name].output).unit
        text = beside_zero(name, unit, error, readings)
        if text is not None:
            yield Contradiction("statement", name, text)


def _twins(study: StudyContext) -> Iterator[Contradiction]:
    """Columns of one sensor, of which the mean is used, that differ by more than is stated."""
    observation = study.observation
    for name, sensor in study.plan.sensors.items():
        if sensor.adds:
            continue  # its columns are parts of it
        unit = study.building.output(sensor.output).unit
        allowed = math.sqrt(2.0) * sensor.uncertainty(unit, f"sensors.{name}").absolute
        read = [study.measurements.at(c, observation.times, observation.interval) for c in sensor.columns]
        for column, values in zip(sensor.columns[1:], read[1:], strict=True):
            apart = values - read[0]
            mean = float(np.nanmean(apart)) if np.isfinite(apart).any() else 0.0
            if abs(mean) > 2.0 * allowed > 0.0:
                yield Contradiction(
                    "statement",
                    name,
                    f"{name}: the columns {sensor.columns[0]} and {column} measure the same and differ by "
                    f"{mean:+.2g} {unit.replace('degC', 'K')} in the mean, {abs(mean) / allowed:.1f} times "
                    "what "
                    "their standard uncertainties allow: one of them is wrong, or they are not in the same "
                    "place",
                    abs(mean) / (2.0 * allowed),
                )


def _few_days(study: StudyContext) -> Iterator[Contradiction]:
    days = len(_days(study)) if study.estimates_errors else _FEW_DAYS
    if days < _FEW_DAYS:
        yield Contradiction(
            "statement",
            "discrepancy",
            f"errors of the model that change from day to day are estimated from {days} day"
            f"{'s' * (days != 1)}: their size is what is assumed, not what the data say; identify with at "
            "least "
            f"{_FEW_DAYS} days",
        )


def _priors(study: StudyContext) -> Iterator[Contradiction]:
    for parameter in study.problem().parameters if study.plan.identification is not None else ():
        if parameter.prior is None:
            continue
        mean = parameter.prior[0]
        if not parameter.lower <= mean <= parameter.upper:
            yield Contradiction(
                "statement",
                parameter.path,
                f"{parameter.path}: the prior is about {mean:g}, outside of the range from "
                f"{parameter.lower:g} to "
                f"{parameter.upper:g}",
            )


def _not_estimated(study: StudyContext) -> Iterator[Contradiction]:
    """Why stated uncertainties count as scatter, where they should not."""
    if study.estimates_errors or all_scatter(study.plan):
        return
    reason = reason_of(study.plan, study.hours)
    if reason is not None:
        yield Contradiction("statement", "sensors", counted_as_scatter(reason))

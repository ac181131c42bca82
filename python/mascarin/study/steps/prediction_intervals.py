"""Prediction intervals of the calibrated model, and their coverage."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin._io.numbers import in_percent
from mascarin.calibration.errors.posterior_checks import NOT_STATED
from mascarin.study.context.step_cache import kept_series
from mascarin.study.steps.findings import PredictionIntervals
from mascarin.study_document.analysis import TableEntry
from mascarin.study_document.comparison import BandEntry
from mascarin.validation.series import effective_samples

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.calibration import Calibration
    from mascarin.study.context.context import StudyContext
    from mascarin.study.steps.findings import ModelRun

    Array = npt.NDArray[np.float64]
    Flags = npt.NDArray[np.bool_]

#: Step of the differences, in ranges.
_STEP: Final = 1e-3
#: A coverage below this is mentioned in the notes. [-]
_LOW_COVERAGE: Final = 0.85
_SHARED: Final = (
    "; it includes errors of sensors and model, numbers that are not estimated{forms}, and, where its "
    "radiation was not measured, the sky of other weather; its middle is the expected reading"
)


def slopes(study: StudyContext, run: ModelRun, fit: Calibration) -> Array:
    """Derivatives of the sensors with respect to the calibrated parameters.

    Parameters
    ----------
    study : StudyContext
        Gives the instants of the comparison.
    run : ModelRun
        The fitted model.
    fit : Calibration
        The calibration, with the ranges of its parameters.

    Returns
    -------
    ndarray, shape (P, n, S)
        Derivative of each series with respect to the parameter, times the range of the parameter; NaN where
        the model cannot be run. [unit of each sensor]
    """
    base = run.simulation.vector(fit.values)
    vectors, steps = [base], []
    for parameter in fit.problem.parameters:
        here = parameter.position(run.simulation.value_in(base, parameter.path))
        there = here + (_STEP if here + _STEP <= 1.0 else -_STEP)
        moved = np.array([[parameter.value(there)]])
        vectors.append(run.simulation.varied([parameter.path], moved, base)[0])
        steps.append(there - here)
    series = kept_series(study, run.simulation, np.array(vectors))
    return np.asarray((series[1:] - series[0]) / np.array(steps)[:, None, None])


def prediction_intervals(
    study: StudyContext, run: ModelRun, fit: Calibration, slope: Array
) -> PredictionIntervals:
    """Intervals in which new measurements are expected.

    Parameters
    ----------
    study : StudyContext
        Gives periods and measurements.
    run : ModelRun
        The fitted model.
    fit : Calibration
        Gives the covariance of the estimates and the model error in the identification period.
    slope : ndarray, shape (P, n, S)
        From `slopes`. [unit of each sensor]
    """
    from scipy import stats

    found, observation, seen = fit.uncertainty, study.observation, study.used["identification"]
    variance = np.maximum(np.einsum("pts,pq,qts->ts", slope, found.covariance, slope, optimize=True), 0.0)
    misses = observation.simulated(run.results.index, run.results.records) - observation.measured
    known = {sensor.name: k for k, sensor in enumerate(fit.problem.sensors)}
    error, count = np.empty(len(observation.names)), np.empty(len(observation.names))
    for s, name in enumerate(observation.names):
        if name in known:
            error[s], count[s] = found.error[known[name]], found.effective_samples[known[name]]
        else:  # Not used in the calibration; its error in the same period is known all the same.
            own = misses[seen[:, s], s]
            error[s] = _root_mean_square(own)
            count[s] = effective_samples(own) if np.isfinite(error[s]) else 1.0
    tail = 0.5 + 0.5 * fit.confidence
    estimates = float(stats.t.ppf(tail, found.freedom)) * np.sqrt(variance)
    # With few independent samples their standard deviation is as uncertain as their mean.
    count = np.maximum(count, 2.0)
    errors = stats.t.ppf(tail, count - 1.0) * error * np.sqrt(1.0 + 1.0 / count)
    half = np.hypot(estimates, errors)
    coverage = {period: coverage_of(misses, half, use) for period, use in study.used.items()}
    return PredictionIntervals(fit.confidence, half, np.sqrt(variance), error, coverage, np.zeros_like(half))


def interval_table(study: StudyContext, found: PredictionIntervals, forms: int = 1) -> TableEntry:
    """Half-width and coverage of the intervals, as a table of the report; forms of the model are counted."""
    spread = f", the spread between the {forms} forms of the model" if forms > 1 else ""
    shared = _SHARED.format(forms=spread) if found.center.any() else ""
    rows = []
    for s, name in enumerate(study.observation.names):
        sensor = study.plan.sensors[name]
        unit = study.building.output(sensor.output).unit.replace("degC", "K")
        shares = [found.coverage[period][s] for period in study.during]
        rows.append(
            [
                sensor.label or name.replace("_", " "),
                unit,
                _number(np.mean(found.half_width[:, s])) if found.stated else "not stated",
                *(_number(100.0 * share) for share in shares),
            ]
        )
    return TableEntry(
        title="Prediction intervals",
        caption=(
            f"{100.0 * found.confidence:g} % prediction interval of the fitted model. It combines the "
            "uncertainty of the estimated parameters, propagated to each instant, and the standard deviation "
            f"of the model error in the identification period{shared}. The "
            "columns of the periods show the coverage: "
            f"the part of the measured values inside the interval. [%]{_doubt(found)}"
        ),
        columns=["sensor", "unit", "mean half-width", *study.during],
        rows=rows,
        section="comparison",
    )


def _doubt(found: PredictionIntervals) -> str:
    """What contradictions have done to the intervals, as a sentence of the caption."""
    if not found.stated:
        return f" The half-width is {NOT_STATED}; the columns show the coverage of the bands that are drawn."
    if found.factor > 1.0:
        return f" They are {found.factor:.2g} times wider for what contradicts the model (top of the report)."
    return ""


def interval_entries(study: StudyContext, found: PredictionIntervals) -> dict[str, BandEntry]:
    """The intervals in numbers, by sensor."""
    return {
        name: BandEntry(
            confidence=found.confidence,
            **({} if found.stated else {"stated": False}),
            half_width=_number(np.mean(found.half_width[:, s])),
            parameters=_number(np.mean(found.parameters[:, s])),
            error=_number(found.error[s]),
            held={period: _number(shares[s]) for period, shares in found.coverage.items()},
        )
        for s, name in enumerate(study.observation.names)
    }


def interval_words(study: StudyContext, found: PredictionIntervals) -> list[str]:
    """Sensors with a low coverage on the blind days, in words."""
    return [
        f"{name}: the {100.0 * found.confidence:g} % prediction interval contains {in_percent(float(share))} "
        f"of the values of the blind days: the model error there differs from that of the identification."
        for name, share in zip(study.observation.names, found.coverage["blind"], strict=True)
        if share < _LOW_COVERAGE
    ]


def _root_mean_square(misses: Array) -> float:
    """NaN where nothing was measured."""
    there = misses[np.isfinite(misses)]
    return float(np.sqrt(np.mean(there**2))) if there.size > 1 else float("nan")


def coverage_of(misses: Array, half: Array, use: Flags) -> Array:
    """Part of the measured values of a period, (n, S), inside the interval, by sensor."""
    there = np.isfinite(misses) & np.isfinite(half) & use
    inside = there & (np.abs(np.where(there, misses, 0.0)) <= half)
    with np.errstate(invalid="ignore"):
        return np.asarray(
            np.where(there.any(axis=0), inside.sum(axis=0) / np.maximum(there.sum(axis=0), 1), np.nan)
        )


def _number(value: Any) -> float | None:
    return float(value) if np.isfinite(value) else None

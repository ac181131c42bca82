"""What the fitted model foresees of the record: a band, and how often it held."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.calibration import Calibration
    from mascarin.study.pipeline import ModelRun, Study

    Array = npt.NDArray[np.float64]
    Flags = npt.NDArray[np.bool_]

#: Step of the differences, in ranges.
_STEP: Final = 1e-3
_BATCH: Final = 64
#: A band of 95 % that held less often than this is spoken of.
_NARROW: Final = 0.85


@dataclass(frozen=True, eq=False)
class Band:
    """A 95 % band about the fitted model.

    Attributes
    ----------
    confidence : float
        What it promises. [-]
    half_width : ndarray, shape (n, S)
        [unit of each sensor]
    parameters, error : ndarray, shape (n, S) and (S,)
        The two standard deviations it is made of: that of the estimates, carried to each instant, and that
        of the model's errors on the identification days. [unit of each sensor]
    held : dict of str to ndarray, shape (S,)
        Share of the measured values inside, by period; NaN where nothing was measured. [-]
    """

    confidence: float
    half_width: Array
    parameters: Array
    error: Array
    held: dict[str, Array]


def answers(study: Study, run: ModelRun, fit: Calibration) -> Array:
    """How the sensors answer to the fitted parameters over the record.

    Parameters
    ----------
    study : Study
        Gives the instants of the comparison.
    run : ModelRun
        The fitted model.
    fit : Calibration
        What was fitted, and how far each parameter may go.

    Returns
    -------
    ndarray, shape (P, n, S)
        Change of each series when the parameter goes through its range, at the rate that it has here; NaN
        where the model cannot be run beside it. [unit of each sensor]
    """
    base = run.simulation.vector(fit.values)
    vectors, steps = [base], []
    for parameter in fit.problem.parameters:
        at = run.simulation.position(parameter.path)
        here = parameter.position(float(base[at]))
        there = here + (_STEP if here + _STEP <= 1.0 else -_STEP)
        vectors.append(base.copy())
        vectors[-1][at] = parameter.value(there)
        steps.append(there - here)
    series = _series(study, run, np.array(vectors))
    return np.asarray((series[1:] - series[0]) / np.array(steps)[:, None, None])


def band(study: Study, run: ModelRun, fit: Calibration, slope: Array) -> Band:
    """The band in which the fitted model expects new measurements.

    Parameters
    ----------
    study : Study
        Gives periods and measurements.
    run : ModelRun
        The fitted model.
    fit : Calibration
        Gives the covariance of the estimates and the model's error on the identification days.
    slope : ndarray, shape (P, n, S)
        From `answers`. [unit of each sensor]
    """
    from scipy import stats

    from mascarin.validation.series import effective_samples

    found, observation, seen = fit.uncertainty, study.observation, study.during["identification"]
    variance = np.maximum(np.einsum("pts,pq,qts->ts", slope, found.covariance, slope, optimize=True), 0.0)
    misses = observation.simulated(run.results.index, run.results.records) - observation.measured
    known = {sensor.name: k for k, sensor in enumerate(fit.problem.sensors)}
    error, count = np.empty(len(observation.names)), np.empty(len(observation.names))
    for s, name in enumerate(observation.names):
        if name in known:
            error[s], count[s] = found.error[known[name]], found.effective_samples[known[name]]
        else:  # It took no part in the fit, and has its error on the same days all the same.
            error[s] = _root_mean_square(misses[seen, s])
            count[s] = effective_samples(misses[seen, s]) if np.isfinite(error[s]) else 1.0
    tail = 0.5 + 0.5 * fit.confidence
    estimates = float(stats.t.ppf(tail, found.freedom)) * np.sqrt(variance)
    # The error of a few independent samples: their scatter is known as little as their mean.
    count = np.maximum(count, 2.0)
    errors = stats.t.ppf(tail, count - 1.0) * error * np.sqrt(1.0 + 1.0 / count)
    half = np.hypot(estimates, errors)
    held = {period: _held(misses, half, use) for period, use in study.during.items()}
    return Band(fit.confidence, half, np.sqrt(variance), error, held)


def band_table(study: Study, found: Band) -> dict[str, Any]:
    """How wide the band is and how often it held, as a table of the report."""
    rows = []
    for s, name in enumerate(study.observation.names):
        sensor = study.file.sensors[name]
        unit = study.building.output(sensor.output).unit.replace("degC", "K")
        shares = [found.held[period][s] for period in study.during]
        rows.append(
            [
                sensor.label or name.replace("_", " "),
                unit,
                _number(np.mean(found.half_width[:, s])),
                *(_number(100.0 * share) for share in shares),
            ]
        )
    return {
        "title": "What the model foresaw",
        "caption": (
            f"A band of {100.0 * found.confidence:g} % about the fitted model: the uncertainty of the "
            "estimates, carried to each instant, and the size of the model's errors on the identification "
            "days, as far as so few independent ones tell it. The shares of the measured values inside show "
            "whether the errors stay as they were there. [%]"
        ),
        "columns": ["sensor", "unit", "mean half-width", *study.during],
        "rows": rows,
        "section": "comparison",
    }


def band_entry(study: Study, found: Band) -> dict[str, Any]:
    """The same for study.json: sensor -> half_width, parameters, error, held."""
    return {
        name: {
            "confidence": found.confidence,
            "half_width": _number(np.mean(found.half_width[:, s])),
            "parameters": _number(np.mean(found.parameters[:, s])),
            "error": _number(found.error[s]),
            "held": {period: _number(shares[s]) for period, shares in found.held.items()},
        }
        for s, name in enumerate(study.observation.names)
    }


def band_words(study: Study, found: Band) -> list[str]:
    """Sensors whose band held less often than it promised, in words."""
    return [
        f"{name}: the band of {100.0 * found.confidence:g} % held only {100.0 * share:.0f} % of the values "
        f"of the blind days: the model errs there in ways that the identification days did not show."
        for name, share in zip(study.observation.names, found.held["blind"], strict=True)
        if share < _NARROW
    ]


def _root_mean_square(misses: Array) -> float:
    """NaN where nothing was measured."""
    there = misses[np.isfinite(misses)]
    return float(np.sqrt(np.mean(there**2))) if there.size > 1 else float("nan")


def _series(study: Study, run: ModelRun, vectors: Array) -> Array:
    """Series (M, n, S) of all sensors at the instants of the comparison; NaN for a member that failed."""
    parts = []
    for first in range(0, len(vectors), _BATCH):
        records, _, _ = run.simulation.ensemble(vectors[first : first + _BATCH])
        parts.append(study.observation.simulated(run.simulation.index, records))
    return np.concatenate(parts)


def _held(misses: Array, half: Array, use: Flags) -> Array:
    """Share of the measured values of a period inside the band, by sensor."""
    there = np.isfinite(misses) & np.isfinite(half) & use[:, None]
    inside = there & (np.abs(np.where(there, misses, 0.0)) <= half)
    with np.errstate(invalid="ignore"):
        return np.asarray(
            np.where(there.any(axis=0), inside.sum(axis=0) / np.maximum(there.sum(axis=0), 1), np.nan)
        )


def _number(value: Any) -> float | None:
    return float(value) if np.isfinite(value) else None

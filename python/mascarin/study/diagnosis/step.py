"""The diagnosis of a study: its runs made into plain arrays, and what is found in words."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.calibration.errors.day_blocks import DayGrid
from mascarin.calibration.errors.discrepancy import DayData, hour_basis
from mascarin.calibration.errors.sensor_errors import error_columns
from mascarin.calibration.errors.stated_errors import shared_errors
from mascarin.diagnosis.causes import diagnose
from mascarin.diagnosis.hypotheses import Candidate, Diagnosis, DiagnosisInput
from mascarin.diagnosis.sensor_faults import SensorSeries, sensor_candidates, stated_errors, white_noise
from mascarin.linear_algebra import one_thread
from mascarin.progress import reporting
from mascarin.study.diagnosis import words
from mascarin.study.diagnosis.missing_paths import input_errors, missing_paths, simulated_with
from mascarin.study.diagnosis.model import DiagnosisModel, SeriesStore
from mascarin.study.diagnosis.other_laws import forms
from mascarin.study.file.description import DiscrepancyPlan
from mascarin.study.steps.error_model import scatter_of

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.calibration import Calibration
    from mascarin.diagnosis.hypotheses import Cause
    from mascarin.progress import ProgressOption
    from mascarin.study.context.context import StudyContext
    from mascarin.study.context.storage import Workspace
    from mascarin.study.steps.findings import Combination, ModelRun

    Array = npt.NDArray[np.float64]

#: A series with fewer values is not diagnosed.
_FEWEST: Final = 48
#: Fewest days on which the errors of a model can be told from a cause. [d]
_FEWEST_DAYS: Final = 3
#: Noise is named when it exceeds the stated uncertainty by this factor, at a level of 0.5 % on one side.
_NOISY: Final = 1.1
_SURE: Final = 2.58
#: No statement is more certain where only one form of the model was tried. [-]
_ONE_FORM: Final = 0.95
#: Standard deviation of a value outside of what its prior allows. [ranges]
_OUTSIDE: Final = 1.0
#: Prior of the size of another law about 1, of a missing heat flow and of an error of an input. [-]
_LAW: Final = 0.3
#: Sizes of another law: 0 is the present law, 1 the other one; a law that differs from the present one to
#: the other side explains nothing. [-]
_OF_LAW: Final = (0.0, 2.0)
_PATH: Final = 1.0
_INPUT: Final = 1.0
#: Combinations of uncertain numbers whose effect is smaller than this part of the stated uncertainty are left
#: out. [-]
_SMALL: Final = 0.03
_ROWS: Final = 400


@one_thread()
def diagnosis(
    setup: StudyContext,
    run: ModelRun,
    fit: Calibration,
    workspace: Workspace,
    *,
    combination: Combination | None = None,
    progress: ProgressOption = None,
) -> Diagnosis:
    """Find the causes of the difference between the fitted model and the measurements.

    Parameters
    ----------
    setup : StudyContext
        The study.
    run : ModelRun
        The fitted model.
    fit : Calibration
        Its calibration.
    workspace : Workspace
        Folder of the intermediate results.
    combination : Combination, optional
        Forms of the model: no statement is more certain than the weight of the one that is used.
    progress : bool, callable or None
        Where progress is shown.

    Returns
    -------
    Diagnosis
        Without causes where nothing is significant.
    """
    causes: list[Cause] = list(words.of_table(setup))
    model = DiagnosisModel(setup, run.simulation, fit, SeriesStore(workspace), progress)
    vector = run.simulation.vector(fit.values)
    with reporting(progress, "diagnosis") as report:
        noise, excess = _noise(setup, model, vector)
        causes += [words.of_noise(excess)] if excess else []
        report(0, 2)
        forms_tried = 1 if combination is None else len(combination.forms)
        inputs = diagnosis_input(setup, model, vector, _weight(combination), forms_tried)
        report(1, 2)
        if inputs is None:
            return Diagnosis(tuple(causes), noise)
        result = diagnose(inputs)
        report(2, 2)
    causes += [words.of_finding(setup, finding) for finding in result.findings]
    return Diagnosis(tuple(causes), noise, result.p, result.candidates, result.draws)


def _weight(combination: Combination | None) -> float:
    """Weight of the form that is used, no larger than that of a model without alternatives. [-]"""
    if combination is None or len(combination.forms) == 1:
        return _ONE_FORM
    return min(float(combination.weights[0]), _ONE_FORM)


def diagnosis_input(
    setup: StudyContext, model: DiagnosisModel, vector: Array, weight: float, number: int = 1
) -> DiagnosisInput | None:
    """Plain arrays of a study: residuals, known effects and candidates.

    Parameters
    ----------
    setup : StudyContext
        The study.
    model : DiagnosisModel
        Its fitted model.
    vector : ndarray, shape (P,)
        Its parameter vector. [unit of each]
    weight : float
        Of the form of the model that is used. [-]
    number : int
        Of forms of the model that were calibrated. [-]

    Returns
    -------
    DiagnosisInput or None
        None where too few values or days are compared.
    """
    mask = np.isfinite(model.measured)
    mask[:, mask.sum(axis=0) < _FEWEST] = False
    simulated = model.series(vector)
    series = _series(setup, model, mask, vector, simulated)
    days = np.unique(np.floor(model.hours / 24.0 + 1e-9))
    if not mask.any() or days.size < _FEWEST_DAYS:
        return None
    slopes = model.slopes(vector, all_paths=True)
    center, precision, _ = model.priors(model.paths, vector)
    sd = precision**-0.5
    grid = series.grid
    residual = np.where(mask, model.measured - simulated, 0.0)
    residual -= np.where(mask, np.tensordot(center, slopes, 1), 0.0)
    effects = _directions(np.moveaxis(slopes * sd[:, None, None], 0, -1), mask, series.uncertainty)
    known_effects = np.concatenate([effects, _sensor_errors(setup, model, simulated)], axis=2)
    mean, count = grid.means(residual, mask)
    basis = np.repeat(hour_basis(model.hours)[:, None, :], mask.shape[1], axis=1)
    data = DayData(
        grid,
        mean,
        np.concatenate([grid.means(known_effects, mask)[0], stated_errors(series)], axis=2),
        grid.means(basis, mask)[0],
        count > 0,
        grid.within(residual, mask),
    )
    candidates = [
        *sensor_candidates(series),
        *_parameters(model, series, vector, slopes, center, sd),
        *_laws(model, series, vector, simulated),
        *_paths(model, series, vector, simulated),
        *_inputs(setup, model, series, vector, simulated),
    ]
    span = np.array([np.ptp(y[np.isfinite(y)]) if np.isfinite(y).any() else 1.0 for y in model.measured.T])
    plan = (setup.plan.identification and setup.plan.identification.discrepancy) or DiscrepancyPlan()
    limit = np.maximum(plan.limit * span, series.uncertainty)
    used = tuple(
        candidate
        for candidate in candidates
        if np.isfinite(candidate.signature).all() and np.any(candidate.signature)
    )
    return DiagnosisInput(data, days, series.names, series.uncertainty, limit, used, weight, number)


def _series(
    setup: StudyContext, model: DiagnosisModel, mask: npt.NDArray[np.bool_], vector: Array, simulated: Array
) -> SensorSeries:
    names = setup.observation.names
    return SensorSeries(
        tuple(names),
        simulated,
        mask,
        np.array([max(setup.plan.sensors[n].expanded, 1e-9) / 1.96 for n in names]),
        model.interval,
        tuple(output.unit for output in model.simulation.outputs[: len(names)]),
        DayGrid.of(model.hours, interval=model.interval / 3600.0, sensors=len(names)),
        model.neighbours(vector),
    )


def _directions(effects: Array, mask: npt.NDArray[np.bool_], uncertainty: Array) -> Array:
    """Combinations (n, S, r) of effects (n, S, P) of one standard deviation that the record can show."""
    scaled = (effects / uncertainty[:, None])[mask]
    thinned = scaled[:: max(1, len(scaled) // (_ROWS * mask.shape[1]))]
    value, vectors = np.linalg.eigh(thinned.T @ thinned / max(len(thinned), 1))
    return np.asarray(effects @ vectors[:, value > _SMALL**2])


def _sensor_errors(setup: StudyContext, model: DiagnosisModel, simulated: Array) -> Array:
    """Effects (n, S, k) of the errors that the sensors state; an uncertainty alone is one of the offset."""
    names, errors = setup.observation.names, []
    for s, name in enumerate(names):
        sensor = setup.plan.sensors[name]
        stated = sensor.uncertainty(model.simulation.outputs[s].unit, f"sensors.{name}")
        error = shared_errors(sensor, stated, scatter_of(setup, name))
        offset = error.offset if error.offset or error.common else sensor.expanded / 1.96
        errors.append(replace(error, offset=offset))
    return error_columns(names, errors, simulated, model.interval)[0]


def _parameters(
    model: DiagnosisModel, series: SensorSeries, vector: Array, slopes: Array, center: Array, sd: Array
) -> Iterator[Candidate]:
    """Values of parameters that their priors do not allow."""
    for k, path in enumerate(model.paths):
        low, high = model.range[path]
        width, now = high - low, model.simulation.value_in(vector, path)
        parameter = model.simulation.building.parameter(path)
        # The whole change is that within the prior and that beyond it, in the ratio of their variances.
        scale, middle = width * (1.0 + (sd[k] / _OUTSIDE) ** 2), now + center[k] * width
        limits = (min((parameter.lower - middle) / scale, 0.0), max((parameter.upper - middle) / scale, 0.0))
        yield Candidate(
            "parameter", "parameter", (path,), series.grid.means(slopes[k], series.mask)[0], 0.0, _OUTSIDE,
            scale, "" if parameter.unit == "-" else parameter.unit, known=middle, limits=limits,
        )  # fmt: skip


def _laws(
    model: DiagnosisModel, series: SensorSeries, vector: Array, simulated: Array
) -> Iterator[Candidate]:
    """Other laws of parts of the model."""
    building, outputs = model.simulation.building, model.simulation.outputs[: len(series.names)]
    surfaces = list(building.surfaces)
    measured_surfaces = {
        surfaces[o.surface] for o in outputs if o.surface is not None and o.surface < len(surfaces)
    }
    for part, kind, changes in forms(building, measured_surfaces):
        other = model.of_form((part, kind), changes, vector)
        if np.isfinite(other).all():
            signature = series.grid.means(other - simulated, series.mask)[0]
            yield Candidate("form", "form", (part,), signature, 1.0, _LAW, detail=kind, limits=_OF_LAW)


def _paths(
    model: DiagnosisModel, series: SensorSeries, vector: Array, simulated: Array
) -> Iterator[Candidate]:
    """Heat flows that the model does not have."""
    for zone, what, changes, size, unit, least in missing_paths(model.simulation.building):
        other = model.of_form((zone, what), changes, vector)
        if np.isfinite(other).all():
            signature = series.grid.means(other - simulated, series.mask)[0]
            yield Candidate(
                "path", "path", (zone,), signature, 0.0, _PATH, size, unit, what,
                limits=(least / size, math.inf),
            )  # fmt: skip


def _inputs(
    setup: StudyContext, model: DiagnosisModel, series: SensorSeries, vector: Array, simulated: Array
) -> Iterator[Candidate]:
    """Errors of measured inputs of the model."""
    for error in input_errors(setup, model.simulation, vector):

        def make(forcing: Array = error.forcing) -> Array:
            return model.averaged(simulated_with(setup, model.simulation, forcing, vector))

        key = ("input", model.simulation.identity, model.group, error.what, error.subject, vector.tobytes())
        right = model.store.array(key, make)
        if np.isfinite(right).all():
            # The signature is what the readings are beside a model that is driven by the wrong input.
            signature = series.grid.means(right - simulated, series.mask)[0]
            subject, size = (error.subject,), (0.0, _INPUT, error.scale)
            yield Candidate("input", error.what, subject, signature, *size, error.unit)


def _noise(
    setup: StudyContext, model: DiagnosisModel, vector: Array
) -> tuple[dict[str, float], list[tuple[str, float, float, str]]]:
    """White noise of each sensor, and where it exceeds the stated uncertainty: name, size, error, unit."""
    # At every sample: slow errors of the model vanish in the second differences.
    interval = setup.observation.interval
    errors = setup.observation.measured - model.fine(vector)
    noise, excess = {}, []
    for s, name in enumerate(setup.observation.names):
        sd, error = white_noise(errors[:, s], interval)
        noise[name] = sd
        stated = max(setup.plan.sensors[name].expanded, 1e-9) / 1.96
        if math.isfinite(sd) and sd - _SURE * error > _NOISY * stated:
            excess.append((name, sd, error, model.simulation.outputs[s].unit))
    return noise, excess

"""The calibrated building compared with other houses, seasons and phases, of which nothing is identified."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from mascarin.errors import InputError
from mascarin.study.context.context import StudyContext
from mascarin.study.steps.calibration_result import building_with_posterior
from mascarin.study.steps.findings import metric_values
from mascarin.study.steps.model_runs import nominal
from mascarin.study.steps.prediction_intervals import interval_entries
from mascarin.study.transfer.bands import bands_of
from mascarin.study_document.analysis import TableEntry
from mascarin.study_document.comparison import MetricValues, TransferEntry, TransferScores

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.study.context.context import Scores
    from mascarin.study.steps.calibration_result import Calibrated
    from mascarin.study.steps.findings import ModelRun

#: Title of the table of the report, and its title for experiments of one study.
TITLE = "Transfer of the calibration"
EXPERIMENTS = "Experiments"
_OF_TRANSFER = (
    "Other houses, seasons and phases, of which nothing was identified: as described, and with the "
    "estimates of this study in their building."
)
_OF_EXPERIMENTS = (
    "The experiments as described, and with the estimates, which are those of all experiments of the role "
    "identification together; of those of the role validation nothing was identified. All other parts of "
    "this report are about the first one."
)
_INSIDE = (
    " Bias in %: of the mean of powers and flows. Inside: part of the measured values in the bands of the "
    "calibration. [%]"
)


def transferred(study: StudyContext, calibrated: Calibrated) -> dict[str, TransferEntry]:
    """Compare every study of ``transfer``, or every experiment, before and after the calibration.

    Parameters
    ----------
    study : StudyContext
        Names the other studies.
    calibrated : Calibrated
        Its calibration. Tied factors act on the values of the other building.

    Returns
    -------
    dict of str to TransferEntry
        By name.
    """
    identified = identified_entries(study, calibrated)
    if not study.inputs.transfer:
        return identified
    own = building_with_posterior(
        study, calibrated.run, calibrated.fit, calibrated.intervals, calibrated.combination
    )
    estimates: dict[str, float] = {}
    for context, each in zip(
        study.experiments.values(), (calibrated, *calibrated.together.values()), strict=True
    ):
        for path, value in each.fit.values.items():
            # What every experiment has for itself is not known of another one.
            if context.building.parameter(path).path not in context.inputs.own_paths:
                estimates.setdefault(path, value)
    return identified | {
        name: _compared(StudyContext(inputs), estimates, own)
        for name, inputs in study.inputs.transfer.items()
    }


def identified_entries(study: StudyContext, calibrated: Calibrated) -> dict[str, TransferEntry]:
    """The experiments that were identified together, before and after; nothing for a study of one data set.

    Parameters
    ----------
    study : StudyContext
        The first of them.
    calibrated : Calibrated
        Its calibration.
    """
    if not study.inputs.experiment:
        return {}
    return {
        name: _identified(context, calibrated if context is study else calibrated.together[name])
        for name, context in study.experiments.items()
    }


def _identified(study: StudyContext, calibrated: Calibrated) -> TransferEntry:
    bands = interval_entries(study, calibrated.intervals) if calibrated.intervals.stated else {}
    held = {sensor: band.held for sensor, band in bands.items()}
    fit, own = calibrated.fit, study.inputs.own_paths
    words = [
        f"{p.path} is {x:.4g} [{low:.4g}, {high:.4g}] {p.unit} in this experiment".replace(" - in", " in")
        for p, x, low, high in zip(
            fit.problem.parameters, fit.x.tolist(), fit.low.tolist(), fit.high.tolist(), strict=True
        )
        if study.building.parameter(p.path).path in own
    ]
    cost = float(fit.of_sensors.sum()) if fit.cost_name == "nll" else None
    described = nominal(study)
    return TransferEntry(
        building=study.building.name,
        role="identification",
        cost=cost,
        words=[*words, *_said(described, calibrated.run)],
        sound=_sound(described, calibrated.run),
        sensors=_scores(described.scores, calibrated.run, held),
    )


def described_entries(study: StudyContext) -> dict[str, TransferEntry]:
    """All experiments as described, for a comparison without a calibration.

    Parameters
    ----------
    study : StudyContext
        The first one.
    """
    if not study.inputs.experiment:
        return {}
    others = {name: StudyContext(inputs) for name, inputs in study.inputs.transfer.items()}
    return {
        name: TransferEntry(
            building=context.building.name,
            role="validation" if name in others else "identification",
            words=_said(run),
            sound=_sound(run),
            sensors=_scores(run.scores, None, {}, run),
        )
        for name, context in {**study.experiments, **others}.items()
        for run in [nominal(context)]
    }


def _compared(other: StudyContext, identified: Mapping[str, float], calibrated: Building) -> TransferEntry:
    described = nominal(other)
    estimates, missing = dict(identified), []
    for path in identified:
        try:
            other.building.parameter(path)
        except InputError:
            missing.append(path)
            del estimates[path]
    building = other.building.with_values(estimates).replace({"posterior": calibrated.posterior})
    # Ranges of factors hold for the building as described: of this one they may leave what is possible.
    plan = other.plan.model_copy(update={"identification": None, "sensitivity": None})
    moved = StudyContext(replace(other.inputs, plan=plan, building=building))
    run = nominal(moved)
    bands, words = bands_of(moved, run)
    entries = {} if bands is None else bands.entries(moved.observation, moved.used)
    unknown = f"estimates of parameters that '{other.building.name}' does not have: {', '.join(missing)}"
    lines = [unknown] if missing else []
    return TransferEntry(
        building=other.building.name,
        words=[*lines, *(word.text for word in words), *_said(described, run)],
        sound=_sound(described, run),
        sensors=_scores(described.scores, run, {sensor: entry.held for sensor, entry in entries.items()}),
    )


def _said(*runs: ModelRun) -> list[str]:
    """Warnings of runs, each once."""
    return list(dict.fromkeys(str(line) for run in runs for line in run.results.warnings))


def _sound(*runs: ModelRun) -> bool:
    return all(run.results.sound for run in runs)


def _scores(
    described: Scores,
    run: ModelRun | None,
    held: Mapping[str, Mapping[str, float | None]],
    outputs: ModelRun | None = None,
) -> dict[str, dict[str, TransferScores]]:
    """Scores by sensor and period, of a calibrated run if there is one."""
    shown = run or outputs
    assert shown is not None  # noqa: S101 (one of the two is there)
    return {
        sensor: {
            period: TransferScores(
                described=metric_values(described[sensor][period]),
                calibrated=MetricValues() if run is None else metric_values(metrics),
                held=held.get(sensor, {}).get(period),
                unit=_unit(shown, number),
            )
            for period, metrics in periods.items()
            if metrics.n
        }
        for number, (sensor, periods) in enumerate(shown.scores.items())
    }


def _unit(run: ModelRun, number: int) -> str:
    return run.results.outputs[number].unit.replace("degC", "K")


def transfer_table(study: StudyContext, transfer: Mapping[str, TransferEntry]) -> TableEntry:
    """Errors before and after, and what the bands hold, as a table of the report."""
    inputs = {
        **{name: context.inputs for name, context in study.experiments.items()},
        **study.inputs.transfer,
    }
    experiments = bool(study.inputs.experiment)
    rows = []
    for name, entry in transfer.items():
        sensors = inputs[name].plan.sensors
        who = [name, entry.role] if experiments else []
        for sensor, periods in entry.sensors.items():
            for period, scores in periods.items():
                held, before, after = scores.held, scores.described, scores.calibrated
                rows.append(
                    [
                        *who,
                        entry.building,
                        sensors[sensor].label or sensor.replace("_", " "),
                        period,
                        scores.unit,
                        before.rmse,
                        after.rmse,
                        before.bias,
                        after.bias,
                        _relative(before),
                        _relative(after),
                        None if held is None else 100.0 * held,
                    ]
                )
    return TableEntry(
        title=title_of(study),
        caption=(_OF_EXPERIMENTS if experiments else _OF_TRANSFER) + _INSIDE,
        columns=[
            *(["experiment", "role"] if experiments else []),
            "building",
            "sensor",
            "period",
            "unit",
            "rmse described",
            "rmse calibrated",
            "bias described",
            "bias calibrated",
            "bias described [%]",
            "bias calibrated [%]",
            "inside [%]",
        ],
        rows=rows,
        section="comparison",
        significant=["rmse described", "rmse calibrated", "bias described", "bias calibrated"],
    )


def _relative(metrics: MetricValues) -> float | None:
    """Bias over the mean of what was measured, of powers and flows; None for temperatures. [%]"""
    value = (metrics.model_extra or {}).get("nmbe")
    return float(value) if isinstance(value, int | float) and math.isfinite(value) else None


def title_of(study: StudyContext) -> str:
    """Title of the table and of what is said of it."""
    return EXPERIMENTS if study.inputs.experiment else TITLE


def transfer_notes(transfer: Mapping[str, TransferEntry]) -> list[str]:
    """Where the bands extrapolate, and what was not transferred, in sentences."""
    return [f"{name}: {word}" for name, entry in transfer.items() for word in entry.words]

"""The calibrated building compared with other houses, seasons and phases, of which nothing is identified."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from mascarin.errors import InputError
from mascarin.study.context.context import StudyContext
from mascarin.study.steps.calibration_result import building_with_posterior
from mascarin.study.steps.findings import metric_values
from mascarin.study.steps.model_runs import nominal
from mascarin.study.transfer.bands import bands_of
from mascarin.study_document.analysis import TableEntry
from mascarin.study_document.comparison import TransferEntry, TransferScores

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.calibration import Calibration
    from mascarin.study.steps.calibration_result import Calibrated
    from mascarin.study.steps.findings import ModelRun

#: Title of the table of the report.
TITLE = "Transfer of the calibration"


def transferred(study: StudyContext, calibrated: Calibrated) -> dict[str, TransferEntry]:
    """Compare every study of ``transfer`` before and after the estimates are put into its building.

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
    if not study.inputs.transfer:
        return {}
    own = building_with_posterior(
        study, calibrated.run, calibrated.fit, calibrated.intervals, calibrated.combination
    )
    return {
        name: _compared(StudyContext(inputs), calibrated.fit, own)
        for name, inputs in study.inputs.transfer.items()
    }


def _compared(other: StudyContext, fit: Calibration, calibrated: Building) -> TransferEntry:
    described = nominal(other)
    estimates, missing = dict(fit.values), []
    for path in fit.values:
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
    held = {} if bands is None else bands.entries(moved.observation, moved.used)
    unknown = f"estimates of parameters that '{other.building.name}' does not have: {', '.join(missing)}"
    lines = [unknown] if missing else []
    return TransferEntry(
        building=other.building.name,
        words=[*lines, *(word.text for word in words)],
        sensors={
            sensor: {
                period: TransferScores(
                    described=metric_values(described.scores[sensor][period]),
                    calibrated=metric_values(metrics),
                    held=held[sensor].held.get(period) if sensor in held else None,
                    unit=_unit(run, number),
                )
                for period, metrics in periods.items()
                if metrics.n
            }
            for number, (sensor, periods) in enumerate(run.scores.items())
        },
    )


def _unit(run: ModelRun, number: int) -> str:
    return run.results.outputs[number].unit.replace("degC", "K")


def transfer_table(study: StudyContext, transfer: Mapping[str, TransferEntry]) -> TableEntry:
    """Errors before and after, and what the bands hold, as a table of the report."""
    rows = []
    for name, entry in transfer.items():
        sensors = study.inputs.transfer[name].plan.sensors
        for sensor, periods in entry.sensors.items():
            for period, scores in periods.items():
                held = scores.held
                rows.append(
                    [
                        entry.building,
                        sensors[sensor].label or sensor.replace("_", " "),
                        period,
                        scores.unit,
                        *(
                            value
                            for before, after in [(scores.described, scores.calibrated)]
                            for value in (before.rmse, after.rmse, before.bias, after.bias)
                        ),
                        None if held is None else 100.0 * held,
                    ]
                )
    return TableEntry(
        title=TITLE,
        caption=(
            "Other houses, seasons and phases, of which nothing was identified: as described, and with the "
            "estimates of this study in their building. Inside: part of the measured values in the bands of "
            "the calibration. [%]"
        ),
        columns=[
            "building",
            "sensor",
            "period",
            "unit",
            "rmse described",
            "rmse calibrated",
            "bias described",
            "bias calibrated",
            "inside [%]",
        ],
        rows=rows,
        section="comparison",
        significant=["rmse described", "rmse calibrated", "bias described", "bias calibrated"],
    )


def transfer_notes(transfer: Mapping[str, TransferEntry]) -> list[str]:
    """Where the bands extrapolate, and what was not transferred, in sentences."""
    return [f"{name}: {word}" for name, entry in transfer.items() for word in entry.words]

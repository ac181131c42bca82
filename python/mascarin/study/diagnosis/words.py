"""Causes in words: what was found, its size, how certain it is, and what to check."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

import pandas as pd

from mascarin._io.numbers import in_percent, with_uncertainty
from mascarin.diagnosis.hypotheses import GROUPS, WORDS, Cause

if TYPE_CHECKING:
    from mascarin.diagnosis.causes import CauseEstimate
    from mascarin.diagnosis.hypotheses import Candidate, Diagnosis
    from mascarin.study.context.context import StudyContext

#: Kinds of suspicious values that are faults of data.
_FAULTY: Final = ("stuck", "forward_filled", "interpolated", "copied")
#: What to check, by kind of a fault of a sensor.
_CHECKS: Final = {
    "offset": "check its calibration",
    "step": "check what was changed at the sensor or its logger then",
    "gain": "check the gain and the unit of its column",
    "scale": "check the gain and the unit of its column",
    "drift": "check its calibration before and after",
    "clock": "check the clock or the time zone of its logger",
    "clock_step": "check the clock or daylight saving of its logger",
    "place": "check the place and the depth of the sensor",
}
#: Said where a cause is named.
NOT_BLIND: Final = (
    "The diagnosis uses all days that are compared. Whoever changes the model or the data because of it is "
    "no longer blind on these days: validate the change with measurements that were not used here."
)


def of_table(setup: StudyContext) -> Iterator[Cause]:
    """Stretches of the sensors' columns that were not measured, the longest first."""
    sensors = {column: name for name, sensor in setup.plan.sensors.items() for column in sensor.columns}
    stretches = [s for s in setup.quality if s.channel in sensors and s.kind in _FAULTY]
    for stretch in sorted(stretches, key=lambda part: -part.count):
        left_out = (
            "they are left out of all comparisons"
            if setup.inputs.leaves_out(stretch)
            else f"leave them out with quality: {{mask: [{stretch.kind}]}}"
        )
        name = sensors[stretch.channel]
        yield Cause(
            "data", stretch.kind, (name,),  # type: ignore[arg-type]
            f"{name}: {stretch.count} {WORDS[stretch.kind]} from {stretch.start:%Y-%m-%d %H:%M} to "
            f"{stretch.end:%Y-%m-%d %H:%M} ({stretch.detail}); {left_out}.",
            float(stretch.count), math.nan, "-",
        )  # fmt: skip


def of_noise(excess: Sequence[tuple[str, float, float, str]]) -> Cause:
    """White noise above the stated uncertainty: name, size, its standard error and unit of each sensor."""
    shown = ", ".join(f"{name} {sd:.2g} {unit.replace('degC', 'K')}" for name, sd, _, unit in excess)
    _, sd, error, unit = max(excess, key=lambda sensor: sensor[1])
    text = (
        f"White noise above the stated uncertainty: {shown}. It is independent from sample to sample: no "
        "model takes it away. State it as the repeatability, or use means over longer intervals."
    )
    return Cause(
        "data", "noise", tuple(sensor[0] for sensor in excess), text, sd, error, unit.replace("degC", "K")
    )


def of_finding(setup: StudyContext, finding: CauseEstimate) -> Cause:
    """A cause that the residuals name, or the candidates that they cannot tell apart."""
    candidate, since = finding.candidate, _since(setup, finding.candidate.start)
    statement = _statement(setup, finding, since)
    evidence = (
        f"In records without any cause something explains as much in {in_percent(finding.p)} of cases (p "
        f"{finding.p:.2g})"
    )
    if finding.told:
        text = (
            f"{statement}. {evidence}; that it is this and no other candidate has a probability of "
            f"{in_percent(finding.certainty)}."
        )
    else:
        alternatives = "; ".join(_short(setup, other) for other in finding.others)
        if candidate.group != "data":
            alternatives = "; ".join(
                filter(None, (alternatives, "an error of the model that is not among the candidates"))
            )
        text = (
            f"Cannot tell: the residuals have a cause, but the measurements do not tell which candidate. "
            f"{evidence}. The most probable of them, with {in_percent(finding.certainty)}, is: {statement}. "
            f"It may as well be: {alternatives or 'none of the candidates'}."
        )
    return Cause(
        candidate.group, candidate.what, candidate.subject, text, finding.value, finding.error,
        candidate.unit, finding.p, finding.certainty, finding.log_bayes_factor, finding.told,
        tuple(_short(setup, other) for other in finding.others),
    )  # fmt: skip


def summary(diagnosis: Diagnosis) -> list[str]:
    """What the diagnosis says as a whole: nothing significant, or that the days are no longer blind."""
    tested = [cause for cause in diagnosis.causes if math.isfinite(cause.p)]
    if tested:
        return [NOT_BLIND]
    if not math.isfinite(diagnosis.p):
        return []
    return [
        f"No cause is named: of {diagnosis.candidates} candidates (sensors, inputs, model) the best one "
        f"explains no more than is usual in records without any cause (p {diagnosis.p:.2g})."
    ]


def _statement(setup: StudyContext, finding: CauseEstimate, since: str) -> str:
    """What is wrong if the candidate is the cause, with its size."""
    candidate, size = finding.candidate, _size(finding)
    what, subject = candidate.what, " and ".join(candidate.subject)
    if candidate.group == "data":
        return (
            f"{_of_sensor(setup, finding, since)}: {_CHECKS[what]}"
            if what in _CHECKS
            else _of_sensor(setup, finding, since)
        )
    if candidate.group == "input":
        errors = {
            "gain": f"reads {size} too {_side(finding.value)}",
            "offset": f"reads {size} too {_side(finding.value)}",
            "clock": f"is {size} {'late' if finding.value > 0.0 else 'early'}",
        }
        return f"Input {subject}: the measured input {errors[what]}: check the instrument and its mounting"
    if candidate.group == "parameter":
        return (
            f"{subject}: a value of {_with_error(finding.value, finding)}"
            + ", outside of what its prior allows, explains "
            "the measurements better: check the number, or what the model lacks beside it"
        )
    if candidate.group == "path":
        side = "missing" if finding.value > 0.0 else "too much"
        return f"Zone {subject}: {side} {candidate.detail}, about {size}"
    return f"{subject}: the law '{candidate.detail}' explains the measurements better than the present one"


def _of_sensor(setup: StudyContext, finding: CauseEstimate, since: str) -> str:
    candidate, size, name = finding.candidate, _size(finding), finding.candidate.subject[0]
    match candidate.what:
        case "swapped" | "swap_step":
            columns = [", ".join(setup.plan.sensors[sensor].columns) for sensor in candidate.subject]
            names = f"{name} and {candidate.subject[1]}"
            return f"{names}: the columns {columns[0]} and {columns[1]} are exchanged{since}"
        case "clock" | "clock_step":
            return f"{name}: its series is {size} {'late' if finding.value > 0.0 else 'early'}{since}"
        case "offset" | "step":
            return f"{name}: it reads {size} too {_side(finding.value)}{since or ' at all times'}"
        case "gain":
            return f"{name}: it reads {size} too {_side(finding.value)}"
        case "scale":
            return f"{name}: it reads {size} too {_side(finding.value)} about its mean"
        case "drift":
            return f"{name}: it drifts by {size} {'up' if finding.value > 0.0 else 'down'} over the record"
        case _:
            return f"{name}: its series contains {size} of {candidate.detail.removeprefix('part of ')}"


def _short(setup: StudyContext, candidate: Candidate) -> str:
    """A candidate in few words."""
    subject, detail = " and ".join(candidate.subject), candidate.detail or WORDS[candidate.what]
    return f"{subject}: {GROUPS[candidate.group]}, {detail}{_since(setup, candidate.start)}"


def _since(setup: StudyContext, start: float) -> str:
    """From when on; empty for the whole record."""
    if not math.isfinite(start):
        return ""
    times = setup.observation.times
    zone = pd.DatetimeIndex(setup.measurements.data.index).tz
    local = (times if times.tz is None else times.tz_convert(zone)).tz_localize(None)
    return f" from about {local[0].normalize() + pd.Timedelta(hours=start):%Y-%m-%d %H:%M} on"


def _size(finding: CauseEstimate) -> str:
    return _with_error(abs(finding.value), finding)


def _with_error(size: float, finding: CauseEstimate) -> str:
    value = with_uncertainty(size, finding.error)
    error = with_uncertainty(finding.error, finding.error) if finding.error > 0.0 else ""
    return f"{value}{f' ± {error}' if error else ''} {finding.candidate.unit}".rstrip()


def _side(value: float) -> str:
    return "high" if value > 0.0 else "low"

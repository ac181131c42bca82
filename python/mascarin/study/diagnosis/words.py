"""Causes in words: what was found, its size, how certain it is, and what to check."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

import pandas as pd

from mascarin._io.numbers import with_uncertainty
from mascarin.diagnosis.hypotheses import GROUPS, WORDS, Cause

if TYPE_CHECKING:
    from mascarin.diagnosis.causes import Finding
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
    for stretch in sorted(stretches, key=lambda one: -one.count):
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
    _, sd, error, unit = max(excess, key=lambda one: one[1])
    text = (
        f"White noise above the stated uncertainty: {shown}. It is independent from sample to sample: no "
        "model takes it away. State it as the repeatability, or use means over longer intervals."
    )
    return Cause("data", "noise", tuple(one[0] for one in excess), text, sd, error, unit.replace("degC", "K"))


def of_finding(setup: StudyContext, found: Finding) -> Cause:
    """A cause that the residuals name, or the candidates that they cannot tell apart."""
    one, since = found.candidate, _since(setup, found.candidate.start)
    statement = _statement(setup, found, since)
    evidence = (
        f"In records without any cause something explains as much in {_percent(found.p)} of cases (p "
        f"{found.p:.2g})"
    )
    if found.told:
        text = (
            f"{statement}. {evidence}; that it is this and no other candidate has a probability of "
            f"{_percent(found.certainty)}."
        )
    else:
        others = "; ".join(_short(setup, other) for other in found.others)
        if one.group != "data":
            others = "; ".join(
                filter(None, (others, "an error of the model that is not among the candidates"))
            )
        text = (
            f"Cannot tell: the residuals have a cause, but the measurements do not tell which candidate. "
            f"{evidence}. The most probable of them, with {_percent(found.certainty)}, is: {statement}. "
            f"It may as well be: {others or 'none of the candidates'}."
        )
    return Cause(
        one.group, one.what, one.subject, text, found.value, found.error, one.unit, found.p, found.certainty,
        found.log_bayes_factor, found.told, tuple(_short(setup, other) for other in found.others),
    )  # fmt: skip


def summary(found: Diagnosis) -> list[str]:
    """What the diagnosis says as a whole: nothing significant, or that the days are no longer blind."""
    tested = [cause for cause in found.causes if math.isfinite(cause.p)]
    if tested:
        return [NOT_BLIND]
    if not math.isfinite(found.p):
        return []
    return [
        f"No cause is named: of {found.candidates} candidates (sensors, inputs, model) the best one explains "
        f"no more than is usual in records without any cause (p {found.p:.2g})."
    ]


def _statement(setup: StudyContext, found: Finding, since: str) -> str:
    """What is wrong if the candidate is the cause, with its size."""
    one, size = found.candidate, _size(found)
    what, subject = one.what, " and ".join(one.subject)
    if one.group == "data":
        return (
            f"{_of_sensor(setup, found, since)}: {_CHECKS[what]}"
            if what in _CHECKS
            else _of_sensor(setup, found, since)
        )
    if one.group == "input":
        errors = {
            "gain": f"reads {size} too {_side(found.value)}",
            "offset": f"reads {size} too {_side(found.value)}",
            "clock": f"is {size} {'late' if found.value > 0.0 else 'early'}",
        }
        return f"Input {subject}: the measured input {errors[what]}: check the instrument and its mounting"
    if one.group == "parameter":
        value = with_uncertainty(found.value, found.error)
        return (
            f"{subject}: a value of {value} {one.unit}".rstrip()
            + ", outside of what its prior allows, explains "
            "the measurements better: check the number, or what the model lacks beside it"
        )
    if one.group == "path":
        side = "missing" if found.value > 0.0 else "too much"
        return f"Zone {subject}: {side} {one.detail}, about {size}"
    return f"{subject}: the law '{one.detail}' explains the measurements better than the present one"


def _of_sensor(setup: StudyContext, found: Finding, since: str) -> str:
    one, size, name = found.candidate, _size(found), found.candidate.subject[0]
    match one.what:
        case "swapped" | "swap_step":
            columns = [", ".join(setup.plan.sensors[sensor].columns) for sensor in one.subject]
            return (
                f"{name} and {one.subject[1]}: the columns {columns[0]} and {columns[1]} are exchanged{since}"
            )
        case "clock" | "clock_step":
            return f"{name}: its series is {size} {'late' if found.value > 0.0 else 'early'}{since}"
        case "offset" | "step":
            return f"{name}: it reads {size} too {_side(found.value)}{since or ' at all times'}"
        case "gain":
            return f"{name}: it reads {size} too {_side(found.value)}"
        case "scale":
            return f"{name}: it reads {size} too {_side(found.value)} about its mean"
        case "drift":
            return f"{name}: it drifts by {size} {'up' if found.value > 0.0 else 'down'} over the record"
        case _:
            return f"{name}: its series contains {size} of {one.detail.removeprefix('part of ')}"


def _short(setup: StudyContext, one: Candidate) -> str:
    """A candidate in few words."""
    return f"{' and '.join(one.subject)}: {GROUPS[one.group]}, {one.detail or WORDS[one.what]}" + _since(
        setup, one.start
    )


def _since(setup: StudyContext, start: float) -> str:
    """From when on; empty for the whole record."""
    if not math.isfinite(start):
        return ""
    times = setup.observation.times
    zone = pd.DatetimeIndex(setup.measurements.data.index).tz
    local = (times if times.tz is None else times.tz_convert(zone)).tz_localize(None)
    return f" from about {local[0].normalize() + pd.Timedelta(hours=start):%Y-%m-%d %H:%M} on"


def _size(found: Finding) -> str:
    value = with_uncertainty(abs(found.value), found.error)
    error = with_uncertainty(found.error, found.error) if found.error > 0.0 else ""
    return f"{value}{f' ± {error}' if error else ''} {found.candidate.unit}".rstrip()


def _percent(share: float) -> str:
    """A probability in percent that is never rounded to certainty."""
    percent = 100.0 * share
    if percent < 0.1:
        return f"{percent:.2g} %"
    return f"{math.floor(percent) if percent >= 10.0 else round(percent, 1):g} %"


def _side(value: float) -> str:
    return "high" if value > 0.0 else "low"

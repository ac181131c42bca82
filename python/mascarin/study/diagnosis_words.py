"""Causes in words: what was found, its size, and what to check."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

import pandas as pd

from mascarin._io.numbers import with_interval
from mascarin.validation.hypotheses import WORDS, Cause

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from mascarin.study.diagnosis_model import Model
    from mascarin.study.setup import Setup
    from mascarin.validation.sensor_faults import Fault

    Array = npt.NDArray[np.float64]

#: Kinds of suspicious values that are faults of data.
_FAULTY: Final = ("stuck", "forward_filled", "interpolated", "copied")
#: Parts of a building that are laws: a coefficient of one belongs to its form.
_LAWS: Final = (".convection", "site.sky", "site.cloud", ".longwave")
_NORMAL_95: Final = 1.96


def of_table(setup: Setup) -> Iterator[Cause]:
    """Stretches of the sensors' columns that were not measured, the longest first."""
    sensors = {column: name for name, sensor in setup.plan.sensors.items() for column in sensor.columns}
    stretches = [s for s in setup.quality if s.channel in sensors and s.kind in _FAULTY]
    for stretch in sorted(stretches, key=lambda one: -one.count):
        left_out = (
            "they are left out of all comparisons"
            if setup.leaves_out(stretch)
            else f"leave them out with quality: {{mask: [{stretch.kind}]}}"
        )
        name = sensors[stretch.channel]
        yield Cause(
            "data", stretch.kind, (name,),  # type: ignore[arg-type]
            f"{name}: {stretch.count} {WORDS[stretch.kind]} from {stretch.start:%Y-%m-%d %H:%M} to "
            f"{stretch.end:%Y-%m-%d %H:%M} ({stretch.detail}); {left_out}.",
            float(stretch.count), math.nan, "-",
        )  # fmt: skip


def of_fault(
    setup: Setup,
    names: Sequence[str],
    units: Sequence[str],
    fault: Fault,
    p: float,
    share: float,
    group: int = 1,
) -> Cause:
    """A fault of a sensor, found in means over `group` samples."""
    when = _when(setup, fault.rows, group)
    subject = tuple(names[s] for s in fault.sensors)
    unit = units[fault.sensors[0]].replace("degC", "K")
    value, error, of = fault.value, fault.error, unit
    name, daylight = subject[0], "daylight saving" if when else "the time zone"
    if fault.what == "swapped":
        columns = [", ".join(setup.plan.sensors[one].columns) for one in subject]
        text = (
            f"{subject[0]} and {subject[1]}: the columns {columns[0]} and {columns[1]} are exchanged{when}; "
            "each series fits the other output"
        )
        of = ""
    elif fault.what == "clock":
        value, error, of = value / 60.0, error / 60.0, "min"
        side = "late" if value > 0.0 else "early"
        text = (
            f"{name}: its series is {_size(abs(value), error, 'min')} {side}{when}, at all frequencies "
            f"alike: check the clock or {daylight} of its logger"
        )
    elif fault.what == "offset" and when:
        text = (
            f"{name}: it reads {_size(abs(value), error, unit)} too {_side(value)}{when}: check what was "
            "changed at the sensor or its logger then"
        )
    elif fault.what == "offset":
        text = (
            f"{name}: it reads {_size(abs(value), error, unit)} too {_side(value)} at all times, more than "
            "its stated uncertainty allows: check its calibration"
        )
    elif fault.what in ("gain", "scale"):
        value, error, of = 100.0 * value, 100.0 * error, "%"
        about = "" if fault.what == "gain" else " about its mean"
        text = (
            f"{name}: it reads {_size(abs(value), error, '%')} too {_side(value)}{about}: check the gain and "
            "the unit of its column"
        )
    elif fault.what == "drift":
        text = (
            f"{name}: it drifts by {_size(abs(value), error, unit)} {'up' if value > 0 else 'down'} over the "
            "record: check its calibration before and after"
        )
    else:
        value, error, of = 100.0 * value, 100.0 * error, "%"
        text = (
            f"{name}: its series contains {_size(value, error, '%')} of {fault.neighbour}: check the place "
            "and the depth of the sensor"
        )
    return Cause(
        "data", fault.what, subject, f"{text}.{_evidence(p, share)}", value, error, of, p, share,  # type: ignore[arg-type]
        fault.deviance,
    )  # fmt: skip


def of_noise(excess: Sequence[tuple[str, float, float, str]], share: float) -> Cause:
    """White noise above the stated uncertainty."""
    shown = ", ".join(f"{name} {sd:.2g} {unit.replace('degC', 'K')}" for name, sd, _, unit in excess)
    _, sd, error, unit = max(excess, key=lambda one: one[1])
    text = (
        f"White noise above the stated uncertainty: {shown}. It is independent from sample to sample: no "
        "model takes it away. State it as the uncertainty, or use means over longer intervals. It is "
        f"{100.0 * share:.0f} % of the remaining sum of squares."
    )
    return Cause(
        "data", "noise", tuple(one[0] for one in excess), text, sd, error, unit.replace("degC", "K"),
        0.005, share,
    )  # fmt: skip


def of_parameter(
    model: Model,
    path: str,
    vector: Array,
    change: tuple[float, float, bool],
    p: float,
    share: float,
    gain: float,
    same: Sequence[str],
) -> Cause:
    """Another value of a parameter that was not calibrated."""
    parameter = model.simulation.building.parameter(path)
    low, high = model.range[path]
    now = model.simulation.value_in(vector, path)
    value, error = now + change[0] * (high - low), change[1] * (high - low)
    unit = "" if parameter.unit == "-" else f" {parameter.unit}"
    if change[2]:
        found = f"{value:.4g}{unit}, the end of its range,"
    else:
        reach = _NORMAL_95 * error
        shown = with_interval(value, value - reach, value + reach)
        found = f"{shown[0]}{unit} (95 %: {shown[1]} to {shown[2]})"
    part = _law(path)
    what = f"{part}: the law or its coefficient {path.removeprefix(part + '.')}" if part else path
    text = f"{what}: {found} instead of {now:.4g}{unit} explains the measurements better"
    if same:
        text += f"; {', '.join(same)} cannot be distinguished from it"
    return Cause(
        "form" if part else "parameter", "form" if part else "parameter",
        (part, path) if part else (path,), f"{text}.{_evidence(p, share)}", value, error, parameter.unit,
        p, share, gain, tuple(same),
    )  # fmt: skip


def of_form(part: str, kind: str, p: float, share: float, gain: float, same: Sequence[str]) -> Cause:
    """Another form of a law."""
    text = f"{part}: the model '{kind}' explains the measurements better than the present one"
    if same:
        text += f"; so do {', '.join(same)}"
    return Cause(
        "form", "form", (part,), f"{text}.{_evidence(p, share)}", unit=kind, p=p, share=share, deviance=gain,
        same=tuple(same),
    )  # fmt: skip


def _law(path: str) -> str:
    """The part of a building that is a law and has this coefficient; empty for any other number."""
    for law in _LAWS:
        at = path.find(law)
        if at >= 0 and path[at + len(law) : at + len(law) + 1] == ".":
            return path[: at + len(law)]
    return ""


def _evidence(p: float, share: float) -> str:
    shown = "below 0.001" if p < 0.001 else f"{p:.3f}"
    percent = 100.0 * share
    if percent >= 0.5:
        return f" It takes away {percent:.0f} % of the remaining sum of squares (p {shown})."
    return (
        " It improves single sensors; the remaining sum of squares over all falls by less than 1 % "
        f"(p {shown})."
    )


def _when(setup: Setup, rows: tuple[int, int] | None, group: int) -> str:
    """From when on, or until when; empty for the whole record."""
    if rows is None:
        return ""
    times = setup.observation.times
    zone = pd.DatetimeIndex(setup.measurements.data.index).tz
    local = times if times.tz is None else times.tz_convert(zone)
    if rows[0] == 0:
        return f" until {local[min(rows[1] * group, len(local) - 1)]:%Y-%m-%d %H:%M}"
    return f" from {local[rows[0] * group]:%Y-%m-%d %H:%M} on"


def _size(value: float, error: float, unit: str) -> str:
    digits = 0 if value == 0.0 else max(0, 1 - math.floor(math.log10(value)))
    spread = f" ± {error:.{digits}f}" if math.isfinite(error) and error > 0.0 else ""
    return f"{value:.{digits}f}{spread} {unit}"


def _side(value: float) -> str:
    return "high" if value > 0.0 else "low"

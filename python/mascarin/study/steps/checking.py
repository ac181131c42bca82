"""Checks of a whole study, before the first run and before anything is written."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin._io.durations import seconds_of
from mascarin._io.limits import above, below
from mascarin.calibration.building_calibration import CONSTANT, MAX_CONSTANT_SHARE
from mascarin.calibration.errors.stated_errors import require_errors
from mascarin.errors import InputError
from mascarin.measurements.observation import require_comparable
from mascarin.study.context.error_rule import reason_of, states_errors
from mascarin.study.context.periods import overlap
from mascarin.study.steps.comfort import require_rooms

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.building import Building
    from mascarin.study.context.context import StudyContext
    from mascarin.study.context.periods import PeriodSpan

#: Measured temperatures of a building lie between these. [degC]
_TEMPERATURES: Final = (-100.0, 200.0)
#: Shortest identification from which errors that change from day to day can be estimated. [h]
_FEWEST_HOURS: Final = 48.0
#: An irradiance that never exceeds this may be in kW/m2. [W/m2]
_DARK: Final = 2.0


def check(study: StudyContext) -> None:
    """Check everything that a run needs.

    Parameters
    ----------
    study : StudyContext
        Its names are checked already.

    Raises
    ------
    InputError
        File, line and entry of the study, what was found, what was expected, what to do.
    """
    for other in study.together.values():
        check(other)
    _periods(study)
    with study.places.blame("periods"):
        _ = study.models.nominal
    _errors(study)
    _sampled(study)
    require_rooms(study)
    _working(study)
    _runs(study)
    _plausible(study)
    _elsewhere(study)


def _elsewhere(study: StudyContext) -> None:
    """Refuse to use the same data twice: one table, common columns and common times."""
    records = [(f"'{study.inputs.experiment}'" if study.inputs.experiment else "this study", study)]
    key = "experiments" if study.inputs.experiment else "transfer"
    for name, inputs in {**study.inputs.together, **study.inputs.transfer}.items():
        other = study.together.get(name) or type(study)(inputs)
        place = (name,) if key == "experiments" else (name, "study")
        if name not in study.together and key == "experiments":
            check(other)
        with study.inputs.file_places.blame(key, *place):
            if key == "transfer":
                check(other)
            for before, earlier in records:
                _apart_from(before, earlier, other)
        records.append((f"'{name}'", other))


def _apart_from(before: str, earlier: StudyContext, other: StudyContext) -> None:
    """Refuse a record that another one has already: of the same columns of a table at the same time."""
    known_inputs, inputs = earlier.inputs, other.inputs
    if known_inputs.hashes["measurements"] != inputs.hashes["measurements"]:
        return
    common = known_inputs.measured_columns & inputs.measured_columns
    for span in _compared(other) if common else ():
        for known in _compared(earlier):
            if span.overlaps(known):
                raise InputError(
                    f"found {span.words} of the table that {before} compares from {known.words} (column "
                    f"{min(common)}), expected another table, other columns, or times that the two do not "
                    "share: correct 'measurements' or 'periods' of one of them"
                )


def _compared(study: StudyContext) -> list[PeriodSpan]:
    timeline = study.periods.timeline
    return [*timeline.every("identification"), *timeline.every("corroboration")]


def _periods(study: StudyContext) -> None:
    blame, (first, last) = study.places.blame, study.periods.record
    given = study.periods.moment_of_end
    with blame("periods", "end"):
        if given is not None and not first < given <= last:
            raise InputError(
                f"found {given:%Y-%m-%d %H:%M}, expected a time inside what climate and measurements both "
                f"cover, {_words(first, last)} ({study.climate.timezone}); leave it out, or move it"
            )
    last = last if given is None else given
    covered = (
        f"and periods.end leave, {_words(first, last)}" if given else f"both cover, {_words(first, last)}"
    )
    timeline, warm_up = study.periods.timeline, study.periods.timeline.warm_up()
    known, held = timeline.every("identification"), timeline.every("corroboration")
    for span in (*([] if warm_up is None else [warm_up]), *known, *held):
        with blame(*span.place):
            if not (first <= span.start and span.end <= last):
                raise InputError(
                    f"found {span.words}, expected a period inside what climate and measurements "
                    f"{covered} ({study.climate.timezone}); move it"
                )
    for sensor in study.plan.sensors:
        _apart(study, sensor)
    for span in known:
        with blame(*span.place):
            if warm_up is not None and span.start < warm_up.end:
                raise InputError(
                    f"found {span.words}, expected a start not before the warm-up ends, "
                    f"{warm_up.end:%Y-%m-%d %H:%M}: nothing is compared until then; move one of the two"
                )
    _ = timeline.every("exclude")


def _apart(study: StudyContext, sensor: str) -> None:
    """Refuse periods of one sensor that overlap."""
    known = study.periods.timeline.spans("identification", sensor)
    held = study.periods.timeline.spans("corroboration", sensor)
    for name, spans in (("identification", known), ("corroboration", held)):
        twice = next(((a, b) for k, a in enumerate(spans) for b in spans[:k] if a.overlaps(b)), None)
        if twice is not None:
            with study.places.blame(*twice[0].place):
                raise InputError(
                    f"found {twice[0].words}, which overlaps {twice[1].words}; expected {name} periods that "
                    "have no instant in common: join them, or move one of the two"
                )
    both = overlap(known, held)
    if both is not None:
        with study.places.blame(*both[1].place):
            raise InputError(
                f"found {both[1].words}, which overlaps the identification {both[0].words}; expected days "
                "that the identification does not use: move one of the two"
            )


def _errors(study: StudyContext) -> None:
    """Refuse an identification from which errors of sensors and model cannot be estimated."""
    plan = study.plan.identification
    if plan is None:
        return
    hours = study.hours
    if plan.independent is not None and seconds_of(plan.independent) >= hours * 3600.0:
        with study.places.blame("identification", "independent"):
            raise InputError(
                f"found {plan.independent}, but the identification lasts {hours:g} h; expected errors that "
                "last shorter than it: make the identification longer, or independent shorter"
            )
    if not states_errors(study.plan):
        return
    leave_out = "or leave out discrepancy, alternatives and the errors of the sensors"
    if plan.method == "emcee":
        with study.places.blame("identification", "method"):
            raise InputError(
                "found emcee in a study that estimates errors of sensors and model, which it would not "
                f"sample; expected a method that finds a minimum: write least-squares, {leave_out}"
            )
    if plan.profiles:
        with study.places.blame("identification", "profiles"):
            raise InputError(
                "found true in a study that estimates errors of sensors and model, which a profile would "
                "hold at zero; expected false: the intervals of the estimates account for these errors "
                f"already; leave profiles out, {leave_out}"
            )
    if hours < _FEWEST_HOURS:
        with study.places.blame("periods", "identification"):
            raise InputError(
                f"found {hours:g} h, expected at least {_FEWEST_HOURS:g} h: errors that change from day to "
                "day are estimated, and days are left out in turn; make it longer, or leave out discrepancy, "
                "alternatives and the errors of the sensors"
            )
    _persistence(study, hours)
    for name, variant in study.plan.variants.items():
        if variant.candidate:
            with study.places.blame("variants", name, "candidate"):
                raise InputError(
                    "found true in a study that estimates errors of sensors and model, expected "
                    "alternatives, which are weighed with these errors; move it there, or leave candidate out"
                )
    _ = study.variants.forms


def _sampled(study: StudyContext) -> None:
    """Refuse to sample a posterior without errors of sensors and model."""
    plan = study.plan.identification
    if plan is None or study.estimates_errors:
        return
    reason = reason_of(study.plan, study.hours) or "all sensors state that they have none"
    with study.places.blame("identification", "posterior"):
        require_errors(plan.posterior, reason, "posterior")


def _persistence(study: StudyContext, hours: float) -> None:
    """Refuse a statement that errors of days last longer than the days from which they are estimated."""
    discrepancy = study.inputs.calibration_plan.discrepancy
    if discrepancy is None or "persistence" not in discrepancy.model_fields_set:
        return
    if hours < seconds_of(discrepancy.persistence) / 3600.0:
        with study.places.blame("identification", "discrepancy", "persistence"):
            raise InputError(
                f"found {discrepancy.persistence}, but the identification lasts {hours:g} h; expected errors "
                "of days that last shorter than it: make the identification longer, or persistence shorter"
            )


def _words(first: pd.Timestamp, last: pd.Timestamp) -> str:
    return f"{first:%Y-%m-%d %H:%M} .. {last:%Y-%m-%d %H:%M}"


def _working(study: StudyContext) -> None:
    """Refuse to calibrate with a sensor that repeats its value, unless the study says that it is masked."""
    start, end = study.periods.identification
    for name, sensor in study.plan.sensors.items():
        # What is left out by default may not be most of the identification; who writes it knows.
        written = study.plan.quality.mask if "mask" in study.plan.quality.model_fields_set else ()
        kinds = [kind for kind in CONSTANT if kind not in written]
        for stretch in study.quality:
            if not sensor.use or stretch.channel not in sensor.columns or stretch.kind not in kinds:
                continue
            shared = (min(end, stretch.end) - max(start, stretch.start)).total_seconds()
            if shared > MAX_CONSTANT_SHARE * (end - start).total_seconds():
                with study.places.blame("sensors", name, "column"):
                    raise InputError(
                        f"found column {stretch.channel} {stretch.kind.replace('_', '-')} from "
                        f"{stretch.start:%Y-%m-%d %H:%M} to {stretch.end:%Y-%m-%d %H:%M} ({stretch.detail}), "
                        "over most of the identification; expected a working sensor: write "
                        f"quality: {{mask: [{stretch.kind}]}}, use: false, or choose another period"
                    )


def _runs(study: StudyContext) -> None:
    """Compile every model and set up every calibration, so that their errors are raised now."""
    file, blame = study.plan, study.places.blame
    _require_validation_days(study)
    for period in ("identification", "corroboration"):
        for name in (name for name, sensor in file.sensors.items() if sensor.use):
            s = study.observation.names.index(name)
            with blame("sensors", name):
                require_comparable(study.observation, study.used[period][:, s], period, [name])
    if file.identification is not None:
        with study.inputs.file_places.blame("identification"):
            _ = study.problem()
    for name, variant in file.variants.items():
        with blame("variants", name):
            study.models.over_record(name)
            if variant.identify and file.identification is not None:
                study.problem(name)
    for part, forms in study.variants.forms.parts.items():
        for form in forms:
            with blame("alternatives", part):
                study.problem(study.variants.variant_of(study.variants.forms.of({part: form})))


def _require_validation_days(study: StudyContext) -> None:
    """Refuse a study without measured instants outside of the identification period."""
    if study.during["corroboration"].any():
        return
    held = study.periods.timeline.spans("corroboration")
    with study.places.blame("periods", "corroboration" if held else "identification"):
        why = "a model is validated on days that the identification does not use"
        if held:
            raise InputError(
                f"found {', '.join(span.words for span in held)}, which contains no measured instant; {why}: "
                "make it longer"
            )
        raise InputError(
            f"found {_words(*study.periods.identification)}, which leaves nothing of the record, up to "
            f"{study.periods.end:%Y-%m-%d %H:%M}, for the comparison; {why}: end it earlier, or give a "
            "corroboration period before it"
        )


def _plausible(study: StudyContext) -> None:
    """Refuse temperatures that are error codes; warn of irradiances that look like kW/m2."""
    low, high = _TEMPERATURES
    observation = study.observation
    for s, name in enumerate(observation.names):
        if study.models.nominal.outputs[s].unit != "degC":
            continue
        measured = observation.measured[:, s]
        outside = np.flatnonzero(below(measured, low) | above(measured, high))
        if outside.size:
            value = measured[outside[0]]
            with study.places.blame("sensors", name, "column"):
                raise InputError(
                    f"found {value:g} at {observation.times[outside[0]]:%Y-%m-%d %H:%M} ({outside.size} such "
                    f"values), expected a temperature from {low:g} to {high:g} degC; if it marks a missing "
                    f"value write missing: [{value:g}] in measurements, else mask: [out_of_range] in quality"
                )
    for name in _irradiances(study.building):
        highest = float(np.nanmax(study.measurements.series(name)))
        if 0.0 < highest < _DARK:
            warnings.warn(
                f"{study.measurements.file}: the irradiance {name} is {highest:g} W/m2 at most; is it kW/m2?",
                stacklevel=2,
            )


def _irradiances(building: Building) -> list[str]:
    """Measured columns that are irradiances."""
    sides = [side for surface in building.surfaces.values() for side in (surface.outside, surface.inside)]
    return list(dict.fromkeys(side.irradiance for side in sides if side.irradiance is not None))

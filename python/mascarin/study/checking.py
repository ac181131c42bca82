"""Everything that can be refused in a study, refused before the first run and before anything is written."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Final

from mascarin.calibration.building_calibration import CONSTANT, MOST_CONSTANT
from mascarin.errors import InputError, did_you_mean
from mascarin.study.calibration_step import free_parameter
from mascarin.study.sensitivity_step import check_plan
from mascarin.validation.observation import PERIODS, require_comparable

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd

    from mascarin.building import Building
    from mascarin.study.locations import Faults
    from mascarin.study.pipeline import Study

#: Measured temperatures of a building lie between these. [degC]
_TEMPERATURES: Final = (-100.0, 200.0)
#: An irradiance that never exceeds this may be in kW/m2. [W/m2]
_DARK: Final = 2.0


def check(study: Study) -> None:
    """Refuse what cannot be used.

    Parameters
    ----------
    study : Study
        Its files are open, and its names are known.

    Raises
    ------
    InputError
        File, line and place in the study, what was found, what was expected, what to do.
    """
    _periods(study)
    _alive(study)
    _runs(study)
    _sensible(study)


def names(study: Study, faults: Faults) -> None:
    """Outputs, parameters, criteria: whatever is called by a name that must exist. No table is needed.

    Parameters
    ----------
    study : Study
        Its building is read.
    faults : Faults
        Takes what is wrong.
    """
    file, places = study.file, study.places
    for name, sensor in file.sensors.items():
        with places.noting(faults, "sensors", name, "output"):
            sensor.stated_uncertainty(study.building.output(sensor.output).unit, name)
    with places.noting(faults, "sensors"):
        if not any(sensor.use for sensor in file.sensors.values()):
            raise InputError("found use: false on every sensor, expected one at least that takes part")
    seen: dict[str, str] = {}
    for path, free in {} if file.identification is None else file.identification.parameters.items():
        with places.noting(faults, "identification", "parameters", path):
            found = free_parameter(study.building, path, free).path
            if found in seen:
                raise InputError(f"is the same as {seen[found]}, expected each parameter once; remove one")
            seen[found] = path
    for what, limits in (("criteria", file.criteria), ("aims", file.aims)):
        for k, criterion in enumerate(limits):
            for key, known in (("sensors", tuple(file.sensors)), ("periods", PERIODS)):
                for name in getattr(criterion, key) or ():
                    with places.noting(faults, what, k, key):
                        _require_known(name, known)
    for name in {} if file.reference is None else file.reference.sensors:
        with places.noting(faults, "reference", "sensors", name):
            _require_known(name, tuple(file.sensors))
    for k, entry in enumerate(() if file.reference is None else file.reference.influential):
        with places.noting(faults, "reference", "influential", k, "parameter"):
            study.building.parameter(entry.parameter)
    if file.sensitivity is not None:
        with faults.kept():
            check_plan(study.building, file.sensitivity, places)
    for variant in file.variants:
        with faults.kept():
            study.building_of(variant)


def _require_known(name: str, known: Sequence[str]) -> None:
    if name not in known:
        raise InputError(f"found '{name}', expected one of {', '.join(known)}. {did_you_mean(name, known)}")


def _periods(study: Study) -> None:
    blame, (first, last) = study.places.blame, study.record
    given = study.moment_of_end
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
    spans = {name: study.span(name) for name in ("warm_up", "identification", "corroboration")}
    for name, span in spans.items():
        with blame("periods", name):
            if span is not None and span[1] <= span[0]:
                raise InputError(
                    f"found {_words(*span)}, expected the end after the start; exchange the two times"
                )
            if span is not None and not (first <= span[0] and span[1] <= last):
                raise InputError(
                    f"found {_words(*span)}, expected a period inside what climate and measurements "
                    f"{covered} ({study.climate.timezone}); move it"
                )
    known, held, warm_up = study.identification, spans["corroboration"], spans["warm_up"]
    with blame("periods", "corroboration"):
        if held is not None and held[0] < known[1] and known[0] < held[1]:
            raise InputError(
                f"found {_words(*held)}, which overlaps the identification {_words(*known)}; expected days "
                "that the fit has not seen, for only they corroborate anything: move one of the two"
            )
    with blame("periods", "identification"):
        if warm_up is not None and known[0] < warm_up[1]:
            raise InputError(
                f"found {_words(*known)}, expected a start not before the warm-up ends, "
                f"{warm_up[1]:%Y-%m-%d %H:%M}: nothing is compared until then; move one of the two"
            )


def _words(first: pd.Timestamp, last: pd.Timestamp) -> str:
    return f"{first:%Y-%m-%d %H:%M} .. {last:%Y-%m-%d %H:%M}"


def _alive(study: Study) -> None:
    """Refuse to fit to a sensor that repeats itself and that nobody asked to mask."""
    start, end = study.identification
    for name, sensor in study.file.sensors.items():
        kinds = [kind for kind in CONSTANT if kind not in study.file.quality.mask]
        for stretch in study.quality:
            if not sensor.use or stretch.channel not in sensor.columns or stretch.kind not in kinds:
                continue
            shared = (min(end, stretch.end) - max(start, stretch.start)).total_seconds()
            if shared > MOST_CONSTANT * (end - start).total_seconds():
                with study.places.blame("sensors", name, "column"):
                    raise InputError(
                        f"found column {stretch.channel} {stretch.kind.replace('_', '-')} from "
                        f"{stretch.start:%Y-%m-%d %H:%M} to {stretch.end:%Y-%m-%d %H:%M} ({stretch.detail}), "
                        "over most of the identification; expected a sensor that measures: write "
                        f"quality: {{mask: [{stretch.kind}]}}, use: false, or choose another period"
                    )


def _runs(study: Study) -> None:
    """Compile every model, and state every problem: what they refuse is refused now."""
    file, blame = study.file, study.places.blame
    with blame("periods"):
        _ = study.simulation
    _corroborated(study)
    for period in ("identification", "corroboration"):
        for name in (name for name, sensor in file.sensors.items() if sensor.use):
            with blame("sensors", name):
                require_comparable(study.observation, study.during[period], period, [name])
    if file.identification is not None:
        with blame("identification"):
            _ = study.problem()
    for name, variant in file.variants.items():
        with blame("variants", name):
            study.whole(name)
            if variant.identify and file.identification is not None:
                study.problem(name)


def _corroborated(study: Study) -> None:
    """Refuse a study in which no instant is left to hold the fitted model against."""
    if study.during["corroboration"].any():
        return
    held = study.span("corroboration")
    with study.places.blame("periods", "identification" if held is None else "corroboration"):
        why = "only days that the fit has not seen corroborate anything"
        if held is not None:
            raise InputError(
                f"found {_words(*held)}, in which no measured instant lies; {why}: make it longer"
            )
        raise InputError(
            f"found {_words(*study.identification)}, which leaves nothing of the record, up to "
            f"{study.end:%Y-%m-%d %H:%M}, to hold the model against; {why}: end it earlier, or name a "
            "corroboration before it"
        )


def _sensible(study: Study) -> None:
    """Refuse temperatures that are codes; ask about irradiances that look like kW/m2."""
    import numpy as np

    low, high = _TEMPERATURES
    observation = study.observation
    for s, name in enumerate(observation.names):
        if study.simulation.outputs[s].unit != "degC":
            continue
        measured = observation.measured[:, s]
        outside = np.flatnonzero((measured < low) | (measured > high))
        if outside.size:
            value = measured[outside[0]]
            with study.places.blame("sensors", name, "column"):
                raise InputError(
                    f"found {value:g} at {observation.times[outside[0]]:%Y-%m-%d %H:%M} ({outside.size} such "
                    f"values), expected a temperature from {low:g} to {high:g} degC; if it stands for no "
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

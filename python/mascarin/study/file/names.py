"""Checks of the names in a study: outputs, parameters, criteria. They need no table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from mascarin.errors import InputError, did_you_mean
from mascarin.measurements.observation import PERIODS
from mascarin.study.file.factors import check_plan
from mascarin.study.file.free_parameters import free_parameter

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.study.file.description import Free, StudyPlan
    from mascarin.study.file.locations import Faults, Places


def check_names(plan: StudyPlan, building: Building, places: Places, faults: Faults) -> None:
    """Check that everything that is referred to by a name exists.

    Parameters
    ----------
    plan : StudyPlan
        What the study does.
    building : Building
        Has the outputs and parameters.
    places : Places
        Lines of the study, for errors.
    faults : Faults
        Collects the errors.
    """
    for name, sensor in plan.sensors.items():
        with places.noting(faults, "sensors", name, "output"):
            sensor.uncertainty(building.output(sensor.output).unit, f"sensors.{name}")
    with places.noting(faults, "sensors"):
        if not any(sensor.use for sensor in plan.sensors.values()):
            raise InputError("found use: false on every sensor, expected at least one that is used")
    if plan.identification is not None:
        _check_parameters(plan.identification.parameters, building, places, faults)
    _check_limits(plan, building, places, faults)
    _check_reference(plan, building, places, faults)
    if plan.sensitivity is not None:
        with faults.kept():
            check_plan(building, plan.sensitivity, places)
    for name, variant in plan.variants.items():
        with places.noting(faults, "variants", name, "changes"):
            building.replace(variant.changes)


def _check_parameters(
    parameters: Mapping[str, Free | None], building: Building, places: Places, faults: Faults
) -> None:
    seen: dict[str, str] = {}
    for path, free in parameters.items():
        with places.noting(faults, "identification", "parameters", path):
            found = free_parameter(building, path, free).path
            if found in seen:
                raise InputError(f"is the same as {seen[found]}, expected each parameter once; remove one")
            seen[found] = path


def _check_limits(plan: StudyPlan, building: Building, places: Places, faults: Faults) -> None:
    for what, limits in (("criteria", plan.criteria), ("aims", plan.aims)):
        for k, criterion in enumerate(limits):
            units = _units(plan, building, criterion.sensors)
            for key, known in (("sensors", tuple(plan.sensors)), ("periods", PERIODS), ("units", units)):
                for name in getattr(criterion, key) or ():
                    with places.noting(faults, what, k, key):
                        _require_known(name, known)


def _units(plan: StudyPlan, building: Building, sensors: Sequence[str] | None) -> tuple[str, ...]:
    """Units of the sensors of a criterion."""
    known = {output.name: output.unit for output in building.outputs()}
    chosen = [plan.sensors[name] for name in sensors or plan.sensors if name in plan.sensors]
    found = (known[sensor.output] for sensor in chosen if sensor.output in known)
    return tuple(dict.fromkeys(found))


def _check_reference(plan: StudyPlan, building: Building, places: Places, faults: Faults) -> None:
    if plan.reference is None:
        return
    for name in plan.reference.sensors:
        with places.noting(faults, "reference", "sensors", name):
            _require_known(name, tuple(plan.sensors))
    for k, published in enumerate(plan.reference.parameters):
        with places.noting(faults, "reference", "parameters", k, "parameter"):
            building.parameter(published.parameter)
    for k, entry in enumerate(plan.reference.influential):
        with places.noting(faults, "reference", "influential", k, "parameter"):
            building.parameter(entry.parameter)


def _require_known(name: str, known: Sequence[str]) -> None:
    if name not in known:
        raise InputError(f"found '{name}', expected one of {', '.join(known)}. {did_you_mean(name, known)}")

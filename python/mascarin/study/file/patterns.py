"""Paths with ``*`` in a study: tied parameters, and parameters written out one by one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypeVar

from mascarin.building.base.wildcards import is_pattern
from mascarin.building.parameters.ties import How, expanded, with_ties
from mascarin.building.parts.derived_output import Derived
from mascarin.errors import InputError
from mascarin.measurements.sensor import DERIVED

if TYPE_CHECKING:
    from mascarin.building import Building, Output
    from mascarin.study.file.description import Free, StudyPlan
    from mascarin.study.file.locations import Places

Plan = TypeVar("Plan", bound="StudyPlan")


def tied_building(plan: StudyPlan, building: Building, places: Places) -> Building:
    """The building with the parameters that a study ties.

    Parameters
    ----------
    plan : StudyPlan
        Ties parameters of its identification and of its sensitivity analysis.
    building : Building
        As described.
    places : Places
        Lines of the study, for errors.

    Raises
    ------
    InputError
        A path matches nothing, or its numbers cannot be tied.
    """
    if plan.identification is not None:
        for path, how in ties_of(plan.identification.parameters).items():
            with places.blame("identification", "parameters", path):
                building = with_ties(building, {path: how})
    if plan.sensitivity is not None:
        for path, how in plan.sensitivity.tie.items():
            with places.blame("sensitivity", "tie", path):
                building = with_ties(building, {_pattern(path): how})
    return building


def ties_of(parameters: Mapping[str, Free | None]) -> dict[str, How]:
    """Tied parameters of an identification: path -> factor or value.

    Raises
    ------
    InputError
        A path without ``*``.
    """
    return {
        _pattern(path): "value" if free.tie == "value" else "factor"
        for path, free in parameters.items()
        if free is not None and free.tie
    }


def with_combined_outputs(plan: Plan, building: Building, places: Places) -> tuple[Plan, Building]:
    """The plan and the building with an output for each sensor that is a sum or a mean of outputs.

    Parameters
    ----------
    plan : StudyPlan
        As read.
    building : Building
        As described.
    places : Places
        Lines of the study, for errors.

    Raises
    ------
    InputError
        A sensor combines what is no output, or itself.
    """
    sensors, derived = dict(plan.sensors), dict(building.derived_outputs)
    for name, sensor in plan.sensors.items():
        if sensor.combined is None:
            continue
        how, parts = sensor.combined
        output = f"{DERIVED}{name}"
        with places.blame("sensors", name, how):
            outputs = [_part_of(part, name, plan, building) for part in parts]
            units = list(dict.fromkeys(part.unit for part in outputs))
            if len(units) > 1:
                raise InputError(f"found outputs in {' and '.join(units)}, expected one unit; remove one")
            text = " + ".join(part.name for part in outputs)
            formula = text if how == "sum" else f"({text})/{len(outputs)}"
            derived[output] = Derived(formula=formula, unit=units[0])
        sensors[name] = sensor.model_copy(update={"output": output})
    if derived == building.derived_outputs:
        return plan, building
    with places.blame("sensors"):
        building = building.replace({"derived_outputs": derived})
    return plan.model_copy(update={"sensors": sensors}), building


def _part_of(part: str, name: str, plan: StudyPlan, building: Building) -> Output:
    if part in (name, f"{DERIVED}{name}"):
        raise InputError(
            f"found '{part}', the sensor itself; expected outputs of the model, such as "
            f"{building.outputs()[0].name}: name what is added"
        )
    if part in plan.sensors:
        other = plan.sensors[part].output or ", ".join((plan.sensors[part].combined or ("", ()))[1])
        raise InputError(f"found '{part}', another sensor; expected outputs of the model: write {other}")
    return building.output(part)


def _pattern(path: str) -> str:
    if not is_pattern(path):
        raise InputError(
            f"{path}: found a tie of one number, expected a path with *, which matches several; write * for "
            "a name between two dots, or leave tie out"
        )
    return path


def written_out(plan: Plan, building: Building, places: Places) -> Plan:
    """The plan with every path with ``*`` that is not tied replaced by the parameters that it matches.

    Parameters
    ----------
    plan : StudyPlan
        As read.
    building : Building
        From `tied_building`.
    places : Places
        Lines of the study, for errors.

    Raises
    ------
    InputError
        A path matches nothing, or nothing that varies.
    """
    if plan.identification is None or not any(map(is_pattern, plan.identification.parameters)):
        return plan
    found: dict[str, Any] = {}
    for path, free in plan.identification.parameters.items():
        with places.blame("identification", "parameters", path):
            every = expanded(building, [path])
            for one in every:
                # What is written for one parameter alone counts for it.
                if one not in found or one == path:
                    found[one] = free
    identification = plan.identification.model_copy(update={"parameters": found})
    return plan.model_copy(update={"identification": identification})

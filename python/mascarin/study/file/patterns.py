"""Paths with ``*`` in a study: tied parameters, and parameters written out one by one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypeVar

from mascarin.building.base.wildcards import is_pattern
from mascarin.building.parameters.ties import How, expanded, with_ties
from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.building import Building
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

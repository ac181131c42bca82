"""The parameters that a study calibrates, with the bounds that it states."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mascarin.calibration.base.building_problem import fit_parameter

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.calibration import FitParameter
    from mascarin.study.file.description import Free, IdentificationPlan


def free_parameter(building: Building, path: str, free: Free | None) -> FitParameter:
    """A parameter with its bounds: the study's, else the building's range.

    Raises
    ------
    InputError
        Unknown path, or bounds beyond the limits of the parameter.
    """
    if free is None:
        return fit_parameter(building, path)
    return fit_parameter(
        building, path, (free.low, free.high), free.prior, start=free.start, scale=free.scale
    )


def fit_parameters(building: Building, plan: IdentificationPlan) -> list[FitParameter]:
    """All parameters of a plan.

    Raises
    ------
    InputError
        As for `free_parameter`.
    """
    return [free_parameter(building, path, free) for path, free in plan.parameters.items()]

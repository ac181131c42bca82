"""The parameters that a sensitivity analysis varies, and its runs, by its plan."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from mascarin._io.durations import record_seconds, seconds_of
from mascarin.building.parameters.ties import expanded
from mascarin.errors import InputError
from mascarin.sensitivity.building_analysis import checked_range, factors_of
from mascarin.sensitivity.methods import plan as design

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.measurements.time_fields import Duration, RunStep
    from mascarin.sensitivity import Factor
    from mascarin.sensitivity.methods import Plan
    from mascarin.study.file.description import SensitivityPlan
    from mascarin.study.file.locations import Places


def check_plan(building: Building, plan: SensitivityPlan, places: Places) -> None:
    """Check the parameters of a plan.

    Raises
    ------
    InputError
        Unknown or structural path, a reversed range, a range beyond the limits of the parameter, or an
        interval that is no whole number of steps.
    """
    if plan.step is not None:
        with places.blame("sensitivity", "step"):
            _require_whole(plan.interval, plan.step)
    for path, span in plan.ranges.items():
        with places.blame("sensitivity", "ranges", path):
            for one in expanded(building, [path]):
                checked_range(building, one, span)
    for path in plan.distributions:
        with places.blame("sensitivity", "distributions", path):
            _require_known(building, [path])
    for name, paths in plan.groups.items():
        with places.blame("sensitivity", "groups", name):
            _require_known(building, paths)
    for key in ("only", "leave_out"):
        with places.blame("sensitivity", key):
            _require_known(building, getattr(plan, key) or ())
    with places.blame("sensitivity"):
        runs_of(plan, factors(building, plan))


def _require_whole(interval: Duration, step: RunStep) -> None:
    steps = seconds_of(interval) / record_seconds(step)
    if steps < 1.0 or abs(steps - round(steps)) > 1e-9:
        raise InputError(
            f"found {step}, expected a whole part of the interval of the analyzed outputs, {interval}: "
            "for example 30min for 1h"
        )


def _require_known(building: Building, paths: Sequence[str]) -> None:
    for path in expanded(building, paths):
        building.parameter(path)


def factors(building: Building, plan: SensitivityPlan) -> list[Factor]:
    """All active parameters with a range, by the plan.

    Raises
    ------
    InputError
        As for `mascarin.sensitivity.factors_of`.
    """
    return factors_of(
        building,
        ranges=plan.ranges,
        distributions=plan.distributions,
        groups=plan.groups,
        leave_out=plan.leave_out,
        only=plan.only,
    )


def runs_of(plan: SensitivityPlan, chosen: list[Factor]) -> Plan:
    """The runs of a plan.

    Raises
    ------
    InputError
        The method does not support the numbers or groups; SALib is not installed.
    """
    return design(
        chosen,
        plan.method,
        replicates=plan.replicates,
        samples=plan.samples,
        order=plan.order,
        seed=plan.seed,
    )

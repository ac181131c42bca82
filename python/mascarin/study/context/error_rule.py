"""Whether a study estimates errors of sensors and model together with its parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mascarin.calibration.errors.stated_errors import only_scatter, reason_not_to_estimate

if TYPE_CHECKING:
    from mascarin.study.file.description import StudyPlan


def states_errors(plan: StudyPlan) -> bool:
    """Whether the study itself says that errors are estimated.

    Parameters
    ----------
    plan : StudyPlan
        The study.
    """
    sought = plan.identification
    stated = any(sensor.states_errors for sensor in plan.sensors.values())
    return sought is not None and (sought.discrepancy is not None or stated or bool(plan.alternatives))


def estimates_errors(plan: StudyPlan, hours: float) -> bool:
    """Whether errors are estimated: by default the uncertainty of a sensor is that of an offset.

    Parameters
    ----------
    plan : StudyPlan
        The study.
    hours : float
        Length of the identification. [h]
    """
    if plan.identification is None or states_errors(plan):
        return states_errors(plan)
    return not all_scatter(plan) and reason_of(plan, hours) is None


def all_scatter(plan: StudyPlan) -> bool:
    """Whether all used sensors of a study say that their readings share no error."""
    return all(only_scatter(sensor) for sensor in plan.sensors.values() if sensor.use)


def reason_of(plan: StudyPlan, hours: float) -> str | None:
    """Why errors cannot be estimated by default; None if they can, or nothing is identified.

    Parameters
    ----------
    plan, hours
        As for `estimates_errors`.
    """
    sought = plan.identification
    if sought is None:
        return None
    if sought.profiles:
        return "the profiles hold them at zero"
    if any(variant.candidate for variant in plan.variants.values()):
        return "the candidates are compared by their cost"
    return reason_not_to_estimate(sought.method, sought.cost, hours)

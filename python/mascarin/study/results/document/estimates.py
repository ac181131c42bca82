"""Calibrated parameters with their uncertainty, as the report shows them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

from mascarin.study.results.document.numbers import plain
from mascarin.study_document.document import StudyDocument
from mascarin.study_document.estimates import CorrelationEntry, ParameterEntry, ProfileEntry

if TYPE_CHECKING:
    from mascarin.calibration import Calibration, Profile
    from mascarin.study.context.context import StudyContext
    from mascarin.study.file.description import IdentificationPlan


_COSTS: Final = {
    "nll": "negative log-likelihood",
    "sd": "sum of the standard deviations",
    "rmse": "sum of the root mean squares",
    "rmse_over_range": "sum of the root mean squares over the measured ranges",
    "cv_rmse": "sum of CV(RMSE) of ASHRAE Guideline 14, over the means",
}


def estimates(study: StudyContext, fit: Calibration, *, stated: bool) -> StudyDocument:
    """Parameters with their uncertainty, and facts about the calibration.

    Where intervals are not stated, each parameter has its whole range in place of one.
    """
    entries = parameters(study, fit, study.inputs.calibration_plan)
    if not stated:
        entries = {path: entry.model_copy(update={"stated": False}) for path, entry in entries.items()}
    return StudyDocument(
        parameters=entries,
        correlation=CorrelationEntry(paths=list(fit.problem.paths), matrix=plain(fit.correlation)),
        identification=_identification(fit),
    )


def profile_entries(profiles: Sequence[Profile]) -> StudyDocument:
    """Profile likelihoods by path; nothing where there are none."""
    entries = {
        profile.path: ProfileEntry(
            unit=profile.unit,
            values=plain(profile.values),
            rise=plain(profile.rise),
            limit=profile.limit,
            low=profile.low,
            high=profile.high,
            bounded=[not profile.open_low, not profile.open_high],
        )
        for profile in profiles
    }
    return StudyDocument(profiles=entries) if entries else StudyDocument()


def parameters(study: StudyContext, fit: Calibration, plan: IdentificationPlan) -> dict[str, ParameterEntry]:
    """Estimates by path, with interval, range and source."""
    building_paths = {parameter.path for parameter in study.building.parameters()}
    free_parameters = {
        study.building.parameter(path).path if path in building_paths else path: free
        for path, free in plan.parameters.items()
    }
    # A candidate may have parameters that the building as described does not have.
    sources = {parameter.path: parameter.source for parameter in study.building.parameters()}
    entries = {}
    for parameter, entry in zip(fit.problem.parameters, fit.to_dict().values(), strict=True):
        free, path = free_parameters.get(parameter.path), parameter.path
        more: dict[str, Any] = {
            "interval": [entry["low"], entry["high"]],
            "range": [parameter.lower, parameter.upper],
        }
        if path in fit.on_bound:
            reason = free.at_bound if free is not None and free.at_bound else fit.on_bound[path]
            more |= {"at_bound": True, "reason": reason}
        if free is not None and free.reference is not None:
            more |= {"reference_nominal": free.reference[0], "reference_fitted": free.reference[1]}
        if sources.get(path):
            more["source"] = sources[path]
        entries[path] = ParameterEntry(**entry, **more)
    return entries


def _identification(fit: Calibration) -> list[list[str]]:
    return [
        ["method", fit.method.replace("_", " ")],
        ["cost", _COSTS.get(fit.cost_name, fit.cost_name)],
        ["searches", str(len(fit.minima))],
        ["distinct minima", str(len(fit.distinct_minima()))],
        ["evaluations", str(len(fit.trace.cost))],
        ["end of the search", fit.reason],
        ["uncertainty", fit.uncertainty_method],
        ["effective samples", ", ".join(f"{n:.0f}" for n in fit.uncertainty.effective_samples)],
        ["seed", str(fit.seed)],
    ]

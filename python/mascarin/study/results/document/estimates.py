"""Calibrated parameters with their uncertainty, as the report shows them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

from mascarin.study.results.document.numbers import plain
from mascarin.study.steps.prediction_intervals import interval_entry

if TYPE_CHECKING:
    from mascarin.calibration import Calibration, Profile
    from mascarin.study.context.context import StudyContext
    from mascarin.study.file.description import IdentificationPlan
    from mascarin.study.steps.findings import PredictionIntervals


_COSTS: Final = {
    "nll": "negative log-likelihood",
    "sd": "sum of the standard deviations",
    "rmse": "sum of the root mean squares",
    "rmse_over_range": "sum of the root mean squares over the measured ranges",
    "cv_rmse": "sum of CV(RMSE) of ASHRAE Guideline 14, over the means",
}


def estimates(study: StudyContext, fit: Calibration, *, stated: bool) -> dict[str, Any]:
    """Parameters with their uncertainty, and facts about the calibration.

    Where intervals are not stated, each parameter has its whole range in place of one.
    """
    entries = parameters(study, fit, study.inputs.calibration_plan)
    if not stated:
        entries = {path: {**entry, "stated": False} for path, entry in entries.items()}
    return {
        "parameters": entries,
        "correlation": {"paths": list(fit.problem.paths), "matrix": plain(fit.correlation)},
        "identification": _identification(fit),
    }


def profile_entries(profiles: Sequence[Profile]) -> dict[str, Any]:
    """Profile likelihoods: path -> values, rise, limit, low, high; nothing where there are none."""
    entries = {
        profile.path: {
            "unit": profile.unit,
            "values": plain(profile.values),
            "rise": plain(profile.rise),
            "limit": profile.limit,
            "low": profile.low,
            "high": profile.high,
            "bounded": [not profile.open_low, not profile.open_high],
        }
        for profile in profiles
    }
    return {"profiles": entries} if entries else {}


def prediction_entries(study: StudyContext, intervals: PredictionIntervals) -> dict[str, Any]:
    """The prediction intervals in numbers."""
    return {"band": interval_entry(study, intervals)}


def parameters(study: StudyContext, fit: Calibration, plan: IdentificationPlan) -> dict[str, dict[str, Any]]:
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
        source = sources.get(path)
        entries[path] = {**entry, **more, **({"source": source} if source else {})}
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

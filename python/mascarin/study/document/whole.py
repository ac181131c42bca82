"""All results of a study, ready for JSON."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from mascarin.study.document.comparison import comparison
from mascarin.study.document.errors import error_entries, error_tables
from mascarin.study.document.estimates import estimates, parameters, prediction_entries, profile_entries
from mascarin.study.document.header import header
from mascarin.study.document.phase_change import phase_change
from mascarin.study.document.sensitivity import importance
from mascarin.study.prediction_intervals import interval_table
from mascarin.validation.error_sources import explain_missed_aims

if TYPE_CHECKING:
    from mascarin.study.findings import Findings


#: Title of the notes on the calibration.
ESTIMATES = "Calibrated parameters"


def document(findings: Findings) -> dict[str, Any]:
    """Everything but the series.

    Parameters
    ----------
    findings : Findings
        The results.

    Returns
    -------
    dict
        Ready for JSON. In ``sensors`` the metrics at the level of a period are those of the fitted model;
        those of every model stand beside them under its name.
    """
    study, fit = findings.setup, findings.calibration
    content = {
        **header(study, "study"),
        **comparison(findings.models, findings.criteria),
        **estimates(study, fit),
        **profile_entries(findings.profiles),
        **prediction_entries(study, findings.prediction_intervals),
        **error_entries(study, findings.combination),
        "tables": [
            interval_table(study, findings.prediction_intervals),
            *error_tables(study, findings.combination),
        ],
        "residuals": {
            name: {**found.to_dict(), "period": "blind"} for name, found in findings.residuals.items()
        },
        "notes": _notes(findings),
        "aims": [{**verdict.to_dict(), "model": "fitted"} for verdict in findings.aims],
        "phase_change": phase_change(study, findings.fitted),
        "variant_parameters": {
            name: parameters(study, run.fit, study.plan_of(name if name in study.plan.variants else None))
            for name, run in findings.variants.items()
            if run.fit is not None
        },
    }
    if findings.error_sources is not None:
        content["shortfall"] = {**findings.error_sources.to_dict(), "period": "blind"}
    if findings.sensitivity is not None:
        content |= importance(study, findings.sensitivity)
    return content


def _notes(findings: Findings) -> list[dict[str, str]]:
    """Notes with the titles under which the report shows them."""
    sources = findings.error_sources
    missed = [] if sources is None else explain_missed_aims(findings.aims, sources, "blind")
    titled = (
        (ESTIMATES, findings.calibration.warnings),
        (ESTIMATES, [profile.words for profile in findings.profiles if profile.words]),
        ("Residuals", findings.notes),
        ("Aims that are not met", missed),
    )
    return [{"title": title, "text": text} for title, texts in titled for text in texts]

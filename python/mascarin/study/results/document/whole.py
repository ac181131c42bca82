"""All results of a study, ready for JSON."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from mascarin.diagnosis.error_sources import explain_missed_aims
from mascarin.diagnosis.hypotheses import WORDS
from mascarin.study.results.document.coefficients import coefficients
from mascarin.study.results.document.comparison import comparison, criterion_entry
from mascarin.study.results.document.errors import error_entries, error_tables, mixed_forms
from mascarin.study.results.document.estimates import (
    estimates,
    parameters,
    profile_entries,
)
from mascarin.study.results.document.header import header
from mascarin.study.results.document.phase_change import phase_change
from mascarin.study.results.document.sensitivity import importance
from mascarin.study.steps.days import day_words, days_table
from mascarin.study.steps.derived_quantities import conductance_table, derived_table
from mascarin.study.steps.prediction_intervals import interval_entries, interval_table
from mascarin.study.transfer.comparison import title_of, transfer_notes, transfer_table
from mascarin.study_document.analysis import (
    ContradictionEntry,
    DaysEntry,
    DiagnosisEntry,
    ErrorSourcesEntry,
    NoteEntry,
    ResidualEntry,
    TableEntry,
)
from mascarin.study_document.document import StudyDocument
from mascarin.study_document.estimates import ReferenceValue

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.calibration.errors.posterior_checks import Contradiction
    from mascarin.diagnosis.error_sources import ErrorSources
    from mascarin.diagnosis.hypotheses import Diagnosis
    from mascarin.study.steps.findings import Findings


#: Title of the notes on the calibration.
ESTIMATES = "Calibrated parameters"
#: Title of the notes on the causes of the remaining error.
CAUSES = "Causes of the remaining error"


def document(findings: Findings) -> StudyDocument:
    """Everything but the series.

    Parameters
    ----------
    findings : Findings
        The results.

    Returns
    -------
    StudyDocument
        In ``sensors`` the metrics at the level of a period are those of the fitted model;
        those of every model stand beside them under its name.
    """
    study, fit = findings.context, findings.calibration
    reference = study.plan.reference
    published = [] if reference is None else [entry.parameter for entry in reference.parameters]
    steps = StudyDocument(
        contradictions=contradictions(findings.contradictions),
        reference_values=_values(study.building, published),
        band=interval_entries(study, findings.prediction_intervals),
        tables=_tables(findings),
        transfer=findings.transfer,
        derived=[quantity.entry for quantity in findings.derived],
        residuals={
            name: ResidualEntry.model_validate({**description.to_dict(), "period": "blind"})
            for name, description in findings.residuals.items()
        },
        notes=_notes(findings),
        aims=[criterion_entry(verdict, "fitted") for verdict in findings.aims],
        diagnosis=_diagnosis(findings.diagnosis),
        days=DaysEntry.model_validate({**findings.days.to_dict(), "table": days_table(findings.days)}),
        phase_change=phase_change(study, findings.fitted),
        variant_parameters={
            name: parameters(
                study, run.fit, study.variants.plan_of(name if name in study.plan.variants else None)
            )
            for name, run in findings.variants.items()
            if run.fit is not None
        },
    )
    models = {"nominal": findings.nominal, "fitted": findings.fitted}
    compared = comparison(findings.models, findings.criteria)
    elsewhere = all(entry.sound for entry in findings.transfer.values())
    return StudyDocument.joined(
        header(study, "study"),
        compared.model_copy(update={"sound": compared.sound and elsewhere}),
        estimates(study, fit, stated=findings.prediction_intervals.stated),
        coefficients(study, models, (*fit.problem.paths, *published)),
        profile_entries(findings.profiles),
        error_entries(study, findings.combination),
        steps,
        StudyDocument() if findings.error_sources is None else _shortfall(findings.error_sources),
        StudyDocument() if findings.sensitivity is None else importance(study, findings.sensitivity),
    )


def contradictions(statements: Iterable[Contradiction]) -> list[ContradictionEntry]:
    """By what the model contradicts its data or what is known."""
    return [ContradictionEntry(**statement.to_dict()) for statement in statements]


def _tables(findings: Findings) -> list[TableEntry]:
    study = findings.context
    tables = [
        interval_table(study, findings.prediction_intervals, mixed_forms(findings.combination)),
        *error_tables(study, findings.combination),
        transfer_table(study, findings.transfer) if findings.transfer else None,
        derived_table(findings.derived) if findings.derived else None,
        conductance_table(findings.calibration),
    ]
    return [table for table in tables if table is not None]


def _diagnosis(diagnosis: Diagnosis) -> DiagnosisEntry:
    table = {"table": causes_table(diagnosis)} if diagnosis.causes else {}
    return DiagnosisEntry.model_validate({**diagnosis.to_dict(), **table})


def _shortfall(sources: ErrorSources) -> StudyDocument:
    return StudyDocument(shortfall=ErrorSourcesEntry.model_validate({**sources.to_dict(), "period": "blind"}))


def _values(building: Building, paths: Sequence[str]) -> dict[str, ReferenceValue]:
    """Values as described of parameters that a publication identified."""
    parameters = {path: building.parameter(path) for path in paths}
    return {path: ReferenceValue(value=p.value, unit=p.unit) for path, p in parameters.items()}


def causes_table(diagnosis: Diagnosis) -> TableEntry:
    """Causes with their evidence, as a table of the report."""
    rows = [
        [
            number,
            WORDS[cause.what],
            ", ".join(cause.subject),
            cause.value if math.isfinite(cause.value) else None,
            cause.error if math.isfinite(cause.error) else None,
            cause.unit or "-",
            None if math.isnan(cause.p) else "yes" if cause.told else "no",
            100.0 * cause.certainty if math.isfinite(cause.certainty) else None,
            cause.p if math.isfinite(cause.p) else None,
        ]
        for number, cause in enumerate(diagnosis.causes, start=1)
    ]
    return TableEntry(
        title=CAUSES,
        caption=(
            "Faults of sensors and of measured inputs, values outside of their ranges, laws and missing heat "
            "flows compete on equal terms, given the errors of the model. p: part of simulated records "
            "without any cause in which some candidate explains as much. Certainty: probability that it is "
            "this one, if it is one of the candidates."
            + (" Where it is not told, the remarks list what else it may be." if _untold(diagnosis) else "")
        ),
        columns=[
            "no.",
            "kind",
            "where",
            "estimate",
            "standard error",
            "unit",
            "told",
            "certainty [%]",
            "p",
        ],
        rows=rows,
        uncertainty={"estimate": "standard error"},
        significant=["p"],
        section="error_sources",
    )


def _untold(diagnosis: Diagnosis) -> bool:
    """Whether the residuals have a cause that the measurements do not name."""
    return any(not cause.told and not math.isnan(cause.p) for cause in diagnosis.causes)


def _notes(findings: Findings) -> list[NoteEntry]:
    """Notes with the titles under which the report shows them."""
    sources = findings.error_sources
    missed = (
        []
        if sources is None
        else explain_missed_aims(findings.aims, sources, "blind", findings.diagnosis.noise)
    )
    titled = (
        (ESTIMATES, findings.calibration.warnings),
        (ESTIMATES, [profile.words for profile in findings.profiles if profile.words]),
        (CAUSES, [cause.text for cause in findings.diagnosis.causes]),
        ("Residuals", findings.notes),
        ("Choice of days", day_words(findings.days)),
        ("Aims that are not met", missed),
        (title_of(findings.context), transfer_notes(findings.transfer)),
    )
    return [NoteEntry(title=title, text=text) for title, texts in titled for text in texts]

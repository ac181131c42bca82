"""Models compared with measurements, as the report shows them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

from mascarin.study.steps.findings import metric_values, scores_of
from mascarin.study_document.comparison import (
    CriterionEntry,
    LedgerEntry,
    LedgerTerm,
    ModelEntry,
    PeriodScores,
)
from mascarin.study_document.document import StudyDocument

if TYPE_CHECKING:
    from mascarin.simulation.checks.warning_kinds import RunWarning
    from mascarin.study.steps.findings import ModelRun
    from mascarin.validation.criteria import Verdict


#: Flows of `simulation` (``FLOWS``), by words.
FLOW_LABELS: Final = {
    "solar": "solar radiation absorbed by opaque surfaces",
    "convection": "convection from outdoor air",
    "longwave": "long-wave exchange with sky and surroundings",
    "boundary": "prescribed boundaries (ground, measured temperatures)",
    "infiltration": "infiltration",
    "ventilation": "ventilation",
    "interzone": "air exchange between zones",
    "gains": "internal gains",
    "heating": "heating",
    "cooling": "cooling",
    "transmitted": "solar radiation transmitted by windows",
    "glass": "solar radiation absorbed by windows",
    "bridges": "thermal bridges",
    "sources": "heat sources in surfaces",
}


def comparison(models: Mapping[str, ModelRun], verdicts: Mapping[str, list[Verdict]]) -> StudyDocument:
    """Metrics, criteria, warnings of the runs, and the energy balance of the fitted model if there is one.

    Parameters
    ----------
    models : mapping of str to ModelRun
        ``nominal``, perhaps ``fitted`` and variants.
    verdicts : mapping of str to list of Verdict
        Criteria by model.
    """
    main = "fitted" if "fitted" in models else "nominal"
    return StudyDocument(
        models={name: ModelEntry(label=run.label, note=run.note) for name, run in models.items()},
        sensors=_scores(models, main),
        criteria=[
            criterion_entry(verdict, model) for model, judged in verdicts.items() for verdict in judged
        ],
        start=models[main].results.provenance.start,
        ledger=_ledger(models[main]),
        warnings=[*run_warnings(models)],
        sound=all(run.results.sound for run in models.values()),
    )


def run_warnings(models: Mapping[str, ModelRun]) -> list[RunWarning]:
    """Warnings of the runs of models, each once, with the models that have it."""
    models_by_line: dict[RunWarning, list[str]] = {}
    for name, run in models.items():
        for line in run.results.warnings:
            models_by_line.setdefault(line, []).append(name)
    return [line.after(", ".join(names)) for line, names in models_by_line.items()]


def _scores(models: Mapping[str, ModelRun], main: str) -> dict[str, dict[str, PeriodScores]]:
    return {
        sensor: {
            period: PeriodScores(
                **by_model[main].to_dict(), **{m: metric_values(values) for m, values in by_model.items()}
            )
            for period, by_model in periods.items()
        }
        for sensor, periods in scores_of(models).items()
    }


def criterion_entry(verdict: Verdict, model: str) -> CriterionEntry:
    """A criterion of a model, and whether it is met."""
    return CriterionEntry.model_validate({**verdict.to_dict(), "model": model})


def _ledger(run: ModelRun) -> LedgerEntry:
    energy = run.results.energy
    terms = [
        LedgerTerm(label=FLOW_LABELS[flow], value=joule / 1e6) for flow, joule in energy.into.items() if joule
    ]
    stored = LedgerTerm(label="increase of the stored heat", value=-energy.stored / 1e6)
    return LedgerEntry.model_validate({**energy.to_dict(), "model": run.label, "terms": [*terms, stored]})

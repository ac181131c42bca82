"""Models compared with measurements, as the report shows them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

from mascarin.study.steps.findings import scores_of

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
}


def comparison(models: Mapping[str, ModelRun], verdicts: Mapping[str, list[Verdict]]) -> dict[str, Any]:
    """Metrics, criteria, warnings of the runs, and the energy balance of the fitted model if there is one.

    Parameters
    ----------
    models : mapping of str to ModelRun
        ``nominal``, perhaps ``fitted`` and variants.
    verdicts : mapping of str to list of Verdict
        Criteria by model.
    """
    main = "fitted" if "fitted" in models else "nominal"
    return {
        "models": {name: {"label": run.label, "note": run.note} for name, run in models.items()},
        "sensors": _scores(models, main),
        "criteria": _criteria(verdicts),
        "start": models[main].results.provenance.start,
        "ledger": _ledger(models[main]),
        "warnings": run_warnings(models),
        "sound": all(run.results.sound for run in models.values()),
    }


def run_warnings(models: Mapping[str, ModelRun]) -> list[RunWarning]:
    """Warnings of the runs of models, each once, with the models that have it."""
    models_by_line: dict[RunWarning, list[str]] = {}
    for name, run in models.items():
        for line in run.results.warnings:
            models_by_line.setdefault(line, []).append(name)
    return [line.after(", ".join(names)) for line, names in models_by_line.items()]


def _scores(models: Mapping[str, ModelRun], main: str) -> dict[str, dict[str, dict[str, Any]]]:
    return {
        sensor: {
            period: {**by_model[main].to_dict(), **{m: metrics.to_dict() for m, metrics in by_model.items()}}
            for period, by_model in periods.items()
        }
        for sensor, periods in scores_of(models).items()
    }


def _criteria(judged: Mapping[str, list[Verdict]]) -> list[dict[str, Any]]:
    return [
        {**verdict.to_dict(), "model": model} for model, verdicts in judged.items() for verdict in verdicts
    ]


def _ledger(run: ModelRun) -> dict[str, Any]:
    energy = run.results.energy
    terms = [
        {"label": FLOW_LABELS[flow], "value": joule / 1e6} for flow, joule in energy.into.items() if joule
    ]
    return {
        **energy.to_dict(),
        "model": run.label,
        "terms": [*terms, {"label": "increase of the stored heat", "value": -energy.stored / 1e6}],
    }

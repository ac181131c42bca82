"""Validation summary: criteria with their limits."""

from __future__ import annotations

from typing import Any

from mascarin._io import units
from mascarin.figures import text
from mascarin.pages.study.data.labels import label_of, main_model, model_label, period_label
from mascarin.pages.study.data.series import Series
from mascarin.study_document.document import StudyDocument

TITLE = "Validation summary"


def content(study: StudyDocument, _series: Series) -> list[dict[str, Any]] | None:
    """Criteria grouped by model and period."""
    groups: dict[tuple[str, str], list[dict[str, Any]]] = {}
    for criterion in study.criteria:
        key = (criterion.model, criterion.period)
        value, limit = criterion.value, criterion.limit
        value_text, limit_text = text.beside_limit(value, limit)
        groups.setdefault(key, []).append(
            {
                "name": text.typeset(criterion.name),
                "sensor": label_of(study, criterion.sensor) if criterion.sensor else "",
                "value": value_text,
                "limit": limit_text,
                "unit": units.difference(criterion.unit),
                "passed": criterion.passed,
                "fill": _fill(value, limit),
            }
        )
    main = main_model(study)
    ordered = sorted(groups.items(), key=lambda item: item[0][0] != main)
    return [
        {
            "model": model_label(study, model or None),
            "period": period_label(study, period) if period else "",
            "rows": rows,
            "met": sum(1 for row in rows if row["passed"]),
            "open": model == main or not model,
            "key": f"criteria-{number}",
        }
        for number, ((model, period), rows) in enumerate(ordered, start=1)
    ] or None


def _fill(value: float | None, limit: float | None) -> float:
    """Value relative to its limit, in percent of the bar (the limit is at 75 %)."""
    if value is None or not limit:
        return 0.0
    return round(min(100.0, 75.0 * abs(float(value)) / abs(float(limit))), 1)

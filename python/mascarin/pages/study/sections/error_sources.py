"""Sources of remaining error, and aims."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from mascarin._io import units
from mascarin.figures import text
from mascarin.pages.study.data.labels import (
    in_words,
    label_of,
    model_label,
    note_words,
    parameter_label,
    period_label,
    unit_of,
)
from mascarin.pages.study.data.series import Series
from mascarin.study_document.comparison import CriterionEntry
from mascarin.study_document.document import StudyDocument

TITLE = "Sources of remaining error"
#: Notes of this title are shown with the aims.
MISSED = "Aims that are not met"


def content(study: StudyDocument, _series: Series) -> dict[str, Any] | None:
    """Aims, and the parameters that would lead to them."""
    aims, shortfall = study.aims, study.shortfall
    if not aims and not shortfall.model_fields_set:
        return None
    sensors = list(shortfall.sd)
    changes = shortfall.steps[-1].changes if shortfall.steps else {}
    rows = [{"label": "fitted model", "change": "", "cells": _scatter(shortfall.sd, sensors)}]
    rows += [
        {
            "label": f"{'with changed' if number == 0 else 'and'} {parameter_label(study, step.path)}",
            "change": text.fixed(100.0 * changes[step.path], 0, sign=True),
            "cells": _scatter(step.sd, sensors),
        }
        for number, step in enumerate(shortfall.steps)
    ]
    if shortfall.all_parameters is not None:
        label = f"all {shortfall.all_parameters.parameters} parameters"
        rows.append({"label": label, "change": "", "cells": _scatter(shortfall.all_parameters.sd, sensors)})
    wished = _aimed_scatter(aims, shortfall.period, sensors)
    distinct_units = {units.difference(unit_of(study, sensor)) for sensor in sensors}
    common = distinct_units.pop() if len(distinct_units) == 1 else ""
    calibrated = {path for path, entry in study.parameters.items() if entry.fitted is not None}
    changed = [step.path for step in shortfall.steps]
    weak = [parameter_label(study, path) for path in changed if path in calibrated]
    free = [parameter_label(study, path) for path in changed if path not in calibrated]
    return {
        "model": model_label(study, next((aim.model for aim in aims if aim.model), "fitted")),
        "weak": in_words(weak) if weak else "",
        "weak_count": len(weak),
        "free": in_words(free) if free else "",
        "free_count": len(free),
        "all": shortfall.all_parameters is not None,
        "causes": bool(study.diagnosis.causes),
        "aims": _aims(study, aims),
        "met": sum(1 for aim in aims if aim.passed),
        "judged": len(aims),
        "labels": [
            units.bracketed(label_of(study, s), "" if common else units.difference(unit_of(study, s)))
            for s in sensors
        ],
        "rows": rows if sensors else [],
        "wished": wished,
        "named": bool(shortfall.steps),
        "notes": [words for note in study.notes if note.title == MISSED for words in note_words(study, note)],
        "period": period_label(study, shortfall.period).lower(),
        "unit": common,
    }


def _scatter(sd: Mapping[str, float | None], sensors: Sequence[str]) -> list[str]:
    return [text.fixed(sd.get(sensor), 3) for sensor in sensors]


def _aimed_scatter(aims: Sequence[CriterionEntry], period: str, sensors: Sequence[str]) -> list[str]:
    """The standard deviation aimed at, by sensor; nothing where there is no such aim."""
    wished = {aim.sensor: aim.limit for aim in aims if aim.metric == "sd" and aim.period == period}
    return [text.fixed(wished.get(sensor), 3) for sensor in sensors] if wished else []


def _aims(study: StudyDocument, aims: Sequence[CriterionEntry]) -> dict[str, Any]:
    """Aims with what was reached in each period beside each other."""
    periods = list(dict.fromkeys(aim.period for aim in aims))
    rows: dict[tuple[str, str, float], dict[str, Any]] = {}
    for aim in aims:
        key = (aim.name, aim.sensor, float(aim.limit or 0.0))
        row = rows.setdefault(
            key,
            {
                "label": label_of(study, key[1]) if key[1] else "",
                "name": text.typeset(key[0]),
                "limit": f"{text.beside_limit(key[2], key[2])[1]}\u00a0{units.difference(aim.unit)}",
                "found": {},
            },
        )
        row["found"][aim.period] = {
            "text": text.beside_limit(aim.value, aim.limit)[0],
            "passed": aim.passed,
        }
    return {
        "periods": [period_label(study, period) for period in periods],
        "rows": [{**row, "cells": [row["found"].get(period) for period in periods]} for row in rows.values()],
    }

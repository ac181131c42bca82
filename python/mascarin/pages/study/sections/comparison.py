"""Accuracy: metrics of all sensors, periods and models."""

from __future__ import annotations

from typing import Any

from mascarin._io import units
from mascarin.figures import text
from mascarin.pages.study.data.labels import (
    in_words,
    is_published,
    label_of,
    layout,
    main_model,
    model_label,
    parameter_label,
    period_label,
    unit_of,
)
from mascarin.pages.study.data.series import Series
from mascarin.study_document.document import NO_VALUES, StudyDocument

TITLE = "Accuracy"


def content(study: StudyDocument, _series: Series) -> dict[str, Any] | None:
    """Values of the template."""
    sensors = study.sensors
    if not sensors:
        return None
    model = main_model(study)
    reference = study.reference
    periods = [_period_table(study, period, model) for period in study.periods]
    return {
        "model": model_label(study, model),
        "nominal": model_label(study, "nominal") if "nominal" in study.models else "",
        "reference": {"label": reference.label or "", "note": reference.note},
        "periods": [p for p in periods if p["rows"]],
        "models": _model_table(study),
    }


def _period_table(study: StudyDocument, period: str, model: str | None) -> dict[str, Any]:
    rows = []
    published = False
    for sensor in study.sensors:
        metrics, nominal = study.metrics(sensor, period, model), study.metrics(sensor, period, "nominal")
        if metrics.sd is None:
            continue
        paper = study.reference.sensors.get(sensor, {}).get(period, NO_VALUES)
        published = published or paper is not NO_VALUES
        rows.append(
            {
                "label": label_of(study, sensor),
                "unit": units.difference(unit_of(study, sensor)),
                "bias": text.fixed(metrics.bias, sign=True),
                "sd": text.fixed(metrics.sd),
                "sd_nominal": text.fixed(nominal.sd),
                "sd_paper": text.fixed(paper.sd, 1),
                "rmse": text.fixed(metrics.rmse),
                "max": text.fixed(metrics.max_error, sign=True),
                "max_paper": text.fixed(paper.max_error, 1, sign=True),
                "max_percent": text.fixed(metrics.max_error_percent, 1),
                "max_percent_paper": text.fixed(paper.max_error_percent, 1),
                "mean_percent": text.fixed(metrics.mean_error_percent, 1),
                "mean_percent_paper": text.fixed(paper.mean_error_percent, 1),
            }
        )
    distinct_units = list(dict.fromkeys(row["unit"] for row in rows))
    return {
        "label": period_label(study, period),
        "key": period.replace("_", "-"),
        "rows": rows,
        "layout": layout(study, period) if published else "",
        "published": published,
        "unit": distinct_units[0] if len(distinct_units) == 1 else "",
    }


def _model_table(study: StudyDocument) -> dict[str, Any] | None:
    """Standard deviation of every model on the last period in which more than one has metrics."""
    sensors = study.sensors
    for period in reversed(list(study.periods)):
        models = [
            m
            for m in study.models
            if any(study.metrics(sensor, period, m).sd is not None for sensor in sensors)
        ]
        if len(models) < 2:
            continue
        table = {m: [study.metrics(sensor, period, m).sd for sensor in sensors] for m in models}
        best = [
            min((v for v in column if v is not None), default=None)
            for column in zip(*table.values(), strict=True)
        ]
        rows = [
            {
                "label": model_label(study, m),
                "note": study.models[m].note,
                "own": _own_estimates(study, m),
                "cells": [
                    {"text": text.fixed(v), "best": v is not None and v == b}
                    for v, b in zip(values, best, strict=True)
                ],
            }
            for m, values in table.items()
        ]
        labels = [
            units.bracketed(label_of(study, sensor), units.difference(unit_of(study, sensor)))
            for sensor in sensors
        ]
        missing = [model_label(study, m) for m in study.models if m not in models]
        which = f"of all models but {in_words(missing)}" if missing else "of every model"
        return {"period": period_label(study, period), "labels": labels, "rows": rows, "which": which}
    return None


def _own_estimates(study: StudyDocument, model: str) -> str:
    """What was identified in a model beside what the fitted one has, in words."""
    entries = study.variant_parameters.get(model, {})
    if is_published(entries):
        return ""  # has a table of its own
    return "; ".join(
        f"{parameter_label(study, path)} {text.with_unit(entry.fitted, entry.unit or '')}"
        for path, entry in entries.items()
        if path not in study.parameters
    )

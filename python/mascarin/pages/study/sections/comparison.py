"""Accuracy: metrics of all sensors, periods and models."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mascarin._io import units
from mascarin.figures import text
from mascarin.pages.study.data.labels import (
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

TITLE = "Accuracy"


def content(study: Mapping[str, Any], _series: Series) -> dict[str, Any] | None:
    """Values of the template."""
    sensors = study.get("sensors", {})
    if not sensors:
        return None
    model = main_model(study)
    reference = study.get("reference", {})
    periods = [_period_table(study, period, model, reference) for period in study.get("periods", {})]
    return {
        "model": model_label(study, model),
        "nominal": model_label(study, "nominal") if "nominal" in study.get("models", {}) else "",
        "reference": {"label": reference.get("label", ""), "note": reference.get("note", "")},
        "periods": [p for p in periods if p["rows"]],
        "models": _model_table(study),
    }


def _period_table(
    study: Mapping[str, Any], period: str, model: str | None, reference: Mapping[str, Any]
) -> dict[str, Any]:
    rows = []
    published = False
    for sensor, periods in study.get("sensors", {}).items():
        metrics = periods.get(period, {}).get(model)
        if metrics is None or metrics.get("sd") is None:
            continue
        paper = reference.get("sensors", {}).get(sensor, {}).get(period, {})
        published = published or bool(paper)
        nominal = periods[period].get("nominal", {})
        rows.append(
            {
                "label": label_of(study, sensor),
                "unit": units.difference(unit_of(study, sensor)),
                "bias": text.fixed(metrics.get("bias"), sign=True),
                "sd": text.fixed(metrics.get("sd")),
                "sd_nominal": text.fixed(nominal.get("sd")),
                "sd_paper": text.fixed(paper.get("sd"), 1),
                "rmse": text.fixed(metrics.get("rmse")),
                "max": text.fixed(metrics.get("max_error"), sign=True),
                "max_paper": text.fixed(paper.get("max_error"), 1, sign=True),
                "max_percent": text.fixed(metrics.get("max_error_percent"), 1),
                "max_percent_paper": text.fixed(paper.get("max_error_percent"), 1),
                "mean_percent": text.fixed(metrics.get("mean_error_percent"), 1),
                "mean_percent_paper": text.fixed(paper.get("mean_error_percent"), 1),
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


def _model_table(study: Mapping[str, Any]) -> dict[str, Any] | None:
    """Standard deviation of every model on the last period in which more than one has metrics."""
    sensors = study.get("sensors", {})
    for period in reversed(list(study.get("periods", {}))):
        models = [
            m
            for m in study.get("models", {})
            if any(p.get(period, {}).get(m, {}).get("sd") is not None for p in sensors.values())
        ]
        if len(models) < 2:
            continue
        table = {
            m: [periods.get(period, {}).get(m, {}).get("sd") for periods in sensors.values()] for m in models
        }
        best = [
            min((v for v in column if v is not None), default=None)
            for column in zip(*table.values(), strict=True)
        ]
        rows = [
            {
                "label": model_label(study, m),
                "note": study["models"][m].get("note", ""),
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
        return {"period": period_label(study, period), "labels": labels, "rows": rows}
    return None


def _own_estimates(study: Mapping[str, Any], model: str) -> str:
    """What was identified in a model beside what the fitted one has, in words."""
    entries = study.get("variant_parameters", {}).get(model, {})
    if is_published(entries):
        return ""  # has a table of its own
    return "; ".join(
        f"{parameter_label(study, path)} {text.with_unit(entry.get('fitted'), str(entry.get('unit', '')))}"
        for path, entry in entries.items()
        if path not in study.get("parameters", {})
    )

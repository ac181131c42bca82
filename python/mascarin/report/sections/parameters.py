"""Calibrated parameters."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from markupsafe import Markup

from mascarin.report import text
from mascarin.report.labels import is_published, layout, model_label, parameter_label
from mascarin.report.series import Series
from mascarin.report.svg import Svg

TITLE = "Calibrated parameters"


def content(study: Mapping[str, Any], _series: Series) -> dict[str, Any] | None:
    """Values of the template."""
    entries = study.get("parameters", {})
    if not entries:
        return None
    referenced = any("reference_fitted" in e or "reference_nominal" in e for e in entries.values())
    rows = []
    for path, entry in entries.items():
        fitted, interval = text.with_interval(entry.get("fitted"), entry.get("low"), entry.get("high"))
        allowed = entry.get("range")
        rows.append(
            {
                "label": parameter_label(study, path),
                "path": path,
                "unit": text.unit(str(entry.get("unit", ""))),
                "nominal": text.significant(entry.get("nominal")),
                "fitted": fitted,
                "interval": interval,
                "drawing": parameter_range(entry) if allowed else "",
                "reference_nominal": text.significant(entry.get("reference_nominal")),
                "reference_fitted": text.significant(entry.get("reference_fitted")),
                "at_bound": bool(entry.get("at_bound")),
                "reason": entry.get("reason", ""),
            }
        )
    return {
        "rows": rows,
        "referenced": referenced,
        "layout": layout(study, "parameters"),
        "reference": study.get("reference", {}).get("label", "Publication"),
        "facts": study.get("identification", []),
        "correlation": _correlation(study),
        "published": _published(study),
    }


def _published(study: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Estimates of the models whose parameters a publication has too, beside its own."""
    found = []
    for model, entries in study.get("variant_parameters", {}).items():
        rows = []
        for path, entry in entries.items():
            fitted, interval = text.with_interval(entry.get("fitted"), entry.get("low"), entry.get("high"))
            rows.append(
                {
                    "label": parameter_label(study, path),
                    "path": path,
                    "unit": text.unit(str(entry.get("unit", ""))),
                    "nominal": text.significant(entry.get("nominal")),
                    "fitted": fitted,
                    "interval": interval or text.NONE,
                    "reference_nominal": text.significant(entry.get("reference_nominal")),
                    "reference_fitted": text.significant(entry.get("reference_fitted")),
                    "at_bound": bool(entry.get("at_bound")),
                }
            )
        if is_published(entries):
            note = study.get("models", {}).get(model, {}).get("note", "")
            found.append({"model": model_label(study, model), "note": note, "rows": rows})
    return found


def _correlation(study: Mapping[str, Any]) -> dict[str, Any] | None:
    entry = study.get("correlation")
    if not entry or len(entry.get("paths", [])) < 2:
        return None
    labels = [parameter_label(study, path) for path in entry["paths"]]
    rows = []
    for i, line in enumerate(entry["matrix"]):
        cells = [
            {
                "text": text.fixed(float(value)),
                "depth": min(6, int(abs(float(value)) * 7.0)),
                "negative": value < 0,
            }
            for value in line[: i + 1]
        ]
        rows.append({"number": i + 1, "label": labels[i], "cells": cells})
    return {"rows": rows, "labels": labels}


def parameter_range(entry: Mapping[str, Any]) -> Markup:
    """Range, nominal value, estimate and its interval of one parameter on a line.

    Parameters
    ----------
    entry : mapping
        As in :class:`~mascarin.report.schema.ParameterEntry`.
    """
    svg = Svg(180.0, 34.0)
    low, high = (float(end) for end in entry["range"])
    values = [low, high, *(float(entry[k]) for k in ("nominal", "fitted") if k in entry)]
    first, last = min(values), max(values)
    span = (last - first) or 1.0

    def place(value: float) -> float:
        return 8.0 + 164.0 * (min(max(value, first), last) - first) / span

    svg.line(place(low), 11.0, place(high), 11.0, "range")
    for end in (low, high):
        svg.line(place(end), 7.0, place(end), 15.0, "range")
        anchor = "start" if end == low else "end"
        svg.label(place(end) - (4.0 if end == low else -4.0), 30.0, text.significant(end), "tick", anchor)
    if entry.get("low") is not None and entry.get("high") is not None:
        a, b = place(float(entry["low"])), place(float(entry["high"]))
        svg.add("rect", x=a, y=5.0, width=max(b - a, 1.5), height=12.0, class_="interval")
    if "nominal" in entry:
        svg.add("circle", cx=place(float(entry["nominal"])), cy=11.0, r=4.0, class_="mark-nominal")
    if "fitted" in entry:
        svg.add("circle", cx=place(float(entry["fitted"])), cy=11.0, r=3.6, class_="mark-fitted")
    return svg.markup("Nominal value, estimate and interval within the range")

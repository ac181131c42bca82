"""Calibrated parameters."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from markupsafe import Markup

from mascarin._io import units
from mascarin.figures import text
from mascarin.figures.svg.chart import Svg
from mascarin.pages.study.data.labels import is_published, layout, model_label, parameter_label, period_label
from mascarin.pages.study.data.series import Series

TITLE = "Calibrated parameters"
#: Columns of a block of the correlation matrix.
_COLUMNS: Final = 9


def content(study: Mapping[str, Any], _series: Series) -> dict[str, Any] | None:
    """Values of the template."""
    entries = study.get("parameters", {})
    if not entries:
        return None
    paper = _paper(study)
    referenced = any("reference_fitted" in e or "reference_nominal" in e for e in entries.values())
    reference = study.get("reference", {})
    return {
        "rows": [_row(study, path, entry, with_range=True) for path, entry in entries.items()],
        "referenced": referenced and not paper,
        "layout": layout(study, "parameters"),
        "reference": reference.get("label", "Publication"),
        "paper": paper,
        "paper_note": reference.get("parameter_note", ""),
        "facts": study.get("identification", []),
        "correlation": _correlation(study),
        "coefficients": _coefficients(study),
        "published": _published(study),
    }


def _row(
    study: Mapping[str, Any], path: str, entry: Mapping[str, Any], *, with_range: bool = False
) -> dict[str, Any]:
    """One parameter of a table."""
    fitted, interval = text.with_interval(entry.get("fitted"), entry.get("low"), entry.get("high"))
    if entry.get("stated") is False:
        interval = "not stated"
    return {
        "label": parameter_label(study, path),
        "path": path,
        "unit": units.shown(str(entry.get("unit", ""))),
        "nominal": text.significant(entry.get("nominal")),
        "fitted": fitted,
        "interval": interval,
        "drawing": parameter_range(entry) if with_range and entry.get("range") else "",
        "reference_nominal": text.significant(entry.get("reference_nominal")),
        "reference_fitted": text.significant(entry.get("reference_fitted")),
        "at_bound": bool(entry.get("at_bound")),
        "reason": entry.get("reason", ""),
        "h": _means(study, path),
    }


def _coefficients(study: Mapping[str, Any]) -> dict[str, str] | None:
    """Period and unit of the effective mean coefficients, if the study has any."""
    coefficients = study.get("coefficients", {})
    if not coefficients.get("models"):
        return None
    period = period_label(study, str(coefficients.get("period", "")))
    return {"period": period, "unit": units.shown(str(coefficients.get("unit", "W/(m2 K)")))}


def _means(study: Mapping[str, Any], path: str) -> tuple[str, str] | None:
    """Effective mean coefficient before and after, for a parameter of a convection law."""
    models = study.get("coefficients", {}).get("models", {})
    law, convection, _ = path.partition(".convection")
    if not convection or not any(law + convection in means for means in models.values()):
        return None
    before, after = (models.get(model, {}).get(law + convection) for model in ("nominal", "fitted"))
    return text.fixed(before), text.fixed(after)


def _paper(study: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The parameters of a publication in its form, beside those of the study."""
    parameters = study.get("parameters", {})
    rows = []
    for line in study.get("reference", {}).get("parameters", []):
        path = str(line.get("parameter", ""))
        entry = parameters.get(path) or _fixed(study, path)
        if line.get("delta_t") is not None:
            entry = _as_gamma(entry, float(line["delta_t"]))
        row = _row(study, path, entry)
        h = row["h"] or ("", "")
        label = row["label"]
        if line.get("delta_t") is not None:
            label += f" w as γ = 4 δT / w, δT = {text.significant(float(line['delta_t']))} K"
        rows.append(
            row
            | {
                "label": label,
                "symbol": str(line.get("symbol", "")),
                "published": text.alike([line.get("before"), line.get("after")]),
                "published_unit": units.shown(str(line.get("unit", ""))),
                "h": h,
            }
        )
    return rows


def _fixed(study: Mapping[str, Any], path: str) -> dict[str, Any]:
    """A parameter that was not calibrated: its value is the same before and after."""
    reference_value = study.get("reference_values", {}).get(path)
    return (
        {}
        if reference_value is None
        else {
            "nominal": reference_value["value"],
            "fitted": reference_value["value"],
            "unit": reference_value["unit"],
        }
    )


def _as_gamma(entry: Mapping[str, Any], delta_t: float) -> dict[str, Any]:
    """The half-width w of a melting range as gamma = 4 delta_t / w (Guichard et al. 2016)."""
    changed = {
        key: 4.0 * delta_t / float(entry[source])
        for key, source in (("nominal", "nominal"), ("fitted", "fitted"), ("low", "high"), ("high", "low"))
        if entry.get(source)
    }
    return {**{k: v for k, v in entry.items() if k not in ("low", "high")}, **changed, "unit": "-"}


def _published(study: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Estimates of the models whose parameters a publication has too, beside its own."""
    return [
        {
            "model": model_label(study, model),
            "note": study.get("models", {}).get(model, {}).get("note", ""),
            "rows": [_row(study, path, entry) for path, entry in entries.items()],
        }
        for model, entries in study.get("variant_parameters", {}).items()
        if is_published(entries)
    ]


def _correlation(study: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The lower triangle in blocks of columns that fit on a page."""
    entry = study.get("correlation")
    if not entry or len(entry.get("paths", [])) < 2:
        return []
    labels = [parameter_label(study, path) for path in entry["paths"]]
    return [
        {
            "columns": [k + 1 for k in range(first, min(first + _COLUMNS, len(labels)))],
            "rows": [
                {
                    "number": i + 1,
                    "label": labels[i],
                    "cells": [
                        _cell(value) for value in entry["matrix"][i][first : min(first + _COLUMNS, i + 1)]
                    ],
                }
                for i in range(first, len(labels))
            ],
        }
        for first in range(0, len(labels), _COLUMNS)
    ]


def _cell(value: float | None) -> dict[str, str]:
    if value is None:
        return {"text": text.NONE, "class": ""}
    depth = min(6, int(abs(float(value)) * 7.0))
    return {"text": text.fixed(float(value)), "class": f"{'minus' if value < 0 else 'plus'}-{depth}"}


def parameter_range(entry: Mapping[str, Any]) -> Markup:
    """Range, nominal value, estimate and its interval of one parameter on a line.

    Parameters
    ----------
    entry : mapping
        As in :class:`~mascarin.pages.study.data.schema.ParameterEntry`.
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

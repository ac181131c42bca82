"""Calibrated parameters."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final

from markupsafe import Markup

from mascarin._io import units
from mascarin.figures import text
from mascarin.figures.svg.chart import Svg
from mascarin.pages.study.data.labels import is_published, layout, model_label, parameter_label, period_label
from mascarin.pages.study.data.series import Series
from mascarin.study_document.document import StudyDocument
from mascarin.study_document.estimates import ParameterEntry

TITLE = "Calibrated parameters"
#: Columns of a block of the correlation matrix.
_COLUMNS: Final = 9


def content(study: StudyDocument, _series: Series) -> dict[str, Any] | None:
    """Values of the template."""
    entries = study.parameters
    if not entries:
        return None
    paper = _paper(study)
    referenced = any(e.states("reference_fitted", "reference_nominal") for e in entries.values())
    reference = study.reference
    return {
        "rows": [_row(study, path, entry, with_range=True) for path, entry in entries.items()],
        "fixed": sum(entry.fitted is None for entry in entries.values()),
        "stated": any(entry.stated and entry.low is not None for entry in entries.values()),
        "unstated": _unstated(entries.values()),
        "referenced": referenced and not paper,
        "layout": layout(study, "parameters"),
        "reference": reference.label or "Publication",
        "paper": paper,
        "paper_note": reference.parameter_note,
        "facts": study.identification,
        "correlation": _correlation(study),
        "coefficients": _coefficients(study),
        "published": _published(study),
    }


def _unstated(entries: Iterable[ParameterEntry]) -> str:
    """Why an interval is not stated."""
    if all(entry.stated for entry in entries):
        return ""
    return "Intervals that are not stated would be too narrow: the model contradicts its data (head of page)."


def _row(
    study: StudyDocument, path: str, entry: ParameterEntry, *, with_range: bool = False
) -> dict[str, Any]:
    """One parameter of a table."""
    fitted, interval = text.with_interval(entry.fitted, entry.low, entry.high)
    if not entry.stated:
        interval = "not stated"
    return {
        "label": parameter_label(study, path),
        "path": path,
        "unit": units.shown(entry.unit or ""),
        "nominal": text.significant(entry.nominal),
        "fitted": fitted,
        "interval": interval,
        "drawing": parameter_range(entry) if with_range and entry.range else "",
        "reference_nominal": text.significant(entry.reference_nominal),
        "reference_fitted": text.significant(entry.reference_fitted),
        "at_bound": entry.at_bound,
        "reason": entry.reason,
        "h": _means(study, path),
    }


def _coefficients(study: StudyDocument) -> dict[str, str] | None:
    """Period and unit of the effective mean coefficients, if the study has any."""
    coefficients = study.coefficients
    if not coefficients.models:
        return None
    period = period_label(study, coefficients.period)
    return {"period": period, "unit": units.shown(coefficients.unit)}


def _means(study: StudyDocument, path: str) -> tuple[str, str] | None:
    """Effective mean coefficient before and after, for a parameter of a convection law."""
    models = study.coefficients.models
    law, convection, _ = path.partition(".convection")
    if not convection or not any(law + convection in means for means in models.values()):
        return None
    before, after = (models.get(model, {}).get(law + convection) for model in ("nominal", "fitted"))
    return text.fixed(before), text.fixed(after)


def _paper(study: StudyDocument) -> list[dict[str, Any]]:
    """The parameters of a publication in its form, beside those of the study."""
    parameters = study.parameters
    rows = []
    for line in study.reference.parameters:
        path = line.parameter
        entry = parameters.get(path) or _fixed(study, path)
        if line.delta_t is not None:
            entry = _as_gamma(entry, float(line.delta_t))
        row = _row(study, path, entry)
        h = row["h"] or ("", "")
        label = row["label"]
        if line.delta_t is not None:
            label += f" w as γ = 4 δT / w, δT = {text.significant(float(line.delta_t))} K"
        rows.append(
            row
            | {
                "label": label,
                "symbol": line.symbol,
                "published": text.alike([line.before, line.after]),
                "published_unit": units.shown(line.unit),
                "h": h,
            }
        )
    return rows


def _fixed(study: StudyDocument, path: str) -> ParameterEntry:
    """A parameter that was not calibrated: its value is the same before and after."""
    same = study.reference_values.get(path)
    if same is None:
        return ParameterEntry()
    return ParameterEntry(nominal=same.value, fitted=same.value, unit=same.unit)


def _as_gamma(entry: ParameterEntry, delta_t: float) -> ParameterEntry:
    """The half-width w of a melting range as gamma = 4 delta_t / w (Guichard et al. 2016)."""

    def gamma(width: float | None) -> float | None:
        return 4.0 * delta_t / width if width else width

    return entry.model_copy(
        update={
            "nominal": gamma(entry.nominal),
            "fitted": gamma(entry.fitted),
            "low": gamma(entry.high),
            "high": gamma(entry.low),
            "unit": "-",
        }
    )


def _published(study: StudyDocument) -> list[dict[str, Any]]:
    """Estimates of the models whose parameters a publication has too, beside its own."""
    return [
        {
            "model": model_label(study, model),
            "note": study.models[model].note if model in study.models else "",
            "rows": [_row(study, path, entry) for path, entry in entries.items()],
        }
        for model, entries in study.variant_parameters.items()
        if is_published(entries)
    ]


def _correlation(study: StudyDocument) -> list[dict[str, Any]]:
    """The lower triangle in blocks of columns that fit on a page."""
    entry = study.correlation
    if len(entry.paths) < 2:
        return []
    labels = [parameter_label(study, path) for path in entry.paths]
    return [
        {
            "columns": [k + 1 for k in range(first, min(first + _COLUMNS, len(labels)))],
            "rows": [
                {
                    "number": i + 1,
                    "label": labels[i],
                    "cells": [
                        _cell(value) for value in entry.matrix[i][first : min(first + _COLUMNS, i + 1)]
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


def parameter_range(entry: ParameterEntry) -> Markup:
    """Range, nominal value, estimate and its interval of one parameter on a line.

    Parameters
    ----------
    entry : ParameterEntry
        The parameter.
    """
    svg = Svg(180.0, 34.0)
    low, high = (float(end) for end in entry.range)
    values = [low, high, *(value for value in (entry.nominal, entry.fitted) if value is not None)]
    first, last = min(values), max(values)
    span = (last - first) or 1.0

    def place(value: float) -> float:
        return 8.0 + 164.0 * (min(max(value, first), last) - first) / span

    svg.line(place(low), 11.0, place(high), 11.0, "range")
    for end in (low, high):
        svg.line(place(end), 7.0, place(end), 15.0, "range")
        anchor = "start" if end == low else "end"
        svg.label(place(end) - (4.0 if end == low else -4.0), 30.0, text.significant(end), "tick", anchor)
    if entry.low is not None and entry.high is not None:
        a, b = place(entry.low), place(entry.high)
        svg.add("rect", x=a, y=5.0, width=max(b - a, 1.5), height=12.0, class_="interval")
    if entry.nominal is not None:
        svg.add("circle", cx=place(entry.nominal), cy=11.0, r=4.0, class_="mark-nominal")
    if entry.fitted is not None:
        svg.add("circle", cx=place(entry.fitted), cy=11.0, r=3.6, class_="mark-fitted")
    return svg.markup("Nominal value, estimate and interval within the range")

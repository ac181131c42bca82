"""Phase change: enthalpy and liquid fraction of the layers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from mascarin.figures import colors
from mascarin.figures.svg.axes import Figure, hours_of, time_axis
from mascarin.figures.svg.chart import Axis, Chart
from mascarin.pages.study.data.labels import period_label, short_periods
from mascarin.pages.study.data.series import Series
from mascarin.study_document.analysis import PhaseChangeEntry
from mascarin.study_document.document import StudyDocument

TITLE = "Phase change"


def content(study: StudyDocument, series: Series) -> list[dict[str, Any]] | None:
    """Values of the template."""
    materials: list[dict[str, Any]] = []
    short = short_periods(study)
    spans = study.periods[short[-1]].spans if short else []
    for entry in study.phase_change:
        figures = [enthalpy_loop(entry), liquid_fraction(series, entry, spans)]
        materials.append(
            {
                "label": entry.label,
                "key": f"phase-change-{len(materials) + 1}",
                "figures": [f for f in figures if f is not None],
                "rows": entry.rows,
                "days": [
                    {"color": colors.look(number).color, "label": day.label}
                    for number, day in enumerate(entry.days)
                ],
                "law": entry.law_temperature,
                "hysteresis": entry.hysteresis,  # not known in files of earlier versions
                "own_path": entry.own_path,
                "period": period_label(study, short[-1]) if short else "",
            }
        )
    return materials or None


def enthalpy_loop(entry: PhaseChangeEntry) -> Figure | None:
    """Path of a phase-change layer in the plane of temperature and enthalpy, over its law.

    Parameters
    ----------
    entry : PhaseChangeEntry
        The layer.
    """
    path_t, path_h, law_t, law_h = (
        np.asarray(values, dtype=np.float64)
        for values in (entry.temperature, entry.enthalpy, entry.law_temperature, entry.law_enthalpy)
    )
    if not (path_t.size or law_t.size):
        return None
    chart = Chart(
        Axis.over(path_t, law_t, count=9),
        Axis.over(path_h, law_h, count=9),
        width=420.0,
        height=260.0,
        y_label="enthalpy, kJ/kg",
        x_label="mean temperature of its two surfaces, °C",
    )
    if law_t.size:
        chart.curve(law_t, law_h, "law")
    days = entry.days
    stride = max(1, path_t.size // 1500)
    chart.curve(path_t[::stride], path_h[::stride], "path faint" if days else "path")
    for number, day in enumerate(days):
        chart.curve(np.asarray(day.temperature), np.asarray(day.enthalpy), f"d{number % 4}")
    label = entry.label or "phase-change layer"
    return Figure("Enthalpy loop", chart.markup(f"Enthalpy over temperature of {label}"))


def liquid_fraction(series: Series, entry: PhaseChangeEntry, spans: Sequence[Sequence[str]]) -> Figure | None:
    """Liquid fraction over time in the first of some spans.

    Parameters
    ----------
    series : Series
        Curves.
    entry : PhaseChangeEntry
        The layer.
    spans : sequence of (start, end)
        Where to look.
    """
    column = series.columns.get(entry.column or "")
    if column is None or not spans:
        return None
    part = series.slice_of(spans[0][0], spans[0][1])
    values = column.values[part]
    hours = hours_of(len(values), series.step)
    stride = max(1, math.ceil(len(values) / 700))
    axis = Axis(0.0, 1.0, (0.0, 0.25, 0.5, 0.75, 1.0), ("0", "0.25", "0.5", "0.75", "1"))
    chart = Chart(
        time_axis(series.time(part.start), hours[-1] if len(hours) else 1.0),
        axis,
        width=420.0,
        height=260.0,
        y_label="liquid fraction",
    )
    chart.band(hours[::stride], np.zeros(len(hours[::stride])), values[::stride], "liquid")
    chart.curve(hours[::stride], values[::stride], "path")
    return Figure("Liquid fraction", chart.markup("Liquid fraction over time"))

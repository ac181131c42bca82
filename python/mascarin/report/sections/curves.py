"""Time series: simulated and measured."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from markupsafe import Markup

from mascarin.report import text
from mascarin.report.drawn import hours_of, time_axis
from mascarin.report.labels import label_of, main_model, model_label, period_label, short_periods, unit_of
from mascarin.report.series import Array, Series
from mascarin.report.svg import Axis, Chart

TITLE = "Time series"
#: Largest number of points of a curve in a printed figure.
_MOST_POINTS = 420


def content(study: Mapping[str, Any], series: Series) -> dict[str, Any] | None:
    """Values of the template."""
    sensors = [key for key in study.get("sensor_info", {}) if f"observed/{key}" in series.columns]
    if not sensors:
        return None
    model = main_model(study)
    return {
        "sensors": [{"key": key, "label": label_of(study, key)} for key in sensors],
        "models": [
            {"key": key, "label": model_label(study, key), "main": key == model}
            for key in study.get("models", {})
            if any(f"{key}/{sensor}" in series.columns for sensor in sensors)
        ],
        "beside": [
            {"key": key, "label": column.label}
            for key, column in series.columns.items()
            if key.split("/")[0] in ("weather", "state")
        ],
        "periods": [
            {"label": period_label(study, period), "start": spans[0][0], "end": spans[-1][1]}
            for period, entry in study.get("periods", {}).items()
            if (spans := entry.get("spans"))
        ],
        "printed": [
            {"label": period_label(study, period), "curves": period_curves(study, series, period)}
            for period in short_periods(study)
        ],
        "model": model_label(study, model),
        "nominal": model_label(study, "nominal") if "nominal" in study.get("models", {}) else "",
        "band": any(info.get("uncertainty") for info in study.get("sensor_info", {}).values()),
        "foreseen": any(key.startswith("band/") for key in series.columns),
        "step": text.significant(series.step / 60.0),
        "timezone": study.get("timezone", ""),
    }


@dataclass(frozen=True)
class PeriodCurves:
    """Curves of one sensor over one period, with the error below."""

    sensor: str
    values: Markup
    errors: Markup


def period_curves(study: Mapping[str, Any], series: Series, period: str) -> list[PeriodCurves]:
    """Observed and simulated curves of every sensor over a short period.

    Parameters
    ----------
    study : mapping
        As in :class:`~mascarin.report.schema.Study`.
    series : Series
        Curves.
    period : str
        Name of a period of one span.
    """
    start, end = study["periods"][period]["spans"][0]
    part = series.slice_of(start, end)
    model = main_model(study)
    found = []
    for sensor in study.get("sensor_info", {}):
        observed = series.columns.get(f"observed/{sensor}")
        simulated = series.columns.get(f"{model}/{sensor}")
        if observed is None or simulated is None:
            continue
        found.append(_period_curves(study, series, sensor, part, (observed.values, simulated.values)))
    return found


def headline(study: Mapping[str, Any], series: Series) -> PeriodCurves | None:
    """Curves of the first sensor over the last short period, for the head of the page.

    Parameters
    ----------
    study : mapping
        As in :class:`~mascarin.report.schema.Study`.
    series : Series
        Curves.
    """
    periods = short_periods(study)
    curves = period_curves(study, series, periods[-1]) if periods else []
    return curves[0] if curves else None


def _period_curves(
    study: Mapping[str, Any], series: Series, sensor: str, part: slice, curves: tuple[Array, Array]
) -> PeriodCurves:
    seen, made = curves[0][part], curves[1][part]
    nominal = series.columns.get(f"nominal/{sensor}")
    every = max(1, math.ceil(len(seen) / _MOST_POINTS))
    hours = hours_of(len(seen), series.step)
    x = time_axis(series.time(part.start), hours[-1] if len(hours) else 1.0)
    raw_unit = unit_of(study, sensor)
    label = label_of(study, sensor)
    before = nominal.values[part] if nominal is not None else np.empty(0)
    chart = Chart(x, Axis.over(seen, made, before), height=170.0, y_label=text.unit(raw_unit), bottom=22.0)
    band = float(study["sensor_info"][sensor].get("uncertainty", 0.0))
    pick = slice(None, None, every)
    if band > 0.0:
        chart.band(hours[pick], seen[pick] - band, seen[pick] + band, "sensor-band")
    foreseen = series.columns.get(f"band/{sensor}")
    if foreseen is not None:
        half = foreseen.values[part][pick]
        chart.band(hours[pick], made[pick] - half, made[pick] + half, "model-band")
    if nominal is not None and main_model(study) != "nominal":
        chart.curve(hours[pick], before[pick], "nominal")
    chart.curve(hours[pick], seen[pick], "observed")
    chart.curve(hours[pick], made[pick], "fitted")
    error = made - seen
    limits = Axis.over(error, [-band, band], count=4, around=0.0)
    below = Chart(
        x, limits, height=104.0, y_label=f"error, {text.difference_unit(raw_unit)}", bottom=22.0, top=20.0
    )
    if band > 0.0:
        below.bar(x.low, x.high, -band, band, "sensor-band")
    below.curve(hours[pick], error[pick], "error")
    words = f"{label}: measured and simulated"
    return PeriodCurves(label, chart.markup(words), below.markup(f"{label}: simulated minus measured"))

"""Time series: simulated and measured."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from markupsafe import Markup

from mascarin.figures import comparison
from mascarin.report import embedding, text
from mascarin.report.labels import label_of, main_model, model_label, period_label, short_periods, unit_of
from mascarin.report.series import Array, Series

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


def period_curves(
    study: Mapping[str, Any], series: Series, period: str, place: str = ""
) -> list[PeriodCurves]:
    """Observed and simulated curves of every sensor over a short period.

    Parameters
    ----------
    study : mapping
        As in :class:`~mascarin.report.schema.Study`.
    series : Series
        Curves.
    period : str
        Name of a period of one span.
    place : str
        Name of the place on the page, if the figures are shown at several.
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
        values = observed.values, simulated.values
        found.append(_period_curves(study, series, sensor, part, values, place))
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
    curves = period_curves(study, series, periods[-1], "headline") if periods else []
    return curves[0] if curves else None


def _period_curves(
    study: Mapping[str, Any],
    series: Series,
    sensor: str,
    part: slice,
    curves: tuple[Array, Array],
    place: str,
) -> PeriodCurves:
    label, unit = label_of(study, sensor), unit_of(study, sensor)
    every = max(1, math.ceil((part.stop - part.start) / _MOST_POINTS))
    pick = slice(part.start, part.stop, every)
    measured, simulated = curves[0][pick], curves[1][pick]
    times = [series.time(part.start + every * k) for k in range(len(measured))]
    models = {"fitted": simulated}
    nominal = series.columns.get(f"nominal/{sensor}")
    if nominal is not None and main_model(study) != "nominal":
        models = {"nominal": nominal.values[pick], **models}
    interval = series.columns.get(f"band/{sensor}")
    middle = series.columns.get(f"expected/{sensor}")
    uncertainty = float(study["sensor_info"][sensor].get("uncertainty", 0.0))
    upper, lower = embedding.axes(340.0, 170.0), embedding.axes(340.0, 104.0)
    comparison.series(
        upper,
        times,
        measured,
        models,
        uncertainty=uncertainty,
        interval=None if interval is None else interval.values[pick],
        middle=None if middle is None else middle.values[pick],
    )
    comparison.errors(lower, times, {"fitted": simulated - measured}, uncertainty=uncertainty)
    for ax, name in ((upper, text.unit(unit)), (lower, f"error, {text.difference_unit(unit)}")):
        embedding.titled(ax, name)
        embedding.days(ax, times)
    return PeriodCurves(
        label,
        embedding.drawn(upper, f"{label}: measured and simulated", place),
        embedding.drawn(lower, f"{label}: simulated minus measured", place),
    )

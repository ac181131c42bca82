"""Time series: simulated and measured."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from datetime import datetime
from typing import TYPE_CHECKING, Any, Final

from markupsafe import Markup

from mascarin._io.units import bracketed, shown
from mascarin.figures import text
from mascarin.figures.comparison import Compared, errors, errors_together, series, together
from mascarin.pages.study.data.labels import (
    band_name,
    bands_stated,
    label_of,
    main_model,
    model_label,
    period_label,
    short_periods,
    unit_of,
)
from mascarin.pages.study.data.main_results import worst_sensor
from mascarin.pages.study.data.series import Series, moment
from mascarin.pages.study.figures import html_figures
from mascarin.pages.study.figures.comparison_data import (
    by_unit,
    compared_sensors,
    error_unit,
    model_looks,
    sensor_looks,
)
from mascarin.study_document.document import StudyDocument

if TYPE_CHECKING:
    from matplotlib.axes import Axes

TITLE = "Time series"
#: Largest number of points of a curve in a figure of the page.
_MAX_POINTS: Final = 420


def content(study: StudyDocument, curves: Series) -> dict[str, Any] | None:
    """Values of the template."""
    sensors = [key for key in study.sensor_info if f"observed/{key}" in curves.columns]
    if not sensors:
        return None
    model = main_model(study)
    return {
        "sensors": [{"key": key, "label": label_of(study, key)} for key in sensors],
        "models": [
            {"key": key, "label": model_label(study, key), "main": key == model}
            for key in study.models
            if any(f"{key}/{sensor}" in curves.columns for sensor in sensors)
        ],
        "beside": [
            {"key": key, "label": column.label}
            for key, column in curves.columns.items()
            if key.split("/")[0] in ("weather", "state")
        ],
        "periods": [
            {"label": period_label(study, period), "start": spans[0][0], "end": spans[-1][1]}
            for period, entry in study.periods.items()
            if (spans := entry.spans)
        ],
        "printed": _printed(study, curves),
        "model": model_label(study, model),
        "nominal": model_label(study, "nominal") if "nominal" in study.models else "",
        "uncertain": any(info.uncertainty for info in study.sensor_info.values()),
        "foreseen": any(key.startswith("band/") for key in curves.columns),
        "band": band_name(study),
        "stated": bands_stated(study),
        "step": text.significant(curves.step / 60.0),
        "timezone": study.timezone,
    }


def _printed(study: StudyDocument, curves: Series) -> list[dict[str, Any]]:
    """Figures of the short periods: all sensors together, and each by itself."""
    printed_periods = []
    looks = sensor_looks(study)
    for period in short_periods(study):
        times, sensors = _of_period(study, curves, period)
        if not sensors:
            continue
        start, end = study.periods[period].spans[0]
        printed_periods.append(
            {
                "key": period.replace("_", "-"),
                "label": period_label(study, period),
                "span": text.span_of(moment(start), moment(end)),
                "together": [_together(study, times, unit, sensors, names, period)
                             for unit, names in by_unit(study, sensors).items()],
                "keys": [
                    {"label": compared.label, "color": looks[name].color, "dash": looks[name].round}
                    for name, compared in sensors.items()
                ],
                "curves": [
                    _single(study, times, name, compared, period) for name, compared in sensors.items()
                ],
            }
        )  # fmt: skip
    return printed_periods


@dataclass(frozen=True)
class Panels:
    """Values over a period, with the errors below."""

    title: str
    values: Markup
    errors: Markup


def headline(study: StudyDocument, curves: Series) -> Panels | None:
    """Curves of the first sensor over the last short period, for the head of the page.

    Parameters
    ----------
    study : StudyDocument
        The results.
    curves : Series
        Curves.
    """
    periods = short_periods(study)
    if not periods:
        return None
    times, sensors = _of_period(study, curves, periods[-1])
    for name, compared in sensors.items():
        panels = _single(study, times, name, compared, "headline")
        count = len(sensors)
        return (
            replace(panels, title=f"{panels.title} (the first of {count} sensors)") if count > 1 else panels
        )
    return None


def last_period(study: StudyDocument, curves: Series) -> Panels | None:
    """Curves of the worst sensor over the first part of the last period, where it is not the headline's.

    Parameters
    ----------
    study : StudyDocument
        The results.
    curves : Series
        Curves.
    """
    periods = [key for key, period in study.periods.items() if period.spans]
    if not periods or periods[-1] in short_periods(study)[-1:]:
        return None
    times, sensors = _of_period(study, curves, periods[-1])
    if not sensors:
        return None
    name, reason = worst_sensor(study, periods[-1], list(sensors))
    panels = _single(study, times, name, sensors[name], "summary-blind")
    span = text.span_of(times[0], times[-1])
    label = period_label(study, periods[-1]).lower()
    return replace(panels, title=f"{panels.title}, {label}, {span}{f' ({reason})' if reason else ''}")


def _of_period(
    study: StudyDocument, curves: Series, period: str
) -> tuple[list[datetime], dict[str, Compared]]:
    start, end = study.periods[period].spans[0]
    return compared_sensors(study, curves, curves.slice_of(start, end), _MAX_POINTS)


def _single(study: StudyDocument, times: list[datetime], sensor: str, compared: Compared, key: str) -> Panels:
    """One sensor with the prediction interval."""
    upper, lower = html_figures.axes(340.0, 170.0), html_figures.axes(340.0, 110.0)
    main = replace(compared, models={compared.main: compared.models[compared.main]})
    named, only = _named(study, compared), _named(study, main)
    looks = model_looks(study)
    series(upper, times, named, looks=looks)
    errors(lower, times, only, looks=looks)
    _finish(upper, times, bracketed("", shown(unit_of(study, sensor))))
    _finish(lower, times, bracketed("error", error_unit(study, sensor)))
    return Panels(
        compared.label,
        html_figures.markup_of(upper, f"{compared.label}: measured and simulated", key),
        html_figures.markup_of(lower, f"{compared.label}: simulated minus measured", key),
    )


def _named(study: StudyDocument, compared: Compared) -> Compared:
    """The same with the names of models for readers."""
    models = {model_label(study, model): values for model, values in compared.models.items()}
    return replace(compared, models=models, main=model_label(study, compared.main))


def _together(
    study: StudyDocument,
    times: list[datetime],
    unit: str,
    sensors: Mapping[str, Compared],
    names: list[str],
    key: str,
) -> Panels:
    """All sensors of one unit."""
    looks = sensor_looks(study)
    chosen = [(sensors[name], looks[name]) for name in names]
    upper, lower = html_figures.axes(700.0, 290.0), html_figures.axes(700.0, 170.0)
    together(upper, times, chosen)
    errors_together(lower, times, chosen)
    _finish(upper, times, bracketed("", shown(unit)))
    _finish(lower, times, bracketed("error", error_unit(study, names[0])))
    words = ", ".join(compared.label for compared, _ in chosen)
    return Panels(
        shown(unit),
        html_figures.markup_of(upper, f"Measured and simulated: {words}", key),
        html_figures.markup_of(lower, f"Simulated minus measured: {words}", key),
    )


def _finish(ax: Axes, times: list[datetime], name: str) -> None:
    html_figures.titled(ax, name)
    html_figures.days(ax, times)

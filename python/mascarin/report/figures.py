"""The figures of a report, each from the study's numbers alone."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

import numpy as np
from markupsafe import Markup

from mascarin.report import text
from mascarin.report.carpet import Carpet, carpet, round_limit
from mascarin.report.payload import Array, Series, moment
from mascarin.report.svg import Axis, Chart, Svg

#: Most points of a curve in a printed figure.
_MOST_POINTS = 420
#: Periods longer than this are left to the interactive curves and the carpets. [days]
_LONG = 16.0
#: Lowest part of the variance that a spectrum shows.
_FLOOR = 1e-4


@dataclass(frozen=True)
class Figure:
    """A drawing with its words."""

    title: str
    drawing: Markup
    caption: str = ""


def label_of(study: Mapping[str, Any], sensor: str) -> str:
    """Name of a sensor for people."""
    return str(study.get("sensor_info", {}).get(sensor, {}).get("label", text.plain_path(sensor)))


def unit_of(study: Mapping[str, Any], sensor: str) -> str:
    """Unit of a sensor as in the study."""
    return str(study.get("sensor_info", {}).get(sensor, {}).get("unit", "degC"))


def main_model(study: Mapping[str, Any]) -> str | None:
    """Name of the model whose errors are shown: the fitted one, else the first."""
    models = list(study.get("models", {}))
    return "fitted" if "fitted" in models else (models[0] if models else None)


# --- curves over time -----------------------------------------------------------------------------


@dataclass(frozen=True)
class PeriodCurves:
    """Curves of one sensor over one period, with the error below."""

    sensor: str
    values: Markup
    errors: Markup


def short_periods(study: Mapping[str, Any]) -> list[str]:
    """Periods short enough to be printed as curves."""
    found = []
    for key, period in study.get("periods", {}).items():
        spans = period.get("spans", [])
        if len(spans) == 1 and moment(spans[0][1]) - moment(spans[0][0]) <= timedelta(days=_LONG):
            found.append(key)
    return found


def period_curves(study: Mapping[str, Any], series: Series, period: str) -> list[PeriodCurves]:
    """Observed and simulated curves of every sensor over a short period.

    Parameters
    ----------
    study : mapping
        As in :class:`~mascarin.report.payload.Study`.
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
        As in :class:`~mascarin.report.payload.Study`.
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
    hours = _hours(len(seen), series.step)
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
    words = f"{label}: observed and simulated"
    return PeriodCurves(label, chart.markup(words), below.markup(f"{label}: simulated less observed"))


def _hours(count: int, step: float) -> Array:
    hours: Array = np.arange(count, dtype=np.float64) * (step / 3600.0)
    return hours


def time_axis(first: datetime, hours: float) -> Axis:
    """Axis in hours from a first instant with marks at midnights."""
    to_midnight = (24.0 - (first.hour + first.minute / 60.0)) % 24.0
    days = max(1.0, hours / 24.0)
    every = max(1, math.ceil(days / 6.0))
    marks = np.arange(to_midnight, hours + 1e-6, 24.0 * every)
    names = [_short_day(first + timedelta(hours=float(m))) for m in marks]
    return Axis(0.0, max(hours, 1e-6), [float(m) for m in marks], names)


def _short_day(time: datetime) -> str:
    return f"{time.day} {time:%b}"


# --- carpets --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class SensorCarpet:
    """Carpets of one sensor's error: of the main model, and of the nominal one."""

    sensor: str
    label: str
    unit: str
    pictures: list[tuple[str, str, Carpet]]
    """Model key, model label, picture."""


def carpets(study: Mapping[str, Any], series: Series) -> list[SensorCarpet]:
    """Errors of every sensor over days and hours.

    Parameters
    ----------
    study : mapping
        As in :class:`~mascarin.report.payload.Study`.
    series : Series
        Curves.
    """
    found = []
    model = main_model(study)
    for sensor in study.get("sensor_info", {}):
        observed = series.columns.get(f"observed/{sensor}")
        main = series.columns.get(f"{model}/{sensor}")
        if observed is None or main is None or len(series) * series.step < 1.5 * 86400.0:
            continue
        pictures = []
        # Each on its own scale: on that of a good model a bad one is a single colour.
        for key in dict.fromkeys((model, "nominal")):
            column = series.columns.get(f"{key}/{sensor}")
            if key is not None and column is not None:
                label = str(study.get("models", {}).get(key, {}).get("label", key))
                pictures.append((key, label, _own_carpet(series, column.values - observed.values)))
        unit = text.difference_unit(unit_of(study, sensor))
        found.append(SensorCarpet(sensor, label_of(study, sensor), unit, pictures))
    return found


def _own_carpet(series: Series, error: Array) -> Carpet:
    finite = np.abs(error[np.isfinite(error)])
    return carpet(series, error, round_limit(float(np.quantile(finite, 0.98))) if finite.size else 1.0)


# --- sensitivity ----------------------------------------------------------------------------------


def spectrum(study: Mapping[str, Any], sensor: str, entry: Mapping[str, Any]) -> Figure:
    """Spectrum of an output over the runs of the design, with the peaks named.

    Parameters
    ----------
    study : mapping
        As in :class:`~mascarin.report.payload.Study`.
    sensor : str
        Name of the output.
    entry : mapping
        As in :class:`~mascarin.report.payload.Spectrum`.
    """
    frequency = np.asarray(entry.get("frequencies", []), dtype=np.float64)
    power = np.asarray(entry.get("power", []), dtype=np.float64)
    threshold = float(entry.get("threshold", 0.0))
    floor = _FLOOR
    marks = [m for m in (1e-4, 1e-3, 1e-2, 1e-1, 1.0) if m >= floor]
    y = Axis(math.log10(floor), 0.25, [math.log10(m) for m in marks], [f"{100 * m:g}" for m in marks])
    x = Axis.over(frequency, around=0.0, count=6)
    x = Axis(0.0, float(frequency.max(initial=1.0)) * 1.02, *_within(x, float(frequency.max(initial=1.0))))
    chart = Chart(x, y, height=210.0, y_label="% of the variance", x_label="frequency")
    _stems(chart, frequency, power, threshold)
    if threshold > floor:
        chart.level(math.log10(threshold), "threshold")
    _name_peaks(chart, list(entry.get("peaks", []))[:7])
    label = label_of(study, sensor)
    return Figure(label, chart.markup(f"Spectrum of {label}", "spectrum"))


def _stems(chart: Chart, frequency: Array, power: Array, threshold: float) -> None:
    """Ordinates as vertical lines, the highest of each pixel, in two paths: below and above the threshold."""
    high: dict[int, tuple[float, float]] = {}
    for place, value in zip(frequency, power, strict=True):
        pixel = round(chart.px(float(place)))
        if value > _FLOOR and value > high.get(pixel, (0.0, 0.0))[1]:
            high[pixel] = (float(place), float(value))
    for class_, wanted in (("stem", False), ("stem high", True)):
        path = "".join(
            f"M{chart.px(place):.1f} {chart.py(math.log10(_FLOOR)):.1f}V{chart.py(math.log10(value)):.1f}"
            for place, value in high.values()
            if (value > threshold) == wanted
        )
        if path:
            chart.svg.add("path", d=path, class_=class_)


def _within(axis: Axis, high: float) -> tuple[list[float], list[str]]:
    kept = [(t, n) for t, n in zip(axis.ticks, axis.names, strict=True) if 0.0 <= t <= high]
    return [t for t, _ in kept], [n for _, n in kept]


def _name_peaks(chart: Chart, peaks: Sequence[Mapping[str, Any]]) -> None:
    """Number the peaks; the key below names them, highest first."""
    taken: list[tuple[float, float]] = []
    for number, peak in enumerate(sorted(peaks, key=lambda p: -float(p["power"])), start=1):
        x = chart.px(float(peak["frequency"]))
        y = chart.py(math.log10(max(float(peak["power"]), _FLOOR))) - 4.0
        while any(abs(x - a) < 8.0 and abs(y - b) < 9.0 for a, b in taken) and y > 14.0:
            y -= 9.0
        taken.append((x, y))
        chart.svg.label(x, y, str(number), "peak", "middle")


def day_shares(study: Mapping[str, Any], sensor: str, entry: Mapping[str, Any]) -> Figure:
    """Shares of the strongest parameters over the hours of the day, stacked.

    Parameters
    ----------
    study : mapping
        As in :class:`~mascarin.report.payload.Study`.
    sensor : str
        Name of the output.
    entry : mapping
        As in :class:`~mascarin.report.payload.DayShares`.
    """
    hours = np.asarray(entry.get("hours", []), dtype=np.float64)
    shares = 100.0 * np.asarray(entry.get("share", []), dtype=np.float64).reshape(-1, len(hours))
    chart = Chart(
        Axis(float(hours.min(initial=0.0)), float(hours.max(initial=24.0)), *_hour_marks(hours)),
        Axis(0.0, 100.0, (0.0, 25.0, 50.0, 75.0, 100.0), ("0", "25", "50", "75", "100")),
        height=190.0,
        y_label="% of the variance",
        x_label="hour of day",
    )
    below = np.zeros(len(hours))
    for number, row in enumerate(shares[:8]):
        chart.band(hours, below, np.minimum(below + row, 100.0), f"area c{number}")
        below = np.minimum(below + row, 100.0)
    label = label_of(study, sensor)
    return Figure(label, chart.markup(f"Shares over the day for {label}"))


def _hour_marks(hours: Array) -> tuple[list[float], list[str]]:
    low, high = float(hours.min(initial=0.0)), float(hours.max(initial=24.0))
    marks = [float(h) for h in range(0, 25, 6) if low - 1e-9 <= h <= high + 1e-9]
    return marks, [f"{int(m)}" for m in marks]


# --- residuals ------------------------------------------------------------------------------------


def residual_figures(study: Mapping[str, Any], sensor: str, entry: Mapping[str, Any]) -> list[Figure]:
    """Autocorrelation, cumulative periodogram, hour of day and correlations of one residual.

    Parameters
    ----------
    study : mapping
        As in :class:`~mascarin.report.payload.Study`.
    sensor : str
        Name of the sensor.
    entry : mapping
        As in :class:`~mascarin.report.payload.Residuals`.
    """
    label = label_of(study, sensor)
    found = []
    if entry.get("acf"):
        found.append(
            Figure("Autocorrelation", _acf(entry).markup(f"Autocorrelation of the residual, {label}"))
        )
    if entry.get("periodogram_cumulative"):
        drawn = _periodogram(entry).markup(f"Cumulative periodogram of the residual, {label}")
        found.append(Figure("Cumulative periodogram", drawn))
    if entry.get("hour_mean"):
        drawn = _by_hour(study, sensor, entry).markup(f"Residual by hour of day, {label}")
        found.append(Figure("Hour of day", drawn))
    if entry.get("cross_correlation"):
        drawn = _cross(entry).markup(f"Correlation of the residual with the climate over the lag, {label}")
        found.append(Figure("Cross-correlation", drawn))
    elif entry.get("correlation"):
        found.append(Figure("Correlation with the climate", _correlation(label, entry)))
    return found


def _cross(entry: Mapping[str, Any]) -> Chart:
    """Correlation with each channel over the time by which the residual comes later."""
    lags = np.asarray(entry["cross_lags"], dtype=np.float64)
    y = Axis(-1.0, 1.0, (-1.0, -0.5, 0.0, 0.5, 1.0), ("−1", "−0.5", "0", "0.5", "1"))
    high = float(lags.max(initial=1.0))
    marks = [float(m) for m in np.arange(0.0, high + 1e-9, 2.0)]
    chart = _small(Axis(0.0, high, marks, [f"{m:g}" for m in marks]), y, "residual later by, h")
    band = float(entry.get("correlation_band") or 0.0)
    if band > 0.0:
        chart.bar(0.0, high, -band, band, "null-band")
    for number, name in enumerate(sorted(entry["cross_correlation"])):
        values = np.array([np.nan if v is None else v for v in entry["cross_correlation"][name]])
        chart.curve(lags, values, f"d{number % 4}")
    return chart


def _small(x: Axis, y: Axis, x_label: str, y_label: str = "") -> Chart:
    return Chart(x, y, width=250.0, height=150.0, left=34.0, x_label=x_label, y_label=y_label)


def _acf(entry: Mapping[str, Any]) -> Chart:
    every = max(1, len(entry["acf"]) // 400)
    lags, values = np.asarray(entry["acf_lags"])[::every], np.asarray(entry["acf"])[::every]
    low = -1.0 if float(values.min()) < -0.5 else -0.5
    ticks = [t for t in (-1.0, -0.5, 0.0, 0.5, 1.0) if t >= low]
    y = Axis(low, 1.0, ticks, [text.fixed(t, 1) for t in ticks])
    high = float(lags.max())
    marks = [
        float(m) for m in np.arange(0.0, high + 1e-9, 24.0 if high >= 48.0 else 12.0 if high >= 24.0 else 6.0)
    ]
    chart = _small(Axis(0.0, high, marks, [f"{m:g}" for m in marks]), y, "lag, h")
    band = float(entry.get("acf_band", 0.0))
    if band > 0.0:
        chart.bar(0.0, high, -band, band, "null-band")
    chart.curve(lags, values, "error")
    return chart


def _periodogram(entry: Mapping[str, Any]) -> Chart:
    frequency = np.asarray(entry["periodogram_frequency"], dtype=np.float64)
    cumulative = np.asarray(entry["periodogram_cumulative"], dtype=np.float64)
    y = Axis(0.0, 1.0, (0.0, 0.5, 1.0), ("0", "0.5", "1"))
    # Logarithmic: what happens in a day and slower is what matters.
    place = np.log10(np.maximum(frequency, 1e-3))
    low, high = float(place.min()), float(place.max())
    marks = [m for m in (0.1, 1.0, 2.0, 10.0, 48.0) if low <= math.log10(m) <= high]
    x = Axis(low, high, [math.log10(m) for m in marks], [f"{m:g}" for m in marks])
    chart = _small(x, y, "cycles per day")
    # As many points as there are pixels, equally far apart on the logarithmic axis.
    _, kept = np.unique(np.round((place - low) / max(high - low, 1e-9) * 200.0), return_index=True)
    white = frequency[kept] / float(frequency.max())
    band = float(entry.get("periodogram_band", 0.0))
    if band > 0.0:
        chart.band(place[kept], np.maximum(white - band, 0.0), np.minimum(white + band, 1.0), "null-band")
    chart.curve(place[kept], cumulative[kept], "error")
    return chart


def _by_hour(study: Mapping[str, Any], sensor: str, entry: Mapping[str, Any]) -> Chart:
    mean = np.asarray(entry["hour_mean"], dtype=np.float64)
    sd = np.asarray(entry.get("hour_sd", np.zeros(len(mean))), dtype=np.float64)
    hours = np.arange(len(mean), dtype=np.float64) + 0.5
    unit = text.difference_unit(unit_of(study, sensor))
    y = Axis.over(mean - sd, mean + sd, count=4, around=0.0)
    chart = _small(Axis(0.0, 24.0, *_hour_marks(np.array([0.0, 24.0]))), y, "h", unit)
    chart.band(hours, mean - sd, mean + sd, "spread")
    chart.curve(hours, mean, "error")
    return chart


def _correlation(label: str, entry: Mapping[str, Any]) -> Markup:
    rows = list(entry["correlation"].items())
    svg = Svg(250.0, 24.0 + 22.0 * len(rows))
    left, right = 118.0, 242.0
    middle = 0.5 * (left + right)
    band = float(entry.get("correlation_band", 0.0))
    half = 0.5 * (right - left)
    if band > 0.0:
        svg.add(
            "rect",
            x=middle - band * half,
            y=2.0,
            width=2 * band * half,
            height=22.0 * len(rows),
            class_="null-band",
        )
    for row, (name, value) in enumerate(rows):
        y = 2.0 + 22.0 * row
        length = half * max(-1.0, min(1.0, float(value)))
        svg.label(0.0, y + 15.0, name, "tick")
        svg.add(
            "rect", x=min(middle, middle + length), y=y + 5.0, width=abs(length), height=12.0, class_="bar"
        )
        outside = middle + length + (4.0 if value >= 0 else -4.0)
        inside = abs(length) > half - 26.0
        x = middle - (4.0 if value >= 0 else -4.0) if inside else outside
        anchor = "start" if (value >= 0) != inside else "end"
        svg.label(x, y + 15.0, text.fixed(float(value)), "tick", anchor)
    svg.line(middle, 0.0, middle, 2.0 + 22.0 * len(rows), "axis")
    for value in (-1, 0, 1):
        svg.label(middle + half * value, 18.0 + 22.0 * len(rows), text.fixed(value, 0), "tick", "middle")
    return svg.markup(f"Correlation of the residual with the climate, {label}")


# --- parameters, phase change, ledger -------------------------------------------------------------


def parameter_range(entry: Mapping[str, Any]) -> Markup:
    """Range, nominal value, estimate and its interval of one parameter on a line.

    Parameters
    ----------
    entry : mapping
        As in :class:`~mascarin.report.payload.ParameterEntry`.
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


def enthalpy_loop(entry: Mapping[str, Any]) -> Figure | None:
    """Path of a phase-change layer in the plane of temperature and enthalpy, over its law.

    Parameters
    ----------
    entry : mapping
        As in :class:`~mascarin.report.payload.PhaseChange`.
    """
    path_t, path_h = (np.asarray(entry.get(k, []), dtype=np.float64) for k in ("temperature", "enthalpy"))
    law_t, law_h = (
        np.asarray(entry.get(k, []), dtype=np.float64) for k in ("law_temperature", "law_enthalpy")
    )
    if not (path_t.size or law_t.size):
        return None
    chart = Chart(
        Axis.over(path_t, law_t, count=9),
        Axis.over(path_h, law_h, count=9),
        width=420.0,
        height=260.0,
        y_label="enthalpy, kJ/kg",
        x_label="mean of its two faces, °C",
    )
    if law_t.size:
        chart.curve(law_t, law_h, "law")
    days = entry.get("days", [])
    every = max(1, path_t.size // 1500)
    chart.curve(path_t[::every], path_h[::every], "path faint" if days else "path")
    for number, day in enumerate(days):
        chart.curve(np.asarray(day["temperature"]), np.asarray(day["enthalpy"]), f"d{number % 4}")
    label = str(entry.get("label", "phase-change layer"))
    return Figure("Enthalpy loop", chart.markup(f"Enthalpy over temperature of {label}"))


def liquid_fraction(
    series: Series, entry: Mapping[str, Any], spans: Sequence[Sequence[str]]
) -> Figure | None:
    """Liquid fraction over time in the first of some spans.

    Parameters
    ----------
    series : Series
        Curves.
    entry : mapping
        As in :class:`~mascarin.report.payload.PhaseChange`.
    spans : sequence of (start, end)
        Where to look.
    """
    column = series.columns.get(str(entry.get("column")))
    if column is None or not spans:
        return None
    part = series.slice_of(spans[0][0], spans[0][1])
    values = column.values[part]
    hours = _hours(len(values), series.step)
    every = max(1, math.ceil(len(values) / 700))
    axis = Axis(0.0, 1.0, (0.0, 0.25, 0.5, 0.75, 1.0), ("0", "0.25", "0.5", "0.75", "1"))
    chart = Chart(
        time_axis(series.time(part.start), hours[-1] if len(hours) else 1.0),
        axis,
        width=420.0,
        height=260.0,
        y_label="liquid fraction",
    )
    chart.band(hours[::every], np.zeros(len(hours[::every])), values[::every], "liquid")
    chart.curve(hours[::every], values[::every], "path")
    return Figure("Liquid fraction", chart.markup("Liquid fraction over time"))


def ledger_bars(ledger: Mapping[str, Any]) -> Markup | None:
    """Terms of the energy ledger as bars about zero.

    Parameters
    ----------
    ledger : mapping
        As in :class:`~mascarin.report.payload.Ledger`.
    """
    terms = [t for t in ledger.get("terms", []) if t.get("value") is not None]
    if not terms:
        return None
    largest = max(abs(float(t["value"])) for t in terms) or 1.0
    svg = Svg(680.0, 8.0 + 26.0 * len(terms))
    middle, half = 480.0, 100.0
    for row, term in enumerate(terms):
        value = float(term["value"])
        y = 4.0 + 26.0 * row
        length = half * value / largest
        svg.label(0.0, y + 16.0, str(term.get("label", "")), "layer-name")
        kind = "gain" if value >= 0 else "loss"
        svg.add(
            "rect",
            x=min(middle, middle + length),
            y=y + 4.0,
            width=max(abs(length), 0.5),
            height=16.0,
            class_=kind,
        )
        x = middle + length + (6.0 if value >= 0 else -6.0)
        shown = f"{text.significant(value, 4)}\u00a0MJ"
        svg.label(x, y + 16.0, shown, "layer-name", "start" if value >= 0 else "end")
    svg.line(middle, 0.0, middle, 8.0 + 26.0 * len(terms), "axis")
    return svg.markup("Terms of the energy ledger")

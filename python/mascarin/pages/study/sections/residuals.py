"""Analysis of the residuals."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from mascarin._io import units
from mascarin.figures import colors, text
from mascarin.figures.svg.axes import Figure, hour_marks
from mascarin.figures.svg.chart import Axis, Chart
from mascarin.pages.study.data.labels import in_words, label_of, period_label, unit_of
from mascarin.pages.study.data.series import Series
from mascarin.study_document.analysis import DailyCycleEntry, ResidualEntry
from mascarin.study_document.document import StudyDocument

TITLE = "Analysis of the residuals"


def content(study: StudyDocument, _series: Series) -> dict[str, Any] | None:
    """Values of the template."""
    sensors = []
    drivers: list[str] = []
    for sensor, entry in study.residuals.items():
        figures = residual_figures(study, sensor, entry)
        if figures:
            period = entry.period
            drivers = drivers or sorted(entry.cross_correlation)
            sensors.append(
                {
                    "label": label_of(study, sensor),
                    "key": f"residuals-{sensor}",
                    "figures": figures,
                    "period": period_label(study, str(period)) if period else "",
                }
            )
    if not sensors:
        return None
    keys = [{"color": colors.look(number).color, "label": name} for number, name in enumerate(drivers)]
    return {
        "sensors": sensors,
        "keys": keys,
        "rows": _statistics(study),
        "cycle": any(entry.daily_cycle is not None for entry in study.residuals.values()),
        "judged": judged(study),
    }


def judged(study: StudyDocument) -> list[str]:
    """Which residuals are white noise, and which follow the weather, in sentences.

    Parameters
    ----------
    study : StudyDocument
        The results.
    """
    sentences = []
    for white, words in ((True, "stays inside its band"), (False, "leaves its band")):
        names = [label_of(study, s) for s, entry in study.residuals.items() if entry.white is white]
        if names:
            sentences.append(f"The cumulative periodogram of {in_words(names)} {words}.")
    follows = [label_of(study, s) for s, entry in study.residuals.items() if _follows(entry)]
    if follows:
        words = "residual of {} correlates" if len(follows) == 1 else "residuals of {} correlate"
        sentences.append(f"The {words.format(in_words(follows))} with the weather.")
    elif any(entry.correlation for entry in study.residuals.values()):
        sentences.append("No residual correlates with the weather.")
    return sentences


def _follows(entry: ResidualEntry) -> bool:
    """Whether a correlation with the climate is larger than that of white noise."""
    band = float(entry.correlation_band or 0.0)
    return any(abs(value) > band for value in entry.correlation.values() if value is not None)


def _statistics(study: StudyDocument) -> list[dict[str, Any]]:
    """Numbers of each residual: what its samples are worth, and its daily cycle."""
    rows = []
    for sensor, entry in study.residuals.items():
        cycle = entry.daily_cycle or DailyCycleEntry()
        unit = units.difference(unit_of(study, sensor))
        rows.append(
            {
                "label": label_of(study, sensor),
                "samples": text.significant(entry.n, 5),
                "effective": text.significant(entry.effective_n, 2),
                "strongest": _strongest_link(entry),
                "hours": text.percent(entry.hour_share, 0),
                "amplitudes": [
                    f"{text.fixed(amplitude)}\u00a0{unit}"
                    for amplitude in (cycle.measured_amplitude, cycle.simulated_amplitude)
                ],
                "peaks": [text.clock(peak) for peak in (cycle.measured_peak, cycle.simulated_peak)],
                "delay": text.fixed(cycle.delay_minutes, 0, sign=True),
            }
        )
    return rows


def _strongest_link(entry: ResidualEntry) -> str:
    """The climate channel that the residual follows most, and how."""
    links = {name: value for name, value in entry.correlation.items() if value is not None}
    if not links:
        return text.NONE
    name = max(links, key=lambda driver: abs(links[driver]))
    lag = entry.correlation_lag.get(name, 0.0)
    later = f", {lag:.2g}\u00a0h later" if lag else ""
    return f"{name} {text.fixed(links[name], sign=True)}{later}"


def residual_figures(study: StudyDocument, sensor: str, entry: ResidualEntry) -> list[Figure]:
    """Autocorrelation, cumulative periodogram, hour of day and correlations of one residual.

    Parameters
    ----------
    study : StudyDocument
        The results.
    sensor : str
        Name of the sensor.
    entry : ResidualEntry
        Its statistics.
    """
    label = label_of(study, sensor)
    figures = []
    if entry.acf:
        figures.append(
            Figure("Autocorrelation", _acf(entry).markup(f"Autocorrelation of the residual, {label}"))
        )
    if entry.periodogram_cumulative:
        markup = _periodogram(entry).markup(f"Cumulative periodogram of the residual, {label}")
        figures.append(Figure("Cumulative periodogram", markup))
    if entry.hour_mean:
        markup = _by_hour(study, sensor, entry).markup(f"Residual by hour of day, {label}")
        figures.append(Figure("Hour of day", markup))
    if entry.cross_correlation:
        markup = _cross(entry).markup(f"Correlation of the residual with the climate over the lag, {label}")
        figures.append(Figure("Cross-correlation", markup))
    return figures


def _cross(entry: ResidualEntry) -> Chart:
    """Correlation with each channel over the time by which the residual comes later."""
    lags = np.asarray(entry.cross_lags, dtype=np.float64)
    y = Axis(-1.0, 1.0, (-1.0, -0.5, 0.0, 0.5, 1.0), ("−1", "−0.5", "0", "0.5", "1"))
    high = float(lags.max(initial=1.0))
    marks = [float(m) for m in np.arange(0.0, high + 1e-9, 2.0)]
    chart = _small(Axis(0.0, high, marks, [f"{m:g}" for m in marks]), y, "lag of the residual, h")
    band = float(entry.correlation_band or 0.0)
    if band > 0.0:
        chart.bar(0.0, high, -band, band, "null-band")
    for number, name in enumerate(sorted(entry.cross_correlation)):
        values = np.array([np.nan if v is None else v for v in entry.cross_correlation[name]])
        chart.curve(lags, values, f"d{number % 4}")
    return chart


def _small(x: Axis, y: Axis, x_label: str, y_label: str = "") -> Chart:
    return Chart(x, y, width=250.0, height=150.0, margin_left=34.0, x_label=x_label, y_label=y_label)


def _acf(entry: ResidualEntry) -> Chart:
    stride = max(1, len(entry.acf) // 400)
    lags, values = np.asarray(entry.acf_lags)[::stride], np.asarray(entry.acf)[::stride]
    low = -1.0 if float(values.min()) < -0.5 else -0.5
    ticks = [t for t in (-1.0, -0.5, 0.0, 0.5, 1.0) if t >= low]
    y = Axis(low, 1.0, ticks, [text.fixed(t, 1) for t in ticks])
    high = float(lags.max())
    marks = [
        float(m) for m in np.arange(0.0, high + 1e-9, 24.0 if high >= 48.0 else 12.0 if high >= 24.0 else 6.0)
    ]
    chart = _small(Axis(0.0, high, marks, [f"{m:g}" for m in marks]), y, "lag, h")
    band = float(entry.acf_band or 0.0)
    if band > 0.0:
        chart.bar(0.0, high, -band, band, "null-band")
    chart.curve(lags, values, "error")
    return chart


def _periodogram(entry: ResidualEntry) -> Chart:
    frequency = np.asarray(entry.periodogram_frequency, dtype=np.float64)
    cumulative = np.asarray(entry.periodogram_cumulative, dtype=np.float64)
    y = Axis(0.0, 1.0, (0.0, 0.5, 1.0), ("0", "0.5", "1"))
    # Logarithmic: what happens in a day and slower is what matters.
    log_frequency = np.log10(np.maximum(frequency, 1e-3))
    low, high = float(log_frequency.min()), float(log_frequency.max())
    marks = [m for m in (0.1, 1.0, 2.0, 10.0, 48.0) if low <= math.log10(m) <= high]
    x = Axis(low, high, [math.log10(m) for m in marks], [f"{m:g}" for m in marks])
    chart = _small(x, y, "frequency, 1/day")
    # As many points as there are pixels, equally far apart on the logarithmic axis.
    _, samples = np.unique(np.round((log_frequency - low) / max(high - low, 1e-9) * 200.0), return_index=True)
    white = frequency[samples] / float(frequency.max())
    band = float(entry.periodogram_band or 0.0)
    if band > 0.0:
        chart.band(
            log_frequency[samples], np.maximum(white - band, 0.0), np.minimum(white + band, 1.0), "null-band"
        )
    chart.curve(log_frequency[samples], cumulative[samples], "error")
    return chart


def _by_hour(study: StudyDocument, sensor: str, entry: ResidualEntry) -> Chart:
    mean = np.asarray(entry.hour_mean, dtype=np.float64)
    sd = np.asarray(entry.hour_sd or np.zeros(len(mean)), dtype=np.float64)
    hours = np.arange(len(mean), dtype=np.float64) + 0.5
    unit = units.difference(unit_of(study, sensor))
    y = Axis.over(mean - sd, mean + sd, count=4, around=0.0)
    chart = _small(Axis(0.0, 24.0, *hour_marks(np.array([0.0, 24.0]))), y, "h", unit)
    chart.band(hours, mean - sd, mean + sd, "spread")
    chart.curve(hours, mean, "error")
    return chart

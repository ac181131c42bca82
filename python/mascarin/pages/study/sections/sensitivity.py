"""Sensitivity analysis: indices, spectra, indices over the day."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from mascarin._io import units
from mascarin.figures import colors, text
from mascarin.figures.sensitivity import indices_over_time, time_axis
from mascarin.figures.svg.axes import Figure
from mascarin.figures.svg.chart import Axis, Chart
from mascarin.pages.study.data.labels import label_of, layout, parameter_label, unit_of
from mascarin.pages.study.data.series import Array, Series
from mascarin.pages.study.figures import html_figures
from mascarin.study_document.document import StudyDocument
from mascarin.study_document.estimates import (
    DaySharesEntry,
    ParameterEntry,
    PeakEntry,
    ShareEntry,
    SpectrumEntry,
)

TITLE = "Sensitivity analysis"
_MAX_LISTED = 14
#: Parameters that a figure over the day names.
_MAX_NAMED = 8
#: Lowest part of the variance that a spectrum shows.
_MIN_POWER = 1e-4
#: A parameter that was not calibrated.
_DECLARED = ParameterEntry()


def content(study: StudyDocument, _series: Series) -> dict[str, Any] | None:
    """Values of the template."""
    shares = study.sensitivity
    if not shares:
        return None
    paths = _strongest(shares)
    outputs = list(shares)
    rows = [
        {
            "label": parameter_label(study, path),
            "path": path,
            "identified": study.parameters.get(path, _DECLARED).fitted is not None,
            "cells": [_share(shares[output].get(path), study, output) for output in outputs],
        }
        for path in paths
    ]
    return {
        "index": _index(study),
        "dots": any(row["identified"] for row in rows),
        "calibrated": any(entry.fitted is not None for entry in study.parameters.values()),
        "significant": any(float(entry.threshold) > _MIN_POWER for entry in study.spectra.values()),
        "peaks": any(entry.peaks for entry in study.spectra.values()),
        "design": study.sensitivity_design,
        "outputs": [label_of(study, output) for output in outputs],
        "rows": rows,
        "examined": len({path for entries in shares.values() for path in entries}),
        "spectra": [_spectrum(study, key, entry) for key, entry in study.spectra.items()],
        "days": [day_shares(study, key, entry) for key, entry in study.day_shares.items()],
        "day_keys": _day_keys(study),
        "rest": colors.REMAINDER,
        "influential": _influential(study, shares),
        "reference": study.reference.label or "",
        "layout": layout(study, "influential"),
    }


def _index(study: StudyDocument) -> str:
    """Name of the index in the table."""
    design = dict(row[:2] for row in study.sensitivity_design)
    if "index" in design:
        return f"{design['index'][:1].upper()}{design['index'][1:]}"
    morris = design.get("method", "") == "morris"
    return "Relative squared elementary effect" if morris else "First-order index S1"


def _influential(
    study: StudyDocument, shares: Mapping[str, Mapping[str, ShareEntry]]
) -> list[dict[str, str | int]]:
    """The parameters that a publication names, and what became of them here."""
    largest: dict[str, tuple[float, str]] = {}
    for output, entries in shares.items():
        for path, entry in entries.items():
            largest[path] = max(largest.get(path, (-1.0, "")), (float(entry.share or 0.0), output))
    ranked = sorted(largest, key=lambda path: -largest[path][0])
    lines = study.frequencies
    return [
        {
            "symbol": entry.symbol,
            "published": str(entry.frequency or text.NONE),
            "label": parameter_label(study, entry.parameter),
            "path": entry.parameter,
            "frequency": str(lines.get(entry.parameter, text.NONE)),
            "share": text.percent(largest[entry.parameter][0]),
            "sensor": label_of(study, largest[entry.parameter][1]),
            "rank": ranked.index(entry.parameter) + 1,
        }
        for entry in study.reference.influential
        if entry.parameter in largest
    ]


def _strongest(shares: Mapping[str, Mapping[str, ShareEntry]]) -> list[str]:
    largest: dict[str, float] = {}
    for entries in shares.values():
        for path, entry in entries.items():
            largest[path] = max(largest.get(path, 0.0), float(entry.share or 0.0))
    return sorted(largest, key=lambda path: -largest[path])[:_MAX_LISTED]


def _share(entry: ShareEntry | None, study: StudyDocument, output: str) -> dict[str, Any]:
    if entry is None:
        return {"text": text.NONE, "depth": 0, "title": ""}
    share = float(entry.share or 0.0)
    unit = units.difference(unit_of(study, output))
    words = []
    if entry.states("low") and entry.states("high"):
        words.append(f"{text.percent(entry.low)} to {text.percent(entry.high)}")
    if entry.states("effect"):
        words.append(f"effect {text.fixed(entry.effect, sign=True)}\u00a0{unit}")
    shown = f"{100 * share:.0f}" if share >= 0.095 else f"{100 * share:.1f}"
    depth = 0 if share < 0.005 else min(6, 1 + int(share**0.5 * 7.0))
    return {"text": shown, "depth": depth, "title": "; ".join(words)}


def _spectrum(study: StudyDocument, key: str, entry: SpectrumEntry) -> dict[str, Any]:
    peaks = sorted(list(entry.peaks)[:7], key=lambda p: -p.power)
    return {
        "figure": draw_spectrum(study, key, entry),
        "peaks": [
            {
                "number": number,
                "frequency": text.significant(float(peak.frequency), 4),
                "label": parameter_label(study, peak.path),
                "share": text.percent(float(peak.power)),
                "harmonic": int(peak.harmonic),
            }
            for number, peak in enumerate(peaks, start=1)
        ],
    }


def _looks(study: StudyDocument) -> dict[str, colors.Look]:
    """How each parameter is drawn that a figure over the day names."""
    shares = {
        output: {path: math.nan if e.share is None else float(e.share) for path, e in entries.items()}
        for output, entries in study.sensitivity.items()
    }
    looks = colors.parameters(shares, _MAX_NAMED)
    named = [p for entry in study.day_shares.values() for p in entry.paths[:_MAX_NAMED]]
    for path in dict.fromkeys(named):
        looks.setdefault(path, colors.look(len(looks)))
    return looks


def _day_keys(study: StudyDocument) -> list[list[dict[str, Any]]]:
    looks = _looks(study)
    return [
        [
            {"color": looks[path].color, "round": looks[path].round, "label": parameter_label(study, path)}
            for path in entry.paths[:_MAX_NAMED]
        ]
        for entry in study.day_shares.values()
    ]


def draw_spectrum(study: StudyDocument, sensor: str, entry: SpectrumEntry) -> Figure:
    """Spectrum of an output over the runs of the design, with the peaks named.

    Parameters
    ----------
    study : StudyDocument
        The results.
    sensor : str
        Name of the output.
    entry : SpectrumEntry
        The spectrum.
    """
    frequency = np.asarray(entry.frequencies, dtype=np.float64)
    power = np.asarray(entry.power, dtype=np.float64)
    threshold = float(entry.threshold)
    floor = _MIN_POWER
    marks = [m for m in (1e-4, 1e-3, 1e-2, 1e-1, 1.0) if m >= floor]
    y = Axis(math.log10(floor), 0.25, [math.log10(m) for m in marks], [f"{100 * m:g}" for m in marks])
    x = Axis.over(frequency, around=0.0, count=6)
    x = Axis(0.0, float(frequency.max(initial=1.0)) * 1.02, *_within(x, float(frequency.max(initial=1.0))))
    chart = Chart(x, y, height=210.0, y_label="part of the variance, %", x_label="frequency")
    _stems(chart, frequency, power, threshold)
    if threshold > floor:
        chart.level(math.log10(threshold), "threshold")
    _name_peaks(chart, list(entry.peaks)[:7])
    label = label_of(study, sensor)
    return Figure(label, chart.markup(f"Spectrum of {label}", "spectrum"))


def _stems(chart: Chart, frequency: Array, power: Array, threshold: float) -> None:
    """Ordinates as vertical lines, the highest of each pixel, in two paths: below and above the threshold."""
    high: dict[int, tuple[float, float]] = {}
    for number, value in zip(frequency, power, strict=True):
        pixel = round(chart.px(float(number)))
        if value > _MIN_POWER and value > high.get(pixel, (0.0, 0.0))[1]:
            high[pixel] = (float(number), float(value))
    for class_, is_high in (("stem", False), ("stem high", True)):
        path = "".join(
            f"M{chart.px(number):.1f} {chart.py(math.log10(_MIN_POWER)):.1f}"
            f"V{chart.py(math.log10(value)):.1f}"
            for number, value in high.values()
            if (value > threshold) == is_high
        )
        if path:
            chart.svg.add("path", d=path, class_=class_)


def _within(axis: Axis, high: float) -> tuple[list[float], list[str]]:
    ticks = [(t, n) for t, n in zip(axis.ticks, axis.names, strict=True) if 0.0 <= t <= high]
    return [t for t, _ in ticks], [n for _, n in ticks]


def _name_peaks(chart: Chart, peaks: Sequence[PeakEntry]) -> None:
    """Number the peaks; the key below names them, highest first."""
    taken: list[tuple[float, float]] = []
    for number, peak in enumerate(sorted(peaks, key=lambda p: -p.power), start=1):
        x = chart.px(float(peak.frequency))
        y = chart.py(math.log10(max(float(peak.power), _MIN_POWER))) - 4.0
        while any(abs(x - a) < 8.0 and abs(y - b) < 9.0 for a, b in taken) and y > 14.0:
            y -= 9.0
        taken.append((x, y))
        chart.svg.label(x, y, str(number), "peak", "middle")


def day_shares(study: StudyDocument, sensor: str, entry: DaySharesEntry) -> Figure:
    """First-order indices of the most influential parameters over the day, stacked.

    Parameters
    ----------
    study : StudyDocument
        The results.
    sensor : str
        Name of the output.
    entry : DaySharesEntry
        Indices over the day.
    """
    hours = np.asarray(entry.hours, dtype=np.float64)
    index = np.asarray(entry.share, dtype=np.float64).reshape(-1, len(hours))[:_MAX_NAMED]
    looks = _looks(study)
    named = [("", looks[path]) for path in entry.paths[: len(index)]]
    ax = html_figures.axes(340.0, 190.0, bottom=32.0)
    indices_over_time(ax, hours, index, named, remainder="")
    time_axis(ax, hours=True)
    html_figures.titled(ax, "first-order index S1 [%]")
    label = label_of(study, sensor)
    return Figure(label, html_figures.markup_of(ax, f"First-order indices over the day, {label}"))

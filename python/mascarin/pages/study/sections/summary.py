"""The first pages: verdict, what to do next, criteria as one matrix, parameters, and three figures."""

from __future__ import annotations

from datetime import datetime
from typing import Any, Final
from urllib.parse import quote

from markupsafe import Markup

from mascarin._io import units
from mascarin.figures import text
from mascarin.figures.svg.chart import Svg
from mascarin.pages.study.data.labels import (
    label_of,
    note_words,
    parameter_label,
    period_label,
)
from mascarin.pages.study.data.main_results import coverage, judged_criteria, mean_errors, scatter
from mascarin.pages.study.data.series import Series
from mascarin.pages.study.sections import curves
from mascarin.pages.study.sections.energy import ledger_bars
from mascarin.study_document.comparison import CriterionEntry
from mascarin.study_document.document import StudyDocument
from mascarin.study_document.estimates import ParameterEntry

TITLE = "Summary"
#: Parameters that are listed here; the appendix has all.
_LISTED: Final = 10
#: Parameters that one step names.
_NAMED: Final = 4
#: Steps that are named at most.
_STEPS: Final = 5
#: Least width of the figure of sensitivity, its longest bar, and a letter of its names. [px]
_WIDTH: Final = 520.0
_BAR: Final = 90.0
_LETTER: Final = 6.2
#: Letters of the longest name there; the table has names in full.
_LETTERS: Final = 42
#: Parameters in the figure of sensitivity.
_BARS: Final = 8


def content(study: StudyDocument, series: Series) -> dict[str, Any] | None:
    """Values of the template; None where the study has neither criteria nor parameters."""
    matrix, listed = criteria_matrix(study), _parameters(study)
    if matrix is None and not listed:
        return None
    return {
        "verdict": verdict(study),
        "next": next_steps(study),
        "live": live_words(study),
        "matrix": matrix,
        "parameters": listed,
        "parameter_title": _parameter_title(study, len(listed)),
        "stated": any(entry.stated and entry.low is not None for entry in _calibrated(study).values()),
        "blind": curves.last_period(study, series),
        "sensitivity": _sensitivity(study),
        "energy": ledger_bars(study.ledger, narrow=True),
    }


def verdict(study: StudyDocument) -> list[str]:
    """What was reached, in two sentences.

    Parameters
    ----------
    study : StudyDocument
        The results.

    Returns
    -------
    list of str
        At most two sentences; none where nothing was judged.
    """
    return [sentence for sentence in (_criteria_words(study), _trust_words(study)) if sentence]


def _criteria_words(study: StudyDocument) -> str:
    judged = judged_criteria(study)
    if not judged:
        return ""
    met = sum(1 for criterion in judged if criterion.passed)
    total = len(judged)
    share = f"meets {'all ' if met == total else f'{met} of '}{total} criteria"
    if met == 0:
        share = f"meets none of {total} criteria"
    subject = "The calibrated model" if _calibrated(study) else "The model"
    return f"{subject} {share}{_scatter_words(study)}."


def _scatter_words(study: StudyDocument) -> str:
    """Mean and standard deviation of the error in the last judged period, and what that period is."""
    scattered = scatter(study)
    if scattered is None:
        return ""
    period, by_unit = scattered
    words = f"a standard deviation of {_by_unit(by_unit)}"
    means = mean_errors(study, period)
    if means:
        words = f"a mean of {_by_unit(means)} and {words}"
    varying = ", depending on the sensor" if any(len(values) > 1 for values in by_unit.values()) else ""
    note = study.periods[period].note if period in study.periods else ""
    where = f"{period_label(study, period).lower()}{': ' if note else ''}{note}"
    return f"; its error has {words}{varying} ({where})"


def _by_unit(by_unit: dict[str, list[float]]) -> str:
    """Spans of numbers with their units: 0.04 to 0.08 K and 12 W."""
    return " and ".join(
        f"{text.span(values).replace('–', ' to ')}\u00a0{unit}".strip("\u00a0")
        for unit, values in by_unit.items()
    )


def _trust_words(study: StudyDocument) -> str:
    """How far bands and intervals can be trusted."""
    contradictions = len(study.contradictions)
    covered = coverage(study)
    parts = []
    if covered is not None:
        period = period_label(study, covered.period).lower()
        parts.append(
            f"{text.percent(covered.share, 0)} of the values of {period} lie in its prediction bands of "
            f"{text.percent(min(covered.asked), 0)}"
        )
    if contradictions:
        points = "one point" if contradictions == 1 else f"{contradictions} points"
        head = "see the head of this page"
        parts.append(f"the model contradicts its data or what is known in {points} ({head})")
    elif study.parameters:
        parts.append("no contradiction with the data of its identification was seen")
    if not parts:
        return ""
    sentence = "; ".join(parts)
    return f"{sentence[0].upper()}{sentence[1:]}."


def next_steps(study: StudyDocument) -> list[str]:
    """What to do next, the most important first.

    Parameters
    ----------
    study : StudyDocument
        The results.
    """
    steps = [*_unsound(study), *_causes(study), *_bounds(study), *_largest_miss(study)]
    return [*steps, *_weak_parameter(study)][:_STEPS]


def live_words(study: StudyDocument) -> Markup | None:
    """The page in which the calibrated building runs, or why there is none, in one sentence.

    Parameters
    ----------
    study : StudyDocument
        The results.
    """
    live = study.live
    if live.refusal:
        return Markup("There is no page in which the calibrated building runs: {}").format(live.refusal)
    if not live.file:
        return None
    count, start, end = len(live.sliders), *map(datetime.fromisoformat, live.period)
    parameters = f"its {count} calibrated parameters" if count > 1 else "its calibrated parameter"
    if live.fixed:
        names = ", ".join(parameter_label(study, path) for path in live.fixed)
        parameters = f"{count} of its {count + len(live.fixed)} calibrated parameters (not {names})"
    return Markup(
        'Run it here: <a href="{}">{}</a>, beside this file, simulates the calibrated building in a browser '
        "({}){}, with {} for {}."
    ).format(
        quote(live.file),
        live.file,
        text.span_of(start, end),
        " beside the measured values" if live.measured else "",
        "sliders" if count > 1 else "a slider",
        parameters,
    )


def _unsound(study: StudyDocument) -> list[str]:
    """What to do about runs whose balance does not close."""
    if study.sound:
        return []
    return ["Mend the run that is not sound before anything else: the remarks have its warnings."]


def _causes(study: StudyDocument) -> list[str]:
    """The first causes of the diagnosis; what was left out of the data for its defects is none any more."""
    causes = [c for c in study.diagnosis.causes if c.group != "data" or "left out" not in c.text]
    return [" ".join(note_words(study, cause)) for cause in causes[:2]]


def _bounds(study: StudyDocument) -> list[str]:
    """Parameters whose estimate is the end of their range."""
    names = [parameter_label(study, path) for path, entry in study.parameters.items() if entry.at_bound]
    if not names:
        return []
    if len(names) == 1:
        return [
            f"{names[0]} is at the end of the stated range: measure it, state a wider range with its source, "
            "or look for a cause outside of the parameters."
        ]
    shown = [*names[:_NAMED], *([f"{len(names) - _NAMED} more"] if len(names) > _NAMED else [])]
    return [
        f"{', '.join(shown[:-1])} and {shown[-1]} are at the ends of their stated ranges: measure them, "
        "state wider ranges with their sources, or look for a cause outside of the parameters."
    ]


def _largest_miss(study: StudyDocument) -> list[str]:
    """The criterion that is missed by most."""
    missed = [c for c in judged_criteria(study) if not c.passed and c.value is not None]
    if not missed:
        return []

    def ratio(criterion: CriterionEntry) -> float:
        limit = abs(criterion.limit or 0.0)
        return abs(criterion.value or 0.0) / limit if limit else 0.0

    worst = max(missed, key=ratio)
    value, limit = text.beside_limit(worst.value, worst.limit)
    unit = units.difference(worst.unit)
    sensor = f"{label_of(study, worst.sensor)}, " if worst.sensor else ""
    period = period_label(study, worst.period).lower()
    return [
        f"Look first at {sensor}{period}: {worst.name} is missed by most ({value} {unit}, limit "
        f"{limit} {unit})."
    ]


def _weak_parameter(study: StudyDocument) -> list[str]:
    """The parameter whose change would reduce the remaining error most."""
    steps = study.shortfall.steps
    if not steps:
        return []
    name = parameter_label(study, steps[0].path)
    return [f"Determine {name} by a measurement of its own: it would reduce the remaining error most."]


def criteria_matrix(study: StudyDocument) -> dict[str, Any] | None:
    """Criteria and periods as rows, sensors as columns.

    Parameters
    ----------
    study : StudyDocument
        The results.
    """
    judged = judged_criteria(study)
    if not judged:
        return None
    sensors = list(dict.fromkeys(c.sensor for c in judged))
    rows: dict[tuple[str, str], dict[str, Any]] = {}
    for criterion in judged:
        key = (criterion.name, criterion.period)
        row = rows.setdefault(key, {"name": text.typeset(key[0]), "period": key[1], "cells": {}})
        value, _ = text.beside_limit(criterion.value, criterion.limit)
        unit = units.difference(criterion.unit)
        row["cells"][criterion.sensor] = {
            "text": f"{value} {unit}".strip(),
            "passed": criterion.passed,
        }
    return {
        "sensors": [label_of(study, sensor) if sensor else "all" for sensor in sensors],
        "rows": [
            {
                "name": row["name"],
                "period": period_label(study, row["period"]) if row["period"] else "",
                "cells": [row["cells"].get(sensor) for sensor in sensors],
            }
            for row in rows.values()
        ],
        "met": sum(1 for c in judged if c.passed),
        "total": len(judged),
    }


def _calibrated(study: StudyDocument) -> dict[str, ParameterEntry]:
    return {path: entry for path, entry in study.parameters.items() if entry.fitted is not None}


def _largest_shares(study: StudyDocument) -> dict[str, tuple[float, str]]:
    """Largest index of each parameter, and the sensor that has it."""
    largest: dict[str, tuple[float, str]] = {}
    for sensor, entries in study.sensitivity.items():
        for path, entry in entries.items():
            share = float(entry.share or 0.0)
            largest[path] = max(largest.get(path, (-1.0, "")), (share, str(sensor)))
    return largest


def _parameters(study: StudyDocument) -> list[dict[str, str]]:
    """The calibrated parameters that matter most, with their intervals."""
    shares = _largest_shares(study)
    entries = _calibrated(study)
    ordered = sorted(entries, key=lambda path: -shares.get(path, (0.0, ""))[0])[:_LISTED]
    rows = []
    for path in ordered:
        entry = entries[path]
        fitted, interval = text.with_interval(entry.fitted, entry.low, entry.high)
        rows.append(
            {
                "label": parameter_label(study, path),
                "path": path,
                "unit": units.shown(entry.unit or ""),
                "nominal": text.significant(entry.nominal),
                "fitted": fitted,
                "interval": "not stated" if not entry.stated else interval,
            }
        )
    return rows


def _parameter_title(study: StudyDocument, listed: int) -> str:
    """What the list of parameters is: without indices their order is that of the study."""
    total = len(_calibrated(study))
    if total <= listed:
        return "Calibrated parameters"
    if not study.sensitivity:
        return f"The first {listed} of {total} calibrated parameters"
    return f"The {listed} of {total} calibrated parameters that matter most"


def _sensitivity(study: StudyDocument) -> Markup | None:
    """Bars of the largest indices."""
    shares = _largest_shares(study)
    if not shares:
        return None
    strongest = sorted(shares, key=lambda path: -shares[path][0])[:_BARS]
    height = 8.0 + 26.0 * len(strongest)
    largest = max(shares[strongest[0]][0], 1e-9)
    bars = [
        (
            _shortened(parameter_label(study, path)),
            max(_BAR * shares[path][0] / largest, 0.5),
            f"{text.percent(shares[path][0], 0)}, {label_of(study, shares[path][1])}",
        )
        for path in strongest
    ]
    axis = 12.0 + _LETTER * max(len(name) for name, _, _ in bars)
    width = max(axis + length + 12.0 + _LETTER * len(words) for _, length, words in bars)
    svg = Svg(max(width, _WIDTH), height)
    for row, (name, length, words) in enumerate(bars):
        y = 4.0 + 26.0 * row
        svg.label(0.0, y + 16.0, name, "layer-name")
        svg.add("rect", x=axis, y=y + 4.0, width=length, height=16.0, class_="gain")
        svg.label(axis + length + 6.0, y + 16.0, words, "layer-name")
    svg.line(axis, 0.0, axis, height, "axis")
    return svg.markup("Largest sensitivity index of each parameter, and its sensor")


def _shortened(name: str) -> str:
    """A name of at most `_LETTERS` letters: its middle is left out."""
    if len(name) <= _LETTERS:
        return name
    half = (_LETTERS - 3) // 2
    return f"{name[:half]} … {name[-half:]}"

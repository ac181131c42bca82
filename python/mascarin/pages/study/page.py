"""The values of the whole page: head, sections, and data of the interactive curves."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from datetime import datetime
from string import ascii_uppercase
from types import ModuleType
from typing import Any, Final

from mascarin._io import units
from mascarin.figures import colors, text
from mascarin.pages.study.data.labels import (
    band_name,
    bands_stated,
    label_of,
    main_model,
    model_label,
    note_words,
    period_label,
    short_periods,
    unit_of,
)
from mascarin.pages.study.data.main_results import coverage, judged_criteria, mean_errors, scatter
from mascarin.pages.study.data.series import Series
from mascarin.pages.study.figures.comparison_data import model_looks
from mascarin.pages.study.sections import (
    carpets,
    comparison,
    criteria,
    curves,
    data,
    energy,
    error_sources,
    model,
    notes,
    parameters,
    phase_change,
    reproduce,
    residuals,
    sensitivity,
    summary,
)
from mascarin.study_document.analysis import TableEntry
from mascarin.study_document.document import StudyDocument

#: In the order of the page: the summary, then the appendices, which are folded on a screen.
SECTIONS: Final[tuple[ModuleType, ...]] = (
    summary,
    criteria,
    model,
    data,
    sensitivity,
    parameters,
    comparison,
    curves,
    carpets,
    phase_change,
    residuals,
    error_sources,
    energy,
    notes,
    reproduce,
)


def context(study: StudyDocument, series: Series) -> dict[str, Any]:
    """Everything the template needs.

    Parameters
    ----------
    study : StudyDocument
        The results.
    series : Series
        Curves.
    """
    observed = study.observed
    return {
        "title": study.title,
        "intro": study.intro,
        "looks": _looks(study, series),
        "observed": {"label": observed.label, "note": observed.note},
        "sound": study.sound,
        "contradictions": [" ".join(note_words(study, entry)) for entry in study.contradictions],
        "facts": _facts(study),
        "headline": headline(study, series),
        "sections": _sections(study, series),
        "version": study.mascarin_version,
        "created": _created(study.created),
        "day": _created(study.created).partition(",")[0],
    }


def headline(study: StudyDocument, series: Series) -> dict[str, Any] | None:
    """Curves beside the introduction."""
    shown = curves.headline(study, series)
    if shown is None:
        return None
    return {
        "title": f"{shown.title}, {period_label(study, short_periods(study)[-1]).lower()}",
        "values": shown.values,
        "errors": shown.errors,
    }


def _looks(study: StudyDocument, series: Series) -> dict[str, Any]:
    """What the legend of the curves of a sensor shows."""
    model, color_of = main_model(study), model_looks(study)
    main = model_label(study, model)
    nominal = model_label(study, "nominal") if "nominal" in study.models else ""
    return {
        "main": {"label": main, "color": color_of.get(main, "")},
        "nominal": {"label": nominal, "color": color_of[nominal]} if nominal and model != "nominal" else None,
        "band": _band(study) if any(key.startswith("band/") for key in series.columns) else "",
        "uncertain": any(info.uncertainty for info in study.sensor_info.values()),
    }


def _band(study: StudyDocument) -> str:
    """The band in the legend."""
    return band_name(study) if bands_stated(study) else f"{band_name(study)}, not to be used"


def _created(raw: str | None) -> str:
    if not raw:
        return ""
    time = datetime.fromisoformat(raw)
    return f"{text.day(time)}, {time:%H:%M}"


def _facts(study: StudyDocument) -> list[dict[str, str]]:
    """Main results for the head of the page."""
    facts: list[dict[str, str]] = []
    judged = judged_criteria(study)
    if judged:
        met = sum(1 for c in judged if c.passed)
        kind = "pass" if met == len(judged) else "fail"
        facts.append(_fact("Criteria met", f"{met} of {len(judged)}", _by(study), kind))
    facts += coverage_facts(study)
    facts += _errors(study)
    fitted = [p for p in study.parameters.values() if p.fitted is not None]
    if fitted:
        sensed = len({path for shares in study.sensitivity.values() for path in shares})
        note = f"of {sensed} analyzed" if sensed else "from the measurements"
        facts.append(_fact("Calibrated parameters", str(len(fitted)), note))
    closure = study.ledger.closure
    if closure is not None:
        facts.append(
            _fact(
                "Energy-balance residual",
                text.significant(closure, 2),
                "relative to the total heat exchanged",
            )
        )
    return facts


def _by(study: StudyDocument) -> str:
    """Which model was judged."""
    return f"by the {model_label(study, main_model(study))} model" if study.models else "by the model"


def _fact(name: str, value: str, note: str, kind: str = "") -> dict[str, str]:
    return {"name": name, "value": value, "note": note, "kind": kind}


def coverage_facts(study: StudyDocument) -> list[dict[str, str]]:
    """Part of the values of the last period that lies inside the prediction bands.

    Parameters
    ----------
    study : StudyDocument
        The results.
    """
    covered = coverage(study)
    if covered is None:
        return []
    period = period_label(study, covered.period).lower()
    note = f"asked: {_percents(covered.asked)}; {period}, all sensors"
    if len(covered.shares) > 1:
        lowest = min(covered.shares, key=covered.shares.__getitem__)
        if (share := text.percent(covered.shares[lowest], 0)) != text.percent(covered.share, 0):
            note += f"; lowest: {label_of(study, lowest)}, {share}"
    return [_fact("Coverage of the prediction bands", text.percent(covered.share, 0), note)]


def _percents(shares: Collection[float]) -> str:
    return " and ".join(f"{100.0 * share:g}\u00a0%" for share in sorted(shares))


def _errors(study: StudyDocument) -> list[dict[str, str]]:
    """Standard deviation of the error over the sensors in the last period with metrics, for each unit."""
    scattered = scatter(study)
    if scattered is None:
        return []
    period, by_unit = scattered
    means = mean_errors(study, period)
    facts = []
    for unit, values in by_unit.items():
        note = f"standard deviation, {period_label(study, period).lower()}"
        if unit in means:
            note += f"; mean {text.span(means[unit]).replace('–', ' to ')}\u00a0{unit}".rstrip()
        span = f"{text.span(values)}\u00a0{unit}".strip()
        facts.append(_fact(f"Error of the {model_label(study, main_model(study))} model", span, note))
    return facts


def _sections(study: StudyDocument, series: Series) -> list[dict[str, Any]]:
    """The sections with content; appendices have letters."""
    sections: list[dict[str, Any]] = []
    for module in SECTIONS:
        content = module.content(study, series)
        if content:
            key = module.__name__.rpartition(".")[2]
            appendices = sum(section["folded"] for section in sections)
            tables = [_further_table(t) for t in _tables(study) if t.section == key]
            sections.append(
                {
                    "id": key.replace("_", "-"),
                    "template": f"pages/study/sections/{key}.html",
                    "title": module.TITLE,
                    "folded": module is not summary,
                    "mark": "" if module is summary else ascii_uppercase[appendices],
                    "content": content,
                    "tables": tables,
                }
            )
    return sections


def _tables(study: StudyDocument) -> list[TableEntry]:
    """All further tables: those by themselves, and those of the diagnosis and of the choice of days."""
    section_tables = (study.days.table, study.diagnosis.table)
    return [*study.tables, *(table for table in section_tables if table is not None)]


def _further_table(table: TableEntry) -> dict[str, Any]:
    columns = table.columns
    rows = _cells(table)
    return {
        "key": "further-" + "-".join(table.title.lower().split()),
        "numeric": [any(row[k]["numeric"] for row in rows if k < len(row)) for k in range(len(columns))],
        "title": table.title,
        "caption": table.caption,
        "columns": columns,
        "rows": rows,
    }


def _cells(table: TableEntry) -> list[list[dict[str, Any]]]:
    """Cells of a table: numbers with the digits of their uncertainty, else those of a column alike."""
    columns, rows = list(table.columns), table.rows
    sizes = dict(table.uncertainty)
    sizes |= {other: other for other in sizes.values()}
    shown = []
    for k, name in enumerate(columns):
        values = [row[k] if k < len(row) else None for row in rows]
        if name in sizes:
            size = [row[columns.index(sizes[name])] for row in rows]
            words = [text.with_uncertainty(v, s) for v, s in zip(values, size, strict=True)]
        elif name in table.significant:
            words = [text.significant(value, 2) for value in values]
        else:
            words = text.alike([{True: "yes", False: "no"}[v] if isinstance(v, bool) else v for v in values])
        shown.append([_cell(word, value) for word, value in zip(words, values, strict=True)])
    return [list(row) for row in zip(*shown, strict=True)]


def _cell(words: str, value: Any) -> dict[str, Any]:
    return {"text": words, "numeric": isinstance(value, int | float) and not isinstance(value, bool)}


def explorer(study: StudyDocument, series: Series) -> dict[str, Any]:
    """Give what the interactive curves need, ready for JSON."""
    return {
        "series": _shown_units(series.to_dict()),
        "observed": study.observed.label,
        "models": {key: model_label(study, key) for key in study.models},
        "colors": colors.models(study.models),
        "main": main_model(study),
        "sensors": {
            key: {
                "label": label_of(study, key),
                "unit": units.shown(unit_of(study, key)),
                "difference": units.difference(unit_of(study, key)),
                "uncertainty": info.uncertainty,
            }
            for key, info in study.sensor_info.items()
        },
        "spans": _spans(study),
    }


def _shown_units(raw: dict[str, Any]) -> dict[str, Any]:
    columns = {key: {**column, "unit": units.shown(column["unit"])} for key, column in raw["columns"].items()}
    return {**raw, "columns": columns}


def _spans(study: StudyDocument) -> list[Sequence[str]]:
    """Short periods to be tinted behind the curves."""
    return [(period_label(study, period), *study.periods[period].spans[0]) for period in short_periods(study)]

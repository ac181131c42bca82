"""The values of the whole page: head, sections, and data of the interactive curves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime
from types import ModuleType
from typing import Any, Final

from mascarin.report import text
from mascarin.report.labels import label_of, main_model, model_label, period_label, short_periods, unit_of
from mascarin.report.sections import (
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
)
from mascarin.report.series import Series

#: In the order of the page.
SECTIONS: Final[tuple[ModuleType, ...]] = (
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


def context(study: Mapping[str, Any], series: Series) -> dict[str, Any]:
    """Everything the template needs.

    Parameters
    ----------
    study : mapping
        As in :class:`~mascarin.report.schema.Study`.
    series : Series
        Curves.
    """
    observed = study.get("observed", {})
    return {
        "title": study["title"],
        "intro": study.get("intro", []),
        "observed": {"label": observed.get("label", "measured"), "note": observed.get("note", "")},
        "facts": _facts(study),
        "headline": headline(study, series),
        "sections": _sections(study, series),
        "version": study.get("mascarin_version", ""),
        "created": _created(study.get("created")),
        "day": _created(study.get("created")).partition(",")[0],
    }


def headline(study: Mapping[str, Any], series: Series) -> dict[str, Any] | None:
    """Curves beside the introduction."""
    shown = curves.headline(study, series)
    if shown is None:
        return None
    model = main_model(study)
    nominal = "nominal" if "nominal" in study.get("models", {}) and model != "nominal" else None
    return {
        "title": f"{shown.sensor}, {period_label(study, short_periods(study)[-1])}",
        "values": shown.values,
        "errors": shown.errors,
        "model": model_label(study, model),
        "nominal": model_label(study, nominal),
    }


def _created(raw: str | None) -> str:
    if not raw:
        return ""
    time = datetime.fromisoformat(raw)
    return f"{text.day(time)}, {time:%H:%M}"


def _facts(study: Mapping[str, Any]) -> list[dict[str, str]]:
    """Main results for the head of the page."""
    found: list[dict[str, str]] = []
    criteria = study.get("criteria", [])
    judged = [c for c in criteria if c.get("model", "fitted") == main_model(study)] or criteria
    if judged:
        met = sum(1 for c in judged if c.get("passed"))
        kind = "pass" if met == len(judged) else "fail"
        found.append(_fact("Criteria met", f"{met} of {len(judged)}", "by the fitted model", kind))
    worst = _worst(study)
    if worst is not None:
        found.append(worst)
    fitted = [p for p in study.get("parameters", {}).values() if "fitted" in p]
    if fitted:
        sensed = len({path for shares in study.get("sensitivity", {}).values() for path in shares})
        note = f"of {sensed} analyzed" if sensed else "from the measurements"
        found.append(_fact("Calibrated parameters", str(len(fitted)), note))
    closure = study.get("ledger", {}).get("closure")
    if closure is not None:
        found.append(
            _fact(
                "Energy-balance residual",
                text.significant(closure, 2),
                "relative to the total heat exchanged",
            )
        )
    return found


def _fact(name: str, value: str, note: str, kind: str = "") -> dict[str, str]:
    return {"name": name, "value": value, "note": note, "kind": kind}


def _worst(study: Mapping[str, Any]) -> dict[str, str] | None:
    """Standard deviation of the error over the sensors in the last period with metrics."""
    model = main_model(study)
    sensors = study.get("sensors", {})
    for period in reversed(list(study.get("periods", {}))):
        values = [
            (float(periods[period][model]["sd"]), sensor)
            for sensor, periods in sensors.items()
            if periods.get(period, {}).get(model, {}).get("sd") is not None
        ]
        if values:
            low, high = min(values), max(values)
            unit = text.difference_unit(unit_of(study, high[1]))
            spread = text.fixed(low[0]) if low == high else f"{text.fixed(low[0])}–{text.fixed(high[0])}"
            label = str(study["periods"][period].get("label", period)).lower()
            return _fact("Error of the fitted model", f"{spread}\u00a0{unit}", f"standard deviation, {label}")
    return None


def _sections(study: Mapping[str, Any], series: Series) -> list[dict[str, Any]]:
    """The sections with content, numbered in their order."""
    found: list[dict[str, Any]] = []
    for module in SECTIONS:
        content = module.content(study, series)
        if content:
            key = module.__name__.rpartition(".")[2]
            number = len(found) + 1
            tables = [_further_table(t) for t in _tables(study) if t.get("section", "comparison") == key]
            found.append(
                {
                    "id": key.replace("_", "-"),
                    "template": f"sections/{key}.html",
                    "title": module.TITLE,
                    "number": number,
                    "content": content,
                    "tables": tables,
                }
            )
    return found


def _tables(study: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """All further tables: those by themselves, and those of the diagnosis and of the choice of days."""
    own = [study.get(key, {}).get("table") for key in ("days", "diagnosis")]
    return [*study.get("tables", []), *(table for table in own if table)]


def _further_table(table: Mapping[str, Any]) -> dict[str, Any]:
    rows = [[_cell(value) for value in row] for row in table.get("rows", [])]
    return {
        "title": table.get("title", ""),
        "caption": table.get("caption", ""),
        "columns": table.get("columns", []),
        "rows": rows,
    }


def _cell(value: Any) -> dict[str, Any]:
    if isinstance(value, bool) or value is None or isinstance(value, str):
        shown = (
            {True: "yes", False: "no", None: text.NONE}.get(value, value)
            if not isinstance(value, str)
            else value
        )
        return {"text": shown, "numeric": False}
    return {"text": text.significant(float(value), 3), "numeric": True}


def explorer(study: Mapping[str, Any], series: Series) -> dict[str, Any]:
    """Give what the interactive curves need, ready for JSON."""
    return {
        "series": series.to_dict(),
        "observed": study.get("observed", {}).get("label", "measured"),
        "models": {key: model_label(study, key) for key in study.get("models", {})},
        "main": main_model(study),
        "sensors": {
            key: {
                "label": label_of(study, key),
                "unit": text.unit(unit_of(study, key)),
                "difference": text.difference_unit(unit_of(study, key)),
                "uncertainty": info.get("uncertainty", 0.0),
            }
            for key, info in study.get("sensor_info", {}).items()
        },
        "spans": _spans(study),
    }


def _spans(study: Mapping[str, Any]) -> list[Sequence[str]]:
    """Short periods to be tinted behind the curves."""
    return [
        (period_label(study, period), *study["periods"][period]["spans"][0])
        for period in short_periods(study)
    ]

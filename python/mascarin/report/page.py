"""What the page shows, section by section, as plain values for the template."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import Any

from markupsafe import Markup

from mascarin.report import drawing, figures, text
from mascarin.report.carpet import legend
from mascarin.report.payload import Series, moment

_STRONGEST = 14
#: Notes of this title stand with the aims.
_MISSED = "Where an aim is missed"


def context(study: Mapping[str, Any], series: Series) -> dict[str, Any]:
    """Everything the template needs.

    Parameters
    ----------
    study : mapping
        As in :class:`~mascarin.report.payload.Study`.
    series : Series
        Curves.
    """
    observed = study.get("observed", {})
    return {
        "title": study["title"],
        "intro": study.get("intro", []),
        "observed": {"label": observed.get("label", "measured"), "note": observed.get("note", "")},
        "facts": _facts(study),
        "headline": _headline(study, series),
        "sections": _sections(study, series),
        "version": study.get("mascarin_version", ""),
        "created": _created(study.get("created")),
        "day": _created(study.get("created")).partition(",")[0],
    }


def _headline(study: Mapping[str, Any], series: Series) -> dict[str, Any] | None:
    curves = figures.headline(study, series)
    if curves is None:
        return None
    model = figures.main_model(study)
    nominal = "nominal" if "nominal" in study.get("models", {}) and model != "nominal" else None
    return {
        "title": f"{curves.sensor}, {_period_label(study, figures.short_periods(study)[-1])}",
        "values": curves.values,
        "errors": curves.errors,
        "model": _model_label(study, model),
        "nominal": _model_label(study, nominal),
    }


def _created(raw: str | None) -> str:
    if not raw:
        return ""
    time = datetime.fromisoformat(raw)
    return f"{text.day(time)}, {time:%H:%M}"


def _facts(study: Mapping[str, Any]) -> list[dict[str, str]]:
    """Few numbers that say how it went."""
    found: list[dict[str, str]] = []
    criteria = study.get("criteria", [])
    judged = [c for c in criteria if c.get("model", "fitted") == figures.main_model(study)] or criteria
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
        note = f"of {sensed} examined" if sensed else "from the measurements"
        found.append(_fact("Parameters identified", str(len(fitted)), note))
    closure = study.get("ledger", {}).get("closure")
    if closure is not None:
        found.append(
            _fact("Energy balance closes to", text.significant(closure, 2), "of the heat turned over")
        )
    return found


def _fact(name: str, value: str, note: str, kind: str = "") -> dict[str, str]:
    return {"name": name, "value": value, "note": note, "kind": kind}


def _worst(study: Mapping[str, Any]) -> dict[str, str] | None:
    """Standard deviation of the error over the sensors in the last period with metrics."""
    model = figures.main_model(study)
    sensors = study.get("sensors", {})
    for period in reversed(list(study.get("periods", {}))):
        values = [
            (float(periods[period][model]["sd"]), sensor)
            for sensor, periods in sensors.items()
            if periods.get(period, {}).get(model, {}).get("sd") is not None
        ]
        if values:
            low, high = min(values), max(values)
            unit = text.difference_unit(figures.unit_of(study, high[1]))
            spread = text.fixed(low[0]) if low == high else f"{text.fixed(low[0])}–{text.fixed(high[0])}"
            label = str(study["periods"][period].get("label", period)).lower()
            return _fact("Scatter of the error", f"{spread}\u00a0{unit}", f"standard deviation, {label}")
    return None


# --- sections -------------------------------------------------------------------------------------


def _sections(study: Mapping[str, Any], series: Series) -> list[dict[str, Any]]:
    """The sections that have something to say, numbered in their order."""
    makers = [
        ("criteria", "Does it hold?", _criteria(study)),
        ("model", "What was modelled", _model(study)),
        ("data", "The data", _data(study)),
        ("sensitivity", "Which parameters matter", _sensitivity(study)),
        ("parameters", "What was identified", _parameters(study)),
        ("comparison", "How close it comes", _comparison(study)),
        ("curves", "Simulated and observed", _curves(study, series)),
        ("carpets", "When it errs", _carpets(study, series)),
        ("phase-change", "The phase change", _phase_change(study, series)),
        ("residuals", "What is left in the residuals", _residuals(study)),
        ("shortfall", "What would take the rest away", _shortfall(study)),
        ("energy", "Where the heat went", _energy(study)),
        ("notes", "What the numbers say", _notes(study)),
        ("reproduce", "How to get the same result", _reproduce(study)),
    ]
    found: list[dict[str, Any]] = []
    for key, title, content in makers:
        if content:
            number = len(found) + 1
            tables = [
                _plain_table(t, study)
                for t in study.get("tables", [])
                if t.get("section", "comparison") == key
            ]
            found.append({"id": key, "title": title, "number": number, "content": content, "tables": tables})
    return found


def _plain_table(table: Mapping[str, Any], study: Mapping[str, Any]) -> dict[str, Any]:
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


def _period_label(study: Mapping[str, Any], key: str) -> str:
    return str(study.get("periods", {}).get(key, {}).get("label", text.plain_path(key)))


def _model_label(study: Mapping[str, Any], key: str | None) -> str:
    if key is None:
        return ""
    return str(study.get("models", {}).get(key, {}).get("label", text.plain_path(key)))


def _criteria(study: Mapping[str, Any]) -> list[dict[str, Any]] | None:
    """Criteria grouped by model and period."""
    groups: dict[tuple[str, str], list[dict[str, Any]]] = {}
    for criterion in study.get("criteria", []):
        key = (str(criterion.get("model", "")), str(criterion.get("period", "")))
        unit = str(criterion.get("unit", ""))
        value, limit = criterion.get("value"), criterion.get("limit")
        groups.setdefault(key, []).append(
            {
                "name": text.typeset(str(criterion.get("name", ""))),
                "sensor": figures.label_of(study, str(criterion.get("sensor", "")))
                if criterion.get("sensor")
                else "",
                "value": text.fixed(value),
                "limit": text.fixed(limit),
                "unit": text.difference_unit(unit),
                "passed": bool(criterion.get("passed")),
                "fill": _fill(value, limit),
            }
        )
    main = figures.main_model(study)
    ordered = sorted(groups.items(), key=lambda item: item[0][0] != main)
    return [
        {
            "model": _model_label(study, model or None),
            "period": _period_label(study, period) if period else "",
            "rows": rows,
            "met": sum(1 for row in rows if row["passed"]),
            "open": model == main or not model,
        }
        for (model, period), rows in ordered
    ] or None


def _fill(value: float | None, limit: float | None) -> float:
    """How much of a limit is used up, in percent of the bar (the limit at 75 %)."""
    if value is None or not limit:
        return 0.0
    return round(min(100.0, 75.0 * abs(float(value)) / abs(float(limit))), 1)


def _model(study: Mapping[str, Any]) -> dict[str, Any] | None:
    building = study.get("building")
    if not building:
        return None
    sensors = study.get("sensor_info", {})
    numbered = [
        {"number": n, "label": figures.label_of(study, key), "output": info.get("output", "")}
        for n, (key, info) in enumerate(sensors.items(), start=1)
    ]
    return {
        "name": building.get("name", ""),
        "view": drawing.view(building),
        "section": drawing.section(building, sensors),
        "sensors": numbered,
        "layers": [
            {
                "name": text.plain_path(str(c.get("name"))),
                "drawing": drawing.layers(building, c, sensors),
                "surfaces": _built_so(building, str(c.get("name"))),
            }
            for c in building.get("constructions", [])
        ],
        "zones": [
            {"name": text.plain_path(str(z.get("name"))), "volume": text.with_unit(z.get("volume"), "m3")}
            for z in building.get("zones", [])
        ],
        "surfaces": [_surface(s) for s in building.get("surfaces", [])],
        "site": [[text.plain_path(str(k)), text.typeset(str(v))] for k, v in building.get("site", [])],
        "choices": [
            *([text.plain_path(str(k)), text.choice(str(v))] for k, v in building.get("choices", [])),
            *([["state at the start", text.typeset(str(study["start"]))]] if study.get("start") else []),
        ],
        "assumptions": _assumptions(study),
    }


def _built_so(building: Mapping[str, Any], construction: str) -> list[str]:
    """Surfaces of a construction; none where it is but the one that bears its name."""
    names = [
        text.plain_path(str(surface.get("name")))
        for surface in building.get("surfaces", [])
        if surface.get("construction") == construction
    ]
    return [] if names == [text.plain_path(construction)] else names


def _surface(surface: Mapping[str, Any]) -> dict[str, str]:
    return {
        "name": text.plain_path(str(surface.get("name"))),
        "construction": text.plain_path(str(surface.get("construction"))),
        "area": text.fixed(surface.get("area")),
        "tilt": text.fixed(surface.get("tilt"), 0),
        "azimuth": text.NONE
        if surface.get("tilt") in (0.0, 180.0)
        else text.fixed(surface.get("azimuth"), 0),
        "outside": text.plain_path(str(surface.get("outside", ""))),
        "inside": text.plain_path(str(surface.get("inside", ""))),
        "film_outside": text.choice(str(surface.get("film_outside", "") or text.NONE)),
        "film_inside": text.choice(str(surface.get("film_inside", "") or text.NONE)),
    }


def _assumptions(study: Mapping[str, Any]) -> list[dict[str, str]]:
    return [
        {
            "path": str(entry.get("path", "")),
            "value": text.significant(entry.get("value")),
            "range": f"{text.significant(entry.get('low'))} to {text.significant(entry.get('high'))}",
            "unit": text.unit(str(entry.get("unit", ""))),
            "source": str(entry.get("source", "")),
        }
        for entry in study.get("assumptions", [])
    ]


def _data(study: Mapping[str, Any]) -> dict[str, Any] | None:
    periods = []
    for period in study.get("periods", {}).values():
        spans = [text.span_of(moment(a), moment(b)) for a, b in period.get("spans", [])]
        shown = "; ".join(spans[:4]) + (f"; and {len(spans) - 4} more spans" if len(spans) > 4 else "")
        days = sum((moment(b) - moment(a)).total_seconds() for a, b in period.get("spans", [])) / 86400.0
        periods.append(
            {
                "label": period.get("label", ""),
                "spans": shown,
                "days": text.significant(days),
                "note": period.get("note", ""),
            }
        )
    sensors = []
    for number, (key, info) in enumerate(study.get("sensor_info", {}).items(), start=1):
        band = info.get("uncertainty")
        unit = text.difference_unit(str(info.get("unit", "degC")))
        sensors.append(
            {
                "number": number,
                "label": figures.label_of(study, key),
                "output": info.get("output", ""),
                "band": f"±{text.significant(band)}\u00a0{unit}" if band else text.NONE,
            }
        )
    if not periods and not sensors and "quality" not in study:
        return None
    return {
        "periods": periods,
        "sensors": sensors,
        "examined": "quality" in study,
        "quality": [_quality(entry) for entry in study.get("quality", [])],
    }


def _quality(entry: Mapping[str, Any]) -> dict[str, Any]:
    return {
        "channel": entry.get("channel", ""),
        "kind": text.plain_path(str(entry.get("kind", ""))),
        "start": _time(entry.get("start")),
        "end": _time(entry.get("end")),
        "count": f"{int(entry.get('count', 0)):,}".replace(",", "\u202f"),
        "detail": entry.get("detail", ""),
        "masked": bool(entry.get("masked")),
    }


def _time(raw: str | None) -> str:
    if not raw:
        return text.NONE
    time = datetime.fromisoformat(raw)
    return f"{text.day(time)} {time:%H:%M}"


# --- sensitivity ----------------------------------------------------------------------------------


def _sensitivity(study: Mapping[str, Any]) -> dict[str, Any] | None:
    shares = study.get("sensitivity", {})
    if not shares:
        return None
    paths = _strongest(shares)
    outputs = list(shares)
    rows = [
        {
            "label": _parameter_label(study, path),
            "path": path,
            "identified": "fitted" in study.get("parameters", {}).get(path, {}),
            "cells": [_share(shares[output].get(path), study, output) for output in outputs],
        }
        for path in paths
    ]
    return {
        "design": study.get("sensitivity_design", []),
        "outputs": [figures.label_of(study, output) for output in outputs],
        "rows": rows,
        "examined": len({path for entries in shares.values() for path in entries}),
        "spectra": [_spectrum(study, key, entry) for key, entry in study.get("spectra", {}).items()],
        "days": [figures.day_shares(study, key, entry) for key, entry in study.get("day_shares", {}).items()],
        "day_keys": _day_keys(study),
        "influential": _influential(study, shares),
        "reference": study.get("reference", {}).get("label", ""),
        "layout": _layout(study, "influential"),
    }


def _layout(study: Mapping[str, Any], what: str) -> str:
    """Which table of the publication a table is laid out after, as the end of a caption."""
    table = study.get("reference", {}).get("tables", {}).get(what)
    return f" (after {table} of {study['reference']['label']})" if table else ""


def _influential(
    study: Mapping[str, Any], shares: Mapping[str, Mapping[str, Any]]
) -> list[dict[str, str | int]]:
    """The parameters that a publication names, and what became of them here."""
    largest: dict[str, tuple[float, str]] = {}
    for output, entries in shares.items():
        for path, entry in entries.items():
            largest[path] = max(largest.get(path, (-1.0, "")), (float(entry.get("share", 0.0)), output))
    ranked = sorted(largest, key=lambda path: -largest[path][0])
    lines = study.get("frequencies", {})
    return [
        {
            "symbol": str(entry.get("symbol", "")),
            "published": str(entry.get("frequency") or text.NONE),
            "label": _parameter_label(study, entry["parameter"]),
            "path": entry["parameter"],
            "frequency": str(lines.get(entry["parameter"], text.NONE)),
            "share": text.percent(largest[entry["parameter"]][0]),
            "sensor": figures.label_of(study, largest[entry["parameter"]][1]),
            "rank": ranked.index(entry["parameter"]) + 1,
        }
        for entry in study.get("reference", {}).get("influential", [])
        if entry.get("parameter") in largest
    ]


def _strongest(shares: Mapping[str, Mapping[str, Any]]) -> list[str]:
    largest: dict[str, float] = {}
    for entries in shares.values():
        for path, entry in entries.items():
            largest[path] = max(largest.get(path, 0.0), float(entry.get("share", 0.0)))
    return sorted(largest, key=lambda path: -largest[path])[:_STRONGEST]


def _parameter_label(study: Mapping[str, Any], path: str) -> str:
    """Name of a parameter for people; of several when a peak belongs to a combination of them."""
    label = study.get("parameters", {}).get(path, {}).get("label")
    return str(label) if label else text.PATH.sub(lambda found: text.plain_path(found.group()), path)


def _share(entry: Mapping[str, Any] | None, study: Mapping[str, Any], output: str) -> dict[str, Any]:
    if entry is None:
        return {"text": text.NONE, "depth": 0, "title": ""}
    share = float(entry.get("share", 0.0))
    unit = text.difference_unit(figures.unit_of(study, output))
    words = []
    if "low" in entry and "high" in entry:
        words.append(f"{text.percent(entry['low'])} to {text.percent(entry['high'])}")
    if "effect" in entry:
        words.append(f"effect {text.fixed(entry['effect'], sign=True)}\u00a0{unit}")
    shown = f"{100 * share:.0f}" if share >= 0.095 else f"{100 * share:.1f}"
    depth = 0 if share < 0.005 else min(6, 1 + int(share**0.5 * 7.0))
    return {"text": shown, "depth": depth, "title": "; ".join(words)}


def _spectrum(study: Mapping[str, Any], key: str, entry: Mapping[str, Any]) -> dict[str, Any]:
    peaks = sorted(list(entry.get("peaks", []))[:7], key=lambda p: -float(p["power"]))
    return {
        "figure": figures.spectrum(study, key, entry),
        "peaks": [
            {
                "number": number,
                "frequency": text.significant(float(peak["frequency"]), 4),
                "label": _parameter_label(study, str(peak.get("path", ""))),
                "share": text.percent(float(peak["power"])),
                "harmonic": int(peak.get("harmonic", 1)),
            }
            for number, peak in enumerate(peaks, start=1)
        ],
    }


def _day_keys(study: Mapping[str, Any]) -> list[list[dict[str, str]]]:
    return [
        [
            {"class": f"c{number}", "label": _parameter_label(study, path)}
            for number, path in enumerate(entry.get("paths", [])[:8])
        ]
        for entry in study.get("day_shares", {}).values()
    ]


# --- parameters and comparison --------------------------------------------------------------------


def _parameters(study: Mapping[str, Any]) -> dict[str, Any] | None:
    entries = study.get("parameters", {})
    if not entries:
        return None
    referenced = any("reference_fitted" in e or "reference_nominal" in e for e in entries.values())
    rows = []
    for path, entry in entries.items():
        interval = [entry.get("low"), entry.get("high")]
        allowed = entry.get("range")
        rows.append(
            {
                "label": _parameter_label(study, path),
                "path": path,
                "unit": text.unit(str(entry.get("unit", ""))),
                "nominal": text.significant(entry.get("nominal")),
                "fitted": text.significant(entry.get("fitted")),
                "interval": _between(interval) if None not in interval else "",
                "drawing": figures.parameter_range(entry) if allowed else "",
                "reference_nominal": text.significant(entry.get("reference_nominal")),
                "reference_fitted": text.significant(entry.get("reference_fitted")),
                "at_bound": bool(entry.get("at_bound")),
                "reason": entry.get("reason", ""),
            }
        )
    return {
        "rows": rows,
        "referenced": referenced,
        "layout": _layout(study, "parameters"),
        "reference": study.get("reference", {}).get("label", "Publication"),
        "facts": study.get("identification", []),
        "correlation": _correlation(study),
        "published": _published(study),
    }


def _published(study: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Estimates of the models whose parameters a publication has too, beside its own."""
    found = []
    for model, entries in study.get("variant_parameters", {}).items():
        rows = [
            {
                "label": _parameter_label(study, path),
                "path": path,
                "unit": text.unit(str(entry.get("unit", ""))),
                "nominal": text.significant(entry.get("nominal")),
                "fitted": text.significant(entry.get("fitted")),
                "interval": _between([entry["low"], entry["high"]])
                if None not in (entry.get("low"), entry.get("high"))
                else text.NONE,
                "reference_nominal": text.significant(entry.get("reference_nominal")),
                "reference_fitted": text.significant(entry.get("reference_fitted")),
                "at_bound": bool(entry.get("at_bound")),
            }
            for path, entry in entries.items()
        ]
        if _is_published(entries):
            note = study.get("models", {}).get(model, {}).get("note", "")
            found.append({"model": _model_label(study, model), "note": note, "rows": rows})
    return found


def _is_published(entries: Mapping[str, Mapping[str, Any]]) -> bool:
    """Whether most parameters of a model are those of a publication; one or two do not make it that."""
    return 2 * sum("reference_fitted" in entry for entry in entries.values()) > len(entries)


def _between(ends: Sequence[Any]) -> str:
    return f"{text.significant(ends[0])} to {text.significant(ends[1])}"


def _correlation(study: Mapping[str, Any]) -> dict[str, Any] | None:
    entry = study.get("correlation")
    if not entry or len(entry.get("paths", [])) < 2:
        return None
    labels = [_parameter_label(study, path) for path in entry["paths"]]
    rows = []
    for i, line in enumerate(entry["matrix"]):
        cells = [
            {
                "text": text.fixed(float(value)),
                "depth": min(6, int(abs(float(value)) * 7.0)),
                "negative": value < 0,
            }
            for value in line[: i + 1]
        ]
        rows.append({"number": i + 1, "label": labels[i], "cells": cells})
    return {"rows": rows, "labels": labels}


def _comparison(study: Mapping[str, Any]) -> dict[str, Any] | None:
    sensors = study.get("sensors", {})
    if not sensors:
        return None
    model = figures.main_model(study)
    reference = study.get("reference", {})
    periods = [_period_table(study, period, model, reference) for period in study.get("periods", {})]
    return {
        "model": _model_label(study, model),
        "nominal": _model_label(study, "nominal") if "nominal" in study.get("models", {}) else "",
        "reference": {"label": reference.get("label", ""), "note": reference.get("note", "")},
        "periods": [p for p in periods if p["rows"]],
        "models": _model_table(study),
    }


def _period_table(
    study: Mapping[str, Any], period: str, model: str | None, reference: Mapping[str, Any]
) -> dict[str, Any]:
    rows = []
    published = False
    for sensor, periods in study.get("sensors", {}).items():
        metrics = periods.get(period, {}).get(model)
        if metrics is None or metrics.get("sd") is None:
            continue
        paper = reference.get("sensors", {}).get(sensor, {}).get(period, {})
        published = published or bool(paper)
        nominal = periods[period].get("nominal", {})
        rows.append(
            {
                "label": figures.label_of(study, sensor),
                "unit": text.difference_unit(figures.unit_of(study, sensor)),
                "bias": text.fixed(metrics.get("bias"), sign=True),
                "sd": text.fixed(metrics.get("sd")),
                "sd_nominal": text.fixed(nominal.get("sd")),
                "sd_paper": text.fixed(paper.get("sd"), 1),
                "rmse": text.fixed(metrics.get("rmse")),
                "max": text.fixed(metrics.get("max_error"), sign=True),
                "max_paper": text.fixed(paper.get("max_error"), 1, sign=True),
                "max_percent": text.fixed(metrics.get("max_error_percent"), 1),
                "max_percent_paper": text.fixed(paper.get("max_error_percent"), 1),
                "mean_percent": text.fixed(metrics.get("mean_error_percent"), 1),
                "mean_percent_paper": text.fixed(paper.get("mean_error_percent"), 1),
            }
        )
    units = list(dict.fromkeys(row["unit"] for row in rows))
    return {
        "label": _period_label(study, period),
        "rows": rows,
        "layout": _layout(study, period) if published else "",
        "published": published,
        "unit": units[0] if len(units) == 1 else "",
    }


def _model_table(study: Mapping[str, Any]) -> dict[str, Any] | None:
    """Standard deviation of every model on the last period in which more than one has metrics."""
    sensors = study.get("sensors", {})
    for period in reversed(list(study.get("periods", {}))):
        models = [
            m
            for m in study.get("models", {})
            if any(p.get(period, {}).get(m, {}).get("sd") is not None for p in sensors.values())
        ]
        if len(models) < 2:
            continue
        table = {
            m: [periods.get(period, {}).get(m, {}).get("sd") for periods in sensors.values()] for m in models
        }
        best = [
            min((v for v in column if v is not None), default=None)
            for column in zip(*table.values(), strict=True)
        ]
        rows = [
            {
                "label": _model_label(study, m),
                "note": study["models"][m].get("note", ""),
                "own": _own_estimates(study, m),
                "cells": [
                    {"text": text.fixed(v), "best": v is not None and v == b}
                    for v, b in zip(values, best, strict=True)
                ],
            }
            for m, values in table.items()
        ]
        labels = [figures.label_of(study, sensor) for sensor in sensors]
        return {"period": _period_label(study, period), "labels": labels, "rows": rows}
    return None


def _own_estimates(study: Mapping[str, Any], model: str) -> str:
    """What was identified in a model beside what the fitted one has, in words."""
    entries = study.get("variant_parameters", {}).get(model, {})
    if _is_published(entries):
        return ""  # has a table of its own
    return "; ".join(
        f"{_parameter_label(study, path)} {text.with_unit(entry.get('fitted'), str(entry.get('unit', '')))}"
        for path, entry in entries.items()
        if path not in study.get("parameters", {})
    )


# --- curves, carpets, residuals and the rest ------------------------------------------------------


def _curves(study: Mapping[str, Any], series: Series) -> dict[str, Any] | None:
    sensors = [key for key in study.get("sensor_info", {}) if f"observed/{key}" in series.columns]
    if not sensors:
        return None
    model = figures.main_model(study)
    return {
        "sensors": [{"key": key, "label": figures.label_of(study, key)} for key in sensors],
        "models": [
            {"key": key, "label": _model_label(study, key), "main": key == model}
            for key in study.get("models", {})
            if any(f"{key}/{sensor}" in series.columns for sensor in sensors)
        ],
        "beside": [
            {"key": key, "label": column.label}
            for key, column in series.columns.items()
            if key.split("/")[0] in ("weather", "state")
        ],
        "periods": [
            {"label": _period_label(study, period), "start": spans[0][0], "end": spans[-1][1]}
            for period, entry in study.get("periods", {}).items()
            if (spans := entry.get("spans"))
        ],
        "printed": [
            {"label": _period_label(study, period), "curves": figures.period_curves(study, series, period)}
            for period in figures.short_periods(study)
        ],
        "model": _model_label(study, model),
        "nominal": _model_label(study, "nominal") if "nominal" in study.get("models", {}) else "",
        "band": any(info.get("uncertainty") for info in study.get("sensor_info", {}).values()),
        "foreseen": any(key.startswith("band/") for key in series.columns),
        "step": text.significant(series.step / 60.0),
        "timezone": study.get("timezone", ""),
    }


def _carpets(study: Mapping[str, Any], series: Series) -> dict[str, Any] | None:
    found = figures.carpets(study, series)
    if not found:
        return None
    return {"sensors": found, "scale": legend()}


def _phase_change(study: Mapping[str, Any], series: Series) -> list[dict[str, Any]] | None:
    found = []
    short = figures.short_periods(study)
    spans = study["periods"][short[-1]]["spans"] if short else []
    for entry in study.get("phase_change", []):
        drawn = [figures.enthalpy_loop(entry), figures.liquid_fraction(series, entry, spans)]
        found.append(
            {
                "label": entry.get("label", ""),
                "figures": [f for f in drawn if f is not None],
                "rows": entry.get("rows", []),
                "days": [
                    {"class": f"d{number % 4}", "label": str(day.get("label", ""))}
                    for number, day in enumerate(entry.get("days", []))
                ],
                "law": bool(entry.get("law_temperature")),
                "period": _period_label(study, short[-1]) if short else "",
            }
        )
    return found or None


def _residuals(study: Mapping[str, Any]) -> dict[str, Any] | None:
    found = []
    drivers: list[str] = []
    for sensor, entry in study.get("residuals", {}).items():
        drawn = figures.residual_figures(study, sensor, entry)
        if drawn:
            period = entry.get("period")
            drivers = drivers or sorted(entry.get("cross_correlation", {}))
            found.append(
                {
                    "label": figures.label_of(study, sensor),
                    "figures": drawn,
                    "period": _period_label(study, str(period)) if period else "",
                }
            )
    if not found:
        return None
    keys = [{"class": f"d{number % 4}", "label": name} for number, name in enumerate(drivers)]
    return {"sensors": found, "keys": keys, "rows": _statistics(study)}


def _statistics(study: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Numbers of each residual: what its samples are worth, and its daily cycle."""
    rows = []
    for sensor, entry in study.get("residuals", {}).items():
        cycle = entry.get("daily_cycle") or {}
        unit = text.difference_unit(figures.unit_of(study, sensor))
        rows.append(
            {
                "label": figures.label_of(study, sensor),
                "samples": text.significant(entry.get("n"), 5),
                "effective": text.significant(entry.get("effective_n"), 2),
                "strongest": _strongest_link(entry),
                "hours": text.percent(entry.get("hour_share"), 0),
                "amplitudes": [
                    f"{text.fixed(cycle.get(f'{which}_amplitude'))}\u00a0{unit}"
                    for which in ("measured", "simulated")
                ],
                "peaks": [text.clock(cycle.get(f"{which}_peak")) for which in ("measured", "simulated")],
                "delay": text.fixed(cycle.get("delay_minutes"), 0, sign=True),
            }
        )
    return rows


def _shortfall(study: Mapping[str, Any]) -> dict[str, Any] | None:
    """Aims, and the parameters that would lead to them."""
    aims, found = study.get("aims", []), study.get("shortfall", {})
    if not aims and not found:
        return None
    sensors = list(found.get("sd", {}))
    changes = found["steps"][-1]["changes"] if found.get("steps") else {}
    rows = [{"label": "as it is", "change": "", "cells": _scatter(found.get("sd", {}), sensors)}]
    rows += [
        {
            "label": f"{'with' if number == 0 else 'and'} {_parameter_label(study, step['path'])}",
            "change": text.fixed(100.0 * changes[step["path"]], 0, sign=True),
            "cells": _scatter(step["sd"], sensors),
        }
        for number, step in enumerate(found.get("steps", []))
    ]
    if "every" in found:
        label = f"all {found['every']['parameters']} parameters"
        rows.append({"label": label, "change": "", "cells": _scatter(found["every"]["sd"], sensors)})
    wished = _aimed_scatter(aims, str(found.get("period", "")), sensors)
    units = {text.difference_unit(figures.unit_of(study, sensor)) for sensor in sensors}
    return {
        "aims": _aims(study, aims),
        "met": sum(1 for aim in aims if aim.get("passed")),
        "judged": len(aims),
        "labels": [figures.label_of(study, sensor) for sensor in sensors],
        "rows": rows if sensors else [],
        "wished": wished,
        "named": bool(found.get("steps")),
        "notes": [
            words
            for note in study.get("notes", [])
            if note.get("title") == _MISSED
            for words in _note_words(study, note)
        ],
        "period": _period_label(study, str(found.get("period", ""))).lower(),
        "unit": units.pop() if len(units) == 1 else "",
    }


def _scatter(sd: Mapping[str, float], sensors: Sequence[str]) -> list[str]:
    return [text.fixed(sd.get(sensor), 3) for sensor in sensors]


def _aimed_scatter(aims: Sequence[Mapping[str, Any]], period: str, sensors: Sequence[str]) -> list[str]:
    """The standard deviation aimed at, by sensor; nothing where there is no such aim."""
    wished = {
        aim.get("sensor"): aim.get("limit")
        for aim in aims
        if aim.get("metric") == "sd" and aim.get("period") == period
    }
    return [text.fixed(wished.get(sensor), 3) for sensor in sensors] if wished else []


def _aims(study: Mapping[str, Any], aims: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Aims with what was reached in each period beside each other."""
    periods = list(dict.fromkeys(str(aim.get("period", "")) for aim in aims))
    rows: dict[tuple[str, str, float], dict[str, Any]] = {}
    for aim in aims:
        key = (str(aim.get("name", "")), str(aim.get("sensor", "")), float(aim.get("limit", 0.0)))
        row = rows.setdefault(
            key,
            {
                "label": figures.label_of(study, key[1]) if key[1] else "",
                "name": text.typeset(key[0]),
                "limit": f"{text.fixed(key[2])}\u00a0{text.difference_unit(str(aim.get('unit', '')))}",
                "found": {},
            },
        )
        row["found"][str(aim.get("period", ""))] = {
            "text": text.fixed(aim.get("value")),
            "passed": bool(aim.get("passed")),
        }
    return {
        "periods": [_period_label(study, period) for period in periods],
        "rows": [{**row, "cells": [row["found"].get(period) for period in periods]} for row in rows.values()],
    }


def _energy(study: Mapping[str, Any]) -> dict[str, Any] | None:
    ledger = study.get("ledger")
    if not ledger:
        return None
    return {
        "closure": text.significant(ledger.get("closure"), 2),
        "drawing": figures.ledger_bars(ledger),
        "rows": [
            {"label": str(t.get("label", "")), "value": text.significant(t.get("value"), 4)}
            for t in ledger.get("terms", [])
        ],
        "model": _model_label(study, ledger.get("model")),
    }


def _reproduce(study: Mapping[str, Any]) -> dict[str, Any] | None:
    if not any(key in study for key in ("command", "versions", "sources", "inputs")):
        return None
    return {
        "command": "\n".join(study.get("command", [])),
        "inputs": study.get("inputs", []),
        "versions": study.get("versions", {}),
        "seed": study.get("seed"),
        "run_time": text.duration(float(study["run_time"])) if study.get("run_time") is not None else "",
        "sources": [_source(source) for source in study.get("sources", [])],
    }


def _strongest_link(entry: Mapping[str, Any]) -> str:
    """The climate channel that the residual follows most, and how."""
    links = {name: value for name, value in entry.get("correlation", {}).items() if value is not None}
    if not links:
        return text.NONE
    name = max(links, key=lambda one: abs(links[one]))
    lag = entry.get("correlation_lag", {}).get(name, 0.0)
    later = f", {lag:.2g}\u00a0h later" if lag else ""
    return f"{name} {text.fixed(links[name], sign=True)}{later}"


def _notes(study: Mapping[str, Any]) -> list[dict[str, Any]] | None:
    """Notes under their titles, those of one title together."""
    found: dict[str, list[str]] = {}
    for note in study.get("notes", []):
        if note.get("title") != _MISSED:
            found.setdefault(str(note.get("title", "")), []).extend(_note_words(study, note))
    return [{"title": title, "paragraphs": paragraphs} for title, paragraphs in found.items()] or None


def _note_words(study: Mapping[str, Any], note: Mapping[str, Any]) -> list[str]:
    return [_named(study, words) for words in str(note.get("text", "")).split("\n\n")]


def _named(study: Mapping[str, Any], words: str) -> str:
    """A note with the sensor that it begins with by its name for people."""
    for sensor in study.get("sensor_info", {}):
        for begin, end in ((f"{sensor}: ", ": "), (f"'{sensor}' ", " ")):
            if words.startswith(begin):
                return f"{figures.label_of(study, sensor)}{end}{words.removeprefix(begin)}"
    for path in study.get("parameters", {}):
        words = words.replace(path, _parameter_label(study, path))
    return words


def _source(source: Mapping[str, str]) -> Markup:
    """Text of a source; its DOI, given or found in the text, becomes a link."""
    words, doi = str(source.get("text", "")), str(source.get("doi", ""))
    found = text.DOI.search(words)
    if not doi.startswith("10.") and found:
        doi = found.group(1)
        words = words[: found.start()] + words[found.end() :]
    if not doi.startswith("10."):
        return Markup("{}").format(words)
    return Markup('{} <a href="https://doi.org/{}" rel="noopener noreferrer">doi:{}</a>').format(
        words.rstrip(" ,;"), doi, doi
    )


def explorer(study: Mapping[str, Any], series: Series) -> dict[str, Any]:
    """Give what the interactive curves need, ready for JSON."""
    return {
        "series": series.to_dict(),
        "observed": study.get("observed", {}).get("label", "measured"),
        "models": {key: _model_label(study, key) for key in study.get("models", {})},
        "main": figures.main_model(study),
        "sensors": {
            key: {
                "label": figures.label_of(study, key),
                "unit": text.unit(figures.unit_of(study, key)),
                "difference": text.difference_unit(figures.unit_of(study, key)),
                "uncertainty": info.get("uncertainty", 0.0),
            }
            for key, info in study.get("sensor_info", {}).items()
        },
        "spans": _spans(study),
    }


def _spans(study: Mapping[str, Any]) -> list[Sequence[str]]:
    """Short periods to be tinted behind the curves."""
    return [
        (_period_label(study, period), *study["periods"][period]["spans"][0])
        for period in figures.short_periods(study)
    ]

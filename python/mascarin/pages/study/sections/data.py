"""Measured data: periods, sensors, quality."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime
from typing import Any

from mascarin._io import units
from mascarin.figures import text
from mascarin.pages.study.data.labels import label_of
from mascarin.pages.study.data.series import Series, moment

TITLE = "Measured data"


def content(study: Mapping[str, Any], _series: Series) -> dict[str, Any] | None:
    """Values of the template."""
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
        unit = units.difference(str(info.get("unit", "degC")))
        sensors.append(
            {
                "number": number,
                "label": label_of(study, key),
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

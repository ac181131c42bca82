"""Measured data: periods, sensors, quality."""

from __future__ import annotations

from datetime import datetime
from typing import Any, get_args

from mascarin._io import units
from mascarin.figures import text
from mascarin.pages.study.data.labels import label_of
from mascarin.pages.study.data.series import Series, moment
from mascarin.study_document.analysis import QualityEntry
from mascarin.study_document.document import StudyDocument
from mascarin.tables.quality.defects import Defect

TITLE = "Measured data"


def content(study: StudyDocument, _series: Series) -> dict[str, Any] | None:
    """Values of the template."""
    periods = []
    for period in study.periods.values():
        spans = [text.span_of(moment(a), moment(b)) for a, b in period.spans]
        shown = "; ".join(spans[:4]) + (f"; and {len(spans) - 4} more spans" if len(spans) > 4 else "")
        days = sum((moment(b) - moment(a)).total_seconds() for a, b in period.spans) / 86400.0
        periods.append(
            {
                "label": period.label or "",
                "spans": shown,
                "days": text.significant(days),
                "note": period.note,
            }
        )
    sensors = []
    for number, (key, info) in enumerate(study.sensor_info.items(), start=1):
        band = info.uncertainty
        unit = units.difference(info.unit)
        sensors.append(
            {
                "number": number,
                "label": label_of(study, key),
                "output": info.output,
                "band": f"±{text.significant(band)}\u00a0{unit}" if band else text.NONE,
            }
        )
    if not periods and not sensors and not study.states("quality"):
        return None
    return {
        "periods": periods,
        "sensors": sensors,
        "examined": study.states("quality"),
        "kinds": ", ".join(text.plain_path(kind) for kind in get_args(Defect)),
        "quality": [_quality(entry) for entry in study.quality],
    }


def _quality(entry: QualityEntry) -> dict[str, Any]:
    return {
        "channel": entry.channel,
        "kind": text.plain_path(entry.kind),
        "start": _time(entry.start),
        "end": _time(entry.end),
        "count": f"{entry.count:,}".replace(",", "\u202f"),
        "detail": entry.detail,
        "use": _use(entry),
    }


def _use(entry: QualityEntry) -> str:
    """What became of suspicious values in the comparison."""
    if not entry.compared:
        return "not compared"
    if entry.kind == "missing":
        return "no value"
    return "excluded" if entry.masked else "included"


def _time(raw: str | None) -> str:
    if not raw:
        return text.NONE
    time = datetime.fromisoformat(raw)
    return f"{text.day(time)} {time:%H:%M}"

"""Measured data: periods, sensors, quality."""

from __future__ import annotations

from collections.abc import Sequence
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
        "quality": _quality(study.quality),
    }


def _quality(entries: Sequence[QualityEntry]) -> list[dict[str, Any]]:
    """One row for the suspicious values of one column, kind and use; the table of the results has all."""
    groups: dict[tuple[str, str, str], list[QualityEntry]] = {}
    for entry in entries:
        groups.setdefault((entry.channel, entry.kind, _use(entry)), []).append(entry)
    return [
        {
            "channel": channel,
            "kind": text.plain_path(kind),
            "start": _time(group[0].start),
            "end": _time(group[-1].end),
            "count": _count(sum(entry.count for entry in group)),
            "detail": _detail(group),
            "use": use,
        }
        for (channel, kind, use), group in groups.items()
    ]


def _detail(group: Sequence[QualityEntry]) -> str:
    """What is known of suspicious values; of several stretches of them that of the longest."""
    if len(group) == 1:
        return group[0].detail
    longest = max(group, key=lambda entry: entry.count)
    return (
        f"{len(group)} times; the longest from {_time(longest.start)}, {_count(longest.count)} values: "
        f"{longest.detail}"
    )


def _count(number: int) -> str:
    return f"{number:,}".replace(",", "\u202f")


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

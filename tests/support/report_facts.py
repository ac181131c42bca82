"""A small study in which everything occurs, and its opposites: one kind of fact changed at a time."""

from __future__ import annotations

import html
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from functools import cache
from typing import Any, Final
from unittest import mock

from jinja2 import Environment
from markupsafe import Markup

import report_example
from mascarin.pages.frame.cross_references import CrossReferences
from mascarin.pages.frame.template import environment
from mascarin.pages.study import html as study_page
from mascarin.pages.study.data.series import Column, Series
from mascarin.pages.study.figures import html_figures
from mascarin.pages.study.sections import curves, sensitivity
from mascarin.study_document.document import StudyDocument
from mascarin.study_document.entry import ResultEntry

#: Sensors of the small study.
SENSORS: Final = ("room_air", "steel_sheet")
#: Every so many values of the series of the larger example.
_STRIDE: Final = 8
#: A time as text.
_TIME: Final = re.compile(r"\d{4}-\d{2}-\d{2}T")


def complete() -> tuple[dict[str, Any], Series]:
    """A study with two sensors in which every part of the document has something."""
    study, series = report_example.lgi()
    other = [sensor for sensor in study["sensor_info"] if sensor not in SENSORS]
    for part in ("sensor_info", "sensors", "sensitivity", "spectra", "day_shares", "residuals"):
        study[part] = {key: entry for key, entry in study[part].items() if key not in other}
    for part in ("criteria", "aims"):
        study[part] = [entry for entry in study[part] if entry["sensor"] not in other]
    shortfall = study["shortfall"]
    for entry in (shortfall, *shortfall["steps"], shortfall["all_parameters"]):
        entry["sd"] = {key: value for key, value in entry["sd"].items() if key not in other}
    columns = {
        key: Column(column.values[::_STRIDE], column.label, column.unit)
        for key, column in series.columns.items()
        if key.split("/")[-1] not in other
    }
    for sensor in SENSORS:
        half = Column(columns[f"fitted/{sensor}"].values * 0.0 + 0.5, "half-width", "K")
        columns[f"band/{sensor}"] = half
    return study | _further(study), replace(series, step=series.step * _STRIDE, columns=columns)


def _further(study: dict[str, Any]) -> dict[str, Any]:
    """Parts that the larger example has not."""
    loop, hysteresis = study["phase_change"][0], {"hysteresis": True}
    path = {"hysteresis": True, "own_path": "it supercools by 2 K."}
    stretch = {"start": "2010-09-21T03:00", "end": "2010-09-22T04:00"}
    for extra in ("zones.room.infiltration.constant", "materials.polyurethane.conductivity"):
        estimate = {"nominal": 1.0, "fitted": 1.2, "low": 1.1, "high": 1.3, "range": [0.0, 2.0]}
        study["parameters"][extra] = estimate | {"stated": True}
    for sensor, white in zip(SENSORS, (True, False), strict=True):
        study["residuals"][sensor]["white"] = white
    study["building"]["equipment"] = [["internal gain people of room", "80 W, schedule evening"]]
    return {
        "contradictions": [
            {"text": "room_air: the band contains 61 % of its own data", "kind": "coverage", "subject": "x"}
        ],
        "processors": 2,
        "run_time": 84.0,
        "created": "2026-11-21T11:30:00",
        "timezone": "UTC+4",
        "live": {
            "file": "model.html", "period": ["2010-09-20T00:00", "2010-09-25T00:00"],
            "sliders": list(study["parameters"])[:2], "fixed": list(study["parameters"])[2:3],
            "measured": True,
        },
        "warnings": ["fitted: the energy balance does not close"],
        "sound": True,
        "band": {
            sensor: {"confidence": 0.95, "stated": True, "half_width": 0.5, "held": {"blind": 0.93}}
            for sensor in SENSORS
        },
        "coefficients": {
            "period": "identification",
            "models": {m: {"surfaces.roof.outside.convection": 11.0} for m in ("nominal", "fitted")},
        },
        "quality": [
            {"channel": "T_3", "kind": "spike", "count": 2, "masked": False, "compared": False} | stretch,
            {"channel": "T_1", "kind": "stuck", "count": 200, "detail": "20.4", "masked": True} | stretch,
            {"channel": "T_2", "kind": "spike", "count": 2, "detail": "40.1", "masked": False} | stretch,
        ],
        "diagnosis": {
            "causes": [{"group": "sensor", "text": "'room_air' reads 0.4 K too high.", "told": True}],
            "table": {
                "title": "Causes", "caption": "Certain ones first.", "columns": ["no.", "kind"],
                "rows": [[1, "offset"]], "section": "error_sources",
            },
        },
        "start": "from a run of 10 days",
        "phase_change": [loop | {"hysteresis": False}, loop | hysteresis, loop | path],
    }  # fmt: skip


@dataclass(frozen=True)
class Page:
    """Clauses of a report by section; those of the head and the foot are under ''."""

    clauses: dict[str, tuple[str, ...]]

    def words(self, section: str | None = None) -> str:
        """All clauses, or those of a section."""
        chosen = self.clauses.values() if section is None else [self.clauses.get(section, ())]
        return "\n".join(clause for clauses in chosen for clause in clauses)


class _References:
    """Numbers of tables and figures of the page that is made now."""

    of_page = CrossReferences()

    def __getattr__(self, name: str) -> Any:
        return getattr(self.of_page, name)


@cache
def _templates() -> Environment:
    """The templates, compiled once for all pages."""
    return environment(_References())  # type: ignore[arg-type]


def _environment(references: CrossReferences) -> Environment:
    _References.of_page = references
    return _templates()


def page_of(study: Any, series: Series) -> Page:
    """The words of a report, by section; curves, which have no words of their own, are not drawn."""
    with (
        mock.patch.object(study_page, "environment", _environment),
        mock.patch.object(html_figures, "axes"),
        mock.patch.object(html_figures, "titled"),
        mock.patch.object(html_figures, "markup_of", return_value=Markup("<svg></svg>")),
        mock.patch.object(curves, "series"), mock.patch.object(curves, "errors"),
        mock.patch.object(curves, "together"), mock.patch.object(curves, "errors_together"),
        mock.patch.object(sensitivity, "indices_over_time"), mock.patch.object(sensitivity, "time_axis"),
    ):  # fmt: skip
        text = study_page.page(StudyDocument.read(study), series)
    text = _NO_SENTENCES.sub(" ", text)
    parts = re.split(r'<section id="([^"]+)"[^>]*>', text)
    last, _, foot = parts[-1].partition("</main>")
    named = zip(["", *parts[1::2]], [parts[0] + foot, *parts[2:-1:2], last], strict=True)
    return Page({name: tuple(_clauses(part)) for name, part in named})


#: Keys whose words are names of other parts of the document.
_NAMES: Final = {
    "path", "paths", "parameter", "sensor", "period", "model", "column", "section", "surface", "construction",
}  # fmt: skip
#: Elements that have no sentences: names of columns, choices and sections.
_NO_SENTENCES: Final = re.compile(
    r"<(script|style|svg|pre|th|h2|h3|dt|label|legend|nav|select|summary)\b.*?</\1>", re.DOTALL
)
#: Elements in which words of different kinds stand; others are within a sentence.
_WITHIN: Final = re.compile(r"</?(a|strong|span|code|sub|sup|em|b|i)\b[^>]*>")


def _clauses(part: str, least: int = 1) -> Iterator[str]:
    for block in re.split(r"<[^>]*>", _WITHIN.sub("", part)):
        words = " ".join(html.unescape(block).split())
        words = re.sub(r"\b(Table|Figure) \d+", r"\1", words)
        for clause in re.split(r"(?<=[.;:!?])\s+", words):
            if len(clause.split()) >= least:
                yield clause


def instances(value: Any) -> Iterator[ResultEntry]:
    """All entries of a document."""
    if isinstance(value, ResultEntry):
        yield value
        for key in value.model_fields_set:
            yield from instances(getattr(value, key))
    elif isinstance(value, dict):
        for item in value.values():
            yield from instances(item)
    elif isinstance(value, list):
        for item in value:
            yield from instances(item)


def fields(document: StudyDocument) -> list[tuple[type[ResultEntry], str]]:
    """Kinds of facts that a document states: class and key."""
    return list(
        dict.fromkeys((type(entry), key) for entry in instances(document) for key in entry.model_fields_set)
    )


def changed(
    value: Any,
    kind: type[ResultEntry],
    key: str,
    how: Callable[[dict[str, Any]], Any],
    *,
    stated: bool = True,
) -> Any:
    """A document in which all facts of one kind are changed; with `stated` only those that are stated."""
    if isinstance(value, ResultEntry):
        facts = {
            name: changed(getattr(value, name), kind, key, how, stated=stated)
            for name in value.model_fields_set
        }
        if type(value) is kind and (key in facts or not stated):
            facts = how(facts)
        return type(value).model_construct(_fields_set=set(facts), **facts)
    if isinstance(value, dict):
        return {name: changed(item, kind, key, how, stated=stated) for name, item in value.items()}
    if isinstance(value, list):
        return [changed(item, kind, key, how, stated=stated) for item in value]
    return value


def opposite(value: Any) -> Any:
    """Another value of the same type."""
    if isinstance(value, bool):
        return not value
    if isinstance(value, int):
        return 2 * value + 1
    if isinstance(value, float):
        return 1.5 * value + 0.125
    if isinstance(value, str):
        if _TIME.match(value):
            return (datetime.fromisoformat(value) - timedelta(hours=1)).isoformat()
        return f"other {value}" if value else value
    if isinstance(value, list):
        return [opposite(item) for item in value]
    if isinstance(value, dict):
        return {name: opposite(item) for name, item in value.items()}
    return value


def removed(value: Any, kind: type[ResultEntry], key: str) -> Any:
    """A document in which one kind of facts is not stated."""
    return changed(value, kind, key, lambda stated: {name: v for name, v in stated.items() if name != key})


def all_changed(value: Any, chosen: Callable[[Any], bool]) -> Any:
    """A document in which all facts of a type are changed; names of parts stay."""
    if isinstance(value, ResultEntry):
        stated = {
            name: getattr(value, name) if name in _NAMES else all_changed(getattr(value, name), chosen)
            for name in value.model_fields_set
        }
        return type(value).model_construct(_fields_set=set(stated), **stated)
    if isinstance(value, dict):
        return {name: all_changed(item, chosen) for name, item in value.items()}
    if isinstance(value, list):
        return [all_changed(item, chosen) for item in value]
    return opposite(value) if chosen(value) else value

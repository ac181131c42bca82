"""Names of sensors, periods, models and parameters for readers."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import timedelta
from typing import Any

from mascarin.figures import text
from mascarin.pages.study.data.series import moment

#: Periods longer than this are not printed as curves. [days]
_MAX_PRINTED_DAYS = 16.0


def label_of(study: Mapping[str, Any], sensor: str) -> str:
    """Name of a sensor."""
    return str(study.get("sensor_info", {}).get(sensor, {}).get("label", text.plain_path(sensor)))


def unit_of(study: Mapping[str, Any], sensor: str) -> str:
    """Unit of a sensor as in the study."""
    return str(study.get("sensor_info", {}).get(sensor, {}).get("unit", "degC"))


def main_model(study: Mapping[str, Any]) -> str | None:
    """Key of the model whose errors are shown: the fitted one, else the first."""
    models = list(study.get("models", {}))
    return "fitted" if "fitted" in models else (models[0] if models else None)


def short_periods(study: Mapping[str, Any]) -> list[str]:
    """Periods short enough to be printed as curves."""
    keys = []
    for key, period in study.get("periods", {}).items():
        spans = period.get("spans", [])
        if len(spans) == 1 and moment(spans[0][1]) - moment(spans[0][0]) <= timedelta(days=_MAX_PRINTED_DAYS):
            keys.append(key)
    return keys


def period_label(study: Mapping[str, Any], key: str) -> str:
    """Name of a period."""
    return str(study.get("periods", {}).get(key, {}).get("label", text.plain_path(key)))


def model_label(study: Mapping[str, Any], key: str | None) -> str:
    """Name of a model."""
    if key is None:
        return ""
    return str(study.get("models", {}).get(key, {}).get("label", text.plain_path(key)))


def parameter_label(study: Mapping[str, Any], path: str) -> str:
    """Name of a parameter, or of several for a peak of a combination."""
    label = study.get("parameters", {}).get(path, {}).get("label")
    return str(label) if label else text.PATH.sub(lambda match: text.plain_path(match.group()), path)


def layout(study: Mapping[str, Any], what: str) -> str:
    """The table of the publication with the same layout, as the end of a caption."""
    table = study.get("reference", {}).get("tables", {}).get(what)
    return f" (after {table} of {study['reference']['label']})" if table else ""


def is_published(entries: Mapping[str, Mapping[str, Any]]) -> bool:
    """Whether most parameters of a model are those of a publication."""
    return 2 * sum("reference_fitted" in entry for entry in entries.values()) > len(entries)


def note_words(study: Mapping[str, Any], note: Mapping[str, Any]) -> list[str]:
    """Paragraphs of a note, with sensors and parameters by their names for readers."""
    return [_named(study, words) for words in str(note.get("text", "")).split("\n\n")]


def _named(study: Mapping[str, Any], words: str) -> str:
    """A note with the names of sensors and parameters for readers."""
    for sensor in study.get("sensor_info", {}):
        for begin, end in ((f"{sensor}: ", ": "), (f"'{sensor}' ", " ")):
            if words.startswith(begin):
                return f"{label_of(study, sensor)}{end}{words.removeprefix(begin)}"
    for path in study.get("parameters", {}):
        words = words.replace(path, parameter_label(study, path))
    return words

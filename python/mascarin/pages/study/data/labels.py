"""Names of sensors, periods, models and parameters for readers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import timedelta

from mascarin.figures import text
from mascarin.pages.study.data.series import moment
from mascarin.study_document.analysis import CauseEntry, NoteEntry
from mascarin.study_document.comparison import ModelEntry, PeriodEntry, SensorEntry
from mascarin.study_document.document import StudyDocument
from mascarin.study_document.estimates import ParameterEntry

#: Periods longer than this are not printed as curves. [days]
_MAX_PRINTED_DAYS = 16.0
_NO_SENSOR = SensorEntry()


def label_of(study: StudyDocument, sensor: str) -> str:
    """Name of a sensor."""
    return _label(study.sensor_info, sensor)


def unit_of(study: StudyDocument, sensor: str) -> str:
    """Unit of a sensor as in the study."""
    return study.sensor_info.get(sensor, _NO_SENSOR).unit


def main_model(study: StudyDocument) -> str | None:
    """Key of the model whose errors are shown: the fitted one, else the first."""
    models = list(study.models)
    return "fitted" if "fitted" in models else (models[0] if models else None)


def short_periods(study: StudyDocument) -> list[str]:
    """Periods short enough to be printed as curves."""
    keys = []
    for key, period in study.periods.items():
        spans = period.spans
        if len(spans) == 1 and moment(spans[0][1]) - moment(spans[0][0]) <= timedelta(days=_MAX_PRINTED_DAYS):
            keys.append(key)
    return keys


def period_label(study: StudyDocument, key: str) -> str:
    """Name of a period."""
    return _label(study.periods, key)


def model_label(study: StudyDocument, key: str | None) -> str:
    """Name of a model."""
    return "" if key is None else _label(study.models, key)


def _label(entries: Mapping[str, SensorEntry | PeriodEntry | ModelEntry], key: str) -> str:
    """Name of an entry: as stated, else its key."""
    label = entries[key].label if key in entries else None
    return text.plain_path(key) if label is None else label


def parameter_label(study: StudyDocument, path: str) -> str:
    """Name of a parameter, or of several for a peak of a combination."""
    label = study.parameters[path].label if path in study.parameters else None
    return label or text.PATH.sub(lambda match: text.plain_path(match.group()), path)


def layout(study: StudyDocument, what: str) -> str:
    """The table of the publication with the same layout, as the end of a caption."""
    table = study.reference.tables.get(what)
    return f" (after {table} of {study.reference.label})" if table else ""


def band_name(study: StudyDocument) -> str:
    """The prediction bands by their confidence; "95 % prediction interval" where none is stated."""
    shares = sorted({float(band.confidence) for band in study.band.values()}) or [0.95]
    return f"{' and '.join(f'{100.0 * share:g}' for share in shares)}\u00a0% prediction interval"


def bands_stated(study: StudyDocument) -> bool:
    """Whether all prediction bands are to be used."""
    return all(band.stated for band in study.band.values())


def in_words(names: Sequence[str]) -> str:
    """Names as a list in a sentence."""
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last


def is_published(entries: Mapping[str, ParameterEntry]) -> bool:
    """Whether most parameters of a model are those of a publication."""
    return 2 * sum(entry.reference_fitted is not None for entry in entries.values()) > len(entries)


def note_words(study: StudyDocument, note: NoteEntry | CauseEntry) -> list[str]:
    """Paragraphs of a note, with sensors and parameters by their names for readers."""
    return [_named(study, words) for words in note.text.split("\n\n")]


def _named(study: StudyDocument, words: str) -> str:
    """A note with the names of sensors and parameters for readers."""
    for sensor in study.sensor_info:
        for begin, end in ((f"{sensor}: ", ": "), (f"'{sensor}' ", " ")):
            if words.startswith(begin):
                return f"{label_of(study, sensor)}{end}{words.removeprefix(begin)}"
    for path in study.parameters:
        words = words.replace(path, parameter_label(study, path))
    return words

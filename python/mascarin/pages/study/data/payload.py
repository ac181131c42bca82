"""Checks of the content of a report before it is drawn."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from mascarin.errors import InputError
from mascarin.pages.study.data.series import Series, moment
from mascarin.study_document.document import StudyDocument


def check(study: StudyDocument, series: Series) -> None:
    """Check the content that every report needs.

    Raises
    ------
    InputError
        No title, or metrics of a sensor, period or model that is not declared.
    """
    if not study.title:
        raise InputError("study: no 'title'; expected the name of the study")
    for sensor, periods in study.sensors.items():
        _declared("sensor_info", [sensor], study)
        _declared("periods", periods, study)
        for entries in periods.values():
            _declared("models", entries.models, study)
    for key, period in study.periods.items():
        for span in period.spans:
            if len(span) != 2:
                raise InputError(f"study: periods.{key}.spans holds {span}; expected pairs of start and end")
            moment(span[0])
            moment(span[1])
    for entry in study.phase_change:
        column = entry.column
        if column is not None and column not in series.columns:
            raise InputError(f"study: phase_change names the series column '{column}', which is not there")


def _declared(where: str, names: Iterable[str], study: StudyDocument) -> None:
    declared: Sequence[str] = list(getattr(study, where))
    for name in names:
        if name not in declared:
            raise InputError(
                f"study: metrics of '{name}', which '{where}' does not declare (it has {declared})"
            )

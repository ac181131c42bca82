"""Checks of the content of a report before it is drawn."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from mascarin.errors import InputError
from mascarin.pages.study.data.series import Series, moment
from mascarin.study_document.comparison import PeriodEntry
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


def tidy(study: StudyDocument) -> StudyDocument:
    """Leave out periods that hold the same instants as one before them.

    Parameters
    ----------
    study : StudyDocument
        The results.

    Returns
    -------
    StudyDocument
        The same without the repetitions, in periods, metrics, criteria and aims.
    """
    distinct_periods: dict[str, PeriodEntry] = {}
    for key, period in study.periods.items():
        if not any(period.spans == other.spans for other in distinct_periods.values()):
            distinct_periods[key] = period
    sensors = {
        sensor: {key: entries for key, entries in periods.items() if key in distinct_periods}
        for sensor, periods in study.sensors.items()
    }
    kept_limits = {
        what: [c for c in limits if not c.period or c.period in distinct_periods]
        for what, limits in (("criteria", study.criteria), ("aims", study.aims))
    }
    changed = {"periods": distinct_periods, "sensors": sensors, **kept_limits}
    return study.model_copy(update={key: value for key, value in changed.items() if study.states(key)})


def _declared(where: str, names: Iterable[str], study: StudyDocument) -> None:
    declared: Sequence[str] = list(getattr(study, where))
    for name in names:
        if name not in declared:
            raise InputError(
                f"study: metrics of '{name}', which '{where}' does not declare (it has {declared})"
            )

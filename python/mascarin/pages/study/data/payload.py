"""Checks of the content of a report before it is drawn."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from mascarin.errors import InputError
from mascarin.pages.study.data.series import Series, moment


def check(study: Mapping[str, Any], series: Series) -> None:
    """Check the content that every report needs.

    Raises
    ------
    InputError
        No title, or metrics of a sensor, period or model that is not declared.
    """
    if not study.get("title"):
        raise InputError("study: no 'title'; expected the name of the study")
    for sensor, periods in study.get("sensors", {}).items():
        _declared("sensor_info", [sensor], study)
        _declared("periods", periods, study)
        for entries in periods.values():
            _declared("models", (key for key, entry in entries.items() if isinstance(entry, dict)), study)
    for key, period in study.get("periods", {}).items():
        for span in period.get("spans", []):
            if len(span) != 2:
                raise InputError(f"study: periods.{key}.spans holds {span}; expected pairs of start and end")
            moment(span[0])
            moment(span[1])
    for entry in study.get("phase_change", []):
        column = entry.get("column")
        if column is not None and column not in series.columns:
            raise InputError(f"study: phase_change names the series column '{column}', which is not there")


def tidy(study: Mapping[str, Any]) -> dict[str, Any]:
    """Leave out periods that hold the same instants as one before them.

    Parameters
    ----------
    study : mapping
        As in :class:`Study`.

    Returns
    -------
    dict
        The same without the repetitions, in periods, metrics, criteria and aims.
    """
    distinct_periods: dict[str, Any] = {}
    for key, period in study.get("periods", {}).items():
        if not any(period.get("spans") == other.get("spans") for other in distinct_periods.values()):
            distinct_periods[key] = period
    sensors = {
        sensor: {key: entries for key, entries in periods.items() if key in distinct_periods}
        for sensor, periods in study.get("sensors", {}).items()
    }
    limits = {
        what: [c for c in study.get(what, []) if not c.get("period") or c["period"] in distinct_periods]
        for what in ("criteria", "aims")
    }
    changed = {"periods": distinct_periods, "sensors": sensors, **limits}
    return {**study, **{key: value for key, value in changed.items() if key in study}}


def _declared(where: str, names: Iterable[str], study: Mapping[str, Any]) -> None:
    declared: Sequence[str] = list(study.get(where, {}))
    for name in names:
        if name not in declared:
            raise InputError(
                f"study: metrics of '{name}', which '{where}' does not declare (it has {declared})"
            )

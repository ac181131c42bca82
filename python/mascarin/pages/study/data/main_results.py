"""Main results of a study, which the head of the report and its summary both say: computed once."""

from __future__ import annotations

from dataclasses import dataclass

from mascarin._io import units
from mascarin.pages.study.data.labels import main_model, unit_of
from mascarin.study_document.comparison import CriterionEntry
from mascarin.study_document.document import StudyDocument


@dataclass(frozen=True)
class Coverage:
    """Part of the values of a period inside the prediction bands.

    Attributes
    ----------
    period : str
        Key of the period.
    share : float
        Over the values of all sensors. [-]
    shares : dict of str to float
        By sensor. [-]
    asked : set of float
        Confidence of the bands. [-]
    """

    period: str
    share: float
    shares: dict[str, float]
    asked: set[float]


def judged_criteria(study: StudyDocument) -> list[CriterionEntry]:
    """Criteria of the model that is shown; all where it has none.

    Parameters
    ----------
    study : StudyDocument
        The results.
    """
    model = main_model(study)
    return [c for c in study.criteria if (c.model or "fitted") == model] or study.criteria


def coverage(study: StudyDocument) -> Coverage | None:
    """Coverage of the bands in the last period in which values were compared.

    Parameters
    ----------
    study : StudyDocument
        The results.
    """
    bands = study.band
    for period in reversed(list(study.periods)):
        shares = {
            sensor: float(share)
            for sensor, entry in bands.items()
            if (share := entry.held.get(period)) is not None
        }
        counts = {sensor: _values(study, sensor, period) for sensor in shares}
        total = sum(counts.values())
        if total:
            weighted = sum(share * counts[sensor] for sensor, share in shares.items()) / total
            asked = {float(bands[sensor].confidence) for sensor in shares}
            return Coverage(period, weighted, shares, asked)
    return None


def _values(study: StudyDocument, sensor: str, period: str) -> int:
    """Number of compared values."""
    return study.metrics(sensor, period, main_model(study)).n


def scatter(study: StudyDocument) -> tuple[str, dict[str, list[float]]] | None:
    """Standard deviations of the error of the sensors in the last period that has them, by unit.

    Parameters
    ----------
    study : StudyDocument
        The results.
    """
    model = main_model(study)
    for period in reversed(list(study.periods)):
        by_unit: dict[str, list[float]] = {}
        for sensor in study.sensors:
            deviation = study.metrics(sensor, period, model).sd
            if deviation is not None:
                by_unit.setdefault(units.difference(unit_of(study, sensor)), []).append(float(deviation))
        if by_unit:
            return period, by_unit
    return None


def mean_errors(study: StudyDocument, period: str) -> dict[str, list[float]]:
    """Means of the error of the sensors in a period, by unit.

    Parameters
    ----------
    study : StudyDocument
        The results.
    period : str
        Key of the period.
    """
    model = main_model(study)
    by_unit: dict[str, list[float]] = {}
    for sensor in study.sensors:
        bias = study.metrics(sensor, period, model).bias
        if bias is not None:
            by_unit.setdefault(units.difference(unit_of(study, sensor)), []).append(float(bias))
    return by_unit


def worst_sensor(study: StudyDocument, period: str, sensors: list[str]) -> tuple[str, str]:
    """The sensor with the largest error in a period, and why it is that.

    Where criteria are judged in the period, the sensor that comes nearest to a limit or is farthest beyond
    it; else that with the largest root mean square error among those of the first unit.

    Parameters
    ----------
    study : StudyDocument
        The results.
    period : str
        Key of the period.
    sensors : list of str
        Sensors to choose from, one at least.

    Returns
    -------
    tuple of (str, str)
        The sensor, and the reason in words; empty where there is no choice.
    """
    if len(sensors) == 1:
        return sensors[0], ""
    ratios: dict[str, float] = {}
    for criterion in judged_criteria(study):
        if criterion.period == period and criterion.sensor in sensors and criterion.value is not None:
            limit = abs(criterion.limit or 0.0)
            ratio = abs(criterion.value) / limit if limit else 0.0
            ratios[criterion.sensor] = max(ratios.get(criterion.sensor, 0.0), ratio)
    if ratios:
        worst = max(ratios, key=lambda sensor: ratios[sensor])
        words = "farthest beyond a limit" if ratios[worst] > 1.0 else "nearest to a limit"
        return worst, f"of {len(sensors)} sensors the {words}"
    model, unit = main_model(study), unit_of(study, sensors[0])
    errors = {
        sensor: float(deviation)
        for sensor in sensors
        if unit_of(study, sensor) == unit
        and (deviation := study.metrics(sensor, period, model).rmse) is not None
    }
    if not errors:
        return sensors[0], f"the first of {len(sensors)} sensors"
    worst = max(errors, key=lambda sensor: errors[sensor])
    return worst, f"of {len(sensors)} sensors that with the largest rmse"

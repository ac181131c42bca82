"""Main results of a study, which the head of the report and its summary both say: computed once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from mascarin._io import units
from mascarin.pages.study.data.labels import main_model, unit_of


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


def judged_criteria(study: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Criteria of the model that is shown; all where it has none.

    Parameters
    ----------
    study : mapping
        As in :class:`~mascarin.pages.study.data.schema.Study`.
    """
    criteria = list(study.get("criteria", []))
    model = main_model(study)
    return [c for c in criteria if c.get("model", "fitted") == model] or criteria


def coverage(study: Mapping[str, Any]) -> Coverage | None:
    """Coverage of the bands in the last period in which values were compared.

    Parameters
    ----------
    study : mapping
        As in :class:`~mascarin.pages.study.data.schema.Study`.
    """
    bands = study.get("band", {})
    for period in reversed(list(study.get("periods", {}))):
        shares = {
            sensor: float(share)
            for sensor, entry in bands.items()
            if (share := entry.get("held", {}).get(period)) is not None
        }
        counts = {sensor: _values(study, sensor, period) for sensor in shares}
        total = sum(counts.values())
        if total:
            weighted = sum(share * counts[sensor] for sensor, share in shares.items()) / total
            asked = {float(bands[sensor].get("confidence", 0.95)) for sensor in shares}
            return Coverage(period, weighted, shares, asked)
    return None


def _values(study: Mapping[str, Any], sensor: str, period: str) -> int:
    """Number of compared values."""
    metrics = study.get("sensors", {}).get(sensor, {}).get(period, {})
    return int(metrics.get(main_model(study), {}).get("n", 0))


def scatter(study: Mapping[str, Any]) -> tuple[str, dict[str, list[float]]] | None:
    """Standard deviations of the error of the sensors in the last period that has them, by unit.

    Parameters
    ----------
    study : mapping
        As in :class:`~mascarin.pages.study.data.schema.Study`.
    """
    model = main_model(study)
    for period in reversed(list(study.get("periods", {}))):
        by_unit: dict[str, list[float]] = {}
        for sensor, periods in study.get("sensors", {}).items():
            deviation = periods.get(period, {}).get(model, {}).get("sd")
            if deviation is not None:
                by_unit.setdefault(units.difference(unit_of(study, sensor)), []).append(float(deviation))
        if by_unit:
            return period, by_unit
    return None

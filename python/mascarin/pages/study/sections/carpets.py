"""Error by date and hour."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from mascarin._io import units
from mascarin.figures.svg.carpet import Carpet, carpet, legend, round_limit
from mascarin.pages.study.data.labels import label_of, main_model, unit_of
from mascarin.pages.study.data.series import Array, Series
from mascarin.study_document.document import StudyDocument

TITLE = "Error by date and hour"


def content(study: StudyDocument, series: Series) -> dict[str, Any] | None:
    """Values of the template."""
    sensors = carpets(study, series)
    if not sensors:
        return None
    pictures = sum(len(sensor.pictures) for sensor in sensors)
    return {
        "sensors": sensors,
        "scale": legend(),
        "several": pictures > 1,
        "gaps": _gaps(study, series),
    }


@dataclass(frozen=True)
class SensorCarpet:
    """Carpets of one sensor's error: of the main model, and of the nominal one."""

    sensor: str
    label: str
    unit: str
    pictures: list[tuple[str, str, Carpet]]
    """Model key, model label, picture."""


def carpets(study: StudyDocument, series: Series) -> list[SensorCarpet]:
    """Errors of every sensor over days and hours.

    Parameters
    ----------
    study : StudyDocument
        The results.
    series : Series
        Curves.
    """
    sensors = []
    model = main_model(study)
    for sensor in study.sensor_info:
        observed = series.columns.get(f"observed/{sensor}")
        main = series.columns.get(f"{model}/{sensor}")
        if observed is None or main is None or len(series) * series.step < 1.5 * 86400.0:
            continue
        pictures = []
        # Each with its own scale: on the scale of an accurate model others have a single color.
        for key in dict.fromkeys((model, "nominal")):
            column = series.columns.get(f"{key}/{sensor}")
            if key is not None and column is not None:
                entry = study.models.get(key)
                label = key if entry is None or entry.label is None else entry.label
                pictures.append((key, label, _own_carpet(series, column.values - observed.values)))
        unit = units.difference(unit_of(study, sensor))
        sensors.append(SensorCarpet(sensor, label_of(study, sensor), unit, pictures))
    return sensors


def _gaps(study: StudyDocument, series: Series) -> bool:
    """Whether an error has no value anywhere."""
    compared = (series.columns.get(f"observed/{sensor}") for sensor in study.sensor_info)
    return any(not np.isfinite(column.values).all() for column in compared if column is not None)


def _own_carpet(series: Series, error: Array) -> Carpet:
    finite = np.abs(error[np.isfinite(error)])
    return carpet(
        series.time(0),
        series.step,
        error,
        round_limit(float(np.quantile(finite, 0.98))) if finite.size else 1.0,
    )

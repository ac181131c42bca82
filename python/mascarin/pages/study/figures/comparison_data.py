"""Sensors over periods, as the figures of a comparison draw them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from datetime import datetime

from mascarin._io.units import difference
from mascarin.figures import colors
from mascarin.figures.comparison import Compared
from mascarin.pages.study.data.labels import label_of, main_model, model_label, unit_of
from mascarin.pages.study.data.series import Array, Series
from mascarin.study_document.document import StudyDocument


def model_looks(study: StudyDocument) -> dict[str, str]:
    """Color of each model of a study, by its name for readers."""
    color_of = colors.models(study.models)
    return {model_label(study, model): color for model, color in color_of.items()}


def sensor_looks(study: StudyDocument) -> dict[str, colors.Look]:
    """How each sensor of a study is drawn."""
    return {sensor: colors.look(number) for number, sensor in enumerate(study.sensor_info)}


def compared_sensors(
    study: StudyDocument, series: Series, part: slice, most: int
) -> tuple[list[datetime], dict[str, Compared]]:
    """Sensors that were measured and simulated, over a part of the record.

    Parameters
    ----------
    study : StudyDocument
        The results.
    series : Series
        Curves.
    part : slice
        Instants.
    most : int
        Most points of a curve; of more, every k-th is taken. [-]

    Returns
    -------
    times : list of datetime
        Local times.
    sensors : dict of str to Compared
        By name; the nominal model comes before the main one.
    """
    stop = min(part.stop, len(series))
    stride = max(1, math.ceil((stop - part.start) / most))
    pick = slice(part.start, stop, stride)
    times = [series.time(k) for k in range(part.start, stop, stride)]
    main = main_model(study)
    compared = {}
    for sensor in study.sensor_info:
        observed, simulated = _values(series, "observed", sensor), _values(series, main, sensor)
        if main is None or observed is None or simulated is None:
            continue
        models = {main: simulated[pick]}
        nominal = _values(series, "nominal", sensor)
        if nominal is not None and main != "nominal":
            models = {"nominal": nominal[pick], **models}
        half, middle = _values(series, "band", sensor), _values(series, "expected", sensor)
        compared[sensor] = Compared(
            label_of(study, sensor),
            observed[pick],
            models,
            main,
            half=None if half is None else half[pick],
            center=None if middle is None else (middle - simulated)[pick],
            uncertainty=float(study.sensor_info[sensor].uncertainty),
        )
    return times, compared


def by_unit(study: StudyDocument, sensors: Mapping[str, Compared]) -> dict[str, list[str]]:
    """Names of sensors by the plain unit of their values."""
    groups: dict[str, list[str]] = {}
    for sensor in sensors:
        groups.setdefault(unit_of(study, sensor), []).append(sensor)
    return groups


def error_unit(study: StudyDocument, sensor: str) -> str:
    """Unit of the error of a sensor, with its signs."""
    return difference(unit_of(study, sensor))


def _values(series: Series, model: str | None, sensor: str) -> Array | None:
    column = series.columns.get(f"{model}/{sensor}")
    return None if column is None else column.values

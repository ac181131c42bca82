"""Reads the results of a study from its folder, for the report."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Sequence
from datetime import datetime
from pathlib import Path
from typing import Final

import numpy as np

from mascarin._io.tables import csv_refused
from mascarin.errors import InputError
from mascarin.figures.text import plain_path
from mascarin.pages.study.data.series import Array, Column, Series, read_json
from mascarin.study_document.document import StudyDocument

#: Climate channels with the words and units of a legend.
_WEATHER: Final = {
    "air_temperature": ("Outdoor air", "degC"),
    "dew_point": ("Dew point", "degC"),
    "cloud_cover": ("Cloud cover, tenths", ""),
    "infrared": ("Infrared from the sky", "W/m2"),
    "wind_speed": ("Wind", "m/s"),
    "wind_direction": ("Wind direction", "deg"),
    "pressure": ("Pressure", "Pa"),
    "direct_normal": ("Direct normal radiation", "W/m2"),
    "diffuse_horizontal": ("Diffuse horizontal radiation", "W/m2"),
    "global_horizontal": ("Global horizontal radiation", "W/m2"),
}


def read_folder(out: Path) -> tuple[StudyDocument, Series]:
    """Read the results of a study.

    Parameters
    ----------
    out : Path
        Folder with ``study.json`` and ``tables/series.csv``. The table's columns are ``time`` and
        ``SENSOR.measured``, ``SENSOR.MODEL``, perhaps ``SENSOR.band`` (half-width) and
        ``SENSOR.expected`` (its middle), ``weather.CHANNEL`` and ``state.OUTPUT``.

    Returns
    -------
    tuple of StudyDocument and Series
        As :func:`mascarin.pages.study.render` takes them.

    Raises
    ------
    InputError
        A file is missing or cannot be read.
    """
    study = read_document(out)
    table = out / "tables" / "series.csv"
    return study, read_series(_open(table), str(table), study)


def read_document(out: Path) -> StudyDocument:
    """Read the results of a study without its series.

    Parameters
    ----------
    out : Path
        Folder with ``study.json``, and perhaps ``run.json`` with the facts of its run.

    Returns
    -------
    StudyDocument
        What both files have.

    Raises
    ------
    InputError
        A file is missing or cannot be read.
    """
    content = read_json(out / "study.json")
    if (out / "run.json").exists():
        content |= read_json(out / "run.json")
    return StudyDocument.read(content, str(out / "study.json"))


#: Local clocks may change between the first and the last stamp. [s]
_CLOCK_CHANGE: Final = 7200.0


def read_series(file: Iterable[str], where: str, study: StudyDocument) -> Series:
    """Read the series of a study from the lines of its table.

    Parameters
    ----------
    file : iterable of str
        Lines of a CSV table; see `read_folder` for its columns.
    where : str
        Its name, for errors.
    study : StudyDocument
        Names of sensors and models.

    Returns
    -------
    Series
        As :func:`mascarin.pages.study.render` takes them.

    Raises
    ------
    InputError
        The table cannot be read.
    """
    try:
        with csv_refused(where):
            header, *rows = csv.reader(file)
        times = [datetime.fromisoformat(row[0]) for row in rows]
        values = np.array([[_number(cell) for cell in row[1:]] for row in rows], dtype=np.float64)
    except (ValueError, IndexError) as error:
        raise InputError(f"{where}: {error}; expected the series of a study; run it again") from error
    if len(times) < 2 or values.shape[1:] != (len(header) - 1,):
        raise InputError(
            f"{where}: {len(rows)} rows; expected at least two, as long as the header; run it again"
        )
    step = _step(times, where)
    return Series(times[0].replace(tzinfo=None).isoformat(), step, _columns(header[1:], values, study))


def _step(times: list[datetime], where: str) -> float:
    """The distance of the first stamps, with which all rows end at the last one. [s]"""
    first, second, last = (time.replace(tzinfo=None) for time in (*times[:2], times[-1]))
    step = (second - first).total_seconds()
    off = (last - first).total_seconds() - step * (len(times) - 1)
    if step <= 0.0 or abs(off) > _CLOCK_CHANGE:
        raise InputError(f"{where}: the stamps are not at equal distances; run the study again")
    return step


def _open(path: Path) -> list[str]:
    try:
        return path.read_text(encoding="utf-8").splitlines(keepends=True)
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}; expected the series of a study; run it again") from error
    except ValueError as error:
        raise InputError(f"{path}: {error}; expected the series of a study; run it again") from error


def _parts(name: str, models: Sequence[str]) -> tuple[str, str]:
    """Owner and content of a column; names of sensors and models may contain dots."""
    if name.startswith(("weather.", "state.")):
        owner, _, what = name.partition(".")
        return owner, what
    model = max((model for model in models if name.endswith(f".{model}")), key=len, default="")
    return name.removesuffix(f".{model}"), model


def _number(cell: str) -> float:
    return float(cell) if cell else math.nan


def _columns(names: Sequence[str], values: Array, study: StudyDocument) -> dict[str, Column]:
    sensors, models = study.sensor_info, ("measured", "band", "expected", *study.models)
    columns = {}
    for name, column in zip(names, values.T, strict=True):
        owner, what = _parts(name, models)
        if owner in sensors:
            info = sensors[owner]
            key = f"{'observed' if what == 'measured' else what}/{owner}"
            columns[key] = Column(column, owner if info.label is None else info.label, info.unit)
        elif owner == "weather":
            label, unit = _WEATHER.get(what, (plain_path(what), ""))
            columns[f"weather/{what}"] = Column(column, label, unit)
        elif owner == "state":
            columns[f"state/{what}"] = Column(
                column, plain_path(what), "degC" if "temperature" in what else ""
            )
    return columns

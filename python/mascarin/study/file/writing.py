"""Writes a study as a file, with its building and its tables beside it."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin._io import atomic
from mascarin._io.identity import DESCRIPTION
from mascarin.building.files.yaml_text import text_of
from mascarin.errors import InputError
from mascarin.study.file.description import StudyFile
from mascarin.study.file.inputs import KNOWN
from mascarin.weather.reading.measured import NEUTRAL
from mascarin.weather.records.channels import BY_NAME

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.study.file.study_inputs import StudyInputs
    from mascarin.weather import Climate

_BUILDING: Final = "building.yaml"
_CLIMATE: Final = "climate.csv"
_MEASUREMENTS: Final = "measurements.csv"


def study_text(inputs: StudyInputs) -> str:
    """The text of a study file.

    Parameters
    ----------
    inputs : StudyInputs
        The study.

    Returns
    -------
    str
        YAML.

    Raises
    ------
    InputError
        The weather cannot be written as a table.
    """
    return text_of(_content(inputs))


def write_study(inputs: StudyInputs, path: Path) -> str:
    """Write a study file; see `Study.to_yaml`.

    Parameters
    ----------
    inputs : StudyInputs
        The study.
    path : Path
        File to write; its folder exists.

    Returns
    -------
    str
        The text of the study file.

    Raises
    ------
    InputError
        The weather cannot be written as a table.
    """
    content = _content(inputs)
    if inputs.path is None:
        inputs.building.to_yaml(path.with_name(_BUILDING))
        atomic.write(path.with_name(_CLIMATE), _table(inputs.climate.data))
        atomic.write(path.with_name(_MEASUREMENTS), _table(inputs.driving.data))
    else:
        content = _moved(content, inputs.path.parent, path.parent)
    text = text_of(content)
    atomic.write(path, text, DESCRIPTION)
    return text


def _content(inputs: StudyInputs) -> dict[str, Any]:
    """The keys of the study file."""
    inputs.require_alone("what is written would be the study of the first one; copy the file instead")
    plan = inputs.plan.model_dump(mode="json", exclude_unset=True)
    for name, sensor in inputs.plan.sensors.items():
        if sensor.combined is not None:
            plan["sensors"][name].pop("output", None)  # it follows from the sum or the mean
    if isinstance(inputs.plan, StudyFile):
        return plan
    measured = inputs.driving
    means = [name for name, kind in measured.kinds.items() if kind == "mean"]
    return {
        "name": inputs.plan.name,
        "building": _BUILDING,
        "climate": {"measured": _weather(inputs.climate)},
        "measurements": {
            "table": _MEASUREMENTS,
            "timezone": measured.timezone,
            **({"mean": means} if means else {}),
        },
        **plan,
    }


def _weather(climate: Climate) -> dict[str, Any]:
    """How the table of the weather is read."""
    if climate.record.of_year:
        raise InputError(
            f"{climate.file}: found the weather of a year, which a table cannot represent; write the study "
            "file by hand with climate: {epw: ...} or climate: {tmy: ...}"
        )
    channels = [name for name in climate.data.columns if name in BY_NAME and climate.data[name].notna().any()]
    return {
        "table": _CLIMATE,
        "timezone": climate.timezone,
        "columns": {name: {"column": name, "kind": climate.kinds[name]} for name in channels},
        "absent": [name for name in NEUTRAL if name in BY_NAME and name not in channels],
    }


def _moved(content: dict[str, Any], before: Path, after: Path) -> dict[str, Any]:
    """The same with paths of files that start at another folder."""
    base = after.resolve()

    def moved(name: str) -> str:
        return name if name.startswith(KNOWN) else os.path.relpath((before / name).resolve(), base)

    climate = {
        kind: {**source, "table": moved(source["table"])} if kind == "measured" else moved(source)
        for kind, source in content["climate"].items()
    }
    measurements = {**content["measurements"], "table": moved(content["measurements"]["table"])}
    return {
        **content,
        "building": moved(content["building"]),
        "climate": climate,
        "measurements": measurements,
    }


def _table(data: pd.DataFrame) -> str:
    """A table as CSV with local stamps and offset; all digits are kept."""
    table = data.dropna(axis="columns", how="all").astype(np.float64)
    table.insert(0, "time", [stamp.isoformat() for stamp in data.index])
    return str(table.to_csv(index=False, lineterminator="\n"))

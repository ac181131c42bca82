"""JSON Schema of a study file, for editors."""

from __future__ import annotations

from typing import Any, Final

from mascarin.building.json_schemas import schema_of
from mascarin.study.file.data_sources import OF_THE_TABLE, Experiment
from mascarin.study.file.description import StudyFile

#: Classes whose keys `with_shared_table` takes from the weather or the measurements.
_TABLES: Final = ("MeasuredTable", "MeasuredWeather")
_EXPERIMENTS: Final[dict[str, Any]] = {"required": ["experiments"]}


def study_schema() -> dict[str, Any]:
    """JSON Schema (2020-12) of a study file.

    Returns
    -------
    dict
        Keys of a table are required once, in the weather or in the measurements. What every experiment may
        state for itself is required of a study without experiments alone.

    Examples
    --------
    >>> "sensors" in study_schema()["properties"]
    True
    """
    schema = schema_of(StudyFile)
    parts = schema["$defs"]
    shared = [key for key in parts["MeasuredTable"]["required"] if key in OF_THE_TABLE]
    for name in _TABLES:
        parts[name]["required"] = [key for key in parts[name]["required"] if key not in shared]
    measurements = schema["properties"]["measurements"]
    held = {"$ref": measurements.pop("$ref")}
    schema["properties"]["measurements"] = {"anyOf": [held, {"type": "null"}], **measurements}
    whole = schema["anyOf"][0]
    whole["required"].remove("measurements")
    own = [key for key in Experiment.model_fields if key in whole["required"]]
    whole["required"] = [key for key in whole["required"] if key not in own]
    whole["allOf"] = [
        {"anyOf": [_EXPERIMENTS, {"required": own}]},
        *({"anyOf": [_EXPERIMENTS, *_once(key)["anyOf"]]} for key in shared),
    ]
    keys = parts["Sensor"]["properties"]
    for name, usual in (
        ("uncertainty", "expanded_uncertainty"),
        ("relative_expanded_uncertainty", "relative"),
    ):
        keys[name] = {"deprecated": True, "description": f"Another name of {usual}", "type": "number"}
    return schema


def _once(key: str) -> dict[str, Any]:
    """Either the measured weather has a key, or the measurements have it."""
    weather = {"required": ["measured"], "properties": {"measured": {"required": [key]}}}
    measurements = {"type": "object", "required": [key]}
    return {
        "anyOf": [
            {"properties": {"climate": weather}},
            {"required": ["measurements"], "properties": {"measurements": measurements}},
        ]
    }

"""The description language as others read it: JSON Schema, table of parameters."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from mascarin.model.building import Building


def json_schema() -> dict[str, Any]:
    """JSON Schema (2020-12) of a building description.

    Returns
    -------
    dict
        Numbers carry ``unit`` and ``default_range`` beside the words of JSON Schema.
    """
    return {"$schema": "https://json-schema.org/draft/2020-12/schema"} | Building.model_json_schema()


def parameter_table(building: Building) -> list[dict[str, Any]]:
    """Parameters of a building as rows, one field for each attribute of :class:`Parameter`."""
    return [asdict(parameter) for parameter in building.parameters()]

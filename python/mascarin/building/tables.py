"""The description language as others read it: JSON Schema, table of parameters."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from pydantic.json_schema import GenerateJsonSchema

from mascarin.building.building import Building
from mascarin.building.number import Number


class _Schema(GenerateJsonSchema):
    """JSON Schema with the numbers' defaults and without titles that repeat the keys."""

    def encode_default(self, dft: Any) -> Any:
        return float(dft) if isinstance(dft, Number) else super().encode_default(dft)

    def field_title_should_be_set(self, schema: Any) -> bool:
        return False


def json_schema() -> dict[str, Any]:
    """JSON Schema (2020-12) of a building description.

    Returns
    -------
    dict
        Numbers carry ``unit`` and ``default_range`` beside the words of JSON Schema.
    """
    return {"$schema": "https://json-schema.org/draft/2020-12/schema"} | Building.model_json_schema(
        schema_generator=_Schema
    )


def parameter_table(building: Building) -> list[dict[str, Any]]:
    """Parameters of a building as rows, one field for each attribute of :class:`Parameter`."""
    return [asdict(parameter) for parameter in building.parameters()]

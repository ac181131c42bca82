"""JSON Schema of the description, and the table of parameters of a building."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any, Final

from pydantic.json_schema import GenerateJsonSchema

from mascarin.building.building import Building
from mascarin.building.documenting import summary_of
from mascarin.building.inheriting import EXTENDS, SET
from mascarin.building.number import Number

USUAL_KINDS: Final = ("solid", "factor")
"""Kinds that a file may leave out: of a material, and of the effect of clouds given by coefficients."""


class _Schema(GenerateJsonSchema):
    """JSON Schema with the defaults of numbers and without titles that repeat the keys."""

    def encode_default(self, dft: Any) -> Any:
        return float(dft) if isinstance(dft, Number) else super().encode_default(dft)

    def field_title_should_be_set(self, schema: Any) -> bool:
        return False


#: Keys that are read before the description itself.
_INHERITING: Final = {
    EXTENDS: {
        "type": "string",
        "description": "File of another description, which this one adds to and changes; its path is counted "
        "from this file",
    },
    SET: {
        "type": "object",
        "description": "Path -> value or part that replaces the one of the extended description",
        "additionalProperties": True,
    },
}


def json_schema() -> dict[str, Any]:
    """JSON Schema (2020-12) of a building description.

    Returns
    -------
    dict
        Numbers have ``unit`` and ``default_range`` beside the keywords of JSON Schema.

    Examples
    --------
    >>> "zones" in json_schema()["properties"]
    True
    """
    schema = Building.model_json_schema(schema_generator=_Schema)
    for part in (schema, *schema["$defs"].values()):
        for form in (part, *part.get("anyOf", ())):
            _as_written(form)
    schema["properties"] |= _INHERITING
    # What a description extends may give all that is required.
    schema["anyOf"] = [{"required": schema.pop("required")}, {"required": [EXTENDS]}]
    return {"$schema": "https://json-schema.org/draft/2020-12/schema"} | schema


def _as_written(form: dict[str, Any]) -> None:
    """Leave out the sections of the docstring, and require the kind, which only objects may leave out."""
    if "description" in form:
        form["description"] = summary_of(form["description"])
    kind = form.get("properties", {}).get("kind", {})
    if "const" in kind and kind["const"] not in USUAL_KINDS and "kind" not in form.get("required", ()):
        form["required"] = ["kind", *form.get("required", ())]


def parameter_table(building: Building) -> list[dict[str, Any]]:
    """Parameters of a building as rows.

    Parameters
    ----------
    building : Building
        The building.

    Returns
    -------
    list of dict
        One entry for each attribute of `Parameter`.

    Examples
    --------
    >>> from mascarin import examples
    >>> import mascarin as mc
    >>> rows = parameter_table(mc.load(examples.FOLDER / "lgi" / "building.yaml"))
    >>> rows[0]["path"]
    'site.latitude'
    """
    return [asdict(parameter) for parameter in building.parameters()]

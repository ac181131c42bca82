"""JSON Schemas of files, for editors: that of a building, and how those of other files are made."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

from mascarin.building.base.docstrings import summary_of
from mascarin.building.base.nested_schema import PartJsonSchema
from mascarin.building.base.number import Number
from mascarin.building.base.part import Part
from mascarin.building.building import Building
from mascarin.building.files.defaults import DEFAULTS, SECTIONS, SIDES
from mascarin.building.files.inheritance import EXTENDS, SET

USUAL_KINDS: Final = ("solid", "factor")
"""Kinds that a file may leave out: of a material, and of the effect of clouds given by coefficients."""

#: What a file can extend.
_EXTENDS: Final = {
    "type": "string",
    "description": "File of another description, which this one adds to and changes; its path is counted "
    "from this file",
}
_SET: Final = {
    "type": "object",
    "description": "Path -> value or part that replaces the one of the extended description",
    "additionalProperties": True,
}


_DEFAULTS: Final = {
    "type": "object",
    "description": "Keys that many parts share, written once; a part that has a key keeps it",
    "properties": {key: {"type": "object", "description": text} for key, text in (SIDES | SECTIONS).items()},
    "additionalProperties": False,
}


class _Schema(PartJsonSchema):
    """JSON Schema with the defaults of numbers and without titles that repeat the keys."""

    def encode_default(self, dft: Any) -> Any:
        return float(dft) if isinstance(dft, Number) else super().encode_default(dft)

    def field_title_should_be_set(self, schema: Any) -> bool:
        return False


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
    schema = schema_of(Building)
    schema["properties"] |= {SET: _SET, DEFAULTS: _DEFAULTS}
    return schema


def schema_of(kind: type[Part]) -> dict[str, Any]:
    """JSON Schema (2020-12) of a file of some kind, with a description of every key.

    Parameters
    ----------
    kind : type of Part
        What the file describes.

    Returns
    -------
    dict
        What is required may come from the file that it extends.
    """
    schema = kind.model_json_schema(schema_generator=_Schema)
    parts = schema.setdefault("$defs", {})
    for part in (schema, *parts.values()):
        for form in (part, *part.get("anyOf", ())):
            _as_written(form)
        for form in _forms(part):
            _describe(form.get("properties", {}), parts)
    schema["properties"][EXTENDS] = _EXTENDS
    schema["anyOf"] = [{"required": schema.pop("required")}, {"required": [EXTENDS]}]
    return {"$schema": "https://json-schema.org/draft/2020-12/schema"} | schema


def _as_written(form: dict[str, Any]) -> None:
    """Leave out the sections of the docstring, and require the kind, which only objects may leave out."""
    if "description" in form:
        form["description"] = summary_of(form["description"])
    kind = form.get("properties", {}).get("kind", {})
    if "const" in kind:
        kind.setdefault("description", "Selects this kind of part")
        if kind["const"] not in USUAL_KINDS and "kind" not in form.get("required", ()):
            form["required"] = ["kind", *form.get("required", ())]


def _forms(schema: Any) -> Iterator[dict[str, Any]]:
    """A schema and all schemas inside it."""
    if isinstance(schema, list):
        for piece in schema:
            yield from _forms(piece)
    elif isinstance(schema, dict):
        yield schema
        for piece in schema.values():
            yield from _forms(piece)


def _describe(properties: dict[str, Any], parts: dict[str, Any]) -> None:
    """Give a key without a description that of what it holds, where an editor looks for it."""
    for entry in properties.values():
        if isinstance(entry, dict) and "description" not in entry:
            held = (entry, *entry.get("anyOf", ()), entry.get("items", {}))
            if text := next(filter(None, (_text(option, parts) for option in held)), None):
                entry["description"] = text


def _text(entry: dict[str, Any], parts: dict[str, Any]) -> str | None:
    """Description of a schema, or of the part that it points to."""
    text: str | None = entry.get("description")
    pointed: str | None = parts.get(entry.get("$ref", "").rpartition("/")[2], {}).get("description")
    return text or (summary_of(pointed) if pointed else None)

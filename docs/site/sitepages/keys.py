"""Reference of the keys of a building description, made from the classes that read it."""

from __future__ import annotations

import re
import types
from collections.abc import Iterator
from functools import cache
from typing import Annotated, Any, Final, Literal, NamedTuple, Union, get_args, get_origin

from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from mascarin.building.base.docstrings import summary_of
from mascarin.building.base.number import (
    Fixed,
    Number,
    OnlyGiven,
    Percent,
    Quantity,
    Span,
    Spread,
    Within,
    quantity_of,
)
from mascarin.building.base.part import Part
from mascarin.building.json_schemas import json_schema
from mascarin.building.parts.description import Description
from mascarin.building.parts.envelope.convection import ConvectionLaw
from mascarin.building.parts.posterior import Posterior
from mascarin.building.parts.site import SkyLaw
from sitepages.snippets import Snippets

#: Steps of a path that the user names.
_NAMES: Final = {
    "materials": "MATERIAL", "constructions": "CONSTRUCTION", "schedules": "SCHEDULE", "zones": "ZONE",
    "air_paths": "PATH", "ventilation_units": "UNIT", "openings": "OPENING", "vents": "VENT",
    "controls": "CONTROL", "surfaces": "SURFACE",
    "glazings": "GLAZING", "windows": "WINDOW", "shades": "SHADE", "sensors": "SENSOR", "layers": "LAYER",
    "heat_sources": "SOURCE",
}  # fmt: skip


class Key(NamedTuple):
    """One key of one kind of part.

    Attributes
    ----------
    part : type
        The class that reads it.
    name : str
        The key.
    holds : str
        What may stand there: its type, unit and limits, as Markdown.
    unit : str
        Unit of a number; empty for what is none.
    default : str
        Default with its source; empty where there is none.
    meaning : str
        What it is.
    range : str
        Plausible range of a number for which none is given, with the reason.
    """

    part: type[Part]
    name: str
    holds: str
    unit: str
    default: str
    meaning: str
    range: str


def parts() -> dict[type[Part], list[str]]:
    """Every kind of part of a description, with the paths at which it can stand."""
    found: dict[type[Part], list[str]] = {}

    def visit(kind: type[Part], path: str) -> None:
        found.setdefault(kind, [])
        if path in found[kind]:
            return
        found[kind].append(path)
        for name, field in kind.model_fields.items():
            step = f"{path}.{name}" if path else name
            for inner, named in inside(field.annotation):
                if inner is Posterior:
                    continue  # written by a study, and sealed: nobody writes its keys
                visit(inner, f"{step}.{_NAMES.get(name, 'NAME')}" if named else step)

    visit(Description, "")
    return found


def inside(annotation: Any, named: bool = False) -> Iterator[tuple[type[Part], bool]]:
    """Parts that a field can hold, and whether each has a name or a position below it."""
    if isinstance(annotation, type) and issubclass(annotation, Part):
        yield annotation, named
        return
    below = named or get_origin(annotation) in (dict, tuple)
    for piece in get_args(annotation):
        if not isinstance(piece, str):
            yield from inside(piece, below)


def keys_of(part: type[Part]) -> list[Key]:
    """Keys of a part, in the order of the class; then the short forms that replace others."""
    return [_key(part, name, field) for name, field in part.model_fields.items()] + _short_forms(part)


@cache
def _schema() -> dict[str, Any]:
    return json_schema()


def _short_forms(part: type[Part]) -> list[Key]:
    """Keys that the class reads as others, such as ``held`` of a zone: in the schema, and no fields."""
    schema = _schema() if part is Description else _schema()["$defs"].get(part.__name__, {})
    found = []
    for name, entry in schema.get("properties", {}).items():
        if name not in part.model_fields:
            words = {"string": "text", "object": "path → value or part"}.get(entry.get("type", ""), "number")
            unit = entry.get("unit", "")
            holds = f"{words} [{unit}]" if unit else words
            found.append(Key(part, name, holds, unit, "", entry["description"], ""))
    return found


def _key(part: type[Part], name: str, field: FieldInfo) -> Key:
    quantity = quantity_of(field) or nested_quantity(field.annotation)
    meaning = field.description or (quantity.description if quantity else "")
    if name == "kind" and not meaning:
        meaning = "Selects this kind of part"
    return Key(
        part=part,
        name=name,
        holds=number(quantity) if quantity and is_number_field(field) else holds(field.annotation),
        unit=quantity.unit if quantity else "",
        default=_default(field),
        meaning=meaning,
        range=range_words(quantity.spread, quantity.unit) if quantity else "",
    )


def is_number_field(field: FieldInfo) -> bool:
    """Whether a field holds one number and nothing else; pydantic has its quantity beside the type then."""
    kinds = [one for one in get_args(field.annotation) or (field.annotation,) if one is not type(None)]
    return (kinds[0] is Number and len(kinds) == 1) or field.annotation is Number


def nested_quantity(annotation: Any) -> Quantity | None:
    """Quantity of a number inside lists and choices."""
    for note in getattr(annotation, "__metadata__", ()):
        if isinstance(note, Quantity):
            return note
    for piece in get_args(annotation):
        if not isinstance(piece, type) and (found := nested_quantity(piece)) is not None:
            return found
    return None


def holds(annotation: Any) -> str:
    """What a field may hold, as Markdown."""
    origin, pieces = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        quantity = next((note for note in pieces[1:] if isinstance(note, Quantity)), None)
        return number(quantity) if quantity else holds(pieces[0])
    if origin in (Union, types.UnionType):
        return " or ".join(dict.fromkeys(holds(one) for one in pieces if one is not type(None)))
    if origin is Literal:
        return ", ".join(f"`{str(word).lower() if word is True else word}`" for word in pieces)
    if origin is dict:
        return f"name → {holds(pieces[1])}"
    if origin is tuple:
        if pieces[-1] is Ellipsis:
            return f"list of {holds(pieces[0])}"
        return f"list of {len(pieces)}: {holds(pieces[0])}"
    if annotation is Posterior:
        return "section written by a study"
    if isinstance(annotation, type) and issubclass(annotation, Part):
        return f"[{title(annotation)}](#{anchor(annotation)})"
    return {str: "text", bool: "true or false", float: "number", int: "whole number"}.get(annotation, "text")


def number(quantity: Quantity) -> str:
    """A number with unit and limits, in words."""
    kind = "whole number" if quantity.integer else "number"
    limits = f", {quantity.limits}" if str(quantity.limits) else ""
    words = f"; or {', '.join(f'`{word}`' for word in quantity.words)}" if quantity.words else ""
    return f"{kind} [{quantity.unit}]{limits}{words}"


def range_words(spread: Spread, unit: str) -> str:
    """The rule of a default range, with its reason."""
    unit = "" if unit == "-" else f" {unit}"
    match spread:
        case Percent(percent, reason):
            return f"± {percent:g} % ({reason})"
        case Within(half, reason):
            return f"± {half:g}{unit} ({reason})"
        case Span(low, high, reason):
            return f"{low:g} to {high:g}{unit} ({reason})"
        case Fixed(reason):
            return f"none, structural ({reason})"
        case OnlyGiven(reason):
            return f"none ({reason})"


def _default(field: FieldInfo) -> str:
    if field.is_required():
        return "required"
    value = field.get_default(call_default_factory=True) if field.default is not PydanticUndefined else None
    if isinstance(value, Number):
        shown = next(
            (w for w, v in (value.quantity.words.items() if value.quantity else ()) if v == value),
            f"{value:g}",
        )
        source = value.source
        return f"`{shown}`" + (f" ({source})" if source else "")
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    if isinstance(value, str):
        return f"`{value}`" if value else ""
    if isinstance(value, Part) and "kind" in type(value).model_fields:
        return f"`{value.kind}`"  # type: ignore[attr-defined]
    return ""


def title(part: type[Part]) -> str:
    """Heading of a part: the name of its class in words."""
    # Names of people and programs.
    if issubclass(part, ConvectionLaw) and not part.row.title.islower():
        return part.row.title
    if issubclass(part, SkyLaw) and not part.row.title.islower():
        return f"{part.row.title} sky"
    words = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", " ", part.__name__)
    return words[:1] + words[1:].lower()


def anchor(part: type[Part]) -> str:
    """Anchor of the section of a part."""
    return "key-" + re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "-", part.__name__).lower()


def is_leaf(field: FieldInfo) -> bool:
    """Whether a key holds values and no parts with sections of their own."""
    return next(inside(field.annotation), None) is None


def page(snippets: Snippets) -> str:
    """The page: one section for each kind of part, with a table of its keys."""
    found = parts()
    count = sum(len(keys_of(part)) for part in found)
    lines = [
        "# Keys of a building",
        "",
        f"All {count} keys of a building description. The page is made from the classes that read the file, "
        "so that it is complete. `mascarin schema` prints the same as a JSON Schema for editors; "
        "`mascarin parameters building.yaml` lists the numbers of one building with their paths; "
        "[Buildings](buildings.md) explains the parts.",
        "",
        "A number may be written alone (`volume: 27`), or with what is known about it "
        "(`volume: {value: 27, range: [26, 28], source: measured, assumed: true}`). Temperatures are in "
        "degC. *Range* is the plausible range that a sensitivity analysis uses where none is given. Examples "
        "are from files that are shipped, and from these pages.",
        "",
    ]
    for part, paths in found.items():
        lines += _section(part, paths, snippets)
    return "\n".join(lines) + "\n"


def _section(part: type[Part], paths: list[str], snippets: Snippets) -> list[str]:
    heading = "The file" if part is Description else title(part)
    summary = " ".join(summary_of(re.split(r"\n\s*Parameters\n\s*---", part.__doc__ or "")[0]).split())
    summary = re.sub(r"``(.+?)``", r"`\1`", re.sub(r":\w+:`(.+?)`", r"`\1`", summary))
    where = [path for path in paths if path]
    shown = ", ".join(f"`{path}`" for path in where[:4]) + (
        f" and {len(where) - 4} more" if len(where) > 4 else ""
    )
    lines = [f"({anchor(part)})=", f"## {heading}", "", summary, ""]
    lines += [f"At {shown}.", ""] if where else []
    lines += ["| key | holds | default | meaning | example |", "|---|---|---|---|---|"]
    for key in keys_of(part):
        example = snippets.of(part, key.name)
        meaning = key.meaning + (f". *Range:* {key.range}" if key.range else "")
        cells = (f"`{key.name}`", key.holds, key.default, meaning, f"`{example}`" if example else "")
        lines.append("| " + " | ".join(cell.replace("|", "\\|").replace("\n", " ") for cell in cells) + " |")
    return [*lines, ""]

"""Signatures and docstrings of parts, made from their fields: each field is described in one place."""

from __future__ import annotations

import inspect
import re
import types
from collections.abc import Mapping
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from mascarin.building.base.number import Number, quantity_of

#: What ends the summary of a docstring by the numpydoc standard.
_SECTION = re.compile(r"^ *(Raises|Examples|References|See Also|Notes)\n *-{3,}$", re.MULTILINE)


def signature_of(fields: Mapping[str, FieldInfo]) -> inspect.Signature:
    """Signature of a part: keyword arguments with short types and their defaults."""
    return inspect.Signature(
        [
            inspect.Parameter(
                key,
                inspect.Parameter.KEYWORD_ONLY,
                default=_default(field),
                annotation=type_of(field.annotation),
            )
            for key, field in fields.items()
            if key != "kind"
        ]
    )


def documented(text: str, fields: Mapping[str, FieldInfo]) -> str:
    """Docstring of a part with a section on its parameters.

    Parameters
    ----------
    text : str
        Docstring as it is in the code: summary, and sections after the parameters.
    fields : mapping of str to FieldInfo
        The fields.
    """
    text = inspect.cleandoc(text)
    heading = _SECTION.search(text)
    summary, sections = (text[: heading.start()].rstrip(), text[heading.start() :]) if heading else (text, "")
    lines = [line for key, field in fields.items() if key != "kind" for line in _entry(key, field)]
    section = "\n".join(["Parameters", "----------", *lines]) if lines else ""
    return "\n\n".join(piece for piece in (summary, section, sections) if piece)


def summary_of(text: str) -> str:
    """Docstring without its sections."""
    section = re.search(r"^ *[A-Z][A-Za-z ]+\n *-{3,}$", text, re.MULTILINE)
    return (text[: section.start()] if section else text).strip()


def _entry(key: str, field: FieldInfo) -> list[str]:
    kind = type_of(field.annotation)
    optional = "" if field.is_required() else ", optional"
    quantity = quantity_of(field)
    meaning = field.description or (quantity.description if quantity is not None else "")
    unit = f" [{quantity.unit}]" if quantity is not None else ""
    text = f"    {meaning}{unit}".rstrip() + "." if meaning else ""
    return [f"{key} : {kind.removesuffix(' or None')}{optional}", *([text] if text else [])]


def _default(field: FieldInfo) -> Any:
    if field.is_required():
        return inspect.Parameter.empty
    return None if field.default is PydanticUndefined else field.default


def type_of(annotation: Any) -> str:
    """Type of a field in a few words: ``float``, ``str``, ``mapping of str to Zone``."""
    origin, pieces = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return type_of(pieces[0])
    if origin in (Union, types.UnionType):
        return " or ".join(dict.fromkeys(type_of(piece) for piece in pieces))
    if origin is Literal:
        return "{" + ", ".join(repr(piece) for piece in pieces) + "}"
    if origin is dict:
        return f"mapping of {type_of(pieces[0])} to {type_of(pieces[1])}"
    if origin is tuple:
        return f"sequence of {type_of(pieces[0])}"
    if annotation is Number:
        return "float"
    return "None" if annotation is type(None) else str(getattr(annotation, "__name__", annotation))

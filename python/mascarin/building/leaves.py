"""Every number of a description by its path."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from mascarin.building.number import Number
from mascarin.building.part import Part

Leaf = tuple[str, Number, str]


def leaves(part: Any, path: str = "", source: str | None = None) -> Iterator[Leaf]:
    """All numbers of a part: path, number, source."""
    if isinstance(part, Number):
        yield path, part, part.source or source or ""
        return
    if isinstance(part, Part):
        source = getattr(part, "source", None) or source
    for key, value in steps(part):
        yield from leaves(value, f"{path}.{key}" if path else str(key), source)


def steps(part: Any) -> Iterator[tuple[str, Any]]:
    """Pieces of a part, each with its step in a path: layers by name, points by position."""
    if isinstance(part, Part):
        yield from ((key, getattr(part, key)) for key in type(part).model_fields)
    elif isinstance(part, Mapping):
        yield from part.items()
    elif isinstance(part, tuple):
        yield from ((getattr(piece, "name", str(index)), piece) for index, piece in enumerate(part))

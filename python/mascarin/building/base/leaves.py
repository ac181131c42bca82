"""Every number of a description by its path."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any

from mascarin.building.base.number import Number
from mascarin.building.base.part import Part

Leaf = tuple[str, Number, str]


def leaves(part: Any, path: str = "", source: str | None = None) -> list[Leaf]:
    """All numbers of a part: path, number, source."""
    entries: list[Leaf] = []
    _add(entries, part, path, source)
    return entries


def _add(entries: list[Leaf], part: Any, path: str, source: str | None) -> None:
    if isinstance(part, Number):
        entries.append((path, part, part.source or source or ""))
        return
    if isinstance(part, Part):
        source = getattr(part, "source", None) or source
    for key, value in steps(part):
        # Most fields are empty, or words.
        if value is not None and not isinstance(value, str):
            _add(entries, value, f"{path}.{key}" if path else str(key), source)


def steps(part: Any) -> Iterator[tuple[str, Any]]:
    """Pieces of a part, each with its step in a path: layers by name, points by position."""
    if isinstance(part, Part):
        fields = part.__dict__
        if part.inline:
            return _inlined(part)
        return ((key, fields[key]) for key in _keys(type(part)))
    if isinstance(part, Mapping):
        return iter(part.items())
    if isinstance(part, tuple):
        return ((getattr(piece, "name", str(index)), piece) for index, piece in enumerate(part))
    return iter(())


def _inlined(part: Part) -> Iterator[tuple[str, Any]]:
    for key in _keys(type(part)):
        value = part.__dict__[key]
        yield from value.items() if key in part.inline else ((key, value),)


@cache
def _keys(kind: type[Part]) -> tuple[str, ...]:
    return tuple(kind.model_fields)

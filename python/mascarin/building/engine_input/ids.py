"""Numbers of a description by their ids, which is how the engine refers to them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from mascarin.building.base.number import Number
from mascarin.building.parts.openings.window import Vertices

Json = dict[str, Any]
#: Position of the channel of each schedule.
Positions = Mapping[str, int]
#: Id of the number at a path.
Ids = Callable[[str], int]


def below(ids: Mapping[str, int], path: str) -> Ids:
    """Ids of the numbers below a path."""
    return lambda key: ids[f"{path}.{key}"]


def deeper(ids: Ids, path: str) -> Ids:
    """Ids below a path of the part that ``ids`` belongs to."""
    return lambda key: ids(f"{path}.{key}")


def each(
    parts: Mapping[str, Any], section: str, ids: Mapping[str, int], write: Callable[..., Json]
) -> list[Json]:
    """Describe every part of a section by `write`, which gets its name, the part and its ids."""
    return [write(name, part, below(ids, f"{section}.{name}")) for name, part in parts.items()]


def fields_of(part: Any, ids: Ids, prefix: str = "") -> Json:
    """Describe a part whose fields have the same names in the engine: its kind and the ids of its numbers."""
    written = {"kind": part.kind} if hasattr(part, "kind") else {}
    for key in type(part).model_fields:
        number = getattr(part, key)
        if isinstance(number, Number) and not number.structural:
            written[key] = ids(f"{prefix}{key}")
    return written


def corners(vertices: Vertices | None) -> list[list[float]]:
    """Corners of a polygon as lists; none where there are no vertices. [m]"""
    return [[float(coordinate) for coordinate in vertex] for vertex in vertices or ()]

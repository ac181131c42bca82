"""Values and parts replaced by path in a description written as mappings and lists."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from mascarin.building.base.leaves import steps
from mascarin.building.base.number import Number
from mascarin.building.base.part import Part, written_value
from mascarin.errors import InputError


def without_parts(value: Any) -> Any:
    """The same value with mappings in place of the parts in it, so that they are read and checked again."""
    if isinstance(value, str | float | int):
        return value
    if isinstance(value, Part):
        return written_value(value)
    if isinstance(value, Mapping):
        return {key: without_parts(piece) for key, piece in value.items()}
    if isinstance(value, list | tuple):
        return [without_parts(piece) for piece in value]
    return value


def piece_at(part: Any, path: Sequence[str]) -> Any:
    """What a part holds at a path; None where there is nothing."""
    for step in path:
        part = next((piece for key, piece in steps(part) if key == step), None)
    return part


def put(plain: dict[str, Any], part: Part, path: Sequence[str], value: Any) -> None:
    """Put a value at a path into a written description.

    Parameters
    ----------
    plain : dict
        The description as :meth:`Part.written` gives it; it is changed.
    part : Part
        The part that it was written from: it has the kinds and ranges of what was not written.
    path : sequence of str
        Steps of the path.
    value : any
        What a file would hold there. A number keeps the range of the number that it replaces, and the unit
        of one of a formula; None removes the key.

    Raises
    ------
    InputError
        The path leads through a part that was replaced by a short form.
    """
    holder: Any = plain
    holder_or_leaf: Any = part
    for step in path[:-1]:
        below = piece_at(holder_or_leaf, [step])
        key = _index(holder, step)
        if key is None:
            holder[step] = _kind_of(below, beside=holder_or_leaf)
            key = step
        holder, holder_or_leaf = holder[key], below
        if not isinstance(holder, dict | list):
            raise InputError(
                f"{'.'.join(path)}: found {holder!r} at '{step}', which replaces the whole part; expected a "
                "mapping there. Give either the part or what is inside it"
            )
    key = _index(holder, path[-1])
    key = path[-1] if key is None else key
    if value is None and isinstance(holder, dict):
        holder.pop(key, None)
        return
    before = piece_at(holder_or_leaf, [path[-1]])
    if isinstance(before, Number) and isinstance(value, int | float) and not isinstance(value, Number | bool):
        value = Number(value, range=before.range, quantity=before.quantity)
    elif not isinstance(value, Number) and (notes := _notes(before)):
        # The unit of a number of a formula stays, also in what is said of a value that is none.
        value = {**notes, **(value if isinstance(value, Mapping) else {"value": value})}
    holder[key] = value


def _notes(before: Any) -> dict[str, Any]:
    """What a file has beside the value of a number, of its unit; nothing where its key says it."""
    quantity = before.quantity if isinstance(before, Number) else None
    return {} if quantity is None else quantity.notes()


def replaced_at(building: Any, values: Mapping[str, tuple[Any, int]]) -> Any:
    """The same building with values by path that a file gives.

    Parameters
    ----------
    building : Building
        What the file and its bases describe otherwise.
    values : mapping of str to (any, int)
        By path: the value, and its line with the name of its file.

    Raises
    ------
    InputError
        A path does not exist or a value is not possible; the line is named.
    """
    try:
        return building.replace({path: value for path, (value, _) in values.items()})
    except InputError as error:
        text = str(error)
        named = [path for path in values if path in text]
        path = max(named, key=len) if named else next(iter(values))
        line = values[path][1]
        said = text.removeprefix(f"{building.name}: ").removeprefix(f"{path}: ")
        raise InputError(f"{getattr(line, 'file', building.name)}:{line}: set.{path}: {said}") from None


def _kind_of(part: Any, beside: Any) -> dict[str, Any]:
    """What must be written with a value of a part, so that the part can be read: its kind."""
    kind = getattr(part, "kind", None)
    # The product determines the law; it needs no kind.
    return {} if kind is None or getattr(beside, "product", None) is not None else {"kind": kind}


def _index(pieces: Any, step: str) -> Any:
    """Key of a step in a mapping or list; layers of a list are found by name."""
    if not isinstance(pieces, list | tuple):
        return step if step in pieces else None
    for index, piece in enumerate(pieces):
        named = piece.get("name") or piece.get("material") if isinstance(piece, Mapping) else None
        if (named or str(index)) == step:
            return index
    return None

"""Errors that pydantic finds in a description, as one text with file, line and path."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from pydantic import BaseModel, ValidationError

from mascarin.errors import InputError

KeyPath = tuple[str | int, ...]

#: Last step of the place of a text's first column, beside the line of the text.
COLUMN: Final = "(column)"


class Line(int):
    """Number of a line, with the name of its file where a description is merged from several files."""

    file: str

    def __new__(cls, number: int, file: str) -> Line:  # noqa: D102
        line = super().__new__(cls, number)
        line.file = file
        return line


def explained(
    error: ValidationError, plain: Any, name: str, lines: Mapping[KeyPath, int] | None = None
) -> InputError:
    """Turn the errors that pydantic found into one error that names each by file, line and path.

    Parameters
    ----------
    error : ValidationError
        What pydantic found.
    plain : mapping or list
        The description as it was given.
    name : str
        Name of the file, or of the part, for the text.
    lines : mapping of place to int, optional
        Line of each key and value in the file.

    Returns
    -------
    InputError
        To be raised by the caller.
    """
    entries = sorted(
        (
            (*_where(path, lines or {}, name), _column(path, lines or {}, fault.get("ctx", {}))),
            _dotted(path, plain),
            _sentences(dict(fault)),
        )
        for fault in error.errors(include_url=False)
        for path in [_path_of(fault["loc"], plain)]
    )
    blocks = []
    for (file, line, column), dotted, sentences in dict.fromkeys(entries):
        where = f"{file}:{line}" if line else file
        where += f":{column}" if column else ""
        blocks.append(f"{where}: {dotted or 'the whole description'}\n{sentences}")
    if len(blocks) > 1:
        blocks.insert(0, f"{name}: {len(blocks)} faults")
    return InputError("\n".join(blocks))


def _sentences(fault: dict[str, Any]) -> str:
    context = fault.get("ctx", {})
    parts = [f"  found: {context.get('found', fault['msg'])}", f"  expected: {context.get('expected', '')}"]
    if context.get("help"):
        parts.append(f"  {context['help']}")
    return "\n".join(parts)


def _path_of(location: KeyPath, plain: Any) -> KeyPath:
    """Remove from pydantic's location the steps that are not in the file, such as the kinds of a union."""
    path: list[str | int] = []
    # An error in the whole description has an empty location.
    for step, following in zip(location, (*location, None)[1:], strict=True):
        # The kind of a union may have the name of one of its lists (panes).
        kind = isinstance(plain, Mapping) and plain.get("kind") == step and isinstance(following, str)
        if not kind and holds(plain, step):
            path.append(step)
            plain = _written(plain[step])
    last = location[-1] if location else None
    if isinstance(last, str) and "]" not in last and _lacks(plain, last, path):
        path.append(last)
    return tuple(path)


def _lacks(plain: Any, key: str, path: list[str | int]) -> bool:
    """Whether the last step of a location is a missing key, and not the kind of the part."""
    return isinstance(plain, Mapping) and path[-1:] != [key] and key not in _kinds(plain)


def _kinds(plain: Mapping[str, Any]) -> tuple[Any, ...]:
    """Kinds as which pydantic may read a mapping: a material without a kind is a solid or a product."""
    return (plain.get("kind", "solid"), plain.get("model"), *(["pcm"] if "product" in plain else []))


def holds(plain: Any, step: str | int) -> bool:
    """Whether a mapping or a list has something at a step of a path."""
    if isinstance(plain, list):
        return isinstance(step, int) and step < len(plain)
    return isinstance(plain, Mapping) and step in plain


def _written(plain: Any) -> Any:
    """A part that was given as an object, as the mapping that a file would hold."""
    if isinstance(plain, tuple):
        return list(plain)
    if not isinstance(plain, BaseModel):
        return plain
    names = plain.model_fields_set | ({"kind"} & type(plain).model_fields.keys())
    return {name: getattr(plain, name) for name in names}


def _where(path: KeyPath, lines: Mapping[KeyPath, int], name: str) -> tuple[str, int]:
    """File and line of a place, else of the nearest part around it; 0 where there is none."""
    for length in range(len(path), -1, -1):
        line = lines.get(path[:length])
        if line is not None:
            return getattr(line, "file", name), int(line)
    return name, 0


def _column(path: KeyPath, lines: Mapping[KeyPath, int], context: Mapping[str, Any]) -> int:
    """Column of a fault inside of a text of one line in the file; 0 where it is not known."""
    first = lines.get((*path, COLUMN), 0)
    return int(first) + context["column"] - 1 if first and context.get("text_line") == 1 else 0


def _dotted(path: KeyPath, plain: Any) -> str:
    """Write a place as the path of a parameter, with the names of layers."""
    steps = []
    for step in path:
        plain = _written(plain[step]) if holds(plain, step) else None
        named = isinstance(step, int) and isinstance(plain, Mapping)
        steps.append(str((plain.get("name") or plain.get("material") or step) if named else step))
    return ".".join(steps)

"""Descriptions that extend another one: `extends: base.yaml`, and what differs.

Mappings are merged key by key; everything else, lists included, replaces what the base has. A mapping with
another `kind` than that of the base replaces it as a whole. In a building, a key without a value removes the
key of the base, and `set` gives values by path.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from mascarin.building.base.error_texts import KeyPath, Line
from mascarin.errors import InputError

EXTENDS: Final = "extends"
SET: Final = "set"
DEEPEST: Final = 100
"""Files that may extend each other in a row."""

Read = Callable[[Path], tuple[dict[str, Any], dict[KeyPath, int]]]
"""Plain values of one file, and the line of each key and value."""


@dataclass(frozen=True)
class Inherited:
    """A description merged from a file and the files that it extends.

    Attributes
    ----------
    plain : dict
        The merged description, without ``extends``.
    lines : dict of place to int
        Line of each key and value; `Line.file` is the file it is in.
    files : tuple of Path
        The file, then what it extends, in order.
    values : dict of str to (any, Line)
        Values by path of the bases and of the file, with their lines; only where `by_path`.
    """

    plain: dict[str, Any]
    lines: dict[KeyPath, int]
    files: tuple[Path, ...]
    values: dict[str, tuple[Any, int]] = field(default_factory=dict)


def inherited(
    file: Path, read: Read, *, by_path: bool, file_keys: Collection[str] = (), chain: tuple[Path, ...] = ()
) -> Inherited:
    """Read a file and what it extends.

    Parameters
    ----------
    file : Path
        The file.
    read : callable
        Reads one file.
    by_path : bool
        Whether ``set`` gives values by path and a key without a value removes that of the base.
    file_keys : collection of str
        Keys that name files; those of a base in another folder are counted from there.
    chain : tuple of Path
        Files that led to this one.

    Returns
    -------
    Inherited
        The merged description.

    Raises
    ------
    InputError
        A base that is not there, or that extends one of the files before it.
    """
    plain, line_of = read(file)
    named = {line: Line(line, str(file)) for line in set(line_of.values())}
    lines: dict[KeyPath, int] = {position: named[line] for position, line in line_of.items()}
    base = plain.pop(EXTENDS, None)
    if base is None:
        return Inherited(plain, lines, (file,))
    chain = (*chain, file)
    if len(chain) > DEEPEST:
        raise InputError(
            f"{_line_text(lines, (EXTENDS,))}: {EXTENDS}\n  found: more than {DEEPEST} files that extend "
            f"each other, from {chain[0]} on\n  expected: at most {DEEPEST}\n  Put the values of some of "
            "them into one file."
        )
    path = _base(base, file, lines, chain)
    above = inherited(path, read, by_path=by_path, file_keys=file_keys, chain=chain)
    moved = _moved(above.plain, path.parent, file.parent, file_keys)
    changes = plain.pop(SET, {}) if by_path else {}
    if not isinstance(changes, Mapping):
        raise InputError(
            f"{_line_text(lines, (SET,))}: {SET}\n  found: {changes!r}\n  expected: values by path"
        )
    remaining = {key: value for key, value in above.values.items() if not _is_stated(plain, key.split("."))}
    values = {key: (value, lines[(SET, key)]) for key, value in changes.items()}
    where = dict(above.lines)
    merged = _merged(moved, plain, (), where, lines, remove=by_path)
    where[()] = lines[()]
    return Inherited(merged, where, (file, *above.files), remaining | values)


def over(
    base: Mapping[str, Any],
    stated: Mapping[str, Any],
    lines: Mapping[KeyPath, int],
    stated_lines: Mapping[KeyPath, int],
) -> tuple[dict[str, Any], dict[KeyPath, int]]:
    """Merge a mapping over another one of the same file, as an extending file over its base.

    Parameters
    ----------
    base, stated : mapping
        What is extended, and what differs.
    lines, stated_lines : mapping of place to int
        Line of each key and value of the two.

    Returns
    -------
    dict
        The merged mapping.
    dict of place to int
        Its lines.

    Examples
    --------
    >>> over({"a": {"b": 1, "c": 2}}, {"a": {"b": 3}}, {}, {("a",): 5, ("a", "b"): 5})[0]
    {'a': {'b': 3, 'c': 2}}
    """
    where = dict(lines)
    return _merged(base, stated, (), where, stated_lines, remove=False), where


def _line_text(lines: Mapping[KeyPath, int], path: KeyPath) -> str:
    line = lines.get(path, 0)
    return f"{getattr(line, 'file', '')}:{line}"


def _base(base: Any, file: Path, lines: Mapping[KeyPath, int], chain: tuple[Path, ...]) -> Path:
    """The file of a base, counted from the folder of the file that extends it."""
    where = f"{_line_text(lines, (EXTENDS,))}: {EXTENDS}"
    if not isinstance(base, str) or not base.strip():
        raise InputError(
            f"{where}\n  found: {base!r}\n  expected: the name of one file, such as base.yaml\n  Write "
            "'extends: base.yaml'; a base may itself extend another file."
        )
    path = file.parent / base
    if not path.is_file():
        raise InputError(
            f"{where}\n  found: no file {path}\n  expected: a file, its path counted from the folder of "
            f"{file.name}\n  Correct the name."
        )
    before = [link.resolve() for link in chain]
    if path.resolve() in before:
        circle = " -> ".join(link.name for link in (*chain[before.index(path.resolve()) :], path))
        raise InputError(
            f"{where}\n  found: a circle, {circle}\n  expected: files that do not extend each other in a "
            "circle\n  Let the first one stand alone."
        )
    return path


def _merged(
    base: Mapping[str, Any],
    stated: Mapping[str, Any],
    path: KeyPath,
    where: dict[KeyPath, int],
    lines: Mapping[KeyPath, int],
    *,
    remove: bool,
) -> dict[str, Any]:
    """Merge a mapping into that of the base; ``where`` gets the lines of what is taken."""
    merged = dict(base)
    for key, value in stated.items():
        inner = (*path, key)
        if value is None and remove:
            merged.pop(key, None)
            continue
        under = merged.get(key)
        if isinstance(value, Mapping) and isinstance(under, Mapping) and not _other_kind(under, value):
            where[inner] = lines[inner]
            merged[key] = _merged(under, value, inner, where, lines, remove=remove)
            continue
        merged[key] = _without_removed(value) if remove else value
        for old in [old for old in where if old[: len(inner)] == inner]:
            del where[old]
        where |= {new: line for new, line in lines.items() if new[: len(inner)] == inner}
    return merged


def _other_kind(base: Mapping[str, Any], stated: Mapping[str, Any]) -> bool:
    return "kind" in stated and stated["kind"] != base.get("kind")


def _without_removed(value: Any) -> Any:
    """A value without the keys that remove something: there is no base below it."""
    if isinstance(value, Mapping):
        return {key: _without_removed(piece) for key, piece in value.items() if piece is not None}
    return value


def _is_stated(value: Any, path: list[str]) -> bool:
    """Whether a description gives what is at a path, or a part that it is in, itself."""
    for step in path:
        if not isinstance(value, Mapping):
            return True
        if step not in value:
            return False
        value = value[step]
    return True


def _moved(plain: Any, of: Path, to: Path, file_keys: Collection[str]) -> Any:
    """The names of files counted from another folder; absolute ones and known data sets stay."""
    if not file_keys or of.resolve() == to.resolve():
        return plain
    if not isinstance(plain, Mapping):
        return plain
    return {
        key: os.path.relpath(of / value, to)
        if key in file_keys and isinstance(value, str) and not value.startswith("data:")
        else _moved(value, of, to, file_keys)
        for key, value in plain.items()
    }

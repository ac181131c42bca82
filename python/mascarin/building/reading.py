"""YAML 1.2 in: plain values with the line each one stands on, and errors that point at it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from pydantic import ValidationError

from mascarin.building.building import Building
from mascarin.building.part import Part
from mascarin.errors import InputError

if TYPE_CHECKING:
    from ruamel.yaml.nodes import Node

Place = tuple[str | int, ...]
AnyPart = TypeVar("AnyPart", bound=Part)

#: A description with more values than this is no description but an attack with aliases.
MOST_VALUES = 100_000


def load(path: str | Path) -> Building:
    """Read a building from a YAML file.

    Parameters
    ----------
    path : str or Path
        The file.

    Returns
    -------
    Building
        Checked, frozen.

    Raises
    ------
    InputError
        If the file cannot be read or describes no sound building. The text names every fault by file, line
        and path, with what was found, what was expected and what to do.
    """
    return read(path, Building, "a building")


def read(path: str | Path, kind: type[AnyPart], what: str) -> AnyPart:
    """Read a description of any kind from a YAML file.

    Parameters
    ----------
    path : str or Path
        The file.
    kind : type of Part
        What it describes.
    what : str
        The same in words, for messages.

    Returns
    -------
    Part
        Checked, frozen.

    Raises
    ------
    InputError
        As for :func:`load`.
    """
    file = Path(path)
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not UTF-8 text"
        raise InputError(f"{file}: cannot be read ({reason}); expected a YAML file of {what}") from error
    return parse_as(kind, text, str(file))


def parse(text: str, name: str) -> Building:
    """Read a building from YAML text; ``name`` stands for the file in messages."""
    return parse_as(Building, text, name)


def parse_as(kind: type[AnyPart], text: str, name: str) -> AnyPart:
    """Read a description of any kind from YAML text; ``name`` stands for the file in messages."""
    document = _Document(name, blanks=kind is not Building)
    plain = document.read(text)
    try:
        return kind.model_validate(plain)
    except ValidationError as error:
        raise explained(error, plain, name, document.lines) from None


def plain(text: str, name: str) -> Any:
    """Read YAML text as plain mappings, lists, texts and numbers; ``name`` stands for its file."""
    return _Document(name).read(text)


def lines(text: str, name: str) -> Mapping[Place, int]:
    """Tell on which line each key and value of YAML text stands, by place; ``name`` stands for its file."""
    document = _Document(name, blanks=True)
    document.read(text)
    return document.lines


def explained(
    error: ValidationError, plain: Any, name: str, lines: Mapping[Place, int] | None = None
) -> InputError:
    """Turn pydantic's faults into one error that names each by file, line and path."""
    found = sorted(
        (_line(place, lines or {}), _dotted(place, plain), _sentences(dict(fault)))
        for fault in error.errors(include_url=False)
        for place in [_place(fault["loc"], plain)]
    )
    blocks = []
    for line, dotted, sentences in dict.fromkeys(found):
        where = f"{name}:{line}" if line else name
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


def _place(location: Place, plain: Any) -> Place:
    """Drop from pydantic's location what does not stand in the file, such as the kinds of a union."""
    place: list[str | int] = []
    # The place of a fault in the whole is empty.
    for step, following in zip(location, (*location, None)[1:], strict=True):
        # The kind of a union may be called like one of its lists (panes).
        kind = isinstance(plain, Mapping) and plain.get("kind") == step and isinstance(following, str)
        if not kind and _holds(plain, step):
            place.append(step)
            plain = plain[step]
    last = location[-1] if location else None
    if isinstance(last, str) and "]" not in last and _lacks(plain, last, place):
        place.append(last)
    return tuple(place)


def _lacks(plain: Any, key: str, place: list[str | int]) -> bool:
    """Tell whether a location ends in a key that should stand here, not in the kind of what stands here."""
    return isinstance(plain, Mapping) and place[-1:] != [key] and plain.get("kind", "solid") != key


def _holds(plain: Any, step: str | int) -> bool:
    if isinstance(plain, list):
        return isinstance(step, int) and step < len(plain)
    return isinstance(plain, Mapping) and step in plain


def _line(place: Place, lines: Mapping[Place, int]) -> int:
    for length in range(len(place), -1, -1):
        if place[:length] in lines:
            return lines[place[:length]]
    return 0


def _dotted(place: Place, plain: Any) -> str:
    """Write a place as a parameter path: layers by name."""
    steps = []
    for step in place:
        plain = plain[step] if _holds(plain, step) else None
        named = isinstance(step, int) and isinstance(plain, Mapping)
        steps.append(str((plain.get("name") or plain.get("material") or step) if named else step))
    return ".".join(steps)


@dataclass
class _Document:
    """One YAML document being turned into plain values; ``blanks``: keys may stand without a value."""

    name: str
    blanks: bool = False
    lines: dict[Place, int] = field(default_factory=dict)
    faults: list[tuple[int, str]] = field(default_factory=list)
    values: int = 0
    scalars: Any = None

    def read(self, text: str) -> Any:
        from ruamel.yaml import YAML
        from ruamel.yaml.error import MarkedYAMLError, YAMLError

        yaml = YAML(typ="safe", pure=True)
        self.scalars = yaml.constructor
        try:
            root = yaml.compose(text)
            plain = self._value(root, (), frozenset()) if root is not None else None
        except MarkedYAMLError as error:
            mark = error.problem_mark or error.context_mark
            self._refuse(
                mark.line if mark else 0,
                "",
                f"text that is no YAML: {error.problem}",
                "valid YAML 1.2",
                "Indent with spaces: YAML knows no tabs there."
                if "\\t" in str(error.problem)
                else "Check indentation, colons and quotes near this line.",
            )
        except YAMLError as error:
            self._refuse(0, "", f"text that is no YAML: {error}", "valid YAML 1.2", "Save it as UTF-8 text.")
        if not self.faults and not isinstance(plain, Mapping):
            self._refuse(0, "", "no keys", "a mapping with site:, surfaces: and so on", "See the examples.")
        if self.faults:
            raise InputError("\n".join(text for _, text in sorted(self.faults)))
        return plain

    def _refuse(self, line: int, place: str, found: str, expected: str, help_: str) -> None:
        where = f"{self.name}:{line + 1}: {place or 'the whole description'}"
        self.faults.append((line, f"{where}\n  found: {found}\n  expected: {expected}\n  {help_}"))

    def _value(self, node: Node, place: Place, above: frozenset[int]) -> Any:
        from ruamel.yaml.nodes import MappingNode, SequenceNode

        self.values += 1
        if self.values > MOST_VALUES:
            raise InputError(f"{self.name}: found more than {MOST_VALUES} values; expected a building")
        if id(node) in above:
            self._refuse(
                node.start_mark.line,
                _text(place),
                "an alias without end",
                "a tree of values",
                "Write it out.",
            )
            return None
        self.lines.setdefault(place, node.start_mark.line + 1)
        inside = above | {id(node)}
        if isinstance(node, MappingNode) and node.tag == "tag:yaml.org,2002:map":
            return dict(self._items(node, place, inside))
        if isinstance(node, SequenceNode) and node.tag == "tag:yaml.org,2002:seq":
            return [self._value(item, (*place, index), inside) for index, item in enumerate(node.value)]
        return self._scalar(node, place)

    def _items(self, node: Any, place: Place, inside: frozenset[int]) -> Iterator[tuple[str, Any]]:
        seen: dict[str, int] = {}
        for key_node, value_node in node.value:
            line, key = key_node.start_mark.line, key_node.value
            if not isinstance(key, str):
                self._refuse(
                    line, _text(place), "a key that is no text", "a plain key", "Quote or simplify it."
                )
                continue
            if key in seen:
                self._refuse(
                    line,
                    _text((*place, key)),
                    f"the key '{key}' again (first on line {seen[key]})",
                    "each key once",
                    "Remove or rename one of the two.",
                )
            seen.setdefault(key, line + 1)
            self.lines[(*place, key)] = line + 1
            yield key, self._value(value_node, (*place, key), inside)

    def _scalar(self, node: Any, place: Place) -> Any:
        kind = node.tag.removeprefix("tag:yaml.org,2002:")
        match kind:
            case "null" if self.blanks:
                return None
            case "null":
                line = self.lines[place] - 1  # the key's: the value that is missing has no line
                # In braces the comma of 0,4 ends a value, and what follows is a key without one.
                comma = isinstance(place[-1], str) and place[-1].isdigit()
                help_ = "Write decimals with a point, as in 0.4." if comma else "Write one or remove the key."
                self._refuse(line, _text(place), "nothing", "a value", help_)
                return None
            case "bool" | "int" | "float":
                return getattr(self.scalars, f"construct_yaml_{kind}")(node)
            case "str" | "timestamp":
                return node.value
            case _:
                self._refuse(
                    node.start_mark.line, _text(place), f"the tag '{kind}'", "plain values", "Remove the tag."
                )
                return None


def _text(place: Place) -> str:
    return ".".join(map(str, place))

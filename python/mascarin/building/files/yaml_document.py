"""Read YAML 1.2: plain values with the line of each, and errors that name the line."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from pydantic import ValidationError

from mascarin._io.arguments import require_type
from mascarin._io.identity import DESCRIPTION
from mascarin._io.memory import uncollected
from mascarin._io.regular import require_regular
from mascarin.building.base.error_texts import COLUMN, KeyPath, explained
from mascarin.building.base.part import Part
from mascarin.building.files.defaults import DEFAULTS, names_a_building, with_defaults
from mascarin.building.files.inheritance import EXTENDS, Inherited, inherited
from mascarin.building.files.recognition import recognized
from mascarin.building.files.yaml_nodes import Reader, compose, number_of
from mascarin.errors import InputError

AnyPart = TypeVar("AnyPart", bound=Part)

#: Aliases can make a small file expand to any size; no text of fewer letters has more values than this.
MOST_VALUES = 100_000
#: No description has values deeper than this.
MOST_LEVELS = 50
#: Longer whole numbers are no quantities; the time to read one grows with the square of its digits.
MOST_DIGITS = 40
#: Keys of texts in which an error has a column.
_FORMULAS = ("formula", "valid")
#: Halves of surrogate pairs.
_HALVES = re.compile("[\ud800-\udfff]")


@uncollected()
def read(
    path: str | Path,
    kind: type[AnyPart],
    what: str,
    *,
    blanks: bool = True,
    file_keys: Collection[str] = (),
    finish: Callable[[AnyPart, Mapping[str, tuple[Any, int]]], AnyPart] | None = None,
) -> AnyPart:
    """Read a description of any kind from a YAML file.

    Parameters
    ----------
    path : str or Path
        The file.
    kind : type of Part
        What it describes.
    what : str
        The same in words, for messages.
    blanks : bool
        Whether a key may stand without a value.
    file_keys : collection of str
        Keys that name files, which are counted from the folder of the file in which they are.
    finish : callable, optional
        Puts in the values that the file gives by path, each with its line.

    Returns
    -------
    Part
        Checked, frozen.

    Raises
    ------
    InputError
        If the file cannot be read or its description has errors. The text names each error by file, line and
        path, with what was found, what was expected and what to do.
    """
    require_type("path", path, (str, Path), "the path of a file; a mapping is read by Building.from_dict")
    document = merged(Path(path), what, blanks=blanks, file_keys=file_keys)
    try:
        part = kind.model_validate(document.plain)
    except ValidationError as error:
        raise explained(error, document.plain, str(path), document.lines) from None
    return finish(part, document.values) if document.values and finish is not None else part


def merged(path: Path, what: str, *, blanks: bool, file_keys: Collection[str] = ()) -> Inherited:
    """Plain values of a file merged with the files that it extends.

    Parameters
    ----------
    path : Path
        The file.
    what : str
        What it describes, for messages.
    blanks : bool
        Whether a key may stand without a value.
    file_keys : collection of str
        Keys that name files.
    """

    def one(file: Path) -> tuple[dict[str, Any], dict[KeyPath, int]]:
        try:
            text = require_regular(file, f"a YAML file of {what}", DESCRIPTION).read_text("utf-8")
        except (OSError, UnicodeDecodeError) as error:
            reason = getattr(error, "strerror", None) or "it is not UTF-8 text"
            raise InputError(f"{file}: cannot be read ({reason}); expected a YAML file of {what}") from error
        document = _Document(str(file), blanks=blanks)
        file_kind = recognized(text, str(file))
        if file_kind is not None:
            document.refuse_at_all(file_kind.what, f"a YAML file of {what}", file_kind.remedy)
        return document.read(text), document.lines

    document = inherited(path, one, by_path=not blanks, file_keys=file_keys)
    # Only buildings have keys without blanks, and defaults.
    return document if blanks else _with_defaults(document)


def _with_defaults(document: Inherited) -> Inherited:
    """The description with its section `defaults` put in; what is put in has the line of its default."""
    if DEFAULTS not in document.plain:
        return document
    where = dict(document.lines)

    def put(position: KeyPath, source: KeyPath) -> None:
        for path, line in document.lines.items():
            if path[: len(source)] == source:
                where[*position, *path[len(source) :]] = line

    try:
        described = with_defaults(document.plain, put)
    except InputError as error:
        line = document.lines[(DEFAULTS,)]
        raise InputError(f"{getattr(line, 'file', document.files[0])}:{line}: {error}") from None
    return replace(document, plain=described, lines=where)


def validated(
    path: Path, kind: type[AnyPart], what: str, *, only: Collection[str], file_keys: Collection[str] = ()
) -> AnyPart:
    """Read some keys of a description, whatever else the file has; see `read`."""
    document = merged(path, what, blanks=True, file_keys=file_keys)
    plain = {key: value for key, value in document.plain.items() if key in only}
    try:
        return kind.model_validate(plain)
    except ValidationError as error:
        raise explained(error, plain, str(path), document.lines) from None


def parse_as(kind: type[AnyPart], text: str, name: str, *, blanks: bool = True) -> AnyPart:
    """Read a description of any kind from YAML text; ``name`` is the name of the file in messages."""
    source = _Document(name, blanks=blanks)
    document = Inherited(source.read(text), source.lines, (Path(name),))
    if not blanks:
        document = _with_defaults(document)
    try:
        return kind.model_validate(document.plain)
    except ValidationError as error:
        raise explained(error, document.plain, name, document.lines) from None


def plain(text: str, name: str) -> Any:
    """Read YAML text as mappings, lists, texts and numbers; ``name`` is the name of the file in messages."""
    return _Document(name).read(text)


def lines(path: Path) -> tuple[Mapping[KeyPath, int], tuple[Path, ...]]:
    """Line of each key and value of a YAML file and the files that it extends, by place; and these files."""
    document = merged(path, "a description", blanks=True)
    return document.lines, document.files


def files_of(path: Path) -> tuple[Path, ...]:
    """A YAML file and the files that it extends, in order."""
    return merged(path, "a description", blanks=True).files


@dataclass
class _Document:
    """One YAML document being turned into plain values; ``blanks``: keys may stand without a value."""

    name: str
    blanks: bool = False
    lines: dict[KeyPath, int] = field(default_factory=dict)
    faults: list[tuple[int, str]] = field(default_factory=list)
    values: int = 0
    most_values: int = MOST_VALUES
    reader: Reader = field(default_factory=Reader)

    def read(self, text: str) -> Any:
        self.most_values = max(MOST_VALUES, len(text))
        plain: Any = None
        try:
            root = compose(self.reader, text)
            # A key without a value removes that of the base.
            self.blanks = self.blanks or _extends(root)
            plain = self._value(root, (), frozenset()) if root is not None else None
        except self.reader.faults[0] as error:
            mark = error.problem_mark or error.context_mark
            self._refuse(
                mark.line if mark else 0,
                "",
                f"text that is no YAML: {error.problem}",
                "valid YAML 1.2",
                "Indent with spaces: YAML does not allow tabs there."
                if "\\t" in str(error.problem)
                else "Check indentation, colons and quotes near this line.",
            )
        except self.reader.faults[1] as error:
            self._refuse(0, "", f"text that is no YAML: {error}", "valid YAML 1.2", "Save it as UTF-8 text.")
        except RecursionError:
            self._too_deep(0)
        except (ValueError, OverflowError) as error:
            # Numbers of a character beyond the last one end in such errors of the parser.
            self._refuse(
                0, "", f"text that is no YAML: {error}", "valid YAML 1.2", "Check the text in double quotes."
            )
        if not self.faults and not isinstance(plain, Mapping):
            self._refuse(0, "", "no keys", "a mapping with site:, surfaces: and so on", "See the examples.")
        # Keys without values are right in a study: what is wrong is that it is one, which is said later.
        other = not self.blanks and isinstance(plain, Mapping) and names_a_building(plain)
        if self.faults and not other:
            raise InputError("\n".join(text for _, text in sorted(self.faults)))
        return plain

    def refuse_at_all(self, actual: str, expected: str, help_: str) -> NoReturn:
        """Refuse a file that is no description."""
        self._refuse(0, "", actual, expected, help_)
        raise InputError(self.faults[0][1])

    def _refuse(self, line: int, path: str, actual: str, expected: str, help_: str) -> None:
        where = f"{self.name}:{line + 1}: {path or 'the whole description'}"
        self.faults.append((line, f"{where}\n  found: {actual}\n  expected: {expected}\n  {help_}"))

    def _too_deep(self, line: int) -> NoReturn:
        raise InputError(
            f"{self.name}:{line + 1}: found values inside each other more than {MOST_LEVELS} times; expected "
            "a description, whose values are a few levels deep"
        )

    def _value(self, node: Any, path: KeyPath, above: frozenset[int]) -> Any:
        self.values += 1
        if self.values > self.most_values:
            raise InputError(
                f"{self.name}: found more than {self.most_values} values, as aliases make them of a short "
                "text; expected a building"
            )
        if id(node) in above:
            self._refuse(
                node.start_mark.line,
                _text(path),
                "an alias without end",
                "a tree of values",
                "Write it out.",
            )
            return None
        if len(above) > MOST_LEVELS:
            self._too_deep(node.start_mark.line)
        self.lines.setdefault(path, node.start_mark.line + 1)
        if path and path[-1] in _FORMULAS and node.id == "scalar" and node.style not in ("|", ">"):
            self.lines[*path, COLUMN] = node.start_mark.column + 1 + (node.style is not None)
        if node.id == "mapping" and node.tag == "tag:yaml.org,2002:map":
            return dict(self._items(node, path, above | {id(node)}))
        if node.id == "sequence" and node.tag == "tag:yaml.org,2002:seq":
            inside = above | {id(node)}
            return [self._value(item, (*path, index), inside) for index, item in enumerate(node.value)]
        return self._scalar(node, path)

    def _items(self, node: Any, path: KeyPath, inside: frozenset[int]) -> Iterator[tuple[str, Any]]:
        line_of_key: dict[str, int] = {}
        for key_node, value_node in node.value:
            line, key = key_node.start_mark.line, key_node.value
            if not isinstance(key, str):
                self._refuse(
                    line, _text(path), "a key that is no text", "a plain key", "Quote or simplify it."
                )
                continue
            if self._words(key_node, (*path, "?")) is None:
                continue
            if key in line_of_key:
                self._refuse(
                    line,
                    _text((*path, key)),
                    f"the key '{key}' again (first on line {line_of_key[key]})",
                    "each key once",
                    "Remove or rename one of the two.",
                )
            line_of_key.setdefault(key, line + 1)
            self.lines[(*path, key)] = line + 1
            yield key, self._value(value_node, (*path, key), inside)

    def _scalar(self, node: Any, path: KeyPath) -> Any:
        kind = node.tag.removeprefix("tag:yaml.org,2002:")
        match kind:
            case "null" if self.blanks:
                return None
            case "null":
                line = self.lines[path] - 1  # the key's: the value that is missing has no line
                # In braces the comma of 0,4 ends a value, and what follows is a key without one.
                comma = isinstance(path[-1], str) and path[-1].isdigit()
                help_ = "Write decimals with a point, as in 0.4." if comma else "Write one or remove the key."
                self._refuse(line, _text(path), "nothing", "a value", help_)
                return None
            case "bool" | "int" | "float" if isinstance(node.value, str):
                return self._number(node, path, kind)
            case "str" | "timestamp" if isinstance(node.value, str):
                return self._words(node, path)
            case _:
                self._refuse(
                    node.start_mark.line, _text(path), f"the tag '{kind}'", "plain values", "Remove the tag."
                )
                return None

    def _number(self, node: Any, path: KeyPath, kind: str) -> Any:
        """A number or a truth value; a tag can stand on a text that is neither."""
        line = node.start_mark.line
        if kind == "int" and len(node.value) > MOST_DIGITS:
            self._refuse(
                line,
                _text(path),
                f"a whole number of {len(node.value)} digits",
                f"at most {MOST_DIGITS} digits",
                "Write it with an exponent, as in 1e21.",
            )
            return None
        try:
            return number_of(self.reader, kind, node.value)
        except (ValueError, KeyError, IndexError, OverflowError):
            actual = f"the tag '{kind}' on the text '{node.value[:40]}'"
            self._refuse(line, _text(path), actual, "plain values", "Remove the tag.")
            return None

    def _words(self, node: Any, path: KeyPath) -> str | None:
        """A text; half of a surrogate pair, which an escape can write, is no character."""
        text: str = node.value
        if _HALVES.search(text):
            actual = f"the text {text[:40]!r} with half of a surrogate pair"
            self._refuse(node.start_mark.line, _text(path), actual, "text", "Write the letter itself.")
            return None
        return text


def _extends(root: Any) -> bool:
    """Whether a document extends another one."""
    pairs = root.value if isinstance(getattr(root, "value", None), list) else []
    return any(isinstance(pair, tuple) and pair[0].value == EXTENDS for pair in pairs)


def _text(path: KeyPath) -> str:
    return ".".join(map(str, path))

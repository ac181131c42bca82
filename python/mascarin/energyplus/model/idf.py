"""Objects of an EnergyPlus file (IDF or epJSON), each with its fields, defaults and line.

The parser and the schemas of each version (field names, their order, defaults, extensible groups) are those
of idfkit; EnergyPlus itself is not needed.
"""

from __future__ import annotations

import bisect
import json
import re
import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, Final

from mascarin._io.regular import require_regular
from mascarin.building.files.recognition import described
from mascarin.energyplus.model.expressions import values_of_first_run, with_values
from mascarin.energyplus.model.field_checks import AUTO, wrong_number
from mascarin.errors import InputError, did_you_mean

_TOKEN: Final = re.compile(r'"(?:[^"\\]|\\.)*"|[{}\[\]]')
_COMMENT: Final = re.compile(rb"![^\n]*")
#: Lines of the macro preprocessor, and its expressions in fields.
_MACRO: Final = re.compile(rb"^[ \t]*##[^\n]*|#(?:eval)?[ \t]*\[[^\n]*", re.MULTILINE | re.IGNORECASE)
#: Blank fields at the end of an object, from the second one on.
_BLANK_END: Final = re.compile(rb"(?<=,)\s*,[\s,]*(?=;)")
#: White space, and what old editors write at the end of a file.
_ENDING: Final = b" \t\r\n\x1a\x00\xef\xbb\xbf"
_SUFFIXES: Final = {".idf": "idf", ".epjson": "epjson", ".json": "epjson"}
_EXPECTED: Final = "a model of EnergyPlus, .idf or .epJSON"


class Fields(dict[str, Any]):
    """Fields of an object, which remember which of them were looked at.

    Attributes
    ----------
    seen : set of str
        Names of the fields that were read.
    """

    def __init__(self, values: Mapping[str, Any]) -> None:
        super().__init__(values)
        self.seen: set[str] = set()

    def __getitem__(self, key: str) -> Any:
        self.seen.add(key)
        return super().__getitem__(key)

    def __contains__(self, key: object) -> bool:
        self.seen.add(str(key))
        return super().__contains__(key)

    def get(self, key: str, default: Any = None) -> Any:
        """The value of a field, which counts as read."""
        self.seen.add(key)
        return super().get(key, default)

    def starting(self, prefix: str) -> list[Any]:
        """Values of the fields whose names start so; they count as read."""
        return [self[key] for key in list(self) if key.startswith(prefix)]

    def pass_over(self, pattern: str) -> None:
        """Count fields as read that a finding speaks of, or without effect; ``*`` stands for any text."""
        self.seen |= {key for key in self if fnmatchcase(key, pattern)}

    def unseen(self) -> dict[str, Any]:
        """Fields that nothing has read."""
        return {key: value for key, value in super().items() if key not in self.seen}


@dataclass(frozen=True)
class IdfObject:
    """One object of the file.

    Attributes
    ----------
    kind : str
        Class of the object, such as ``Zone``.
    name : str
        Its name; empty for a class without names.
    fields : Fields
        Values by the names of epJSON; blank fields are left out.
    defaults : mapping of str to object
        Default of each field in this version of EnergyPlus.
    line : int or None
        Line in the file.
    file : str
        Name of the file.
    """

    kind: str
    name: str
    fields: Fields
    defaults: Mapping[str, Any] = field(repr=False)
    line: int | None
    file: str

    @property
    def label(self) -> str:
        """Class and name."""
        return f"{self.kind} '{self.name}'" if self.name else self.kind

    @property
    def where(self) -> str:
        """File, line, class and name."""
        return f"{self.file}{'' if self.line is None else f':{self.line}'}: {self.label}"

    def get(self, *keys: str) -> Any:
        """First given value of some fields, else their default; None without either."""
        stated: Any = None
        for key in reversed(keys):
            value = self.fields.get(key)
            stated = stated if value is None else value
        if stated is not None:
            return stated
        return next((self.defaults[key] for key in keys if key in self.defaults), None)

    def text(self, *keys: str) -> str:
        """The same as text without spaces at its ends; empty where nothing is given."""
        value = self.get(*keys)
        return "" if value is None else str(value).strip()

    def word(self, *keys: str) -> str:
        """The same in small letters, for words that EnergyPlus compares without case."""
        return self.text(*keys).casefold()

    def number(self, *keys: str) -> float | None:
        """A number; None where nothing is given or EnergyPlus finds it (autosize, autocalculate).

        Raises
        ------
        InputError
            The field holds something else.
        """
        value = self.get(*keys)
        if value is None or (isinstance(value, str) and value.strip().casefold() in AUTO):
            return None
        try:
            return float(value)
        except (TypeError, ValueError):
            raise self.error(f"{keys[0]}: found {value!r}", "a number", "Correct the field") from None

    def needed(self, *keys: str) -> float:
        """A number that must be given.

        Raises
        ------
        InputError
            There is none.
        """
        number = self.number(*keys)
        if number is None:
            text = self.text(*keys)
            raise self.error(f"{keys[0]}: found {text or 'nothing'}", "a number", "Give the number")
        return number

    def rows(self, key: str) -> list[Mapping[str, Any]]:
        """Groups of an extensible field."""
        return [row for row in self.fields.get(key) or [] if isinstance(row, Mapping)]

    def error(self, problem: str, expected: str, advice: str) -> InputError:
        """An error that names the object and its line."""
        return InputError(f"{self.where}: {problem}; expected {expected}. {advice}")


class IdfModel:
    """All objects of a file, by class and by name, without regard to case.

    Parameters
    ----------
    file : Path
        The file.
    version : tuple of int
        Version of EnergyPlus that it is written for.
    items : list of IdfObject
        In the order of the file.
    groups : mapping of str to str
        Group of each class that occurs, in the dictionary of this version.
    """

    def __init__(
        self, file: Path, version: tuple[int, ...], items: list[IdfObject], groups: Mapping[str, str]
    ) -> None:
        self.file, self.version, self.items, self.groups = file, version, items, groups
        #: Classes that handlers have read, and all that were looked up, in small letters.
        self.read: set[str] = set()
        self.looked_up: set[str] = set()
        self._by_kind: dict[str, list[IdfObject]] = {}
        self._by_name: dict[tuple[str, str], IdfObject] = {}
        for item in items:
            self._by_kind.setdefault(item.kind.casefold(), []).append(item)
            self._by_name.setdefault((item.kind.casefold(), item.name.casefold()), item)

    def of(self, *kinds: str) -> list[IdfObject]:
        """Objects of some classes."""
        self.looked_up |= {kind.casefold() for kind in kinds}
        return [item for kind in kinds for item in self._by_kind.get(kind.casefold(), [])]

    def of_class(self, kind: str) -> list[IdfObject]:
        """Objects of a class, which does not count as looked up."""
        return self._by_kind.get(kind.casefold(), [])

    def has(self, kind: str) -> bool:
        """Whether the file has objects of a class, which do not count as looked up."""
        return kind.casefold() in self._by_kind

    def one(self, kind: str) -> IdfObject | None:
        """The object of a class of which there is one; None without it."""
        objects = self.of(kind)
        return objects[0] if objects else None

    def named(self, name: str, *kinds: str) -> IdfObject | None:
        """The object of one of some classes with a name."""
        self.looked_up |= {kind.casefold() for kind in kinds}
        return self.of_any_class(name, *kinds)

    def of_any_class(self, name: str, *kinds: str) -> IdfObject | None:
        """The object with a name of classes that the file names itself: no handler need read them."""
        keys = ((kind.casefold(), name.strip().casefold()) for kind in kinds)
        return next((self._by_name[key] for key in keys if key in self._by_name), None)

    def require(self, user: IdfObject, key: str, *kinds: str, name: str | None = None) -> IdfObject:
        """The object that a field names.

        Raises
        ------
        InputError
            There is none; the text names the nearest ones.
        """
        target = user.text(key) if name is None else name
        target_object = self.named(target, *kinds)
        if target_object is None:
            names = [item.name for item in self.of(*kinds)]
            raise user.error(
                f"{key}: found '{target}'" if target else f"{key}: found nothing",
                f"the name of a {' or '.join(kinds[:3])} of the file",
                did_you_mean(target, names) or f"Add the {kinds[0]}",
            )
        return target_object

    def count_as_read(self, classes: tuple[str, ...]) -> None:
        """Count classes as read; see `reads`."""
        self.read |= {name.casefold() for name in classes}

    def unread(self) -> Iterator[tuple[str, list[IdfObject]]]:
        """Classes that no handler has read, with their objects."""
        for key, items in self._by_kind.items():
            if key not in self.read:
                yield items[0].kind, items


def read(path: Path) -> IdfModel:
    """Read an IDF or epJSON file of EnergyPlus 8.9 or later.

    Parameters
    ----------
    path : Path
        The file; ``.idf``, ``.epJSON`` or ``.json``.

    Returns
    -------
    Model
        Its objects.

    Raises
    ------
    InputError
        The file cannot be read, its version is not known, or it has objects or fields that do not exist in
        its version; the text names file, line and object.
    """
    form = _SUFFIXES.get(path.suffix.casefold())
    if form is None:
        file_kind = described(path)
        actual = f"a file '{path.suffix}'" if file_kind is None else file_kind.what
        remedy = "" if file_kind is None else f": {file_kind.remedy.removesuffix('.')}"
        raise InputError(f"{path}: found {actual}; expected .idf or .epJSON of EnergyPlus{remedy}")
    require_regular(path, _EXPECTED)
    if not path.is_file():
        raise InputError(f"{path}: found no such file; expected {_EXPECTED}. Check its folder and name")
    kit = _idfkit()
    try:
        document: Any = _idf(kit, path) if form == "idf" else _epjson(kit, path)
    except kit.VersionNotFoundError:
        raise InputError(
            f"{path}: found no Version object; expected one such as 'Version, 25.2;'. Is this a model of "
            "EnergyPlus?"
        ) from None
    except (kit.SchemaNotFoundError, kit.UnsupportedVersionError):
        raise _unknown_version(kit, path) from None
    except kit.IDFParseError as error:
        raise _unreadable(path, error) from None
    except kit.IdfKitError as error:
        raise InputError(f"{path}: {error}; expected a model of EnergyPlus") from None
    if document.version[:2] not in {
        version[:2] for version in kit.get_schema_manager().get_supported_versions()
    }:
        raise _unknown_version(kit, path)
    items, schema = _items(document, path, form), document.schema
    kinds = {item.kind for item in items}
    groups = {kind: str(schema.get_group(kind) or "") for kind in kinds} if schema is not None else {}
    return IdfModel(path, tuple(document.version), items, groups)


def _idfkit() -> Any:
    try:
        import idfkit
    except ImportError:
        raise InputError(
            "convert: found no package idfkit, which reads files of EnergyPlus. Install it: "
            "pip install 'mascarin[energyplus]'"
        ) from None
    return idfkit


def _idf(kit: Any, path: Path) -> Any:
    data = path.read_bytes()
    if b"\0" in data:
        line = data.count(b"\n", 0, data.index(b"\0")) + 1
        raise InputError(f"{path}:{line}: found bytes that are no text; expected {_EXPECTED}. Check the file")
    plain = _COMMENT.sub(b"", data)
    macro = _MACRO.search(plain)
    if macro is not None:
        line = plain.count(b"\n", 0, macro.start()) + 1
        text = macro[0].decode("latin-1").strip()[:60]
        raise InputError(
            f"{path}:{line}: found the macro '{text}'; expected objects alone. Write the file out by the "
            "preprocessor EPMacro, which comes with EnergyPlus, and convert out.idf"
        )
    last = plain.rfind(b";") + 1
    incomplete = plain[last:].strip(_ENDING)
    if incomplete:
        # idfkit would look for the end of this object without end.
        line = plain.count(b"\n", 0, plain.index(incomplete, last)) + 1
        name = incomplete.split(b",")[0].decode("latin-1").strip()[:60]
        raise InputError(
            f"{path}:{line}: found {name!r} without a semicolon after its last field; expected one at the "
            "end of each object. Is the file complete?"
        )
    try:
        data.decode("utf-8")
        encoding = "utf-8"
    except UnicodeDecodeError:
        encoding = "latin-1"
    tidy = _without_blank_ends(data)
    if tidy == data:
        return kit.parse_idf(path, encoding=encoding, preserve_formatting=True)
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "model.idf"
        copy.write_bytes(tidy)
        return kit.parse_idf(copy, encoding=encoding, preserve_formatting=True)


def _without_blank_ends(data: bytes) -> bytes:
    """A file without the blank fields at the ends of its objects, with the same lines.

    EnergyPlus reads over blank fields after the last field of a class; a parser by its schema does not.
    """
    blanked = bytearray(data)
    plain = _COMMENT.sub(lambda match: b" " * len(match[0]), data)
    for match in _BLANK_END.finditer(plain):
        for offset in range(match.start(), match.end()):
            if plain[offset : offset + 1] == b",":
                blanked[offset] = ord(" ")
    return bytes(blanked)


def _epjson(kit: Any, path: Path) -> Any:
    try:
        document: Any = kit.load_epjson(path)
    except json.JSONDecodeError as error:
        raise InputError(f"{path}:{error.lineno}: found no JSON: {error.msg}; expected epJSON") from None
    except RecursionError:
        raise InputError(
            f"{path}: found values that are nested too deeply; expected classes of objects with "
            "their fields. Is this a model of EnergyPlus?"
        ) from None
    except (UnicodeDecodeError, AttributeError, TypeError) as error:
        raise InputError(f"{path}: found no epJSON ({error}); expected classes of objects") from None
    return document


def _unknown_version(kit: Any, path: Path) -> InputError:
    versions = kit.get_schema_manager().get_supported_versions()
    ends = " to ".join(f"{major}.{minor}" for major, minor, _ in (min(versions), max(versions)))
    match = re.search(r"version[^0-9]*([0-9.]+)", path.read_text(encoding="latin-1"), re.IGNORECASE)
    return InputError(
        f"{path}: found EnergyPlus version {match[1] if match else 'that is not known'}; expected {ends}. "
        "Bring the file to such a version by IDFVersionUpdater, which comes with EnergyPlus"
    )


def _unreadable(path: Path, error: Any) -> InputError:
    messages = []
    for diagnostic in error.diagnostics:
        position = f"{path}{'' if diagnostic.line is None else f':{diagnostic.line}'}"
        name = (
            f"{diagnostic.obj_type or 'object'}{f' {diagnostic.obj_name!r}' if diagnostic.obj_name else ''}"
        )
        messages.append(f"{position}: {name}: {diagnostic.message}")
    return InputError(
        "\n".join(messages or [f"{path}: {error}"])
        + "; expected objects and fields of the version that the file names. Correct it, or bring it to "
        "that version by IDFVersionUpdater, which comes with EnergyPlus"
    )


def _items(document: Any, path: Path, form: str) -> list[IdfObject]:
    schema = document.schema
    lines = _idf_lines(document) if form == "idf" else _epjson_lines(path)
    defaults: dict[str, dict[str, Any]] = {}
    parameters = values_of_first_run(
        (str(entry.obj_type), str(entry.name or ""), dict(entry.data))
        for entry in document.all_objects
        if str(entry.obj_type).startswith("Parametric:")
    )
    items = []
    for k, entry in enumerate(document.all_objects):
        kind = str(entry.obj_type)
        if schema is None or kind not in schema:
            classes = list(schema.object_types) if schema is not None else []
            raise InputError(
                f"{path}:{lines.get((kind, entry.name), '?')}: found the class '{kind}', which EnergyPlus "
                f"{'.'.join(map(str, document.version[:2]))} does not have. {did_you_mean(kind, classes)}"
            )
        if kind not in defaults:
            defaults[kind] = _defaults(schema, kind)
        plain = {key: value for key, value in dict(entry.data).items() if value is not None and value != ""}
        if parameters:
            plain = {key: with_values(value, parameters) for key, value in plain.items()}
        line = lines.get(k) if form == "idf" else lines.get((kind, entry.name), lines.get((kind, "")))
        item = IdfObject(kind, str(entry.name or ""), Fields(plain), defaults[kind], line, path.name)
        if form == "epjson":
            _only_known(schema, item)
        fault = wrong_number(schema, kind, plain)
        if fault is not None:
            advice = (
                "ParametricPreprocessor of EnergyPlus writes a file for each of its runs: convert one"
                if re.search(r"found '\s*=", fault)
                else "EnergyPlus refuses it too: correct the field"
            )
            raise InputError(f"{item.where}: {fault}. {advice}")
        items.append(item)
    return items


def _only_known(schema: Any, item: IdfObject) -> None:
    """Refuse fields that the class does not have, as EnergyPlus does."""
    names = set((schema.get_inner_schema(item.kind) or {}).get("properties", {}))
    names |= set(schema.get_all_field_names(item.kind))
    for key in item.fields.unseen():
        if names and key not in names and not key.startswith("idf_"):
            raise item.error(
                f"found the field '{key}'", "a field of this class", did_you_mean(key, names) or "Remove it"
            )


def _defaults(schema: Any, kind: str) -> dict[str, Any]:
    names = schema.get_all_field_names(kind)
    pairs = ((name, schema.get_field_default(kind, name)) for name in names)
    return {name: value for name, value in pairs if value is not None and value != ""}


def _idf_lines(document: Any) -> dict[Any, int]:
    """Line of each object by its place."""
    text = document.raw_text or ""
    starts = [0, *(match.end() for match in re.finditer("\n", text))]
    line_of: dict[Any, int] = {}
    for k, entry in enumerate(document.all_objects):
        span = document.region_of(entry)
        if span is not None:
            line_of[k] = bisect.bisect_right(starts, span.start)
    return line_of


def _epjson_lines(path: Path) -> dict[Any, int]:
    """Line of each object by class and name; that of the class under the empty name."""
    text = path.read_text(encoding="utf-8-sig")
    starts = [0, *(match.end() for match in re.finditer("\n", text))]
    line_of: dict[Any, int] = {}
    above: list[str] = []
    last = ""
    for token in _TOKEN.finditer(text):
        mark = token[0]
        if mark in "{[":
            above.append(last)
            if mark == "{" and len(above) in (2, 3):
                key = (above[1], "" if len(above) == 2 else above[2])
                line_of.setdefault(key, bisect.bisect_right(starts, token.start()))
            last = ""
        elif mark in "}]":
            above = above[:-1]
        else:
            last = json.loads(mark, strict=False)
    return line_of

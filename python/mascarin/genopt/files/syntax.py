"""Reads the block syntax of GenOpt's files: ``Section { Key = value; ... }``."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from mascarin._io.regular import require_regular
from mascarin.errors import InputError, did_you_mean
from mascarin.genopt.files.numbers import normalised

_WORD = re.compile(r"[\w.:/\\*%+\-\x80-\U0010ffff]+")
_NUMBER_WITH_EXPONENT = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)[eE][+-]?\d+\Z")
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "b": "\b", "f": "\f", '"': '"', "'": "'", "\\": "\\"}
_MAX_ERRORS = 30


@dataclass
class Report:
    """Collects the errors in the files of a project, and what GenOpt would not have accepted.

    Parameters
    ----------
    lenient : bool
        Whether things that GenOpt cannot run are accepted and reported instead of being errors.
    errors, notes : list of str
        Texts, each with file and line.
    """

    lenient: bool = False
    errors: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def error(self, location: str, text: str) -> None:
        """Add an error."""
        if len(self.errors) < _MAX_ERRORS:
            self.errors.append(f"{location}: {text}")

    def beyond(self, location: str, text: str, remedy: str) -> None:
        """Add something that GenOpt cannot run: a note when lenient, else an error."""
        if self.lenient:
            self.notes.append(f"{location}: accepted beyond GenOpt: {text}")
        else:
            self.error(location, f"{text}; {remedy} (or accept it with --lenient)")

    def raise_if_any(self) -> None:
        """Raise an error with all errors found.

        Raises
        ------
        InputError
            There is an error.
        """
        if self.errors:
            raise InputError("\n".join(self.errors))


@dataclass(frozen=True)
class Entry:
    """One ``Key = value;``.

    Parameters
    ----------
    key : str
        The key.
    value : str
        The text of the value, without quotes.
    quoted : bool
        Whether the value was in quotes.
    location : str
        File and line.
    raw : str
        The value as written in the file.
    """

    key: str
    value: str
    quoted: bool
    location: str
    raw: str = ""

    @property
    def has_exponent(self) -> bool:
        """Whether the value is an unquoted number with an exponent, like ``1e-3``."""
        return not self.quoted and _NUMBER_WITH_EXPONENT.match(self.raw) is not None


@dataclass
class Block:
    """One ``Name { ... }``.

    Parameters
    ----------
    name : str
        The name.
    location : str
        File and line of the name.
    end : str
        File and line of the closing brace.
    entries : list of Entry
        Keys and values in order.
    blocks : list of Block
        Blocks inside, in order.
    order : list of Entry or Block
        Both, in order.
    """

    name: str
    location: str
    end: str = ""
    entries: list[Entry] = field(default_factory=list)
    blocks: list[Block] = field(default_factory=list)
    order: list[Entry | Block] = field(default_factory=list)

    def get(self, key: str) -> Entry | None:
        """Return the first entry of a key, None when there is none."""
        return next((e for e in self.entries if e.key == key), None)

    def block(self, name: str) -> Block | None:
        """Return the first block of a name, None when there is none."""
        return next((b for b in self.blocks if b.name == name), None)


@dataclass(frozen=True, slots=True)
class _Token:
    text: str
    kind: str  # "word", "string", "mark" or "end"
    line: int


class _Bad(Exception):
    """A syntax error that ends reading of a file."""


def read(path: Path, report: Report) -> Block:
    """Read one file into blocks.

    Parameters
    ----------
    path : Path
        The file.
    report : Report
        Takes errors and notes.

    Returns
    -------
    Block
        A block without a name that contains the whole file.

    Raises
    ------
    InputError
        The file cannot be read or has a syntax error.
    """
    try:
        text = require_regular(path).read_text(encoding="utf-8", errors="surrogateescape")
    except OSError as error:
        msg = f"cannot read '{path}': {error.strerror}"
        raise InputError(msg) from error
    try:
        return _Reader(path, text.removeprefix("\ufeff"), report).file()
    except _Bad:
        report.raise_if_any()
        raise


class _Reader:
    """One file being read."""

    def __init__(self, path: Path, text: str, report: Report) -> None:
        self._path, self._text, self._report = path, text, report
        self._tokens: list[_Token] = list(self._tokenise())
        self._at = 0

    def _location(self, line: int) -> str:
        return f"{self._path}:{line}"

    def _fail(self, line: int, text: str) -> _Bad:
        self._report.error(self._location(line), text)
        return _Bad()

    # ------------------------------------------------------------------ tokens

    def _tokenise(self) -> Iterator[_Token]:
        """Words, strings and marks; comments are skipped."""
        text, position, line = self._text, 0, 1
        while position < len(text):
            c = text[position]
            if c.isspace():
                line += c == "\n"
                position += 1
            elif text.startswith("//", position):
                position = end if (end := text.find("\n", position)) >= 0 else len(text)
            elif text.startswith("/*", position):
                end = self._comment(position, line)
                line += text.count("\n", position, end)
                position = end
            elif c == '"':
                value, position = self._string(position, line)
                yield _Token(value, "string", line)
            elif c in "{}=;":
                yield _Token(c, "mark", line)
                position += 1
            elif match := _WORD.match(text, position):
                yield _Token(match[0], "word", line)
                position = match.end()
            else:
                raise self._fail(line, f"unexpected character '{c}'; write the value in double quotes")
        yield _Token("", "end", line)

    def _comment(self, start: int, line: int) -> int:
        """End of a block comment; reports what GenOpt cannot read."""
        text = self._text
        end = text.find("*/", start + 2)
        if end < 0:
            raise self._fail(line, "comment without end; add ' */'")
        last = line + text.count("\n", start, end)
        if end > start + 2 and not text[end - 1].isspace():
            self._report.beyond(
                self._location(last),
                "no blank before '*/', with which GenOpt does not end",
                "put a blank before it",
            )
        if "'" in text[start:end]:
            quote = line + text.count("\n", start, text.index("'", start))
            self._report.beyond(
                self._location(quote),
                "apostrophe in a '/* */' comment, with which GenOpt may not end",
                "remove it, or use '//'",
            )
        return end + 2

    def _string(self, start: int, line: int) -> tuple[str, int]:
        """Text of a quoted string and the position after it."""
        text, position, out = self._text, start + 1, []
        while position < len(text) and text[position] not in '"\n':
            if text[position] != "\\":
                out.append(text[position])
                position += 1
                continue
            octal = re.compile(r"\\([0-3]?[0-7]{1,2})").match(text, position)
            if octal:
                out.append(chr(int(octal[1], 8)))
                position = octal.end()
            else:
                c = text[position + 1 : position + 2]
                out.append(_ESCAPES.get(c, c))
                position += 2
        if position >= len(text) or text[position] != '"':
            raise self._fail(line, "string without end on its line; close it with a double quote")
        return "".join(out), position + 1

    # ------------------------------------------------------------------ structure

    def _next(self) -> _Token:
        token = self._tokens[self._at]
        self._at = min(self._at + 1, len(self._tokens) - 1)
        return token

    def file(self) -> Block:
        """The whole file."""
        root = Block("", self._location(1))
        while self._tokens[self._at].kind != "end":
            token = self._next()
            if token.text == "}" and token.kind == "mark":
                raise self._fail(token.line, "closing brace without an opening one; remove it")
            self._item(root, token)
        root.end = self._location(self._tokens[-1].line)
        return root

    def _item(self, parent: Block, name: _Token) -> None:
        """One entry or block."""
        if name.kind == "mark":
            raise self._fail(name.line, f"found '{name.text}', expected a keyword")
        after = self._next()
        if after.text == "=" and after.kind == "mark":
            entry = self._entry(name)
            parent.entries.append(entry)
            parent.order.append(entry)
        elif after.text == "{" and after.kind == "mark":
            block = self._block(name)
            parent.blocks.append(block)
            parent.order.append(block)
        else:
            actual = after.text or "the end of the file"
            raise self._fail(after.line, f"expected '=' or '{{' after '{name.text}', found '{actual}'")

    def _block(self, name: _Token) -> Block:
        """The inside of a block, up to its closing brace."""
        block = Block(name.text, self._location(name.line))
        while True:
            token = self._next()
            if token.kind == "end":
                raise self._fail(
                    token.line, f"'{name.text}' opened in line {name.line} is not closed; add '}}'"
                )
            if token.text == "}" and token.kind == "mark":
                block.end = self._location(token.line)
                return block
            self._item(block, token)

    def _entry(self, key: _Token) -> Entry:
        """A value and its semicolon."""
        value = self._next()
        if value.kind in ("mark", "end"):
            actual = value.text or "the end of the file"
            raise self._fail(value.line, f"'{key.text}' has no value, found '{actual}'; write it in quotes")
        end = self._next()
        if end.text != ";" or end.kind != "mark":
            actual = end.text or "the end of the file"
            raise self._fail(
                end.line,
                f"expected ';' after the value of '{key.text}', found '{actual}'; "
                "a value with blanks needs double quotes",
            )
        text = value.text if value.kind == "string" else normalised(value.text)
        return Entry(key.text, text, value.kind == "string", self._location(key.line), value.text)


def ordered(
    block: Block, keys: Sequence[str], report: Report, *, optional: Sequence[str] = (), repeated: bool = False
) -> dict[str, Entry]:
    """Return the entries of a block by key, checked as by GenOpt: known keys, each once, in order.

    Parameters
    ----------
    block : Block
        The block.
    keys : sequence of str
        All keys that it may have, in order.
    report : Report
        Takes errors.
    optional : sequence of str
        Keys that may be missing.
    repeated : bool
        Whether a key may occur again.

    Returns
    -------
    dict of str to Entry
        The first entry of each known key.
    """
    entries: dict[str, Entry] = {}
    highest = -1
    for entry in block.entries:
        if entry.key not in keys:
            report.error(
                entry.location,
                f"unknown or unexpected keyword '{entry.key}' in '{block.name}'. "
                f"{did_you_mean(entry.key, keys)}".rstrip(),
            )
            continue
        if entry.key in entries and not repeated:
            report.error(entry.location, f"'{entry.key}' is written a second time; remove one")
            continue
        position = keys.index(entry.key)
        if position < highest:
            report.beyond(
                entry.location,
                f"'{entry.key}' comes after '{keys[highest]}'",
                f"GenOpt needs the order {', '.join(keys)}",
            )
        highest = max(highest, position)
        entries.setdefault(entry.key, entry)
    for key in keys:
        if key not in entries and key not in optional:
            report.error(block.end or block.location, f"missing specification of '{key}' in '{block.name}'")
    return entries


def expect_blocks(
    block: Block, names: Sequence[str], report: Report, *, optional: Sequence[str] = ()
) -> dict[str, Block]:
    """Return the blocks inside a block by name, checked for known names in order, each once.

    Parameters
    ----------
    block : Block
        The outer block.
    names : sequence of str
        Names it may have, in order.
    report : Report
        Takes errors.
    optional : sequence of str
        Names that may be missing.

    Returns
    -------
    dict of str to Block
        The blocks.
    """
    blocks: dict[str, Block] = {}
    highest = -1
    for inner in block.blocks:
        if inner.name not in names:
            report.error(
                inner.location,
                f"unknown or unexpected section '{inner.name}'. {did_you_mean(inner.name, names)}".rstrip(),
            )
            continue
        if inner.name in blocks:
            report.error(inner.location, f"section '{inner.name}' is written a second time; remove one")
            continue
        position = names.index(inner.name)
        if position < highest:
            report.beyond(
                inner.location,
                f"section '{inner.name}' comes after '{names[highest]}'",
                f"GenOpt needs the order {', '.join(names)}",
            )
        highest = max(highest, position)
        blocks[inner.name] = inner
    for name in names:
        if name not in blocks and name not in optional:
            report.error(block.end or block.location, f"missing section '{name}'")
    return blocks

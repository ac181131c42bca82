"""Reads the block syntax of GenOpt's files: ``Section { Key = value; ... }``."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from mascarin._io.regular import require_regular
from mascarin.errors import InputError, did_you_mean
from mascarin.genopt.numbers import normalised

_WORD = re.compile(r"[\w.:/\\*%+\-\x80-\U0010ffff]+")
_NUMBER_WITH_EXPONENT = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)[eE][+-]?\d+\Z")
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "b": "\b", "f": "\f", '"': '"', "'": "'", "\\": "\\"}
_MOST_ERRORS = 30


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

    def error(self, place: str, text: str) -> None:
        """Add an error."""
        if len(self.errors) < _MOST_ERRORS:
            self.errors.append(f"{place}: {text}")

    def beyond(self, place: str, text: str, remedy: str) -> None:
        """Add something that GenOpt cannot run: a note when lenient, else an error."""
        if self.lenient:
            self.notes.append(f"{place}: accepted beyond GenOpt: {text}")
        else:
            self.error(place, f"{text}; {remedy} (or accept it with --lenient)")

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
    place : str
        File and line.
    raw : str
        The value as written in the file.
    """

    key: str
    value: str
    quoted: bool
    place: str
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
    place : str
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
    place: str
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

    def _place(self, line: int) -> str:
        return f"{self._path}:{line}"

    def _fail(self, line: int, text: str) -> _Bad:
        self._report.error(self._place(line), text)
        return _Bad()

    # ------------------------------------------------------------------ tokens

    def _tokenise(self) -> Iterator[_Token]:
        """Words, strings and marks; comments are skipped."""
        text, at, line = self._text, 0, 1
        while at < len(text):
            c = text[at]
            if c.isspace():
                line += c == "\n"
                at += 1
            elif text.startswith("//", at):
                at = end if (end := text.find("\n", at)) >= 0 else len(text)
            elif text.startswith("/*", at):
                end = self._comment(at, line)
                line += text.count("\n", at, end)
                at = end
            elif c == '"':
                value, at = self._string(at, line)
                yield _Token(value, "string", line)
            elif c in "{}=;":
                yield _Token(c, "mark", line)
                at += 1
            elif found := _WORD.match(text, at):
                yield _Token(found[0], "word", line)
                at = found.end()
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
                self._place(last),
                "no blank before '*/', with which GenOpt does not end",
                "put a blank before it",
            )
        if "'" in text[start:end]:
            quote = line + text.count("\n", start, text.index("'", start))
            self._report.beyond(
                self._place(quote),
                "apostrophe in a '/* */' comment, with which GenOpt may not end",
                "remove it, or use '//'",
            )
        return end + 2

    def _string(self, start: int, line: int) -> tuple[str, int]:
        """Text of a quoted string and the position after it."""
        text, at, out = self._text, start + 1, []
        while at < len(text) and text[at] not in '"\n':
            if text[at] != "\\":
                out.append(text[at])
                at += 1
                continue
            octal = re.compile(r"\\([0-3]?[0-7]{1,2})").match(text, at)
            if octal:
                out.append(chr(int(octal[1], 8)))
                at = octal.end()
            else:
                c = text[at + 1 : at + 2]
                out.append(_ESCAPES.get(c, c))
                at += 2
        if at >= len(text) or text[at] != '"':
            raise self._fail(line, "string without end on its line; close it with a double quote")
        return "".join(out), at + 1

    # ------------------------------------------------------------------ structure

    def _next(self) -> _Token:
        token = self._tokens[self._at]
        self._at = min(self._at + 1, len(self._tokens) - 1)
        return token

    def file(self) -> Block:
        """The whole file."""
        root = Block("", self._place(1))
        while self._tokens[self._at].kind != "end":
            token = self._next()
            if token.text == "}" and token.kind == "mark":
                raise self._fail(token.line, "closing brace without an opening one; remove it")
            self._item(root, token)
        root.end = self._place(self._tokens[-1].line)
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
            found = after.text or "the end of the file"
            raise self._fail(after.line, f"expected '=' or '{{' after '{name.text}', found '{found}'")

    def _block(self, name: _Token) -> Block:
        """The inside of a block, up to its closing brace."""
        block = Block(name.text, self._place(name.line))
        while True:
            token = self._next()
            if token.kind == "end":
                raise self._fail(
                    token.line, f"'{name.text}' opened in line {name.line} is not closed; add '}}'"
                )
            if token.text == "}" and token.kind == "mark":
                block.end = self._place(token.line)
                return block
            self._item(block, token)

    def _entry(self, key: _Token) -> Entry:
        """A value and its semicolon."""
        value = self._next()
        if value.kind in ("mark", "end"):
            found = value.text or "the end of the file"
            raise self._fail(value.line, f"'{key.text}' has no value, found '{found}'; write it in quotes")
        end = self._next()
        if end.text != ";" or end.kind != "mark":
            found = end.text or "the end of the file"
            raise self._fail(
                end.line,
                f"expected ';' after the value of '{key.text}', found '{found}'; "
                "a value with blanks needs double quotes",
            )
        text = value.text if value.kind == "string" else normalised(value.text)
        return Entry(key.text, text, value.kind == "string", self._place(key.line), value.text)


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
    found: dict[str, Entry] = {}
    highest = -1
    for entry in block.entries:
        if entry.key not in keys:
            report.error(
                entry.place,
                f"unknown or unexpected keyword '{entry.key}' in '{block.name}'. "
                f"{did_you_mean(entry.key, keys)}".rstrip(),
            )
            continue
        if entry.key in found and not repeated:
            report.error(entry.place, f"'{entry.key}' is written a second time; remove one")
            continue
        position = keys.index(entry.key)
        if position < highest:
            report.beyond(
                entry.place,
                f"'{entry.key}' comes after '{keys[highest]}'",
                f"GenOpt needs the order {', '.join(keys)}",
            )
        highest = max(highest, position)
        found.setdefault(entry.key, entry)
    for key in keys:
        if key not in found and key not in optional:
            report.error(block.end or block.place, f"missing specification of '{key}' in '{block.name}'")
    return found


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
    found: dict[str, Block] = {}
    highest = -1
    for inner in block.blocks:
        if inner.name not in names:
            report.error(
                inner.place,
                f"unknown or unexpected section '{inner.name}'. {did_you_mean(inner.name, names)}".rstrip(),
            )
            continue
        if inner.name in found:
            report.error(inner.place, f"section '{inner.name}' is written a second time; remove one")
            continue
        position = names.index(inner.name)
        if position < highest:
            report.beyond(
                inner.place,
                f"section '{inner.name}' comes after '{names[highest]}'",
                f"GenOpt needs the order {', '.join(names)}",
            )
        highest = max(highest, position)
        found[inner.name] = inner
    for name in names:
        if name not in found and name not in optional:
            report.error(block.end or block.place, f"missing section '{name}'")
    return found

"""Layout of a table in a text file: its encoding, separator, decimal mark, and the line with the names."""

from __future__ import annotations

import codecs
import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from mascarin.errors import InputError
from mascarin.tables.encodings import encodings_of
from mascarin.tables.reading.numbers import EMPTY, WITH_CODE
from mascarin.tables.units import parse_unit

_MARKS: Final = (";", "\t", ",", "|")
_SEARCHED: Final = 200
"""Lines from the start of a file in which the header is searched."""
_BLOCK: Final = 3
"""Rows of data in a row that end the search for the header."""
_DIGIT: Final = re.compile(r"[-+]?[.,]?\d")
_COMMA: Final = re.compile(r"[-+]?\d+,\d+(?:[eE][-+]?\d+)?")
_POINT: Final = re.compile(r"[-+]?\d+\.\d+(?:[eE][-+]?\d+)?")
_PLAIN: Final = re.compile(r"[-+]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?")
_THOUSANDS: Final = re.compile(r"[-+]?[1-9]\d{0,2}[.,]\d{3}")
_FORMAT: Final = re.compile(r"(?:yy|dd|mm|hh|ss)[-/.:, tydmhs]+", re.IGNORECASE)
_BRACKETS: Final = re.compile(r"\[.*\]|\(.*\)|<.*>")
_WORDS: Final = frozenset(
    {"ts", "rn", "avg", "ave", "mean", "smp", "min", "max", "tot", "std", "inst", "s", "h", "d", "days"}
    | {"date", "time", "hours", "minutes", "seconds", "-", "1", "m", "cm", "kg", "w/(m2k)", "w/m2k", "mw"}
    | {"ma", "id", "no", "nr", "record", "mj", "mwh"}
)
"""Entries of rows of units that are no unit of `tables.units`, or say how a logger formed its values."""
_UNIT_ROWS: Final = 3
"""Rows of units, of kinds of values and of labels that a header may have at most."""


@dataclass(frozen=True)
class Layout:
    """Where a table is in its file, and how it is written.

    Attributes
    ----------
    separator, decimal : str
        Between entries; the decimal mark.
    header : int
        Number of the line with the names, from 0.
    first : int
        Number of the first line with data, from 0.
    trailing : bool
        The rows end with a separator that the header does not have.
    units : tuple of str
        Entries of the row of units below the names; empty without one.
    evident : bool
        Whether entries can have this decimal mark alone, or the user states it.
    names : tuple of str
        Names that are spread over two lines; empty where they are in the line of the header.
    """

    separator: str
    decimal: str
    header: int
    first: int
    trailing: bool = False
    units: tuple[str, ...] = ()
    evident: bool = False
    names: tuple[str, ...] = ()


def decoded(raw: bytes, where: str) -> tuple[str, str]:
    """Text of a file, and the name of its encoding.

    A byte order mark decides; without one, UTF-16 is recognized by its zero bytes. What is not UTF-8 is
    that of `encodings_of`, or Windows-1252, of which Latin-1 is a part (WHATWG Encoding Standard): degree
    signs and umlauts of loggers.

    Parameters
    ----------
    raw : bytes
        Content of the file.
    where : str
        File name, for the error.

    Raises
    ------
    InputError
        The file is no text.
    """
    guesses = ["utf-8-sig", *encodings_of(raw), "cp1252", "latin-1"]
    if raw[:2] in (b"\xff\xfe", b"\xfe\xff"):
        guesses = ["utf-16"]
    elif len(raw) >= 4:
        head = raw[:400]
        zeros = [head[k::2].count(0) * 2 / len(head) for k in (0, 1)]
        if max(zeros) > 0.4 and min(zeros) < 0.1:
            guesses = ["utf-16-le" if zeros[1] > zeros[0] else "utf-16-be"]
    for name in guesses:
        try:
            # The codec with a mark copies its text piece by piece.
            marked = name == "utf-8-sig" and raw.startswith(codecs.BOM_UTF8)
            text = raw[3 * marked :].decode("utf-8" if name == "utf-8-sig" else name)
        except UnicodeDecodeError:
            continue
        if "\x00" in text:
            break
        return text, name
    raise InputError(
        f"{where}: found bytes that are no text, expected a table as text (CSV) in UTF-8, UTF-16 or "
        "Windows-1252; a spreadsheet must be saved as CSV, and Parquet files end in .parquet."
    )


def find_layout(
    lines: Sequence[str], where: str, separator: str | None, decimal: str | None, skip_lines: int | None
) -> Layout:
    """Find separator, header, row of units and decimal mark.

    Parameters
    ----------
    lines : sequence of str
        Lines of the file.
    where : str
        File name, for errors.
    separator, decimal : str or None
        As stated; None: found.
    skip_lines : int or None
        Lines before the header; None: found.

    Raises
    ------
    InputError
        There is no header, or no separator in it.
    """
    header = skip_lines if skip_lines is not None else _header(lines, where, separator)
    delimiter = separator or _separator(lines, where, header)
    names = cells_of(lines[header], delimiter) if header < len(lines) else []
    units: tuple[str, ...] = ()
    first = header + 1
    while first - header <= _UNIT_ROWS and first < len(lines):
        cells = cells_of(lines[first], delimiter)
        if len(cells) != len(names) or not (_is_units(cells) or _is_labels(cells)):
            break
        units, first = units or (tuple(cells) if _is_units(cells) else ()), first + 1
    sample = [cells_of(line, delimiter) for line in lines[first : first + _SEARCHED] if line.strip()]
    trailing = bool(sample) and all(len(row) == len(names) + 1 and not row[-1].strip() for row in sample)
    mark, evident = (decimal, True) if decimal else _decimal(sample)
    two = _names_of_two_lines(lines, header, delimiter, names)
    return Layout(delimiter, mark, header, first, trailing, units, evident, two)


def _names_of_two_lines(
    lines: Sequence[str], header: int, mark: str, names: Sequence[str]
) -> tuple[str, ...]:
    """Names of WeatherLink, whose first words are in the line above that of date and time."""
    if header == 0 or [name.lower() for name in names[:2]] != ["date", "time"]:
        return ()
    above = cells_of(lines[header - 1], mark)
    if len(above) != len(names) or any(above[:2]) or not any(above):
        return ()
    return tuple(" ".join(pair).strip() for pair in zip(above, names, strict=True))


def _header(lines: Sequence[str], where: str, separator: str | None) -> int:
    """Number of the line with the names of the columns."""
    start = next((k for k, line in enumerate(lines) if line.strip()), 0)
    marks = [separator] if separator else list(_MARKS)
    third = next((line for line in lines[start + 2 : start + 5] if line.strip()), "")
    if any(
        _begins_with_names(lines[start : start + 2], mark) and not _are_names(third, mark) for mark in marks
    ):
        return start
    blocks = [(block[1], -block[0], mark) for mark in marks if (block := _first_block(lines, mark))]
    if not blocks:
        return start
    count, negated_first, mark = max(blocks)
    first = -negated_first
    # Rows above the block that begin with a time are data, too: one of their entries is no number.
    while first > 0 and len(cells := cells_of(lines[first - 1], mark)) == count and _DIGIT.match(cells[0]):
        first -= 1
    header = first - 1
    while header >= 0 and (not lines[header].strip() or _is_units(cells_of(lines[header], mark))):
        header -= 1
    header = _above_labels(lines, header, mark, count)
    header = _below_a_preamble(lines, header, mark, count)
    names = cells_of(lines[header], mark) if header >= 0 else []
    if header < 0 or len(names) not in (count, count - 1):
        above = (
            f"line {header + 1} has {len(names)} of {count} entries"
            if header >= 0
            else "there is no line above it"
        )
        raise InputError(
            f"{where}:{first + 1}: found the first row of data, {lines[first].strip()[:60]!r}, and no names "
            f"of columns above it ({above}); expected a line with the name of each column: add one, or "
            "state skip_lines, the number of lines before the line with the names."
        )
    return header


def _above_labels(lines: Sequence[str], header: int, mark: str, count: int) -> int:
    """Number of the line with the names where a line of labels without one for the time is below them."""
    line_number = header
    while line_number > 0 and _is_labels(cells_of(lines[line_number], mark)):
        line_number -= 1
        while line_number > 0 and _is_units(cells_of(lines[line_number], mark)):
            line_number -= 1
    names = cells_of(lines[line_number], mark) if line_number >= 0 else []
    return line_number if len(names) == count and all(names) else header


def _below_a_preamble(lines: Sequence[str], header: int, mark: str, count: int) -> int:
    """Number of the line with the names where rows of a preamble have as many entries as those of the table.

    Such a preamble, as spreadsheets write it, leaves entries of the line above its rows empty, or begins it
    with a number.
    """
    cells = cells_of(lines[header], mark) if header >= 0 else []
    if len(cells) == count and _are_names(lines[header], mark):
        return header
    for line_number in range(max(header, 0) + 1, min(len(lines), _SEARCHED)):
        if not _are_names(lines[line_number], mark) or len(cells_of(lines[line_number], mark)) != count:
            continue
        rows = [cells_of(line, mark) for line in lines[line_number + 1 : line_number + 2 + _UNIT_ROWS]]
        data = [row for row in rows if row and not _is_units(row)]
        if data and all(len(row) == count and _is_data(row) for row in data):
            return line_number
    return header


def _begins_with_names(lines: Sequence[str], mark: str) -> bool:
    """Whether the first line of a table holds names and the second one data."""
    names, data = (cells_of(line, mark) for line in lines) if len(lines) == 2 else ([], [])
    named = sum(bool(name) for name in names)
    return 1 < len(names) == len(data) and 2 * named > len(names) and not _is_data(names) and _is_data(data)


def _are_names(line: str, mark: str) -> bool:
    """Whether a line below two others has names of columns: the two are a preamble, as that of NSRDB."""
    cells = cells_of(line, mark)
    return (
        len(cells) > 1
        and all(cells)
        and not any(_DIGIT.match(cell) or cell.lower() in EMPTY for cell in cells)
    )


def footer_of(lines: Sequence[str], first: int, separator: str) -> int:
    """Number of the line from which on a file has no data any more but remarks, such as those of PVGIS.

    Parameters
    ----------
    lines : sequence of str
        Lines of the file.
    first : int
        First line with data, from 0.
    separator : str
        Between entries.

    Returns
    -------
    int
        The number of lines where there are no remarks.

    Examples
    --------
    >>> footer_of(["time,T", "2024-01-01,3", "", "T: air temperature"], 1, ",")
    2
    """
    end = len(lines)
    while end > first:
        line = lines[end - 1]
        if line.strip() and (_DIGIT.match(line.strip(" \"'")) or line.count(separator) > 3):
            break
        end -= 1
    blank = end < len(lines) and not lines[end].strip()
    return end if blank and any(line.strip() for line in lines[end:]) else len(lines)


def _first_block(lines: Sequence[str], mark: str) -> tuple[int, int] | None:
    """Number of the first of some rows of data with the same number of entries, and that number."""
    rows = [cells_of(line, mark) for line in lines[:_SEARCHED]]
    for k, cells in enumerate(rows):
        block = rows[k : k + _BLOCK]
        if (
            len(cells) > 1
            and len(block) > 1
            and all(len(row) == len(cells) and _is_data(row) for row in block)
        ):
            return k, len(cells)
    return None


def cells_of(line: str, mark: str) -> list[str]:
    """Entries of a line, without blanks around them.

    Parameters
    ----------
    line : str
        The line.
    mark : str
        Between entries.
    """
    try:
        cells = next(csv.reader([line], delimiter=mark, skipinitialspace=True), [])
    except csv.Error:  # a field of more than 131,072 characters, which is no data
        cells = line.split(mark)
    return [cell.strip() for cell in cells]


def _is_data(cells: Sequence[str]) -> bool:
    """Whether a row holds data: it begins with a time or a number, and most entries are numbers or empty."""
    numbers = [bool(_DIGIT.match(cell)) for cell in cells]
    empty = [cell.lower() in EMPTY for cell in cells]
    return any(numbers[:2]) and sum(n or e for n, e in zip(numbers, empty, strict=True)) > 0.5 * len(cells)


def _is_units(cells: Sequence[str]) -> bool:
    """Whether a row holds units: all its entries are units, in brackets, formats of times, or empty."""
    written = [cell for cell in cells if cell]
    return bool(written) and all(
        cell.lower() in _WORDS or parse_unit(cell) or _BRACKETS.fullmatch(cell) or _FORMAT.match(cell)
        for cell in written
    )


def _is_labels(cells: Sequence[str]) -> bool:
    """Whether a row below the names holds further names: it has none for the time, and no numbers."""
    return not cells[0] and any(cells) and not any(_DIGIT.match(cell) for cell in cells)


def _separator(lines: Sequence[str], where: str, line: int) -> str:
    """The mark that divides the names and the rows below into as many entries."""
    header = lines[line] if line < len(lines) else ""
    below = [text for text in lines[line + 1 : line + 8] if text.strip()]
    fits: dict[str, tuple[int, int]] = {}
    for mark in _MARKS:
        count = len(cells_of(header, mark))
        if count > 1:
            same = sum(len(cells_of(text, mark)) in (count, count + 1) for text in below)
            fits[mark] = (same, header.count(mark))
    words = below[0].split() if below else []
    same = len(below) > 1 and all(len(text.split()) == len(header.split()) for text in below)
    if not fits and same and len(words) > 1 and _PLAIN.fullmatch(words[-1]):
        return " "
    if not fits:
        raise InputError(
            f"{where}:{line + 1}: no separator found in the header {header.strip()[:40]!r}, expected the "
            "names of columns; state separator, or skip_lines if the header is further down."
        )
    return max(fits, key=lambda mark: fits[mark])


def _decimal(rows: Sequence[Sequence[str]]) -> tuple[str, bool]:
    """The decimal mark, and whether entries can have this one alone.

    It is the comma where entries have decimal commas and none has a point that stands before decimals: three
    digits behind a mark may be thousands.
    """
    cells = [cell for row in rows for cell in row if not WITH_CODE.fullmatch(cell)]
    comma = any(_COMMA.fullmatch(cell) for cell in cells)
    evident = {
        mark: any(pattern.fullmatch(cell) and not _THOUSANDS.fullmatch(cell) for cell in cells)
        for mark, pattern in ((",", _COMMA), (".", _POINT))
    }
    if evident[","] and not evident["."]:
        return ",", True
    if evident["."]:
        return ".", not evident[","]
    point = any(_POINT.fullmatch(cell) for cell in cells)
    return ("," if comma and not point else "."), False

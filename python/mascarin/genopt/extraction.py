"""Finds numbers in output files."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final


def lines_of(text: str) -> list[str]:
    """Split a text into lines without their ends.

    Parameters
    ----------
    text : str
        A text whose lines end with a line feed.

    Returns
    -------
    list of str
        The lines.
    """
    lines = text.split("\n")
    return lines[:-1] if lines[-1] == "" else lines


def word_after(lines: Sequence[str], delimiter: str, column: int, separators: str) -> str | None:
    """Return the text of the number after a delimiter.

    The last line with the delimiter counts, and in it the last occurrence, unless a column is given.

    Parameters
    ----------
    lines : sequence of str
        Lines of an output file.
    delimiter : str
        Text in front of the number; empty for the first word of the last line with text.
    column : int
        Column in which the delimiter starts, counted from 1; 0 for any.
    separators : str
        Characters that end a number, besides blanks and tabs.

    Returns
    -------
    str or None
        The text, None when the delimiter is missing.
    """
    if delimiter == "":
        for line in reversed(lines):
            if line.strip(" \t"):
                return _first_word(line, separators)
        return None
    for line in reversed(lines):
        if column > 0:
            if len(line) > column and line.startswith(delimiter, column - 1):
                return _first_word(line[column - 1 + len(delimiter) :], separators)
        elif delimiter in line:
            text = line.rstrip(" \t")
            end = delimiter.rstrip(" \t")
            if end and text.endswith(end):
                text = text[: -len(end)]
            position = text.rfind(delimiter)
            return _first_word(text[position + len(delimiter) :], separators) if position >= 0 else ""
    return None


def count_of(lines: Sequence[str], delimiter: str, column: int) -> int:
    """How often a delimiter stands in an output file.

    Parameters
    ----------
    lines : sequence of str
        Lines of an output file.
    delimiter : str
        Text in front of the number.
    column : int
        Column in which it starts, counted from 1; 0 for any.

    Examples
    --------
    >>> count_of(["cost= 1", "cost= 2; cost= 3"], "cost=", 0), count_of(["5,1", " 5,2"], "5,", 1)
    (3, 1)
    """
    if column > 0:
        return sum(line.startswith(delimiter, column - 1) for line in lines)
    return sum(line.count(delimiter) for line in lines)


#: Whole digits, a comma and digits.
_DECIMAL_COMMA: Final = re.compile(r"[-+]?\d+,\d+(?:[eE][-+]?\d+)?")


def decimal_comma(lines: Sequence[str], delimiter: str, column: int) -> str | None:
    """The number with a decimal comma that seems to stand behind a delimiter.

    Parameters
    ----------
    lines, delimiter, column
        As for `word_after`.

    Returns
    -------
    str or None
        Its text; None where a point, or a list with more commas, shows that the comma is none.

    Examples
    --------
    >>> decimal_comma(["cost= 12,5"], "cost=", 0), decimal_comma(["cost, 12, 5"], "cost,", 0)
    ('12,5', None)
    >>> decimal_comma(["7,12,5,30"], "7,", 1) is None
    True
    """
    word = word_after(lines, delimiter, column, "\n")  # up to a blank
    match = None if word is None else _DECIMAL_COMMA.fullmatch(word.rstrip(";"))
    return None if match is None else match[0]


def _first_word(text: str, separators: str) -> str:
    """Text up to the first blank or separator."""
    return re.split(rf"[ \t{re.escape(separators)}]", text.lstrip(" \t"), maxsplit=1)[0]

"""Dates that begin with a day or a month, such as 13.02.2024 00:15:30, read all at once in long columns."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from mascarin.tables.arrays import Array, Lines
from mascarin.tables.stamps.iso_stamps import Bytes, letters_of

if TYPE_CHECKING:
    import pandas as pd

#: Signs that may stand between the parts: in the date, before the time of day, and in it.
_DATE: Final = b"./-"
_BEFORE_TIME: Final = b" T,"
_TIME: Final = b":."
#: Least and most digits of each part, in order of day or month, the other, year, hour, minute, second.
_DIGITS: Final = ((1, 2), (1, 2), (1, 4), (1, 2), (2, 2), (2, 2))
#: Fewer rows are read one by one.
_LONG: Final = 2000
#: Rows that are worked out together, so that little memory is used beside the result.
_BLOCK: Final = 2**18


class DateParts(NamedTuple):
    """Numbers of which dates consist, in the order in which they are written.

    Attributes
    ----------
    a, b, c : ndarray, shape (n,)
        Day, month and year, in an order that is not known.
    seconds : ndarray, shape (n,)
        Since midnight. [s]
    first_is_year, last_is_year : bool
        Whether all of `a`, and one of `c`, have four digits.
    mark : str
        Between `a` and `b` in the first row.
    """

    a: Lines
    b: Lines
    c: Lines
    seconds: Array
    first_is_year: bool
    last_is_year: bool
    mark: str


def date_parts(text: pd.Series[Any]) -> DateParts | None:
    """The parts of dates that begin with at most two digits, all in the same form.

    Parameters
    ----------
    text : pandas.Series
        As read.

    Returns
    -------
    DateParts or None
        None where the column is short, or a row is of another form or has no such time of day: it is read
        with care then.

    Examples
    --------
    >>> import pandas as pd
    >>> parts = date_parts(pd.Series(["1.12.2023 9:05", "24.12.2023 23:59"] * 1000))
    >>> [int(part[1]) for part in parts[:4]]
    [24, 12, 2023, 86340]
    """
    if len(text) < _LONG or not isinstance(text.iloc[0], str):
        return None
    letters = letters_of(text)
    if letters is None:
        return None
    raw, ends = letters
    first = raw[ends[0] : ends[1]].tobytes()
    half = first[-3:].lower() in (b" am", b" pm")
    signs = bytes(sign for sign in (first[:-3] if half else first) if not 48 <= sign <= 57)
    allowed = (_DATE, _DATE, _BEFORE_TIME, _TIME, _TIME)[: len(signs)]
    if len(signs) not in (2, 4, 5) or not all(s in a for s, a in zip(signs, allowed, strict=True)):
        return None
    columns: list[list[Lines]] = []
    widths = np.zeros((2, len(signs) + 1), dtype=np.int64)
    for row in range(0, len(text), _BLOCK):
        block = _numbers(raw, ends[row : row + _BLOCK + 1], signs, half=half)
        if block is None:
            return None
        columns.append(block[0])
        widths = (
            block[1]
            if not row
            else np.stack([np.minimum(widths[0], block[1][0]), np.maximum(widths[1], block[1][1])])
        )
    numbers = [np.concatenate(parts) for parts in zip(*columns, strict=True)]
    a, b, c, *clock = numbers
    hour, minute, second = (*clock, *[np.zeros_like(a)] * (3 - len(clock)))
    if (hour > 23).any() or (minute > 59).any() or (second > 59).any():
        return None
    seconds = (3600 * hour + 60 * minute + second).astype(np.float64)
    return DateParts(a, b, c, seconds, False, bool(widths[1][2] == 4), chr(signs[0]))


def _numbers(raw: Bytes, ends: Lines, signs: bytes, *, half: bool) -> tuple[list[Lines], Lines] | None:
    """Numbers between the signs of some rows, and least and most digits of each; None for another form."""
    first = int(ends[0])
    letters = raw[first : int(ends[-1])]
    start, end = ends[:-1] - first, ends[1:] - first
    afternoon = np.zeros(len(start), dtype=bool)
    if half:
        if (end - start < 4).any():
            return None
        # Small letters are 32 above the capital ones.
        blank, which, letter = (letters[end - k] | np.uint8(32) for k in (3, 2, 1))
        if (blank != ord(" ")).any() or (letter != ord("m")).any():
            return None
        afternoon = which == ord("p")
        if not (afternoon | (which == ord("a"))).all():
            return None
        letters = letters.copy()
        for k in (3, 2, 1):
            letters[end - k] = ord("0")
        end = end - 3
    digits = letters - np.uint8(ord("0"))  # of what is below "0" a number above 9
    marks = np.flatnonzero(digits > 9)
    if len(marks) != len(signs) * len(start):
        return None
    borders = marks.reshape(len(start), len(signs))
    if (letters[borders] != np.frombuffer(signs, dtype=np.uint8)).any():
        return None
    begins = np.column_stack([start, borders + 1])
    stops = np.column_stack([borders, end])
    # Marks of one row that belong to its neighbour make a part of no digits or too many.
    widths = stops - begins
    limits = np.array(_DIGITS[: widths.shape[1]])
    extremes = np.stack([widths.min(axis=0), widths.max(axis=0)])
    if (extremes[0] < limits[:, 0]).any() or (extremes[1] > limits[:, 1]).any():
        return None
    numbers = []
    for k in range(widths.shape[1]):
        number = np.zeros(len(start), dtype=np.int64)
        for power in range(int(extremes[1, k])):
            digit = digits[np.maximum(stops[:, k] - 1 - power, 0)].astype(np.int64) * 10**power
            number += np.where(widths[:, k] > power, digit, 0)
        numbers.append(number)
    if half and len(numbers) > 3:
        if (numbers[3] > 12).any():
            return None
        numbers[3] = numbers[3] % 12 + 12 * afternoon
    return numbers, extremes

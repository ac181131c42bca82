"""Stamps of one width, such as 2024-09-04 00:15:00, read all at once: long records have millions of them."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import numpy as np

from mascarin.tables.arrays import Lines

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd


Bytes: TypeAlias = "npt.NDArray[np.uint8]"

ISO_TEXT: Final = re.compile(r"\d{4}-\d{2}-\d{2}[T ]\d{2}:\d{2}(?::\d{2}(?:\.\d+)?)?")
"""ISO 8601 without an offset."""
MIDNIGHT: Final = re.compile(r"[T ]00:00(?::00(?:\.0+)?)?$")
"""A time of day that may say nothing: the hour may be in another column."""
#: Places of the marks between the digits, and the marks.
_MARKS: Final = ((4, "-"), (7, "-"), (13, ":"), (16, ":"))
_WIDTHS: Final = (16, 19)
#: Rows that are worked out together, so that little memory is used beside the result.
_BLOCK: Final = 2**18


def iso_stamps(text: pd.Series[Any]) -> npt.NDArray[np.datetime64] | None:
    """Stamps of which each is ISO 8601 to the minute or to the second, without an offset.

    Parameters
    ----------
    text : pandas.Series
        As read.

    Returns
    -------
    ndarray, shape (n,), or None
        Times without a zone; None where one is of another form, or no time of the calendar.

    Examples
    --------
    >>> import pandas as pd
    >>> iso_stamps(pd.Series(["2024-02-29 23:59", "2024-03-01 00:00"]))[0]
    np.datetime64('2024-02-29T23:59:00.000000')
    >>> iso_stamps(pd.Series(["2023-02-29 23:59"])) is None
    True
    """
    letters = _letters(text)
    if letters is None or letters.shape[1] not in _WIDTHS:
        return None
    times = np.empty(len(letters), dtype="datetime64[us]")
    for row in range(0, len(letters), _BLOCK):
        block = _times(letters[row : row + _BLOCK])
        if block is None:
            return None
        times[row : row + _BLOCK] = block
    return times


def _letters(text: pd.Series[Any]) -> Bytes | None:
    """The bytes of texts of one width, shape (n, width); None where widths differ or one is missing."""
    width = len(str(text.iloc[0]))
    letters = letters_of(text)
    if letters is None or not (np.diff(letters[1]) == width).all():
        return None
    return letters[0].reshape(len(text), width)


def letters_of(text: pd.Series[Any]) -> tuple[Bytes, Lines] | None:
    """The bytes of texts one after the other, and where each begins and the last one ends.

    Parameters
    ----------
    text : pandas.Series
        As read.

    Returns
    -------
    (ndarray of uint8, ndarray of int, shape (n + 1,)) or None
        None where one is missing, or no text.

    Examples
    --------
    >>> import pandas as pd
    >>> [part.tolist() for part in letters_of(pd.Series(["1.2", "7"]))]
    [[49, 46, 50, 55], [0, 3, 4]]
    """
    try:
        import pyarrow as pa

        column = pa.array(text.array, type=pa.large_string())
        column = column.combine_chunks() if isinstance(column, pa.ChunkedArray) else column
        if column.null_count or len(column) != len(text):
            return None
        _, ends, content = column.buffers()
        offsets = np.frombuffer(ends, dtype=np.int64)[column.offset : column.offset + len(column) + 1]
        raw = np.frombuffer(content, dtype=np.uint8)[offsets[0] : offsets[-1]]
        return raw, offsets - offsets[0]
    except ImportError:
        entries = text.tolist()
        try:
            joined = "".join(entries)
        except TypeError:  # a missing value is no text
            return None
        if not joined.isascii():
            return None
        ends = np.cumsum([0, *map(len, entries)], dtype=np.int64)
        return np.frombuffer(joined.encode(), dtype=np.uint8), ends
    except (TypeError, ValueError):
        return None


def _times(letters: Bytes) -> npt.NDArray[np.datetime64] | None:
    columns = np.ascontiguousarray(letters.T)  # by place in the text, each a row in memory
    width = len(columns)
    marks = [(position, mark) for position, mark in _MARKS if position < width]
    if any((columns[position] != ord(mark)).any() for position, mark in marks):
        return None
    if ((columns[10] != ord(" ")) & (columns[10] != ord("T"))).any():
        return None
    between = {position for position, _ in marks} | {10}
    digits = columns - np.uint8(ord("0"))  # of what is below "0" a number above 9
    if any((digits[position] > 9).any() for position in range(width) if position not in between):
        return None

    def number(first: int) -> npt.NDArray[np.int32]:
        return np.asarray(digits[first] * np.int32(10) + digits[first + 1], dtype=np.int32)

    hour, minute = number(11), number(14)
    second = number(17) if width > _WIDTHS[0] else np.zeros_like(hour)
    month, day = number(5), number(8)
    if (hour > 23).any() or (minute > 59).any() or (second > 59).any() or (month > 12).any():
        return None
    if (month < 1).any() or (day < 1).any():
        return None
    year = 100 * number(0) + number(2)
    months = ((year - 1970) * 12 + month - 1).astype("datetime64[M]")
    dates = months.astype("datetime64[D]") + (day - 1).astype("timedelta64[D]")
    if (dates.astype("datetime64[M]") != months).any():
        return None
    seconds = 3600 * hour + 60 * minute + second
    return np.asarray(dates.astype("datetime64[us]") + seconds.astype("timedelta64[s]"))

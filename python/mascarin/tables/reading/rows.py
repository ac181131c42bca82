"""Rows of a table: which hold numbers, and which entries are no value."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.tables.arrays import Lines
from mascarin.tables.reading.numbers import EMPTY

if TYPE_CHECKING:
    import pandas as pd


def rows_with_values(
    text: pd.Series[Any], frame: pd.DataFrame, lines: Lines, where: str
) -> tuple[pd.Series[Any], pd.DataFrame, Lines, tuple[str, ...]]:
    """The rows that hold a number; those with words of events alone are left out and counted.

    Parameters
    ----------
    text : pandas.Series
        Stamps.
    frame : pandas.DataFrame
        All other columns.
    lines : ndarray, shape (n,)
        Line of each row.
    where : str
        File, for the note.

    Returns
    -------
    text, frame, lines
        The rows that are used.
    notes : tuple of str
        How many were left out.
    """
    if not frame.columns.is_unique:
        return text, frame, lines, ()
    numeric = [name for name in frame.columns if has_numbers(frame[name]) and not _counts_rows(frame[name])]
    words = [name for name in frame.columns if name not in numeric and frame[name].notna().any()]
    if not numeric or not words:
        return text, frame, lines, ()
    idle = frame[numeric].isna().all(axis=1) & frame[words].notna().any(axis=1)
    if not idle.any() or idle.all():
        return text, frame, lines, ()
    keep = ~idle.to_numpy()
    note = (
        f"{where}: {int(idle.sum())} rows without any number were left out, the first in line "
        f"{lines[int(np.argmax(idle))]}."
    )
    return text[keep], frame[keep], lines[keep], (note,)


def _counts_rows(series: pd.Series[Any]) -> bool:
    """Whether a column counts the rows."""
    import pandas as pd

    is_integer = pd.api.types.is_integer_dtype(series.dtype)
    return is_integer and bool(np.all(np.diff(series.to_numpy(dtype=np.float64)) == 1.0))


def has_numbers(series: pd.Series[Any]) -> bool:
    """Whether a column has entries that begin like a number.

    Parameters
    ----------
    series : pandas.Series
        As read.
    """
    import pandas as pd

    if pd.api.types.is_numeric_dtype(series.dtype):
        return bool(series.notna().any())
    return bool(series.dropna().astype(str).str.match(r"\s*[-+]?[.,]?\d").any())


def without_entries(frame: pd.DataFrame, missing: Sequence[str | float]) -> pd.DataFrame:
    """The table without the entries that the user names as missing.

    Parameters
    ----------
    frame : pandas.DataFrame
        As read.
    missing : sequence of str or float
        Entries that mean that there is no value.
    """
    texts = [str(entry) for entry in missing]
    values: list[Any] = list(missing) + texts
    for text in texts:
        try:
            values.append(float(text))
        except ValueError:
            continue
    return frame.mask(frame.isin(values))


#: A date with a time of day: a second clock beside that of the rows.
_STAMP: Final = r"\s*\d{1,4}[./-]\d{1,2}[./-]\d{1,4}[ T]+\d{1,2}:\d{2}"


def has_words(series: pd.Series[Any]) -> bool:
    """Whether a column has entries, and all of them are words that mean something.

    Parameters
    ----------
    series : pandas.Series
        As read.
    """
    import pandas as pd

    if pd.api.types.is_numeric_dtype(series.dtype):
        return False
    entries = series.dropna()
    if not len(entries):
        return False
    if isinstance(entries.iloc[0], str) and re.match(_STAMP, entries.iloc[0]):
        return bool(entries.astype(str).str.match(_STAMP).all())
    if has_numbers(series):
        return False
    return not bool(entries.astype(str).str.strip().str.lower().isin(EMPTY).all())

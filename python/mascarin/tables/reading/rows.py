"""Rows of a table: which columns hold the stamps, which rows hold numbers, and which entries are no value."""

from __future__ import annotations

import re
from collections.abc import Hashable, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.errors import InputError, did_you_mean
from mascarin.tables.arrays import Lines
from mascarin.tables.reading.numbers import EMPTY
from mascarin.tables.units import parse_unit

if TYPE_CHECKING:
    import pandas as pd

_TIME_NAME: Final = re.compile(r"date|time|zeit|datum|stamp|heure|fecha|hora|\bts\b", re.IGNORECASE)


def time_text(
    frame: pd.DataFrame, time: str | Sequence[str] | None, where: str
) -> tuple[pd.Series[Any], list[Hashable]]:
    """The stamps of a table, several columns joined by a blank, and the names of these columns.

    Parameters
    ----------
    frame : pandas.DataFrame
        As read.
    time : str or sequence of str or None
        Column or columns with the stamps; None: see `_time_names`.
    where : str
        File, for errors.

    Raises
    ------
    InputError
        There is no such column.
    """
    names: list[Hashable]
    names = _time_names(frame) if time is None else [time] if isinstance(time, str) else list(time)
    for name in names:
        if name not in frame.columns:
            hint = did_you_mean(str(name), [str(column) for column in frame.columns])
            raise InputError(
                f"{where}: no time column {name!r}. {hint} Expected the name of a column of the file, or "
                "several in a list."
            )
    if len(names) == 1:
        return frame[names[0]], names
    joined = frame[names[0]].astype(str)
    for name in names[1:]:
        joined = joined + " " + frame[name].astype(str)
    return joined, names


def _time_names(frame: pd.DataFrame) -> list[Hashable]:
    """The column with the stamps: the first one, unless that counts rows and a later one is called so.

    A date beside a column of the time of day is joined with it.
    """
    import pandas as pd

    names = list(frame.columns)
    first = 0
    if pd.api.types.is_integer_dtype(frame[names[0]].dtype) and not _TIME_NAME.search(str(names[0])):
        steps = np.diff(frame[names[0]].to_numpy(dtype=np.float64))
        named = [k for k, name in enumerate(names[:6]) if k and _TIME_NAME.search(str(name))]
        if np.all(steps == 1.0) and named:
            first = named[0]
    if first + 1 < len(names):
        pair = [frame[name].iloc[:50].dropna().astype(str).str.strip() for name in names[first : first + 2]]
        whole = [
            len(part) > 0 and bool(part.str.fullmatch(form).all())
            for part, form in zip(pair, _PAIR, strict=True)
        ]
        if all(whole):
            return list(names[first : first + 2])
    return [names[first]]


_PARTS: Final = ("year", "month", "day", "hour", "minute", "second")


def parts_of_time(frame: pd.DataFrame) -> tuple[list[str], str] | None:
    """Columns of the parts of the time: year, month, day, hour and so on, or year, day of the year and hhmm.

    The first as NSRDB and many models write them, the second as Campbell's older loggers do.

    Parameters
    ----------
    frame : pandas.DataFrame
        As read.

    Returns
    -------
    (list of str, str) or None
        Names of the columns and the format of the joined texts; None where they are not there.

    Examples
    --------
    >>> import pandas as pd
    >>> parts_of_time(pd.DataFrame(columns=["Year", "Month", "Day", "Hour", "Minute", "GHI"]))
    (['Year', 'Month', 'Day', 'Hour', 'Minute'], '%Y %m %d %H %M')
    """
    names = [str(name).strip().lower() for name in frame.columns]
    for k in range(min(3, len(names) - 2)):
        if (
            names[k] in ("year", "yyyy", "year_rtm")
            and names[k + 1] in ("day", "doy", "jday", "julian_day", "day_rtm", "dayofyear")
            and names[k + 2] in ("hhmm", "hrmn", "time", "hour_minute", "hour_minute_rtm")
        ):
            return [str(name) for name in frame.columns[k : k + 3]], "%Y %j %H%M"
    count = next((k for k, part in enumerate(_PARTS) if names[k : k + 1] != [part]), len(_PARTS))
    if count >= 4:
        form = " ".join(["%Y", "%m", "%d", "%H", "%M", "%S"][:count])
        return [str(name) for name in frame.columns[:count]], form
    return None


#: A date without a time, and a time of day.
_PAIR: Final = (
    r"\d{1,4}[./-]\d{1,2}[./-]\d{1,4}",
    r"\d{1,2}:\d{2}(?::\d{2}(?:[.,]\d+)?)?(?:\s*[AaPp]\.?(?:[Mm]\.?)?)?",
)


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

    whole = pd.api.types.is_integer_dtype(series.dtype)
    return whole and bool(np.all(np.diff(series.to_numpy(dtype=np.float64)) == 1.0))


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
#: A number, and what is written behind it.
_WITH_UNIT: Final = r"^\s*([-+\u2212]?\d[\d.,' ]*?)\s*([^\d\s.,'+-].*?)\s*$"


def without_units(frame: pd.DataFrame) -> tuple[pd.DataFrame, dict[str, str]]:
    """Columns whose entries all have the same known unit behind the number, without it.

    Parameters
    ----------
    frame : pandas.DataFrame
        As read.

    Returns
    -------
    frame : pandas.DataFrame
        Numbers as texts, where there were units.
    units : mapping of str to str
        The units, by column.
    """
    import pandas as pd

    units: dict[str, str] = {}
    if not frame.columns.is_unique:
        return frame, units
    columns = {}
    for name in frame.columns:
        if pd.api.types.is_numeric_dtype(frame[name].dtype):
            continue
        entries = frame[name].dropna()
        if not len(entries) or not isinstance(entries.iloc[0], str):
            continue
        first = re.match(_WITH_UNIT, entries.iloc[0])
        if first is None or parse_unit(first[2]) is None:
            continue
        parts = frame[name].astype(str).str.extract(_WITH_UNIT)
        numbers, written = parts[0], parts[1]
        there = numbers.notna()
        empty = frame[name].isna() | frame[name].astype(str).str.strip().str.lower().isin(EMPTY)
        if (there | empty).all() and (written[there] == first[2]).all():
            columns[name], units[str(name)] = numbers, first[2]
    if not columns:
        return frame, units
    return frame.assign(**{str(name): column for name, column in columns.items()}), units


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

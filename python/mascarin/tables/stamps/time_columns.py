"""Which columns of a table hold the stamps."""

from __future__ import annotations

import re
from collections.abc import Hashable, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.errors import InputError, did_you_mean

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
    if time is None and _has_days(frame):
        return _of_days(frame), list(frame.columns[:2])
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
    if time is None and _is_hours(frame, names[1]):
        return _with_hours(frame, names), names
    joined = _texts(frame[names[0]]).str.replace(_NO_TIME, "", regex=True)
    for name in names[1:]:
        joined = joined + " " + _texts(frame[name])
    return joined, names


def _texts(series: pd.Series[Any]) -> pd.Series[Any]:
    return series.astype(str).where(series.notna(), "")


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
    if first == 0 and not _can_be_times(frame[names[0]]):
        first = next((k for k in range(1, min(len(names), 8)) if _are_dates(frame[names[k]])), 0)
    if _has_times_of_day(frame[names[first]]):
        return [names[first]]
    if first + 1 < len(names):
        pair = [frame[name].iloc[:50].dropna().astype(str).str.strip() for name in names[first : first + 2]]
        matches = [
            len(part) > 0 and bool(part.str.fullmatch(form).all())
            for part, form in zip(pair, _PAIR, strict=True)
        ]
        if all(matches) or (_are_days(frame[names[first]]) and _is_hours(frame, names[first + 1])):
            return list(names[first : first + 2])
    return [names[first]]


#: Dates of which a column of texts, or one of digits, consists.
_A_DATE: Final = r"(?:\d{4}[./-]\d{1,2}[./-]\d{1,2}|\d{1,2}[./-]\d{1,2}[./-]\d{2,4})(?:[T ,].*)?"
_DIGITS_OF_DATE: Final = r"(?:19|20)\d{2}(?:0[1-9]|1[0-2])(?:[0-2]\d|3[01])(?:[0-2]\d(?:[0-5]\d){0,2})?"
#: A time of day that says nothing: the hour is in another column.
_MIDNIGHT: Final = r"[T ,]+00:00(?::00(?:\.0+)?)?(?:Z|[+-]\d{2}:?\d{2})?$"
_HOUR_NAME: Final = re.compile(r"h|hh|hr|hour|hours|hod|stunde|heure|hora|uur", re.IGNORECASE)


def _sample(series: pd.Series[Any]) -> pd.Series[Any]:
    return series.iloc[:50].dropna().astype(str).str.strip().str.removesuffix(".0")


def _can_be_times(series: pd.Series[Any]) -> bool:
    """Whether a first column can hold the stamps: it is not constant, and its entries have digits."""
    import pandas as pd

    if pd.api.types.is_datetime64_any_dtype(series.dtype):
        return True
    sample = _sample(series)
    return bool(len(set(sample)) > 1 or _are_dates(series)) and bool(sample.str.contains(r"\d").all())


def _has_times_of_day(series: pd.Series[Any]) -> bool:
    """Whether a column holds times that are not all midnight."""
    import pandas as pd

    if not pd.api.types.is_datetime64_any_dtype(series.dtype):
        return False
    times = series.dropna()
    return bool((times != times.dt.normalize()).any())


def _are_dates(series: pd.Series[Any]) -> bool:
    """Whether all entries of a column are dates, with or without a time of day."""
    sample = _sample(series)
    return len(sample) > 0 and any(
        bool(sample.str.fullmatch(form).all()) for form in (_A_DATE, _DIGITS_OF_DATE)
    )


def _are_days(series: pd.Series[Any]) -> bool:
    """Whether all entries of a column are dates without a time of day, or with midnight."""
    days = _sample(series).str.replace(_MIDNIGHT, "", regex=True)
    return len(days) > 0 and any(
        bool(days.str.fullmatch(form).all())
        for form in (
            _A_DATE.removesuffix("(?:[T ,].*)?"),
            r"(?:19|20)\d{2}(?:0[1-9]|1[0-2])(?:[0-2]\d|3[01])",
        )
    )


def _is_hours(frame: pd.DataFrame, name: Hashable) -> bool:
    """Whether a column beside a date has its hours, 0 to 23 or 1 to 24."""
    import pandas as pd

    if not _HOUR_NAME.fullmatch(str(name).strip()) or not pd.api.types.is_numeric_dtype(frame[name].dtype):
        return False
    hours = frame[name].to_numpy(dtype=np.float64)
    return bool(np.all((hours >= 0.0) & (hours <= 24.0) & (hours == np.floor(hours))))


def _has_days(frame: pd.DataFrame) -> bool:
    """Whether the first two columns are a year and a day of it with a fraction, such as 194.5."""
    import pandas as pd

    names = [str(name).strip().lower() for name in frame.columns[:2]]
    if len(names) < 2 or names[0] not in _YEAR_NAMES or names[1] not in _DAY_NAMES:
        return False
    if not all(pd.api.types.is_numeric_dtype(frame[name].dtype) for name in frame.columns[:2]):
        return False
    year, day = (frame[name].to_numpy(dtype=np.float64) for name in frame.columns[:2])
    return bool(
        np.all((year == np.floor(year)) & (year > 1900.0) & (year < 2100.0) & (day >= 1.0) & (day < 367.0))
        and np.any(day != np.floor(day))
    )


def _of_days(frame: pd.DataFrame) -> pd.Series[Any]:
    """Stamps of years and days with a fraction, to the second: five decimals of a day are 0.9 s."""
    import pandas as pd

    year, day = (frame[name].to_numpy(dtype=np.float64) for name in frame.columns[:2])
    first = (year - 1970.0).astype(np.int64).astype("datetime64[Y]").astype("datetime64[s]")
    seconds = np.round((day - 1.0) * 86400.0).astype(np.int64)
    full_minutes = 60 * np.round(seconds / 60.0).astype(np.int64)
    seconds = full_minutes if np.all(np.abs(seconds - full_minutes) <= 1) else seconds
    return pd.Series(first + seconds.astype("timedelta64[s]"), index=frame.index)


def _with_hours(frame: pd.DataFrame, names: Sequence[Hashable]) -> pd.Series[Any]:
    """Dates and hours as one text, or as digits."""
    import pandas as pd

    dates, hours = frame[names[0]], frame[names[1]].astype("int64")
    if pd.api.types.is_numeric_dtype(dates.dtype):
        return dates.astype("int64") * 100 + hours
    return dates.astype(str).str.strip() + " " + hours.astype(str).str.zfill(2) + ":00"


_YEAR_NAMES: Final = ("year", "yyyy", "year_rtm")
_DAY_NAMES: Final = ("day", "doy", "jday", "julian_day", "day_rtm", "dayofyear", "decimal_day")
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
            names[k] in _YEAR_NAMES
            and names[k + 1] in _DAY_NAMES
            and names[k + 2] in ("hhmm", "hrmn", "time", "hour_minute", "hour_minute_rtm")
        ):
            return [str(name) for name in frame.columns[k : k + 3]], "%Y %j %H%M"
    count = next((k for k, part in enumerate(_PARTS) if names[k : k + 1] != [part]), len(_PARTS))
    if count >= 4:
        form = " ".join(["%Y", "%m", "%d", "%H", "%M", "%S"][:count])
        return [str(name) for name in frame.columns[:count]], form
    return None


_NO_TIME: Final = r" 00:00(?::00)?$"
#: A date without a time, and a time of day.
_PAIR: Final = (
    r"\d{1,4}[./-]\d{1,2}[./-]\d{1,4}(?: 00:00(?::00)?)?",  # a date cell of a spreadsheet has a time, too
    r"\d{1,2}:\d{2}(?::\d{2}(?:[.,]\d+)?)?(?:\s*[AaPp]\.?\s?(?:[Mm]\.?)?)?",
)

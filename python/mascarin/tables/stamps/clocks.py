"""Stamps as loggers and spreadsheets write them: dates in any order, 12-hour clocks, numbers, 24:00."""

from __future__ import annotations

import re
from datetime import datetime, tzinfo
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from mascarin.errors import InputError
from mascarin.tables.arrays import Array, Flags, Lines
from mascarin.tables.stamps.digit_groups import DateParts, date_parts
from mascarin.tables.stamps.formats import DATE, FORMATS, written_format
from mascarin.tables.stamps.iso_stamps import ISO_TEXT, iso_stamps
from mascarin.tables.stamps.months import with_numbers_of_months
from mascarin.tables.timezones import YEARS, localize, zone_name

if TYPE_CHECKING:
    import pandas as pd

# Texts of plain classes, not compiled: pandas searches them in columns without a loop in Python.
_HAS_OFFSET: Final = r"[0-9]{1,2}:[0-9]{2}(?::[0-9]{2}(?:[.][0-9]+)?)? *(?:Z|[+-][0-9]{2}:?[0-9]{2})$"
_MIDNIGHT: Final = r"[T ]24:00(?::00)?$"
_MIDNIGHT_OF_DIGITS: Final = r" 2400$"
_BLANKS: Final = "  |\t|\u00a0"
#: Formats with names of months, in English, that are tried in turn.
_NAMED: Final = (
    "%Y%m%d:%H%M",
    "%d-%b-%Y %H:%M:%S", "%d-%b-%Y %H:%M", "%d-%b-%y %H:%M:%S", "%d-%b-%y %H:%M", "%d %b %Y %H:%M:%S",
    "%d %b %Y %H:%M", "%b %d %Y %H:%M:%S", "%b %d, %Y %I:%M:%S %p", "%a %b %d %H:%M:%S %Y",
)  # fmt: skip
#: Part of the steps that are equal where a record is regular.
_REGULAR: Final = 0.8
_DAY: Final = 86400.0
#: Numbers from 1973 to 2103 in each unit, and the unit. [s]
_SINCE_1970: Final = (
    (1e8, 4.2e9, 1.0, "seconds"), (1e11, 4.2e12, 1e-3, "milliseconds"), (1e14, 4.2e15, 1e-6, "microseconds"),
    (1e17, 4.2e18, 1e-9, "nanoseconds"),
)  # fmt: skip
#: Days from 1899-12-30, from which spreadsheets count, to 1970-01-01.
_SPREADSHEET: Final = 25569.0
_SPREADSHEET_SAID: Final = (
    "stamps such as {:g} are days of a spreadsheet since 1899-12-30; those of a workbook with dates since "
    "1904 are 1462 days later: see the year."
)
_ISO: Final = "ISO 8601 such as 2024-09-04 00:15"


class Stamped(NamedTuple):
    """Stamps in their zone, and what was done to read them.

    Attributes
    ----------
    times : pandas.DatetimeIndex
        With a time zone.
    notes : tuple of str
        Sentences, without the name of the file.
    """

    times: pd.DatetimeIndex
    notes: tuple[str, ...] = ()


def stamps_from(
    text: pd.Series[Any], time_format: str | None, zone: tzinfo, clock: tzinfo, lines: Lines, where: str
) -> Stamped:
    """Stamps of a column of times.

    Parameters
    ----------
    text : pandas.Series
        As read: texts, numbers or times.
    time_format : str or None
        strptime format; None: ISO 8601, else what all stamps together allow.
    zone : datetime.tzinfo
        Zone of the result.
    clock : datetime.tzinfo
        Zone of stamps without an offset.
    lines : ndarray, shape (n,)
        Line of each row.
    where : str
        File, for errors.

    Raises
    ------
    InputError
        A stamp cannot be read, or two readings are possible.
    """
    import pandas as pd

    if isinstance(text.dtype, pd.DatetimeTZDtype):
        return Stamped(pd.DatetimeIndex(text).tz_convert(zone))
    if pd.api.types.is_datetime64_any_dtype(text.dtype):
        return _local(pd.DatetimeIndex(text), clock, zone, lines, where)
    if time_format is None and pd.api.types.is_numeric_dtype(text.dtype) and not text.isna().any():
        return _of_numbers(text, zone, clock, lines, where)
    if time_format is None and (plain := _plain_iso(text)) is not None:
        return _local(plain, clock, zone, lines, where)
    if time_format is None and (dates := date_parts(text)) is not None:
        ordered = _in_order(dates, str(text.iloc[0]), lines, where)
        if ordered is not None:
            stamped = _local(ordered[0], clock, zone, lines, where)
            return Stamped(stamped.times, (*ordered[1], *stamped.notes))
    written = with_numbers_of_months(text.astype(str).str.strip())
    if written.str.contains(_BLANKS).any():
        written = written.str.replace(r"\s+", " ", regex=True)
    offset = bool(written.str.contains(_HAS_OFFSET).any())
    written, late = _without_midnight(written, time_format)
    parsed = _parsed(written, time_format, offset, f"{where}:{lines[0]}")
    bad = np.flatnonzero(parsed.isna().to_numpy() | text.isna().to_numpy())
    notes: tuple[str, ...] = ()
    if len(bad) and time_format is None and not offset:
        other = _of_dates(written, lines, where)
        if other is not None:
            parsed, notes, bad = pd.Series(other[0]), other[1], np.zeros(0, np.int64)
    if len(bad):
        raise InputError(_unreadable(written, bad, time_format, lines, where))
    index = pd.DatetimeIndex(parsed) + pd.to_timedelta(late.astype(np.int64), unit="D")
    if time_format is not None and not offset:
        _require_likely_order(index, time_format, lines, where)
    if offset:
        return Stamped(possible(index, lines, where).tz_convert(zone), notes)
    stamped = _local(index, clock, zone, lines, where)
    return Stamped(stamped.times, (*notes, *stamped.notes))


def _unreadable(
    written: pd.Series[str], bad: Lines, time_format: str | None, lines: Lines, where: str
) -> str:
    """Text of the refusal of stamps: among many dates in one form, the row that is none is the cause."""
    row = int(bad[0])
    undated_rows = np.flatnonzero(written.str.extract(DATE)["a"].isna().to_numpy())
    if 0 < len(undated_rows) < 0.1 * len(written) and time_format is None:
        row = int(undated_rows[0])
    expected = f"the format {time_format!r}" if time_format else _ISO
    entry = str(written.iloc[row])
    remedy = "state time_format (for example '%d/%m/%Y %H:%M'), or repair the row."
    if row and not any(sign.isdigit() for sign in entry):
        remedy = "remove this row; where a second table begins with it, write that one as a file of its own."
    return f"{where}:{lines[row]}: time {entry!r} cannot be read, expected {expected}; {remedy}"


def _plain_iso(text: pd.Series[Any]) -> pd.DatetimeIndex | None:
    """Stamps all of which are ISO 8601 without an offset, read at once; None where one is not."""
    import pandas as pd

    if not len(text) or not isinstance(text.iloc[0], str) or not ISO_TEXT.fullmatch(text.iloc[0]):
        return None
    if (times := iso_stamps(text)) is not None:
        return pd.DatetimeIndex(times)
    try:
        index = pd.DatetimeIndex(pd.to_datetime(text, format="ISO8601"))
    except (ValueError, TypeError):  # an offset, 24:00, another order: read with care
        return None
    return None if index.tz is not None or index.hasnans else index


def _without_midnight(written: pd.Series[str], time_format: str | None) -> tuple[pd.Series[str], Flags]:
    """24:00 and 2400 become 00:00 of the next day; hours as digits get their zeros."""
    late = written.str.contains(_MIDNIGHT).to_numpy(dtype=bool)
    if late.any():
        written = written.where(~late, written.str.replace("24:00", "00:00", n=1, regex=False))
    if time_format is not None and time_format.endswith(" %H%M"):
        parts = written.str.rsplit(" ", n=1, expand=True)
        if parts.shape[1] == 2:
            written = parts[0] + " " + parts[1].str.zfill(4)
        midnight = written.str.contains(_MIDNIGHT_OF_DIGITS).to_numpy(dtype=bool)
        written = written.where(~midnight, written.str.replace(_MIDNIGHT_OF_DIGITS, " 0000", regex=True))
        late = late | midnight
    return written, late


def _parsed(written: pd.Series[str], time_format: str | None, offset: bool, where: str) -> pd.Series[Any]:
    import pandas as pd

    try:
        return pd.to_datetime(written, format=time_format or "ISO8601", errors="coerce", utc=offset)
    except ValueError as error:
        raise InputError(
            f"{where}: time_format: found {time_format!r}, which strptime does not know ({error}); expected "
            "a format such as '%d/%m/%Y %H:%M'. Leave it out where the stamps are seconds since 1970 or "
            "numbers of a spreadsheet: they are recognized."
        ) from None


def _local(index: pd.DatetimeIndex, clock: tzinfo, zone: tzinfo, lines: Lines, where: str) -> Stamped:
    return Stamped(localize(possible(index, lines, where), clock, where).tz_convert(zone))


def possible(index: pd.DatetimeIndex, lines: Lines, where: str) -> pd.DatetimeIndex:
    """Refuse years of which there are no measurements: the calendar of the computer does not reach them.

    Parameters
    ----------
    index : pandas.DatetimeIndex
        Stamps.
    lines : ndarray, shape (n,)
        Their lines.
    where : str
        File, for errors.

    Raises
    ------
    InputError
        A year is not possible.
    """
    years = index.year.to_numpy()
    bad = np.flatnonzero((years < YEARS[0]) | (years > YEARS[1]))
    if len(bad):
        row = int(bad[0])
        raise InputError(
            f"{where}:{lines[row]}: found a time in the year {years[row]}, expected one from {YEARS[0]} to "
            f"{YEARS[1]} ({len(bad)} such rows in all); repair the row."
        )
    return index


# ---------------------------------------------------------------------- numbers


def _of_numbers(text: pd.Series[Any], zone: tzinfo, clock: tzinfo, lines: Lines, where: str) -> Stamped:
    """Stamps as numbers: digits of a date, seconds or milliseconds since 1970, days of a spreadsheet."""
    import pandas as pd

    values = text.to_numpy(dtype=np.float64)
    digits = _of_digits(values)
    if digits is not None:
        stamped = _local(pd.DatetimeIndex(digits), clock, zone, lines, where)
        return Stamped(stamped.times, (f"stamps such as {values[0]:.0f} are digits of date and time.",))
    for low, high, unit, name in _SINCE_1970:
        if low <= values.min() and values.max() <= high:
            seconds = np.round(values * unit * 1e3).astype(np.int64)
            index = pd.DatetimeIndex(seconds.astype("datetime64[ms]")).tz_localize("UTC").tz_convert(zone)
            return Stamped(index, (f"stamps such as {values[0]:.0f} are {name} since 1970-01-01 UTC.",))
    if values.min() >= 20000.0 and values.max() <= 80000.0:
        # A day with eight decimals is read to the millisecond; clocks of loggers have whole seconds.
        seconds = np.round((values - _SPREADSHEET) * _DAY).astype(np.int64)
        stamped = _local(pd.DatetimeIndex(seconds.astype("datetime64[s]")), clock, zone, lines, where)
        return Stamped(stamped.times, (_SPREADSHEET_SAID.format(values[0]),))
    raise InputError(
        f"{where}:{lines[0]}: time {text.iloc[0]} cannot be read, expected {_ISO}, seconds or milliseconds "
        "since 1970, days of a spreadsheet, or digits such as 202409040015; state the column of the times "
        "(time: NAME, or time: [YEAR, DAY, HHMM] with time_format '%Y %j %H%M')."
    )


def _of_digits(values: Array) -> Any:
    """Dates written as YYYYMMDD, with hours, minutes and seconds; None where they are none."""
    if np.any(values != np.floor(values)) or values.min() < 1.8e7:
        return None
    width = len(f"{values[0]:.0f}")
    if width not in (8, 10, 12, 14) or len(f"{values[-1]:.0f}") != width:
        return None
    leading_digits = values.astype(np.int64)
    parts: list[Lines] = []
    for _ in range((width - 8) // 2):
        parts.insert(0, leading_digits % 100)
        leading_digits //= 100
    parts = [
        leading_digits // 10000,
        leading_digits // 100 % 100,
        leading_digits % 100,
        *parts,
        *[np.zeros_like(leading_digits)] * ((14 - width) // 2),
    ]
    year, month, day, hour, minute, second = parts
    if (
        np.any((year < 1900) | (year > 2200) | (month < 1) | (month > 12) | (day < 1) | (day > 31))
        or np.any((hour > 24) | (minute > 59) | (second > 59))
    ):  # fmt: skip
        return None
    return _times(year, month, day, 3600.0 * hour + 60.0 * minute + second)


def _times(year: Lines, month: Lines, day: Lines, seconds: Array) -> Any:
    """Times of their parts; None where a date is not in the calendar."""
    months = (year - 1970) * 12 + month - 1
    first = months.astype("datetime64[M]").astype("datetime64[D]")
    date = first + (day - 1).astype("timedelta64[D]")
    if np.any(date.astype("datetime64[M]") != months.astype("datetime64[M]")):
        return None
    return date.astype("datetime64[ms]") + np.round(seconds * 1e3).astype("timedelta64[ms]")


# ---------------------------------------------------------------------- dates in any order


def _of_dates(
    written: pd.Series[str], lines: Lines, where: str
) -> tuple[pd.DatetimeIndex, tuple[str, ...]] | None:
    """Stamps whose order of day, month and year follows from all of them; None where they are no dates."""
    parts = written.str.extract(DATE)
    if parts["a"].isna().any():
        return _with_names(written)
    a, b, c = (parts[name].to_numpy(dtype=np.int64) for name in "abc")
    hour = parts["hour"].fillna("0").to_numpy(dtype=np.int64)
    minute = parts["minute"].fillna("0").to_numpy(dtype=np.int64)
    second = parts["second"].fillna("0").str.replace(",", ".").to_numpy(dtype=np.float64)
    half = parts["half"].str.lower()
    if np.any((hour > 24) | (minute > 59) | (second >= 60.0)) or (half.notna().any() and np.any(hour > 12)):
        return None
    if half.notna().any():
        hour = hour % 12 + 12 * (half == "p").to_numpy(dtype=np.int64)
    seconds = 3600.0 * hour + 60.0 * minute + second
    first_is_year = bool((parts["a"].str.len() == 4).all())
    last_is_year = bool((parts["c"].str.len() == 4).any())
    dates = DateParts(a, b, c, seconds, first_is_year, last_is_year, str(parts["mark"].iloc[0]))
    return _in_order(dates, str(written.iloc[0]), lines, where)


def _in_order(
    dates: DateParts, example: str, lines: Lines, where: str
) -> tuple[pd.DatetimeIndex, tuple[str, ...]] | None:
    """Stamps of dates in the order of day, month and year that gives regular times; None for no order."""
    import pandas as pd

    a, b, c, seconds, first_is_year, last_is_year, mark = dates
    orders = {"ymd": (a, b, c), "dmy": (c, b, a), "mdy": (c, a, b)}
    index_of_order = {}
    for name, (year, month, day) in orders.items():
        if first_is_year != (name == "ymd") and (first_is_year or last_is_year):
            continue
        full = year + np.where(year < 100, np.where(year < 70, 2000, 1900), 0)
        if month.min() < 1 or month.max() > 12 or day.min() < 1 or day.max() > 31:
            continue
        times = _times(full, month, day, seconds)
        if times is not None:
            index_of_order[name] = pd.DatetimeIndex(times)
    if not index_of_order:
        return None
    shares = {name: _share(index) for name, index in index_of_order.items()}
    best = max(shares, key=lambda name: shares[name])
    rivals = [name for name in shares if name != best and shares[name] >= _REGULAR]
    rivals = [name for name in rivals if not index_of_order[name].equals(index_of_order[best])]
    if "dmy" in (best, *rivals) and mark == ".":
        best, rivals = "dmy", []  # points stand between day, month and year alone (DIN 5008)
    if rivals:
        names = [best, *rivals]
        readings = " or ".join(
            f"{index_of_order[name][0]:%Y-%m-%d %H:%M} ({FORMATS[name]})" for name in names
        )
        formats = " or ".join(repr(written_format(example, name)) for name in names)
        count = "both" if len(names) == 2 else "all of them"
        raise InputError(
            f"{where}:{lines[0]}: time {example!r} can be {readings}, and {count} give regular "
            f"times; expected one reading: state time_format: {formats}."
        )
    words = {"ymd": "year, month, day", "dmy": "day, month, year", "mdy": "month, day, year"}[best]
    return index_of_order[best], (f"stamps such as {example!r} are {words}, by the regular times of all.",)


def _with_names(written: pd.Series[str]) -> tuple[pd.DatetimeIndex, tuple[str, ...]] | None:
    import pandas as pd

    for name in _NAMED:
        parsed = pd.to_datetime(written.iloc[:5], format=name, errors="coerce")
        if not parsed.isna().any():
            stamps = pd.to_datetime(written, format=name, errors="coerce")
            if not stamps.isna().any():
                return pd.DatetimeIndex(stamps), (f"stamps are read as {name!r}.",)
    return None


def _share(index: pd.DatetimeIndex) -> float:
    """Part of the steps that are the commonest one; of steps backwards there must be none."""
    steps = np.diff(index.to_numpy().astype("datetime64[ms]").astype(np.int64))
    if not len(steps):
        return 1.0
    lengths, counts = np.unique(steps, return_counts=True)
    back = float(np.mean(steps < -3_700_000))
    # Days that are a month apart are fewer than the steps of a day: their share weighs as much.
    jumps = float(np.mean(steps > 20 * 86_400_000))
    return float(counts[np.argmax(counts)] / len(steps)) if not back and not jumps else 0.0 * lengths[0]


def _require_likely_order(index: pd.DatetimeIndex, time_format: str, lines: Lines, where: str) -> None:
    """Refuse a stated order of day and month where the other one, and it alone, gives regular times."""
    if not {"%d", "%m"} <= set(re.findall("%.", time_format)) or len(index) < 3:
        return
    day, month = index.day.to_numpy(), index.month.to_numpy()
    if day.max() > 12 or np.array_equal(day, month):
        return
    within = (index - index.normalize()).total_seconds().to_numpy()
    other = _times(
        index.year.to_numpy().astype(np.int64), day.astype(np.int64), month.astype(np.int64), within
    )
    if other is None:
        return
    steps = [np.diff(times.astype("datetime64[s]").astype(np.int64)) for times in (index.to_numpy(), other)]
    mine, theirs = (len(np.unique(gaps)) for gaps in steps)
    if theirs == 1 and mine > 1 and steps[1][0] > 0:
        swapped = time_format.replace("%d", "%0").replace("%m", "%d").replace("%0", "%m")
        row = int(np.argmax(steps[0] != steps[1])) + 1
        raise InputError(
            f"{where}:{lines[row]}: with time_format {time_format!r} the time after "
            f"{index[row - 1]:%Y-%m-%d %H:%M} is {index[row]:%Y-%m-%d %H:%M}; expected one "
            f"step: with day and month exchanged all steps are {steps[1][0]} s. "
            f"State time_format: {swapped!r}, or "
            "repair the stamps."
        )


# ---------------------------------------------------------------------- zones in names, jitter

_ZONE: Final = re.compile(r"\b(?:GMT|UTC)\s*(?P<sign>[-+−])\s*(?P<hours>\d{1,2})(?::?(?P<minutes>\d{2}))?\b")


_PLAIN_ZONE: Final = re.compile(r"(?:^|[\s,(\[_])(?:GMT|UTC)\s*[)\]]?\s*$", re.IGNORECASE)


def offset_in_name(name: str) -> float | None:
    """Offset of the clock that the name of a column states.

    Parameters
    ----------
    name : str
        Name of the column of times.

    Returns
    -------
    float or None
        East of Greenwich [h].

    Examples
    --------
    >>> offset_in_name("Date Time, GMT-05:00"), offset_in_name("time(UTC)"), offset_in_name("Date Time")
    (-5.0, 0.0, None)
    """
    match = _ZONE.search(name)
    if match is None:
        return 0.0 if _PLAIN_ZONE.search(name) else None
    hours = int(match["hours"]) + int(match["minutes"] or 0) / 60.0
    if hours > 14.0:
        return None
    return -hours if match["sign"] != "+" else hours


def require_zone_has(zone: tzinfo, hours: float, years: tuple[int, int], name: str, where: str) -> None:
    """Refuse a zone of the user in which the clock of the file never goes.

    Parameters
    ----------
    zone : datetime.tzinfo
        Stated by the user.
    hours : float
        Offset that the file states [h].
    years : (int, int)
        First and last year of the record.
    name : str
        Where the offset is stated, in words.
    where : str
        File, for errors.

    Raises
    ------
    InputError
        The zone never has this offset in these years.
    """
    offsets = [
        datetime(year, month, 1, 12, tzinfo=zone).utcoffset() for year in years for month in range(1, 13)
    ]
    if all(offset is None or abs(offset.total_seconds() / 3600.0 - hours) > 1e-6 for offset in offsets):
        sign = "+" if hours >= 0.0 else "-"
        stated = f"UTC{sign}{int(abs(hours))}" + (f":{round(abs(hours) % 1 * 60):02d}" if hours % 1 else "")
        raise InputError(
            f"{where}: found the timezone {zone_name(zone)}, but {name} says "
            f"{stated}, which that zone never has; expected one of them. Write timezone: {stated}, or a zone "
            "of the place with that offset; correct the name in the file where it is wrong."
        )


def on_grid(seconds: Array, interval: float, tolerance: float) -> tuple[Array, float] | None:
    """Stamps with a jitter of the clock, moved to a regular grid.

    Parameters
    ----------
    seconds : ndarray, shape (n,)
        Stamps [s].
    interval : float
        Step of the grid [s].
    tolerance : float
        Largest shift [s].

    Returns
    -------
    seconds : ndarray, shape (n,)
        On the grid [s].
    largest : float
        Largest shift [s]. The result is None where one exceeds the tolerance, or two stamps meet.
    """
    # The grid starts where most stamps do: the middle of their phases, on a whole second.
    turns = np.exp(2j * np.pi * (seconds - seconds[0]) / interval)
    phase = float(np.round(np.angle(np.mean(turns)) / (2.0 * np.pi) * interval))
    start = seconds[0] + phase
    moved = start + interval * np.round((seconds - start) / interval)
    largest = float(np.max(np.abs(moved - seconds)))
    if largest > tolerance or np.any(np.diff(moved) <= 0.0):
        return None
    return moved, largest

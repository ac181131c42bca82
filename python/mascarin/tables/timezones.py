"""Time zones: fixed offsets and IANA names; local stamps that do not exist or exist twice."""

from __future__ import annotations

import contextlib
import re
from datetime import UTC, datetime, timedelta, timezone, tzinfo
from typing import TYPE_CHECKING, Final
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError, available_timezones

from mascarin.errors import InputError, did_you_mean

if TYPE_CHECKING:
    import pandas as pd

_OFFSET = re.compile(r"^(?:UTC|GMT)?\s*([+-])(\d{1,2})(?::?([0-5]\d))?$", re.IGNORECASE)
_EXPECTED_ZONE = (
    "expected an IANA name such as 'Europe/Paris' or 'Indian/Reunion', "
    "or a fixed offset such as 'UTC+4' or 'UTC-07:00'"
)


YEARS: Final = (1800, 2200)
"""First and last year of stamps."""

_ISO_DATE: Final = re.compile(r"\d{4}-\d{2}-\d{2}(?:[T ]|$)|\d{8}T")
"""How a date begins in ISO 8601: year, month, day."""


_MONTH_AND_DAY: Final = re.compile(r"\d{2}-\d{2}(?:[T ]\d{2}:\d{2}(?::\d{2})?)?")
"""A date without a year, with or without a time of the day."""


_ISO_PLAIN: Final = re.compile(r"\d{4}-\d{2}-\d{2}(?:[T ]\d{2}:\d{2}(?::\d{2})?)?")
"""A whole date in ISO 8601, with or without a time of the day."""


def parse_timezone(text: object, where: str = "timezone") -> tzinfo:
    """Time zone from its text.

    Parameters
    ----------
    text : str
        IANA name (`Europe/Paris`) or fixed offset east of Greenwich (`UTC+4`, `UTC-07:00`, `UTC`).
    where : str
        Place of the text, for the error.

    Returns
    -------
    datetime.tzinfo
        The zone.

    Raises
    ------
    InputError
        The text is missing or does not name a time zone.

    Examples
    --------
    >>> parse_timezone("Indian/Reunion").key, str(parse_timezone("UTC+4"))
    ('Indian/Reunion', 'UTC+4')
    """
    if not isinstance(text, str) or not text.strip():
        raise InputError(f"{where}: a time zone is required, found {text!r}; {_EXPECTED_ZONE}.")
    name = text.strip()
    if name.upper() in {"UTC", "GMT", "Z"}:
        return UTC
    match = _OFFSET.match(name)
    if match:
        hours, minutes = int(match[2]), int(match[3] or 0)
        offset = timedelta(hours=hours, minutes=minutes) * (-1 if match[1] == "-" else 1)
        if not timedelta(hours=-12) <= offset <= timedelta(hours=14):
            raise InputError(f"{where}: offset {name!r} is outside UTC-12 .. UTC+14; {_EXPECTED_ZONE}.")
        return timezone(offset, _offset_name(offset))
    try:
        return ZoneInfo(name)
    except (ZoneInfoNotFoundError, ValueError, OSError) as error:
        hint = did_you_mean(name, available_timezones())
        raise InputError(f"{where}: no time zone {name!r}; {_EXPECTED_ZONE}. {hint}".rstrip()) from error


def fixed_zone(hours: float) -> tzinfo:
    """Zone with a fixed offset.

    Parameters
    ----------
    hours : float
        Offset east of Greenwich [h].
    """
    offset = timedelta(hours=hours)
    return timezone(offset, _offset_name(offset))


def zone_of(zone: tzinfo) -> tzinfo:
    """The same zone as an IANA zone or a fixed offset of the standard library.

    Parameters
    ----------
    zone : datetime.tzinfo
        Of any library, such as pytz or dateutil.
    """
    if isinstance(zone, ZoneInfo):
        return zone
    name = getattr(zone, "zone", None)  # pytz
    if isinstance(name, str):
        return parse_timezone(name)
    offset = zone.utcoffset(None)
    if offset is None:
        raise InputError(f"timezone: found {zone!r}; {_EXPECTED_ZONE}.")
    return fixed_zone(offset.total_seconds() / 3600.0)


def fixed_offset(zone: tzinfo) -> bool:
    """Whether clocks never change in a zone today (no summer time)."""
    return len({datetime(2024, month, 1, tzinfo=zone).utcoffset() for month in range(1, 13)}) == 1


def zone_name(zone: tzinfo) -> str:
    """Name of a zone, from which `parse_timezone` makes the same zone."""
    if isinstance(zone, ZoneInfo):
        return zone.key
    return _offset_name(zone.utcoffset(datetime(2001, 1, 1)) or timedelta())


def _offset_name(offset: timedelta) -> str:
    minutes = round(offset.total_seconds() / 60)
    if minutes == 0:
        return "UTC"
    sign = "-" if minutes < 0 else "+"
    hours, odd_minutes = divmod(abs(minutes), 60)
    return f"UTC{sign}{hours}" + (f":{odd_minutes:02d}" if odd_minutes else "")


def localize(stamps: pd.DatetimeIndex, zone: tzinfo, where: str) -> pd.DatetimeIndex:
    """Add the time zone to local stamps.

    Parameters
    ----------
    stamps : pandas.DatetimeIndex
        Local stamps without a zone, shape (n,).
    zone : datetime.tzinfo
        The zone that they are in.
    where : str
        File or table, for the error.

    Returns
    -------
    pandas.DatetimeIndex
        Stamps with a zone, shape (n,).

    Raises
    ------
    InputError
        Stamps that do not exist in spring, or exist twice in autumn.

    Notes
    -----
    Rows of the doubled hour in autumn are taken in order where the clock goes back once among them: those
    before are in summer time, those after in winter time.
    """
    import numpy as np

    exists = stamps.tz_localize(zone, ambiguous=np.ones(len(stamps), dtype=bool), nonexistent="NaT")
    skipped = stamps[exists.isna()]
    if len(skipped):
        raise InputError(_clock_text(skipped, zone, where, "skips", "when clocks go forward"))
    single = stamps.tz_localize(zone, ambiguous="NaT", nonexistent="NaT")
    doubled = single.isna()
    if not doubled.any():
        return single
    summer = np.ones(len(stamps), dtype=bool)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], doubled, [False]]).astype(np.int8)))
    for first, last in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        back = np.flatnonzero(np.diff(stamps[first:last].to_numpy()) <= np.timedelta64(0))
        if len(back) != 1:
            raise InputError(_clock_text(stamps[first:last], zone, where, "has twice", "when clocks go back"))
        summer[first + int(back[0]) + 1 : last] = False
    return stamps.tz_localize(zone, ambiguous=summer, nonexistent="NaT")


def _clock_text(stamps: pd.DatetimeIndex, zone: tzinfo, where: str, verb: str, when: str) -> str:
    shown = ", ".join(f"{stamp:%Y-%m-%d %H:%M}" for stamp in stamps[:3])
    more = f" and {len(stamps) - 3} more, up to {stamps[-1]:%Y-%m-%d %H:%M}" if len(stamps) > 3 else ""
    winter = standard_offset(zone, stamps[0].year)
    order = " Rows of both hours, one after the other, are taken in order." if verb == "has twice" else ""
    return (
        f"{where}: {zone_name(zone)} {verb} the local stamps {shown}{more} ({when}), so the time of "
        f"these rows is not known.{order} If the clock of the file has winter time all year, state timezone: "
        f"{_offset_name(winter)}; otherwise write the stamps with their offset, as in 2024-10-27T02:00+01:00."
    )


def standard_offset(zone: tzinfo, year: int) -> timedelta:
    """Offset of winter time.

    Parameters
    ----------
    zone : datetime.tzinfo
        The zone.
    year : int
        Calendar year; zones change.
    """
    offsets = [datetime(year, month, 1, tzinfo=zone).utcoffset() or timedelta() for month in (1, 7)]
    return min(offsets)


def with_year(value: object, zone: tzinfo, since: float) -> object:
    """A date without a year as the first one from a moment on; all else as it is.

    Parameters
    ----------
    value : object
        Such as ``07-01`` or ``07-01 06:30``.
    zone : datetime.tzinfo
        Zone of the climate.
    since : float
        Seconds since 1970-01-01 UTC. [s]

    Examples
    --------
    >>> with_year("07-01", UTC, 0.0), with_year("2024-07-01", UTC, 0.0)
    ('1970-07-01', '2024-07-01')
    """
    if not isinstance(value, str) or not _MONTH_AND_DAY.fullmatch(value.strip()):
        return value
    begin = datetime.fromtimestamp(since, tz=zone)
    text = value.strip()
    year = begin.year if f"{begin:%m-%d %H:%M}" <= text.replace("T", " ").ljust(11, "~") else begin.year + 1
    return f"{year}-{text}"


def seconds_at(value: object, zone: tzinfo, what: str) -> float:
    """A point in time given by the user, in seconds since 1970-01-01 UTC; the same as `moment`. [s]

    A plain date whose local time exists once is read without pandas, whose import takes longer than a run.
    """
    stamp = _plain(value)
    if stamp is not None and YEARS[0] <= stamp.year <= YEARS[1]:
        if stamp.tzinfo is not None:
            return stamp.timestamp()
        early, late = (stamp.replace(tzinfo=zone, fold=fold) for fold in (0, 1))
        if early.utcoffset() == late.utcoffset():
            return early.timestamp()
    return moment(value, zone, what).timestamp()


def _plain(value: object) -> datetime | None:
    """A date of the standard library, or one from ISO text without an offset; None for all else."""
    if type(value) is datetime:  # a pandas.Timestamp is one as well, and has nanoseconds
        return value
    if isinstance(value, str) and _ISO_PLAIN.fullmatch(value.strip()):
        with contextlib.suppress(ValueError):
            return datetime.fromisoformat(value.strip())
    return None


def moment(value: object, zone: tzinfo, what: str) -> pd.Timestamp:
    """A point in time given by the user.

    Parameters
    ----------
    value : str, datetime or pandas.Timestamp
        With an offset it is taken as it is; without one it is local time in `zone`.
    zone : datetime.tzinfo
        Zone of the climate or table.
    what : str
        Name of the value, for the error.

    Returns
    -------
    pandas.Timestamp
        The same point, in `zone`.

    Raises
    ------
    InputError
        No date can be read, or the local time does not exist or exists twice.
    """
    import pandas as pd

    if isinstance(value, int | float):
        raise InputError(f"{what}: found the number {value!r}, expected a date such as 2012-09-20 06:30.")
    if isinstance(value, str) and not _ISO_DATE.match(value.strip()):
        # pandas reads 01/02/2023 as 2 January, but 13/02/2023 as 13 February.
        raise InputError(f"{what}: {value!r} is not a date; write it as 2012-09-20 or 2012-09-20 06:30.")
    try:
        stamp = pd.Timestamp(value)  # type: ignore[arg-type]
    except (ValueError, TypeError, OverflowError) as error:
        raise InputError(
            f"{what}: {value!r} is not a date; write it as 2012-09-20 or 2012-09-20 06:30."
        ) from error
    if pd.isna(stamp):
        raise InputError(f"{what}: found {value!r}, expected a date such as 2012-09-20 06:30.")
    if not YEARS[0] <= stamp.year <= YEARS[1]:
        raise InputError(
            f"{what}: found {value!r}, in the year {stamp.year}; expected one from {YEARS[0]} to {YEARS[1]}"
        )
    if stamp.tzinfo is not None:
        return stamp.tz_convert(zone)
    try:
        return localize(pd.DatetimeIndex([stamp]), zone, what)[0]
    except InputError as error:
        raise InputError(
            f"{what}: {stamp:%Y-%m-%d %H:%M} does not exist or exists twice in {zone_name(zone)}, where "
            "clocks change then; write it with its offset, as in 2024-10-27T02:00+01:00."
        ) from error

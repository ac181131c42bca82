"""Lengths of time, and stamps as seconds since 1970-01-01 UTC."""

from __future__ import annotations

import re
from datetime import UTC, datetime, timedelta, tzinfo
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.errors import InputError
from mascarin.weather.arrays import Array

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

_EPOCH: Final = datetime(1970, 1, 1, tzinfo=UTC)

_SECONDS: Final = {
    **dict.fromkeys(("s", "sec", "second", "seconds"), 1.0),
    **dict.fromkeys(("min", "minute", "minutes"), 60.0),
    **dict.fromkeys(("h", "hour", "hours"), 3600.0),
    **dict.fromkeys(("d", "day", "days"), 86400.0),
}
"""Units of a length of time."""

#: Stamps are kept to the microsecond; the calendar has 400 years (`YEARS` in timezones). [s]
_SHORTEST: Final = 1e-6
_LONGEST: Final = 400 * 366 * 86400.0

_TIMES: Final = "a positive time such as 900, 15min or 1h"

_LENGTH_OF_TIME: Final = re.compile(rf"(\d+\.?\d*(?:e[+-]?\d+)?)\s*({'|'.join(_SECONDS)})?", re.IGNORECASE)


def seconds_of(step: str | float, where: str = "step") -> float:
    """Length of a step.

    Parameters
    ----------
    step : str or float
        Text such as `15min`, `1h`, `90s`, `3d`, or a number of seconds [s].
    where : str
        Name of the length, for the error.

    Returns
    -------
    float
        Length [s].

    Raises
    ------
    InputError
        No positive length can be read.

    Examples
    --------
    >>> seconds_of("15min"), seconds_of("1h"), seconds_of(90)
    (900.0, 3600.0, 90.0)
    """
    match = _LENGTH_OF_TIME.fullmatch(str(step).strip())
    if match is None or isinstance(step, bool):
        raise InputError(f"{where}: found {step!r}; expected {_TIMES}")
    seconds = float(match[1]) * _SECONDS[(match[2] or "s").lower()]
    if not _SHORTEST <= seconds <= _LONGEST:
        raise InputError(
            f"{where}: found {step!r}; expected {_TIMES}, from {_SHORTEST:g} s to {_LONGEST:g} s"
        )
    return seconds


def epoch_seconds(index: pd.DatetimeIndex) -> Array:
    """Seconds since 1970-01-01 UTC of stamps with a zone, shape (n,) [s]."""
    moments = index.tz_convert("UTC").tz_localize(None).to_numpy()
    return np.asarray((moments - np.datetime64(0, "s")) / np.timedelta64(1, "us") * 1e-6, dtype=np.float64)


def local_time(seconds: float, zone: tzinfo) -> datetime:
    """A time in a zone from seconds since 1970-01-01 UTC [s], without pandas."""
    return (_EPOCH + timedelta(seconds=seconds)).astimezone(zone)


def clock(seconds: Array, zone: tzinfo) -> npt.NDArray[np.datetime64]:
    """Readings of the local clock, without a zone, from seconds since 1970-01-01 UTC, shape (n,) [s]."""
    offset = zone.utcoffset(None)
    if offset is None:  # a zone whose clocks change
        return np.asarray(stamps_of(seconds, zone).tz_localize(None).to_numpy())
    return _moments(seconds) + np.timedelta64(round(offset.total_seconds() * 1e6), "us")


def stamps_of(seconds: Array, zone: tzinfo) -> pd.DatetimeIndex:
    """Stamps in a zone from seconds since 1970-01-01 UTC [s]."""
    import pandas as pd

    return pd.DatetimeIndex(_moments(seconds)).tz_localize("UTC").tz_convert(zone)


def _moments(seconds: Array) -> npt.NDArray[np.datetime64]:
    """Times in UTC, to the microsecond."""
    return np.round(np.asarray(seconds) * 1e6).astype(np.int64).astype("datetime64[us]")

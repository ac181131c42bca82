"""Lengths of time in words of people."""

from __future__ import annotations

import re
from typing import Final

from mascarin.errors import InputError

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

_DAY: Final = 86400.0

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


def shift_of(shift: str | float, where: str = "shift") -> float:
    """A shift of a clock, which may be negative.

    Parameters
    ----------
    shift : str or float
        Text such as `30min` or `-1h`, or a number of seconds [s].
    where : str
        Name of the shift, for the error.

    Returns
    -------
    float
        Shift [s].

    Raises
    ------
    InputError
        No time of at most a day can be read.

    Examples
    --------
    >>> shift_of("-30min"), shift_of("1h"), shift_of(0)
    (-1800.0, 3600.0, 0.0)
    """
    text = str(shift).strip()
    sign = -1.0 if text[:1] in ("-", "\u2212") else 1.0
    plain = text.lstrip("+-\u2212")
    match = _LENGTH_OF_TIME.fullmatch(plain)
    seconds = float(match[1]) * _SECONDS[(match[2] or "s").lower()] if match is not None else -1.0
    if isinstance(shift, bool) or len(text) - len(plain) > 1 or not 0.0 <= seconds <= _DAY:
        raise InputError(
            f"{where}: found {shift!r}; expected a time of at most one day with or without a sign, such as "
            "30min or -1h"
        )
    return sign * seconds if seconds else 0.0

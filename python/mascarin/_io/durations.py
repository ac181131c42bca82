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

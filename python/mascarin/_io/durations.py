"""Lengths of time in words of people."""

from __future__ import annotations

import re
from dataclasses import dataclass
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
    if match is None and str(step).strip().lower().startswith("auto"):
        raise InputError(
            f"{where}: found {step!r}, expected one length: steps that are chosen along a run "
            "(docs/speed.md) are for runs in a climate. State a length, such as 15min"
        )
    if match is None or isinstance(step, bool):
        raise InputError(f"{where}: found {step!r}; expected {_TIMES}")
    seconds = float(match[1]) * _SECONDS[(match[2] or "s").lower()]
    if not _SHORTEST <= seconds <= _LONGEST:
        raise InputError(
            f"{where}: found {step!r}; expected {_TIMES}, from {_SHORTEST:g} s to {_LONGEST:g} s"
        )
    return seconds


def length_words(seconds: float) -> str:
    """A length of time for people, such as `56.25 s` or `15 min`.

    Parameters
    ----------
    seconds : float
        The length. [s]

    Examples
    --------
    >>> length_words(56.25), length_words(900.0)
    ('56.25 s', '15 min')
    """
    return f"{seconds:.4g} s" if seconds < 120.0 else f"{seconds / 60.0:.4g} min"


#: Tolerance where none is stated. [K]
_TOLERANCE: Final = 0.05
#: Tolerances that can be asked for. [K]
_TOLERANCES: Final = (1e-4, 10.0)
_AUTO: Final = re.compile(
    r"auto(?:\s+(?P<tolerance>[\d.]+(?:e[+-]?\d+)?)\s*K)?(?:\s+every\s+(?P<every>.+))?", re.IGNORECASE
)


@dataclass(frozen=True)
class AutoStep:
    """Steps whose lengths are chosen.

    Parameters
    ----------
    tolerance : float
        Largest error of temperatures that is aimed at. [K]
    interval : float or None
        Record interval; None: that of the weather, and 15 min at least. [s]
    """

    tolerance: float = _TOLERANCE
    interval: float | None = None

    def __str__(self) -> str:
        records = "" if self.interval is None else f" every {self.interval:g}s"
        return f"auto {self.tolerance:g}K{records}"


def auto_step(step: str | float, where: str = "step") -> AutoStep | None:
    """Steps whose lengths are chosen, where they are asked for; None for a length.

    Parameters
    ----------
    step : str or float
        Text such as `auto`, `auto 0.02K` or `auto 0.02K every 30min`, or a length.
    where : str
        Name of the option, for the error.

    Raises
    ------
    InputError
        The text begins with `auto` and cannot be read, or the tolerance is beyond its limits.

    Examples
    --------
    >>> auto_step("auto 0.02K every 1h")
    AutoStep(tolerance=0.02, interval=3600.0)
    >>> auto_step("auto"), auto_step("15min")
    (AutoStep(tolerance=0.05, interval=None), None)
    """
    text = str(step).strip()
    if not text.lower().startswith("auto"):
        return None
    match = _AUTO.fullmatch(text)
    low, high = _TOLERANCES
    try:
        tolerance = _TOLERANCE if match is None or match["tolerance"] is None else float(match["tolerance"])
    except ValueError:
        match, tolerance = None, 0.0
    if match is None or not low <= tolerance <= high:
        raise InputError(
            f"{where}: found {step!r}, expected 'auto', 'auto TOLERANCE' or 'auto TOLERANCE every "
            f"INTERVAL' with a tolerance of {low:g} to {high:g} K, such as 'auto 0.02K every 1h'"
        )
    interval = match["every"]
    return AutoStep(tolerance, None if interval is None else seconds_of(interval, where))


def record_seconds(step: str | float, where: str = "step") -> float:
    """Interval of the records of a run: its step, or what `auto` states. [s]

    Parameters
    ----------
    step : str or float
        A length, or text such as `auto 0.02K every 30min`.
    where : str
        Name of the option, for the error.

    Raises
    ------
    InputError
        The text cannot be read, or `auto` states no interval.

    Examples
    --------
    >>> record_seconds("auto 0.02K every 30min"), record_seconds("1h")
    (1800.0, 3600.0)
    """
    chosen = auto_step(step, where)
    if chosen is None:
        return seconds_of(step, where)
    if chosen.interval is None:
        raise InputError(
            f"{where}: found {step!r}, expected the interval of the records with it. Write 'auto "
            f"{chosen.tolerance:g}K every 30min'"
        )
    return chosen.interval


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

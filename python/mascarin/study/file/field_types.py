"""Types of the values in a study file, with their checks."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Final, Literal

from pydantic import AfterValidator, BeforeValidator, Discriminator, Tag, WithJsonSchema

from mascarin.building.base.number import problem
from mascarin.errors import InputError, did_you_mean
from mascarin.simulation.preparation.initial_state import Degrees, GivenStart


def _duration(text: str) -> str:
    """A length of time that can be read."""
    from mascarin._io.durations import seconds_of

    try:
        seconds_of(text)
    except InputError:
        raise problem(f"'{text}'", "a length of time", "Write 15min, 1h, 2d or 90s.") from None
    return text


def _shift(text: str) -> str:
    """A shift of a clock that can be read."""
    from mascarin._io.durations import shift_of

    try:
        shift_of(text)
    except InputError:
        raise problem(f"'{text}'", "a time of at most one day", "Write 30min, -1h or 90s.") from None
    return text


def _seconds(given: Any) -> Any:
    """A number without a unit is a number of seconds."""
    return f"{given}s" if isinstance(given, int | float) and not isinstance(given, bool) else given


def _timezone(text: object) -> object:
    """A time zone that exists."""
    from mascarin.tables.timezones import parse_timezone

    try:
        parse_timezone(text)
    except InputError as error:
        _, _, hint = str(error).rpartition("'. ")
        expected = "an IANA name such as Europe/Paris, or a fixed offset such as UTC+4"
        raise problem(f"'{text}'", expected, hint if hint.startswith("Did") else "") from None
    return text


def _listed(given: Any) -> Any:
    """One pair of times is a list of one period."""
    if (
        isinstance(given, list | tuple)
        and len(given) == 2
        and not any(isinstance(t, list | tuple) for t in given)
    ):
        return (tuple(given),)
    if isinstance(given, list | tuple) and not given:
        raise problem("no period", "a pair of times, or a list of pairs", "Write [start, end].")
    return given


def _hour(text: str) -> str:
    """An hour of the day."""
    hours, colon, minutes = text.partition(":")
    known = colon and hours.isdigit() and minutes.isdigit() and int(minutes) < 60
    if known and 60 * int(hours) + int(minutes) <= 24 * 60:
        return text
    raise problem(f"'{text}'", "an hour of the day", "Write 06:00 or 22:30.")


def require_bounds(given: Any) -> Any:
    """Refuse two numbers, which are probably bounds, and a single number."""
    if isinstance(given, list) and len(given) == 2:
        raise problem(str(given), "a mapping", f"Write {{low: {given[0]}, high: {given[1]}}}.")
    if isinstance(given, int | float):
        raise problem(str(given), "a mapping", "Write values in the building; write {low: , high: } here.")
    return given


def _start(given: Any) -> Any:
    """Check a word."""
    if isinstance(given, str) and given not in ("repeat", "measured"):
        expected = "repeat, measured, a temperature in degC, or a mapping of temperatures"
        raise problem(f"'{given}'", expected, did_you_mean(given, ("repeat", "measured")))
    return given


def _kind_of_start(given: Any) -> str:
    if isinstance(given, str):
        return "word"
    return "given" if isinstance(given, Mapping | GivenStart) else "number"


Initial = Annotated[
    Annotated[Literal["repeat", "measured"], Tag("word")]
    | Annotated[Degrees, Tag("number")]
    | Annotated[GivenStart, Tag("given")],
    Discriminator(_kind_of_start),
    BeforeValidator(_start),
]

#: A local time, ISO 8601, with or without an offset.
Time = str
Span = tuple[Time, Time]
_PAIR: Final = {"type": "array", "items": {"type": "string"}, "minItems": 2, "maxItems": 2}
Spans = Annotated[
    tuple[Span, ...],
    BeforeValidator(_listed),
    WithJsonSchema({"anyOf": [_PAIR, {"type": "array", "items": _PAIR, "minItems": 1}]}),
]
#: A part of the record: start and end, or one day.
Stretch = Span | Time
Hours = tuple[Annotated[str, AfterValidator(_hour)], Annotated[str, AfterValidator(_hour)]]
Duration = Annotated[
    str,
    BeforeValidator(_seconds),
    AfterValidator(_duration),
    WithJsonSchema({"anyOf": [{"type": "string"}, {"type": "number"}]}),
]
Shift = Annotated[
    str,
    BeforeValidator(_seconds),
    AfterValidator(_shift),
    WithJsonSchema({"anyOf": [{"type": "string"}, {"type": "number"}]}),
]
TimeZone = Annotated[str, BeforeValidator(_timezone)]
Columns = str | tuple[str, ...] | dict[str, Any]

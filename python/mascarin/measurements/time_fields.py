"""Types of the times in a study file: lengths, periods, hours of the day."""

from __future__ import annotations

from typing import Annotated, Any, Final

from pydantic import AfterValidator, BeforeValidator, WithJsonSchema

from mascarin.building.base.number import problem
from mascarin.errors import InputError


def _duration(text: str) -> str:
    """A length of time that can be read."""
    from mascarin._io.durations import seconds_of

    try:
        seconds_of(text)
    except InputError:
        raise problem(f"'{text}'", "a length of time", "Write 15min, 1h, 2d or 90s.") from None
    return text


def _run_step(text: str) -> str:
    """A step of a run: a length, or `auto` with the interval of the records."""
    from mascarin._io.durations import auto_step

    try:
        chosen = auto_step(text)
    except InputError as error:
        raise problem(f"'{text}'", "a length of time, or 'auto'", str(error)) from None
    if chosen is not None and chosen.interval is None:
        raise problem(
            f"'{text}'",
            "the interval of the records with it, which periods are whole numbers of",
            f"Write 'auto {chosen.tolerance:g}K every 30min'.",
        )
    return text if chosen is not None else _duration(text)


def _shift(text: str) -> str:
    """A shift of a clock that can be read."""
    from mascarin._io.durations import shift_of

    try:
        shift_of(text)
    except InputError:
        raise problem(f"'{text}'", "a time of at most one day", "Write 30min, -1h or 90s.") from None
    return text


def _seconds(value: Any) -> Any:
    """A number without a unit is a number of seconds."""
    return f"{value}s" if isinstance(value, int | float) and not isinstance(value, bool) else value


def _listed(value: Any) -> Any:
    """One pair of times is a list of one period."""
    if (
        isinstance(value, list | tuple)
        and len(value) == 2
        and not any(isinstance(t, list | tuple) for t in value)
    ):
        return (tuple(value),)
    if isinstance(value, list | tuple) and not value:
        raise problem("no period", "a pair of times, or a list of pairs", "Write [start, end].")
    return value


def _hour(text: str) -> str:
    """An hour of the day."""
    hours, colon, minutes = text.partition(":")
    is_time = colon and hours.isdigit() and minutes.isdigit() and int(minutes) < 60
    if is_time and 60 * int(hours) + int(minutes) <= 24 * 60:
        return text
    raise problem(f"'{text}'", "an hour of the day", "Write 06:00 or 22:30.")


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
#: Step of a run; with `auto` steps are chosen.
RunStep = Annotated[
    str,
    BeforeValidator(_seconds),
    AfterValidator(_run_step),
    WithJsonSchema({"anyOf": [{"type": "string"}, {"type": "number"}]}),
]
Shift = Annotated[
    str,
    BeforeValidator(_seconds),
    AfterValidator(_shift),
    WithJsonSchema({"anyOf": [{"type": "string"}, {"type": "number"}]}),
]

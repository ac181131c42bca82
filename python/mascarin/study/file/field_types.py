"""Types of the values in a study file, with their checks."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Tag

from mascarin.building.base.number import problem
from mascarin.errors import InputError, did_you_mean
from mascarin.simulation.preparation.initial_state import Degrees, GivenStart


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

TimeZone = Annotated[str, BeforeValidator(_timezone)]
Columns = str | tuple[str, ...] | dict[str, Any]

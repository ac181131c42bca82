"""Checks of arguments that users give to public functions."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from numbers import Integral, Real
from typing import Any

from mascarin.errors import InputError


def require_type(name: str, value: object, kinds: type | tuple[type, ...], expected: str) -> None:
    """Refuse an argument of another type.

    Parameters
    ----------
    name : str
        Name of the argument, for the error.
    value : object
        What was given.
    kinds : type or tuple of type
        Types that can be used.
    expected : str
        What was expected and how one gets it, for the error.

    Raises
    ------
    InputError
        The value is of another type.
    """
    if not isinstance(value, kinds):
        raise InputError(f"{name}: found {kind_of(value)}, expected {expected}")


def kind_of(value: object) -> str:
    """What was given, in the few words of an error: short values as they are, others by their type."""
    if value is None or isinstance(value, str | int | float):
        return repr(value)
    return type(value).__name__


def names_of(name: str, value: Any, *, such_as: str = "'materials.concrete.conductivity'") -> list[str]:
    """A list of names; one text alone is refused, because it would be read letter by letter.

    Raises
    ------
    InputError
        A text, something that is no list, or an entry that is no text.
    """
    if isinstance(value, str):
        raise InputError(f"{name}: found the text '{value}', expected a list: ['{value}']")
    if not isinstance(value, Iterable):
        raise InputError(f"{name}: found {kind_of(value)}, expected a list of names, such as [{such_as}]")
    names = list(value)
    for entry in names:
        require_type(name, entry, str, f"names as texts, such as {such_as}")
    return names


def mapping_of(name: str, value: Any, expected: str) -> dict[str, Any]:
    """A mapping whose keys are texts; none is empty.

    Raises
    ------
    InputError
        Something else.
    """
    if value is None:
        return {}
    require_type(name, value, Mapping, expected)
    for key in value:
        require_type(f"{name}: key {key!r}", key, str, "a text")
    return dict(value)


def bounds_of(name: str, value: Any) -> tuple[float, float]:
    """A pair (low, high) of numbers; whether low is below high is checked where the limits are known.

    Raises
    ------
    InputError
        Something else than two numbers.
    """
    pair = list(value) if isinstance(value, Iterable) and not isinstance(value, str | Mapping) else [value]
    if len(pair) != 2 or any(isinstance(bound, bool) or not isinstance(bound, Real) for bound in pair):
        raise InputError(f"{name}: found {value!r}, expected two numbers (low, high)")
    return pair[0], pair[1]


def whole_number(name: str, value: Any, least: int = 0) -> int:
    """A whole number from `least` on.

    Raises
    ------
    InputError
        Something else.
    """
    if isinstance(value, bool) or not isinstance(value, Integral) or value < least:
        raise InputError(f"{name}: found {value!r}, expected a whole number from {least} on")
    return int(value)


def finite_number(name: str, value: Any, low: float, high: float, unit: str = "") -> float:
    """A number within limits.

    Raises
    ------
    InputError
        Something else.
    """
    try:
        number = math.nan if isinstance(value, bool) or not isinstance(value, Real) else float(value)
    except OverflowError:  # an integer of more digits than a float holds
        number = math.inf
    if not low <= number <= high:  # not for NaN either
        shown = f" {unit}" if unit else ""
        raise InputError(f"{name}: found {value!r}, expected a number from {low:g} to {high:g}{shown}")
    return number

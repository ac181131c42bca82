"""Numbers of a model by its schema: of the type, and within the limits, that EnergyPlus itself accepts."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any, Final

#: What EnergyPlus finds by itself, in whichever field of numbers.
AUTO: Final = ("autosize", "autocalculate", "useweatherfile")


#: No number of a model is larger; products of such numbers are finite.
_LARGEST: Final = 1e30


def finite(text: str) -> float:
    """Read a number of a text.

    Raises
    ------
    ValueError
        It is none, not finite, or above 1e30.
    """
    found = float(text)
    if not _is_finite(found):
        raise ValueError(f"found {text}, expected a finite number up to {_LARGEST:g}")
    return found


def wrong_number(schema: Any, kind: str, data: Mapping[str, Any]) -> str | None:
    """Find a field that EnergyPlus would refuse too: no finite number, or one outside of its limits.

    Parameters
    ----------
    schema : idfkit.schema.EpJSONSchema
        Of the version of the model.
    kind : str
        Class of the object.
    data : mapping of str to object
        Its fields; those that repeat are lists of mappings.

    Returns
    -------
    str or None
        Field, what was found and what is expected; None where all are right.
    """
    inner = schema.get_inner_schema(kind) or {}
    for key, value, told in _fields(inner.get("properties", {}), data):
        fault = _fault(value, told)
        if fault is not None:
            return f"{key}: found {_short(value)}; expected {fault}"
    return None


def _fields(
    told: Mapping[str, Any], data: Mapping[str, Any], place: str = ""
) -> Iterator[tuple[str, Any, Mapping[str, Any]]]:
    """Fields with a value, and what the schema says of each."""
    for key, value in data.items():
        own = told.get(key, {})
        if isinstance(value, list):
            repeated = own.get("items", {}).get("properties", {})
            for k, one in enumerate(value, 1):
                if isinstance(one, Mapping):
                    yield from _fields(repeated, one, f"{place}{key} {k}: ")
        elif value is not None and value != "":
            yield f"{place}{key}", value, own


def _fault(value: Any, told: Mapping[str, Any]) -> str | None:
    """What is expected in place of a value; None where it is right."""
    kinds = told.get("anyOf", [told])
    numeric = [one for one in kinds if one.get("type") in ("number", "integer")]
    if isinstance(value, bool) or not isinstance(value, int | float):
        words = [one.get("enum") for one in kinds if one.get("type") not in ("number", "integer")]
        return None if not numeric or _is_word(value, words) else "a number"
    if not _is_finite(value):
        return f"a finite number up to {_LARGEST:g}"
    return _outside(float(value), numeric[0]) if numeric else None


def _is_word(value: Any, words: list[list[str] | None]) -> bool:
    """Whether a field of numbers takes a text: any, or words such as Autosize."""
    text = str(value).strip().casefold()
    return any(one is None or text in AUTO or text in map(str.casefold, one) for one in words)


def _is_finite(value: float) -> bool:
    return abs(value) <= _LARGEST  # false for nan, and exact for whole numbers of any length


def _outside(value: float, told: Mapping[str, Any]) -> str | None:
    """The limit of the schema that a number misses."""
    if value < told.get("minimum", -math.inf):
        return f"at least {told['minimum']:g}"
    if value > told.get("maximum", math.inf):
        return f"at most {told['maximum']:g}"
    for key, words, missed in (
        ("exclusiveMinimum", "above", value <= told.get("exclusiveMinimum", -math.inf)),
        ("exclusiveMaximum", "below", value >= told.get("exclusiveMaximum", math.inf)),
    ):
        if missed:
            return f"a number {words} {told[key]:g}"
    return None


def _short(value: Any) -> str:
    text = f"{value:g}" if isinstance(value, float) else repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."

"""Numbers of a model by its schema: of the type, and within the limits, that EnergyPlus itself accepts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Final

#: What EnergyPlus finds by itself, in whichever field of numbers.
AUTO: Final = ("autosize", "autocalculate", "useweatherfile")


#: No number of a model is larger; products of such numbers are finite.
_MAX_NUMBER: Final = 1e30


def finite(text: str) -> float:
    """Read a number of a text.

    Raises
    ------
    ValueError
        It is none, not finite, or above 1e30.
    """
    number = float(text)
    if not _is_finite(number):
        raise ValueError(f"found {text}, expected a finite number up to {_MAX_NUMBER:g}")
    return number


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
    for key, value, definition in _fields(inner.get("properties", {}), data):
        fault = _fault(value, definition)
        if fault is not None:
            return f"{key}: found {_short(value)}; expected {fault}"
    return None


def _fields(
    definitions: Mapping[str, Any], data: Mapping[str, Any], path: str = ""
) -> Iterator[tuple[str, Any, Mapping[str, Any]]]:
    """Fields with a value, and what the schema says of each."""
    for key, value in data.items():
        definition = definitions.get(key, {})
        if isinstance(value, list):
            repeated = definition.get("items", {}).get("properties", {})
            for k, row in enumerate(value, 1):
                if isinstance(row, Mapping):
                    yield from _fields(repeated, row, f"{path}{key} {k}: ")
        elif value is not None and value != "":
            yield f"{path}{key}", value, definition


def _fault(value: Any, definition: Mapping[str, Any]) -> str | None:
    """What is expected in place of a value; None where it is right."""
    kinds = definition.get("anyOf", [definition])
    numeric = [option for option in kinds if option.get("type") in ("number", "integer")]
    if isinstance(value, bool) or not isinstance(value, int | float):
        words = [option.get("enum") for option in kinds if option.get("type") not in ("number", "integer")]
        return None if not numeric or _is_word(value, words) else "a number"
    if not _is_finite(value):
        return f"a finite number up to {_MAX_NUMBER:g}"
    return _outside(float(value), numeric[0]) if numeric else None


def _is_word(value: Any, words: list[list[str] | None]) -> bool:
    """Whether a field of numbers takes a text: any, or words such as Autosize."""
    text = str(value).strip().casefold()
    return any(options is None or text in AUTO or text in map(str.casefold, options) for options in words)


def _is_finite(value: float) -> bool:
    return abs(value) <= _MAX_NUMBER  # false for nan, and exact for whole numbers of any length


def _outside(value: float, definition: Mapping[str, Any]) -> str | None:
    """The limit of the schema that a number misses."""
    for key, strict, sign, bound, beyond in (
        ("minimum", "exclusiveMinimum", 1.0, "at least", "a number above"),
        ("maximum", "exclusiveMaximum", -1.0, "at most", "a number below"),
    ):
        exclusive = definition.get(strict)
        # Up to 9.5, the strict limit is a word on the other limit; later it is a limit itself.
        old = isinstance(exclusive, bool)
        limit = definition.get(key) if old or exclusive is None else exclusive
        if limit is None:
            continue
        if exclusive is not None and exclusive is not False:
            if sign * (value - limit) <= 0.0:
                return f"{beyond} {limit:g}"
            limit = definition.get(key, limit)
        if sign * (value - limit) < 0.0:
            return f"{bound} {limit:g}"
    return None


def _short(value: Any) -> str:
    text = f"{value:g}" if isinstance(value, float) else repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."

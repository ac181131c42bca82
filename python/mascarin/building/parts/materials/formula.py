"""Numbers that stand beside a formula of a description, with names of their own."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Final

from pydantic import ConfigDict, Field, field_validator, model_validator
from pydantic_core import InitErrorDetails, PydanticCustomError

from mascarin.building.base.number import Limits, Number, OnlyGiven, Quantity, noted_form, problem, shown
from mascarin.building.base.part import Part, insist

#: A number and its unit in one text.
_WITH_UNIT: Final = re.compile(r"(?P<value>[-+]?\d+(\.\d*)?(e[-+]?\d+)?)\s*(?P<unit>[^\d\s,].*)")
_NAME: Final = re.compile(r"[A-Za-z_]\w*")
_NO_RANGE: Final = "the source of a law gives numbers without a range: give one where they are uncertain"


@dataclass(frozen=True)
class FormulaQuantity(Quantity):
    """Unit and limits of a number of a formula, which the description gives with it."""

    KEYS: ClassVar[tuple[str, ...]] = (*Quantity.KEYS, "unit", "limits")

    def notes(self) -> dict[str, Any]:
        """What a file has of it beside the value."""
        plain: dict[str, Any] = {} if self.unit == "-" else {"unit": self.unit}
        if self.limits != Limits():
            plain["limits"] = [self.limits.lower, self.limits.upper]
        return plain

    def _bracketed(self) -> str:
        # Without a stated unit it may have any.
        return "" if self.unit == "-" else super()._bracketed()

    def _advice(self, raw: object) -> str:
        with_unit = _WITH_UNIT.fullmatch(raw) if isinstance(raw, str) else None
        if with_unit is None or self.unit != "-":
            return super()._advice(raw)
        return f'Write {{value: {with_unit["value"]}, unit: "{with_unit["unit"]}"}}.'


def _quantity(name: str, unit: str, limits: Limits) -> FormulaQuantity:
    return FormulaQuantity(unit, f"Number '{name}' of the formula", OnlyGiven(_NO_RANGE), limits)


def _number(name: str, raw: Any) -> Number:
    """A number of a formula: plain, or with value, unit, range, limits and source."""
    if isinstance(raw, Number):
        quantity = (
            raw.quantity if isinstance(raw.quantity, FormulaQuantity) else _quantity(name, "-", Limits())
        )
        return quantity.read(raw)
    if not isinstance(raw, Mapping):
        return _quantity(name, "-", Limits()).read(raw)
    unit, ends = raw.get("unit", "-"), raw.get("limits")
    if not isinstance(unit, str) or not unit.strip():
        raise problem(f"unit: {shown(unit)}", "a text", 'Write the unit in quotes, such as "W/(m2 K)".')
    limits = Limits() if ends is None else _limits(ends)
    notes = {key: value for key, value in raw.items() if key not in ("unit", "limits")}
    return _quantity(name, unit, limits).read(notes)


def _limits(raw: Any) -> Limits:
    numbers = (
        isinstance(raw, list | tuple)
        and len(raw) == 2
        and all(
            isinstance(end, int | float) and not isinstance(end, bool) and math.isfinite(end) for end in raw
        )
    )
    if not numbers or not raw[0] < raw[1]:
        help_ = "Write the lowest and the highest value that has a meaning."
        raise problem(f"limits: {shown(raw)}", "limits: [low, high] with low < high", help_)
    return Limits(at_least=float(raw[0]), at_most=float(raw[1]))


def _with_numbers(schema: dict[str, Any]) -> None:
    """Allow numbers of any name beside the formula in the JSON Schema."""
    number = {"type": "number"}
    noted = noted_form(number)
    noted["properties"]["unit"] = {"type": "string", "description": "Unit of the value"}
    noted["properties"]["limits"] = {
        "type": "array",
        "items": number,
        "minItems": 2,
        "maxItems": 2,
        "description": "Smallest and largest value that has a meaning",
    }
    schema["additionalProperties"] = {"anyOf": [number, noted]}


class Formula(Part):
    """A part with a formula, and the numbers of it as keys of the part.

    Examples
    --------
    >>> Formula(formula="a*x", a=2).numbers
    {'a': 2.0}
    """

    model_config = ConfigDict(json_schema_extra=_with_numbers)
    inline: ClassVar[frozenset[str]] = frozenset({"numbers"})

    formula: str = Field(description="The law, with names of numbers that stand beside it")
    source: str | None = Field(None, description="Where the law comes from")
    numbers: Mapping[str, Any] = Field(
        {}, description="Its numbers by their names; each may stand beside the formula as well"
    )

    @model_validator(mode="before")
    @classmethod
    def _collect(cls, raw: Any) -> Any:
        """Read all other keys as numbers of the formula."""
        if not isinstance(raw, Mapping):
            return raw
        fields = {key: value for key, value in raw.items() if key in cls.model_fields}
        numbers = {key: value for key, value in raw.items() if key not in cls.model_fields}
        stated = fields.get("numbers", {})
        return fields | {"numbers": {**(stated if isinstance(stated, Mapping) else {}), **numbers}}

    @field_validator("numbers", mode="plain")
    @classmethod
    def _read(cls, raw: Any) -> dict[str, Number]:
        plain, errors = {}, []
        for name, value in raw.items():
            try:
                plain[str(name)] = _number(str(name), value)
            except PydanticCustomError as error:
                errors.append(InitErrorDetails(type=error, loc=(str(name),), input=None))
        insist(*errors)
        return plain

    @property
    def names_of_formula(self) -> frozenset[str]:
        """Names that the formula uses, functions included."""
        return frozenset(_NAME.findall(self.formula))


def names_in(text: str | None) -> frozenset[str]:
    """Names in a formula, functions included."""
    return frozenset(_NAME.findall(text or ""))


def stated_unit(number: Number) -> str | None:
    """Unit of a number of a formula; None where the description gives none."""
    return None if number.quantity is None or number.quantity.unit == "-" else number.quantity.unit

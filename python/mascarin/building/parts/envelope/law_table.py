"""The published laws that a description has by name, from the table of the engine."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Final, Literal, NamedTuple

from mascarin import _engine
from mascarin.building.base.number import Limits, Number, Percent, Quantity, Remark, Span


class LawNumber(NamedTuple):
    """A number of a law.

    Attributes
    ----------
    name : str
        Its key.
    quantity : Quantity
        Unit, meaning, range and limits.
    default : Number or None
        Its value where none is written; None where it has to be written or follows from the building.
    follows : str
        What it follows from where none is written: ``length`` or ``perimeter`` of the surface, ``assumed``;
        nothing for other numbers.
    assumed : tuple of float and str, optional
        The value that is assumed, and its source.
    outdoors : bool
        Whether it is there on outdoor sides only.
    wind : bool
        Whether it has an effect only where wind reaches the side.
    of : str or None
        The number without which it has no effect.
    example : float
        A value for examples. [unit of the quantity]
    """

    name: str
    quantity: Quantity
    default: Number | None
    follows: str
    assumed: tuple[float, str] | None
    outdoors: bool
    wind: bool
    of: str | None
    example: float

    @property
    def required(self) -> bool:
        """Whether it has to be written."""
        return self.default is None and not self.follows

    @property
    def field(self) -> tuple[Any, Any]:
        """Type and default of the field of a part."""
        annotation = Annotated[Number, self.quantity]
        if self.follows:
            return annotation | None, None
        return annotation, ... if self.default is None else self.default


class LawRow(NamedTuple):
    """A published law: a row of the engine's table (``crates/engine/src/physics/law_row.rs``).

    Attributes
    ----------
    kind : str
        Its name in a description.
    title : str
        Its name in reports.
    meaning : str
        What it is, in one sentence.
    source : str or None
        Where it is published.
    valid : str
        Where it is valid.
    numbers : tuple of LawNumber
        Its numbers.
    by_direction : bool
        Whether it has them twice, by the direction of the flow of heat.
    sides : str
        Where it may stand: ``any``, ``air`` (outdoors or in a zone) or ``outdoors``.
    tilt : str
        How it depends on the tilt: ``none``, ``cases`` or ``steady``.
    wind : bool
        Whether it depends on the wind.
    wind_direction : bool
        Whether it depends on the direction of the wind.
    alternatives : tuple of (bool, dict)
        Where studies try it in place of another law: outdoors or in a zone, and values of numbers.
    """

    kind: str
    title: str
    meaning: str
    source: str | None
    valid: str
    numbers: tuple[LawNumber, ...]
    by_direction: bool
    sides: Literal["any", "air", "outdoors"]
    tilt: Literal["none", "cases", "steady"]
    wind: bool
    wind_direction: bool
    alternatives: tuple[tuple[bool, dict[str, float]], ...]

    @property
    def class_name(self) -> str:
        """Name of the class: ``AlamdariHammond`` for ``alamdari_hammond``."""
        return "".join(word[:1].upper() + word[1:] for word in self.kind.split("_"))

    def number(self, name: str) -> LawNumber:
        """One of its numbers."""
        return next(number for number in self.numbers if number.name == name)

    @property
    def example(self) -> dict[str, Any]:
        """What a description may have of it: all numbers."""
        numbers = {number.name: number.example for number in self.numbers}
        return {"upward": numbers, "downward": numbers} if self.by_direction else numbers


def _read(row: Mapping[str, Any]) -> LawRow:
    fields = {key: row[key] for key in LawRow._fields if key in row}
    alternatives = tuple((where["outdoors"], dict(where["numbers"])) for where in row["alternatives"])
    return LawRow(**fields | {"numbers": tuple(map(_number, row["numbers"])), "alternatives": alternatives})


def _number(row: Mapping[str, Any]) -> LawNumber:
    ((spread, words),) = row["range"].items()
    quantity = Quantity(
        row["unit"],
        row["meaning"],
        Percent(*words) if spread == "percent" else Span(*words),
        Limits(**row["limits"]),
        dict(row["words"]),
    )
    default, follows, assumed = None, "", None
    match row["default"]:
        case {"value": [value, reason]}:
            default = Number(value, source=Remark(reason))
        case {"assumed": [value, source]}:
            follows, assumed = "assumed", (value, source)
        case "length" | "perimeter" as shape:
            follows = shape
    return LawNumber(
        row["name"],
        quantity,
        default,
        follows,
        assumed,
        row["outdoors"],
        row["wind"],
        row["of"],
        row["example"],
    )


def _rows(family: str) -> Iterator[LawRow]:
    for row in json.loads(_engine.law_table())[family]:
        yield _read(row)


CONVECTION: Final[Mapping[str, LawRow]] = {row.kind: row for row in _rows("convection")}
"""Every published law of convection, by its kind."""

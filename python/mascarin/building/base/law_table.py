"""The published laws that a description has by name, from the table of the engine."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Annotated, Any, Final, Literal, NamedTuple

from mascarin import _engine
from mascarin.building.base.number import Limits, Number, Percent, Quantity, Remark, Span, Within


class LawChoice(NamedTuple):
    """A choice among integers that values of numbers are tabulated by.

    Attributes
    ----------
    name : str
        Its key.
    meaning : str
        What it is.
    among : tuple of int
        What may be chosen.
    default : int
        What is chosen where nothing is written.
    """

    name: str
    meaning: str
    among: tuple[int, ...]
    default: int


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
        What it follows from where none is written: ``length`` or ``perimeter`` of the surface, ``assumed``,
        the ``choices`` of the law; nothing for other numbers.
    assumed : tuple of float and str, optional
        The value that is assumed, and its source.
    tabulated : tuple of float
        Values for all combinations of the choices, the last choice varying fastest. [unit of the quantity]
    reason : str
        Why these values.
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
    tabulated: tuple[float, ...]
    reason: str
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

    @property
    def field_without_sides(self) -> tuple[Any, Any]:
        """The same where no surface decides whether a value is assumed."""
        if self.assumed is None:
            return self.field
        value, source = self.assumed
        return Annotated[Number, self.quantity], Number(value, source=source, assumed=True)


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
    details : str
        More about it; empty where a sentence is enough.
    source : str or None
        Where it is published.
    further_sources : tuple of str
        Where what it is made of is published.
    valid : str
        Where it is valid.
    numbers : tuple of LawNumber
        Its numbers.
    choices : tuple of LawChoice
        Choices that values of its numbers are tabulated by.
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
    weather : tuple of str
        Columns of the weather that it needs.
    clouds : str or None
        Effect of clouds that a sky is used with where none is described: ``factor`` or ``layer``; None where
        clouds have no effect.
    gives_heat : bool
        Of a law of what a side is in contact with: whether it gives heat beside its temperature.
    gives_coefficient : bool
        Whether it gives the coefficient through which its temperature acts.
    """

    kind: str
    title: str
    meaning: str
    details: str
    source: str | None
    further_sources: tuple[str, ...]
    valid: str
    numbers: tuple[LawNumber, ...]
    choices: tuple[LawChoice, ...]
    by_direction: bool
    sides: Literal["any", "air", "outdoors"]
    tilt: Literal["none", "cases", "steady"]
    wind: bool
    wind_direction: bool
    alternatives: tuple[tuple[bool, dict[str, float]], ...]
    weather: tuple[str, ...]
    clouds: Literal["factor", "layer"] | None
    gives_heat: bool
    gives_coefficient: bool

    @property
    def class_name(self) -> str:
        """Name of the class: ``AlamdariHammond`` for ``alamdari_hammond``."""
        return "".join(word[:1].upper() + word[1:] for word in self.kind.split("_"))

    def number(self, name: str) -> LawNumber:
        """One of its numbers."""
        return next(number for number in self.numbers if number.name == name)

    @property
    def sources(self) -> tuple[str, ...]:
        """Where it, and what it is made of, are published."""
        return (*(() if self.source is None else (self.source,)), *self.further_sources)

    @property
    def example(self) -> dict[str, Any]:
        """What a description may have of it: all numbers."""
        numbers = {number.name: number.example for number in self.numbers}
        return {"upward": numbers, "downward": numbers} if self.by_direction else numbers


def _read(row: Mapping[str, Any]) -> LawRow:
    fields = {key: row[key] for key in LawRow._fields if key in row}
    alternatives = tuple((where["outdoors"], dict(where["numbers"])) for where in row["alternatives"])
    rows = {
        "numbers": tuple(map(_number, row["numbers"])),
        "choices": tuple(
            LawChoice(**choice | {"among": tuple(choice["among"])}) for choice in row["choices"]
        ),
        "alternatives": alternatives,
    }
    return LawRow(**{key: tuple(v) if isinstance(v, list) else v for key, v in fields.items()} | rows)


def _number(row: Mapping[str, Any]) -> LawNumber:
    ((spread, words),) = row["range"].items()
    quantity = Quantity(
        row["unit"],
        row["meaning"],
        {"percent": Percent, "within": Within, "span": Span}[spread](*words),
        Limits(**row["limits"]),
        dict(row["words"]),
    )
    default, follows, assumed, tabulated, reason = None, "", None, (), ""
    match row["default"]:
        case {"value": [value, reason]}:
            default = Number(value, source=Remark(reason))
        case {"published": [value, source]}:
            default = Number(value, source=source)
        case {"tabulated": [values, reason]}:
            follows, tabulated = "choices", tuple(values)
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
        tabulated,
        reason,
        row["outdoors"],
        row["wind"],
        row["of"],
        row["example"],
    )


_FAMILIES: Final = {
    family: {row.kind: row for row in map(_read, rows)}
    for family, rows in json.loads(_engine.law_table()).items()
}

CONVECTION: Final[Mapping[str, LawRow]] = _FAMILIES["convection"]
"""Every published law of convection, by its kind."""

SKY: Final[Mapping[str, LawRow]] = _FAMILIES["sky"]
"""Every published model of the emission of the sky, by its kind."""

DIFFUSE: Final[Mapping[str, LawRow]] = _FAMILIES["diffuse"]
"""Every published model of the diffuse radiation of the sky, by its kind."""

LEAKAGE: Final[Mapping[str, LawRow]] = _FAMILIES["leakage"]
"""Every published law of infiltration by a pressure test, by its kind."""

IMPOSED: Final[Mapping[str, LawRow]] = _FAMILIES["imposed"]
"""Every law of a temperature that surroundings impose, by its kind."""

SORPTION: Final[Mapping[str, LawRow]] = _FAMILIES["sorption"]
"""Every published law of sorption, by its kind."""

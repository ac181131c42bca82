"""Surface heat transfer coefficients: the published laws of the engine's table, measured ones, formulas.

Each law of the table (`mascarin.building.base.law_table`) is a class here: `Constant`, `Tarp`
and so on.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Annotated, Any, Final, Literal, TypeGuard

from pydantic import Field, create_model

from mascarin.building.base.law_classes import PublishedLaw, example_of, union_of
from mascarin.building.base.law_table import CONVECTION as ROWS
from mascarin.building.base.law_table import LawNumber, LawRow
from mascarin.building.base.number import Number, Remark
from mascarin.building.base.part import Part
from mascarin.building.parts.envelope.formula_law import FormulaLaw
from mascarin.building.parts.envelope.published_laws import LawShorthand


class ConvectionLaw(PublishedLaw):
    """A published law of convection with its numbers."""

    if TYPE_CHECKING:

        def __init__(self, **numbers: Any) -> None: ...

    def values(self, *, wind: bool | None = None) -> Iterator[tuple[str, LawNumber, Number]]:
        """Numbers that it has: key below the law, what it is, value.

        Parameters
        ----------
        wind : bool, optional
            Only numbers that have an effect with wind alone, or only the others.
        """
        groups = ("upward", "downward") if self.row.by_direction else ("",)
        for group in groups:
            part = getattr(self, group) if group else self
            for number in self.row.numbers:
                value = getattr(part, number.name)
                if value is not None and wind in (None, number.wind):
                    yield f"{group}.{number.name}" if group else number.name, number, value

    @property
    def windy(self) -> bool:
        """Whether it depends on the wind with its numbers."""
        owners = {number.of for number in self.row.numbers if number.wind}
        gains = [value for _, number, value in self.values(wind=True) if number.name in owners]
        return self.row.wind and (not gains or any(gain > 0.0 for gain in gains))


def _example(row: LawRow) -> str:
    """Section of a docstring with an example that can be run."""
    name = row.class_name
    if not row.by_direction:
        return example_of(row, name)
    arguments = ", ".join(f'{way}={{"{row.numbers[0].name}": {row.numbers[0].example:g}}}' for way in _WAYS)
    shown = ", ".join(f"{way}={name}Law" for way in _WAYS)
    return f"Examples\n--------\n>>> {name}({arguments})\n{name}({shown})"


_WAYS: Final = {"upward": "Heat flows up, or the surface is vertical", "downward": "Heat flows down"}


def _class_of(row: LawRow) -> dict[str, type[Part]]:
    """The class of a law, and that of its numbers where it has them by direction."""
    fields: dict[str, Any] = {number.name: number.field for number in row.numbers}
    classes: dict[str, type[Part]] = {}
    if row.by_direction:
        name = f"{row.class_name}Law"
        number = row.numbers[0]
        example = f">>> {name}({number.name}={number.example:g}).{number.name}\n{float(number.example)}"
        text = f"{row.meaning.replace('each', 'one')}\n\nExamples\n--------\n{example}"
        classes[name] = create_model(name, __base__=Part, __module__=__name__, __doc__=text, **fields)
        fields = {way: (classes[name], Field(description=words)) for way, words in _WAYS.items()}
    name = row.class_name
    law = create_model(
        name,
        __base__=ConvectionLaw,
        __module__=__name__,
        __doc__=f"{row.meaning}\n\n{_example(row)}",
        **{"kind": (Literal[row.kind], row.kind), **fields},
    )
    law.row = row
    return classes | {name: law}


CLASSES: Final[Mapping[str, type[Part]]] = {
    name: law for row in ROWS.values() for name, law in _class_of(row).items()
}
"""Classes of all laws of the table by their names."""
globals().update(CLASSES)

if TYPE_CHECKING:

    def __getattr__(name: str) -> Any: ...


#: Factor on a measurement.
_FACTOR: Final = ROWS["alamdari_hammond"].number("factor").quantity


class Measured(Part):
    """A surface heat transfer coefficient from a measured column [W/(m2 K)], times a factor.

    Examples
    --------
    >>> Measured(column="h_wall")
    Measured(column=h_wall, factor=1)
    """

    kind: Literal["measured"] = "measured"
    column: str = Field(description="Name of a measured column [W/(m2 K)], not below 0")
    factor: Annotated[Number, _FACTOR] = Number(1.0, source=Remark("the measurement without a correction"))


if TYPE_CHECKING:
    Convection = ConvectionLaw | Measured | FormulaLaw
else:
    _LAWS = [law for law in CLASSES.values() if issubclass(law, ConvectionLaw)]
    _LAWS.sort(key=lambda law: law.row.kind != "constant")
    Convection = Annotated[
        union_of([*_LAWS, Measured, FormulaLaw]),
        Field(discriminator="kind"),
        LawShorthand(
            word="kind",
            number="coefficient",
            kind="constant",
            implied=("formula", "text"),
            kinds=(*(law.row.kind for law in _LAWS), "measured", "text"),
        ),
    ]


def measured_column(convection: Convection | None) -> str | None:
    """Column of a measured coefficient; None for any other."""
    return convection.column if isinstance(convection, Measured) else None


def is_law(convection: Convection | None, kind: str) -> TypeGuard[ConvectionLaw]:
    """Whether a coefficient is a published law of a kind."""
    return isinstance(convection, ConvectionLaw) and convection.kind == kind


def by_wind_direction(convection: Convection | None) -> bool:
    """Whether a coefficient depends on the direction of the wind."""
    if isinstance(convection, FormulaLaw):
        return convection.uses("windward") or convection.uses("wind_angle")
    return isinstance(convection, ConvectionLaw) and convection.row.wind_direction


#: Description of the fields that hold a coefficient.
CONVECTION = "Surface heat transfer coefficient: a number [W/(m2 K)], or a correlation"

#: Sources of the correlations.
SOURCES: Final = {kind: row.sources for kind, row in ROWS.items() if row.sources}

"""Classes of published laws, made from the rows of the engine's tables."""

from __future__ import annotations

import functools
import operator
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Literal, TypeVar

from pydantic import Field, create_model, model_validator

from mascarin.building.base.law_table import LawRow
from mascarin.building.base.number import Number, Remark
from mascarin.building.base.part import Part


class PublishedLaw(Part):
    """A published law with its numbers."""

    #: What the engine says of it.
    row: ClassVar[LawRow]

    if TYPE_CHECKING:
        kind: str

        def __init__(self, **numbers: Any) -> None: ...

        def __getattr__(self, name: str) -> Any: ...

    @model_validator(mode="after")
    def _from_tables(self) -> PublishedLaw:
        """Take numbers that are not given from the table of the choices."""
        position = 0
        for choice in self.row.choices:
            position = position * len(choice.among) + choice.among.index(getattr(self, choice.name))
        for number in self.row.numbers:
            if number.tabulated and getattr(self, number.name) is None:
                value, source = number.tabulated[position], Remark(number.reason)
                derived = Number(value, source=source, derived=True, quantity=number.quantity)
                self._fill(**{number.name: derived})
        return self


Law = TypeVar("Law", bound=PublishedLaw)


def example_of(row: LawRow, name: str, common: Mapping[str, float] | None = None) -> str:
    """Section of a docstring with an example that can be run.

    Parameters
    ----------
    row : LawRow
        The law.
    name : str
        Name of the class.
    common : mapping, optional
        Numbers that the class has beside those of the law, and has to be given.
    """
    stated = {number.name: f"{number.example:g}" for number in row.numbers if number.required}
    stated |= {choice.name: str(choice.default) for choice in row.choices}
    stated |= {key: f"{value:g}" for key, value in (common or {}).items()}
    call = f"{name}({', '.join(f'{key}={value}' for key, value in stated.items())})"
    required = next((number for number in row.numbers if number.required), None)
    if required is None:
        return f"Examples\n--------\n>>> {call}.kind\n'{row.kind}'"
    return f"Examples\n--------\n>>> float({call}.{required.name})\n{float(required.example)}"


def classes_of(
    rows: Iterable[LawRow],
    base: type[Law],
    name: str,
    *,
    common: Mapping[str, Any] | None = None,
    examples: Mapping[str, float] | None = None,
) -> dict[str, type[Law]]:
    """Make the classes of the laws of a table.

    Parameters
    ----------
    rows : iterable of LawRow
        The laws.
    base : type
        What all of them are.
    name : str
        Name of a class, with ``{}`` for that of the law.
    common : mapping, optional
        Types and defaults of further fields.
    examples : mapping, optional
        Values of those that have to be given, for the docstring.

    Returns
    -------
    dict
        Classes by their names.
    """
    classes: dict[str, type[Law]] = {}
    for row in rows:
        title = name.format(row.class_name)
        fields: dict[str, Any] = {"kind": (Literal[row.kind], row.kind)}
        numbers = {number.name: number for number in row.numbers}
        fields |= {key: number.field_without_sides for key, number in numbers.items() if not number.tabulated}
        for choice in row.choices:
            fields[choice.name] = (Literal[choice.among], Field(choice.default, description=choice.meaning))
        fields |= {key: number.field_without_sides for key, number in numbers.items() if number.tabulated}
        text = "\n\n".join(filter(None, (row.meaning, row.details, example_of(row, title, examples))))
        law = create_model(
            title, __base__=base, __module__=base.__module__, __doc__=text, **fields, **(common or {})
        )
        law.row = row
        classes[title] = law
    return classes


def union_of(classes: Iterable[Any]) -> Any:
    """Any of some classes, as a type."""
    return functools.reduce(operator.or_, classes)

"""Published laws of convection that are written as text: a key of a description becomes its formula.

The laws stand in ``published_laws.yaml``. A new one is a section of that file and nothing else: runs,
derivatives, ensembles, calibrations and FMUs read its formula as that of a user.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any, Final

from pydantic import GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import core_schema

from mascarin.building.base.number import problem, shown
from mascarin.building.base.part import Shorthand
from mascarin.building.files.yaml_document import plain
from mascarin.building.parts.envelope.formula_law import LENGTH, PERIMETER
from mascarin.building.parts.materials.formula import names_in
from mascarin.errors import did_you_mean

FILE: Final = "published_laws.yaml"


@dataclass(frozen=True)
class PublishedLaw:
    """A law of a paper.

    Parameters
    ----------
    key : str
        In descriptions.
    title, meaning, range, source : str
        Its name, what it is of, where it holds, and where it is published.
    formula : str
        The coefficient. [W/(m2 K)]
    numbers : dict
        Its numbers as in a description.
    """

    key: str
    title: str
    meaning: str
    range: str
    source: str
    formula: str
    numbers: dict[str, Any]

    def described(self, stated: Mapping[str, Any]) -> dict[str, Any]:
        """Write it as a law as text, with numbers of a description in place of its own."""
        of_shape = [name for name in (LENGTH, PERIMETER) if name in names_in(self.formula)]
        for name in stated:
            if name not in self.numbers and name not in of_shape:
                raise problem(
                    f"{name}: {shown(stated[name])}",
                    f"one of {', '.join((*self.numbers, *of_shape))}",
                    f"These are the numbers of {self.key}.",
                )
        numbers = dict(self.numbers)
        for name, value in stated.items():
            notes = dict(value) if isinstance(value, Mapping) else {"value": value}
            # The range of the law is about its own value.
            limits = {key: ends for key, ends in self.numbers.get(name, {}).items() if key == "limits"}
            numbers[name] = limits | notes
        return {"kind": "text", "formula": self.formula, "source": self.source, "numbers": numbers}


@cache
def published_laws() -> dict[str, PublishedLaw]:
    """All of them by key.

    Examples
    --------
    >>> published_laws()["awbi_hatton"].range
    '5 to 40 K, surfaces of 1 to 9 m2'
    """
    text = files(__package__).joinpath(FILE).read_text(encoding="utf-8")
    return {key: PublishedLaw(key, **law) for key, law in plain(text, FILE).items()}


@dataclass(frozen=True)
class LawShorthand(Shorthand):
    """Short forms of a coefficient: a number, a word, a formula, or the key of a published law.

    Parameters
    ----------
    kinds : tuple of str
        Kinds of all other laws.
    """

    kinds: tuple[str, ...] = ()

    def expand(self, raw: Any) -> Any:
        """The whole mapping."""
        law = super().expand(raw)
        if not isinstance(law, Mapping) or not isinstance(law.get("kind"), str):
            return law
        kind = law["kind"]
        if kind in self.kinds:
            return law
        published = published_laws().get(kind)
        if published is None:
            kinds = (*self.kinds, *published_laws())
            raise problem(f"kind: {kind}", f"one of {', '.join(kinds)}", did_you_mean(kind, kinds))
        return published.described({key: value for key, value in law.items() if key != "kind"})

    def __get_pydantic_json_schema__(
        self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Allow published laws beside the others."""
        laws = published_laws()
        titles = "; ".join(f"{key}: {law.title}" for key, law in laws.items())
        kind = {"enum": list(laws), "description": f"A published law that is text. {titles}"}
        keys = {"type": "object", "required": ["kind"], "properties": {"kind": kind}}
        short = super().__get_pydantic_json_schema__(schema, handler)
        return {"anyOf": [*short["anyOf"], keys]}

"""Laws and outputs of a building that are written as text."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from mascarin.building.checks.formula_sides import formula_sides
from mascarin.building.parameters.text_laws import text_laws
from mascarin.building.parts.materials.formula import stated_unit
from mascarin.building.parts.materials.formula_curve import FormulaCurve
from mascarin.figures import text

if TYPE_CHECKING:
    from mascarin.building import Building


def formulas(building: Building) -> list[dict[str, Any]]:
    """Rows of the table of formulas.

    Parameters
    ----------
    building : Building
        The building.

    Returns
    -------
    list of dict
        The paths with the same formula and the same numbers, the formula, its numbers with units and ranges,
        where it is valid, and its source.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> formulas(box())
    []
    """
    rows: dict[tuple[str, ...], list[str]] = {}
    for path, law in _laws(building):
        numbers = "; ".join(_number(name, number) for name, number in law.numbers.items())
        valid = str(getattr(law, "valid", None) or "")
        row = (law.formula, numbers, valid, str(getattr(law, "source", None) or ""))
        rows.setdefault(row, []).append(path)
    names = ("formula", "numbers", "valid", "source")
    return [{"paths": paths, **dict(zip(names, row, strict=True))} for row, paths in rows.items()]


def _laws(building: Building) -> Iterator[tuple[str, Any]]:
    yield from ((side.path, side.law) for side in formula_sides(building))
    yield from text_laws(building)
    for name, material in building.materials.items():
        if isinstance(curve := getattr(material, "law", None), FormulaCurve):
            yield f"materials.{name}.law", curve
    yield from ((f"derived_outputs.{name}", output) for name, output in building.derived_outputs.items())


def _number(name: str, number: Any) -> str:
    """``c = 2.3 W/(m2 K), 1 to 4``."""
    words = f"{name} = {text.with_unit(float(number), stated_unit(number) or '-')}"
    if number.range is None:
        return words
    low, high = (text.significant(float(end)) for end in number.range)
    return f"{words}, {low} to {high}"

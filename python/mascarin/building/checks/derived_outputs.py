"""Whether derived outputs follow from outputs, without a loop."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from mascarin import _engine
from mascarin.building.base.part import fault, text_fault
from mascarin.building.outputs.output import outputs
from mascarin.building.parts.materials.formula import stated_unit
from mascarin.errors import did_you_mean

if TYPE_CHECKING:
    from mascarin.building.parts.derived_output import Derived
    from mascarin.building.parts.description import Description

Units = tuple[tuple[str, str], ...]


def derived_faults(building: Description) -> Iterator[Any]:
    """What is wrong with the derived outputs of a building."""
    if not building.derived_outputs:
        return
    all_outputs = outputs(building)
    units = {output.name: output.unit for output in all_outputs if output.derived is None}
    aliases = {alias: output.name for output in all_outputs for alias in output.aliases}
    looped = set(_in_loops(building.derived_outputs))
    for name, output in building.derived_outputs.items():
        path = ("derived_outputs", name)
        if name in units:
            yield fault(
                path, f"the name '{name}'", "a name that no other output has", "Give it another name."
            )
        if name in looped:
            loop = _loop(building.derived_outputs, name)
            words = [
                f"a loop of derived outputs: {' -> '.join(loop)}",
                "outputs that need no others of the loop",
                "Write one of them by outputs of the building.",
            ]
            yield text_fault((*path, "formula"), words, _position(output.formula, loop[1]))
        else:
            yield from _text_faults(path, output, building.derived_outputs, units, aliases)


def _position(formula: str, name: str) -> tuple[int, int]:
    """Line and column of a name in a formula."""
    match = re.search(rf"(?<![\w.]){re.escape(name)}(?![\w.])", formula)
    before = formula[: match.start()] if match else ""
    return before.count("\n") + 1, len(before) - before.rfind("\n")


def _text_faults(
    path: tuple[str, ...],
    output: Derived,
    derived: Mapping[str, Derived],
    units: Mapping[str, str],
    aliases: Mapping[str, str],
) -> Iterator[Any]:
    units_by_name: list[tuple[str, str]] = []
    absent: list[tuple[str, str]] = []
    for word in output.used:
        if word in units:
            units_by_name.append((word, units[word]))
        elif word in derived:
            units_by_name.append((word, "any" if derived[word].unit == "-" else derived[word].unit))
        elif word in aliases:
            absent.append((word, f"Write {aliases[word]}."))
        elif "." in word or word not in output.numbers:
            hint = did_you_mean(word, [*units, *derived])
            absent.append((word, hint or "'mascarin outputs' lists the outputs of a building."))
    numbers = tuple(
        (name, float(number), number.range, stated_unit(number)) for name, number in output.numbers.items()
    )
    problem = _checked(
        output.formula,
        tuple(units_by_name),
        numbers,
        None if output.unit == "-" else output.unit,
        tuple(absent),
    )
    if problem is not None:
        key, line, column, *words = problem
        yield text_fault((*path, key), words, (line, column) if key == "formula" else None)


@lru_cache(maxsize=512)
def _checked(
    formula: str, units_by_name: Units, numbers: tuple[Any, ...], unit: str | None, absent: Units
) -> tuple[str, int, int, str, str, str] | None:
    return _engine.check_derived(formula, list(units_by_name), list(numbers), unit, list(absent))


def _in_loops(derived: Mapping[str, Derived]) -> Iterator[str]:
    """Names of derived outputs that need themselves."""
    for name in derived:
        if _loop(derived, name):
            yield name


def _loop(derived: Mapping[str, Derived], name: str) -> tuple[str, ...]:
    """The shortest way from a derived output back to itself; empty where there is none."""
    ways: list[tuple[str, ...]] = [(name,)]
    visited = set()
    while ways:
        longer = []
        for way in ways:
            for word in derived[way[-1]].used:
                if word == name:
                    return (*way, name)
                if word in derived and word not in visited:
                    visited.add(word)
                    longer.append((*way, word))
        ways = longer
    return ()

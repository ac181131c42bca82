"""Laws written as text: values that make them no laws, and runs in which they do not hold."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from mascarin.building.checks.formula_sides import formula_sides
from mascarin.building.parameters.text_laws import text_laws
from mascarin.errors import InputError
from mascarin.simulation.checks.warning_kinds import RunWarning, WarningKind

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building

    Array = npt.NDArray[np.float64]


def require_laws(building: Building, vectors: Array, *, positions: Mapping[str, int]) -> None:
    """Refuse values of numbers with which a law is none; within their ranges it was checked before.

    Parameters
    ----------
    building : Building
        The building.
    vectors : ndarray, shape (M, P)
        Parameter vectors. [unit of each]
    positions : mapping of str to int
        Position of each parameter in a vector.

    Raises
    ------
    InputError
        Naming the law, the member, and the point at which it is no law.
    """
    _require_text_laws(building, vectors, positions)
    for side in formula_sides(building):
        names = list(side.law.numbers)
        columns = [positions[f"{side.path}.{name}"] for name in names]
        values = vectors[:, columns]
        ends = [side.law.numbers[name].range or (float(side.law.numbers[name]),) * 2 for name in names]
        low, high = np.array(ends, dtype=np.float64).reshape(-1, 2).T
        for member in np.flatnonzero(((values < low) | (values > high)).any(axis=1)):
            changed = replace(side, law=side.law.at_values(dict(zip(names, values[member], strict=True))))
            for fault in changed.faults():
                context = fault["type"].context or {}
                whose = f" (member {member})" if len(vectors) > 1 else ""
                raise InputError(
                    f"{side.path}: found {context['found']}{whose}, with "
                    f"{', '.join(f'{name} = {x:g}' for name, x in zip(names, values[member], strict=True))}; "
                    f"expected {context['expected']}. Take other values of its numbers"
                )


def _require_text_laws(building: Building, vectors: Array, positions: Mapping[str, int]) -> None:
    """The same for conductivities, infiltration and the sky."""
    for path, law in text_laws(building):
        names = list(law.numbers)
        values = vectors[:, [positions[f"{path}.{name}"] for name in names]]
        ends = [law.numbers[name].range or (float(law.numbers[name]),) * 2 for name in names]
        low, high = np.array(ends, dtype=np.float64).reshape(-1, 2).T
        for member in np.flatnonzero(((values < low) | (values > high)).any(axis=1)):
            for fault in law.at_values(dict(zip(names, values[member], strict=True))):
                context = fault["type"].context or {}  # type: ignore[union-attr]
                whose = f" (member {member})" if len(vectors) > 1 else ""
                numbers = ", ".join(f"{name} = {x:g}" for name, x in zip(names, values[member], strict=True))
                raise InputError(
                    f"{path}: found {context['found']}{whose}, with {numbers}; expected "
                    f"{context['expected']}. Take other values of its numbers"
                )


def range_warnings(raw: Mapping[str, Any], dated: Callable[[str], str]) -> list[str]:
    """One line for each law that was used where it does not hold.

    Parameters
    ----------
    raw : mapping
        What the engine returns of a run: ``out_of_range`` has for each law what has it, what it is a law of,
        the number of steps, the first of them, and for each name that its ``valid`` depends on its unit and
        its least and largest value at the ends of these steps.
    dated : callable
        Adds the time to a text that names a step.

    Returns
    -------
    list of str
        The warnings.

    Examples
    --------
    >>> law = ("zone room", "infiltration", 3, 40, [("dT", "K", 30.2, 31.5)])
    >>> range_warnings({"out_of_range": [law]}, str)[0][:62]
    "zone room: its law of infiltration is outside of its 'valid' a"
    """
    return [
        f"{owner}: its law of {law} is outside of its 'valid' at the end of {steps} "
        f"{'step' if steps == 1 else 'steps'}, first in {dated(f'step {first}')}, with "
        f"{', '.join(map(_extent, values))}. The formula is used as it is there: "
        "take a law that holds, or widen 'valid' where its source does"
        for owner, law, steps, first, values in raw["out_of_range"]
    ]


def member_range_warnings(beyond: Array, first: int = 0) -> list[RunWarning]:
    """One line for the members of an ensemble in which a law was used where it does not hold.

    Parameters
    ----------
    beyond : ndarray, shape (members,)
        Steps at whose end a law did not hold, of the law that holds least often; NaN for a member that
        failed.
    first : int
        Number of the first member.

    Examples
    --------
    >>> member_range_warnings(np.array([0.0, np.nan, 7.0]))[0][:70]
    "1 of 3 members: a law written as text is outside of its 'valid' at the"
    """
    members = np.flatnonzero(beyond > 0.0)
    if not members.size:
        return []
    worst = int(np.nanargmax(beyond))
    steps = int(beyond[worst])
    text = (
        f"{members.size} of {len(beyond)} members: a law written as text is outside of its 'valid' at the "
        f"end of up to {steps} {'step' if steps == 1 else 'steps'} (member {first + worst}). The formula is "
        "used as it is there: run this member alone, which names the law and the values"
    )
    return [RunWarning(text, WarningKind.VALIDITY)]


def _extent(value: tuple[str, str, float, float]) -> str:
    """A name with its values; one where they do not differ."""
    name, unit, least, most = value
    shown = "" if unit == "-" else f" {unit}"
    if f"{least:.1f}" == f"{most:.1f}":
        return f"{name} = {least:.1f}{shown}"
    return f"{name} from {least:.1f} to {most:.1f}{shown}"

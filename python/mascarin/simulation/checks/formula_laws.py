"""Laws written as text: values that make them no laws, and runs in which they do not hold."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from mascarin.building.checks.formula_sides import formula_sides
from mascarin.building.parameters.text_laws import text_laws
from mascarin.errors import InputError

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
        What the engine returns of a run: ``out_of_range`` has for each law the surface, the number of steps,
        the first of them, and in the worst one the difference of surface and air [K] and the wind at the
        mast [m/s].
    dated : callable
        Adds the time to a text that names a step.

    Returns
    -------
    list of str
        The warnings.

    Examples
    --------
    >>> range_warnings({"out_of_range": [("roof (outside)", 3, 40, 31.5, 2.0)]}, str)[0][:62]
    "roof (outside): its law of convection is outside of its 'valid"
    """
    return [
        f"{surface}: its law of convection is outside of its 'valid' at the end of {steps} "
        f"{'step' if steps == 1 else 'steps'}, first in {dated(f'step {first}')}; farthest at dT = "
        f"{difference:.1f} K with a wind of {wind:.1f} m/s at the mast. The formula is used as it is there: "
        "take a law that holds, or widen 'valid' where its source does"
        for surface, steps, first, difference, wind in raw["out_of_range"]
    ]

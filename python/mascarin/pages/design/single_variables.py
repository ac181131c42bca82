"""One variable at a time: what each option brings beside the reference, the others as in the best design."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from mascarin._io import units
from mascarin.design.variants.results import ALL
from mascarin.figures import text
from mascarin.pages.design import charts

if TYPE_CHECKING:
    from mascarin.design.variants.results import DesignResults
    from mascarin.design.variants.variables import Choice


def single_variables(results: DesignResults, reference: float) -> dict[str, Any] | None:
    """Each variable by itself, with the building as described and the mean of the climates.

    Parameters
    ----------
    results : DesignResults
        The results.
    reference : float
        The objective of the ranking for the reference; NaN where it has none. [unit of the objective]

    Returns
    -------
    dict or None
        None where no two designs differ in one variable alone from the best one.
    """
    tables = [
        table
        for position, choice in enumerate(results.inputs.choices.all)
        if (table := _table(results, position, choice, reference)) is not None
    ]
    if not tables:
        return None
    unit = units.shown(results.inputs.objective(results.ranked_by).unit)
    return {
        "tables": tables,
        "objective": f"{results.ranked_by}, {unit}" if unit else results.ranked_by,
        "unit": unit,
        "reference": text.significant(reference, 4) if np.isfinite(reference) else "",
        "best": results.label(results.best[results.rankings[ALL].order[0]]),
    }


def _table(results: DesignResults, position: int, choice: Choice, reference: float) -> dict[str, Any] | None:
    """The options of one variable that were run with the others as in the best design."""
    best = results.designs[results.best[results.rankings[ALL].order[0]]]
    same = [
        (design[position], number)
        for number, design in enumerate(results.designs)
        if design[:position] + design[position + 1 :] == best[:position] + best[position + 1 :]
    ]
    if len(same) < 2:
        return None
    objective = results.inputs.objective(results.ranked_by)
    values = results.values(results.ranked_by)
    free = results.inputs.choices.free
    rows = []
    for chosen, number in sorted(same):
        value = float(values[number])
        change = value - reference
        rows.append(
            {
                "label": choice.option(chosen, free=free).label,
                "value": text.significant(value, 4),
                "change": _signed(change),
                "percent": _percent(change, reference),
                "verdict": _verdict(change, reference, least=objective.least),
                "best": chosen == best[position],
            }
        )
    labels = [row["label"] for row in rows]
    numbers = np.array([values[number] for _, number in sorted(same)], dtype=np.float64)
    unit = units.shown(objective.unit)
    title = with_unit_of(choice) if _numeric(choice) else choice.name
    name = results.ranked_by
    axis = f"{name}, {unit}" if unit else name
    return {
        "title": title,
        "rows": rows,
        "drawing": charts.beside_reference(numbers, labels, reference, axis, f"{name} by {title}"),
    }


def with_unit_of(choice: Choice) -> str:
    """Name of a variable with the unit of its numbers; a share or a factor has none."""
    unit = units.shown(choice.unit) if choice.unit else ""
    return f"{choice.name}, {unit}" if unit else choice.name


def _numeric(choice: Choice) -> bool:
    """Whether the options are numbers with a unit; products are named."""
    return bool(choice.unit) and not choice.structural


def _signed(change: float) -> str:
    return f"{'+' if change > 0.0 else ''}{text.significant(change)}"


def _percent(change: float, reference: float) -> str:
    if not np.isfinite(change) or not reference:
        return text.NONE
    return f"{text.fixed(100.0 * change / abs(reference), 1, sign=True)}"


def _verdict(change: float, reference: float, *, least: bool) -> str:
    """Better or worse than the reference; nothing without one."""
    if not np.isfinite(change):
        return ""
    if abs(change) <= 1e-9 * abs(reference):
        return "same"
    return "better" if (change < 0.0) == least else "worse"

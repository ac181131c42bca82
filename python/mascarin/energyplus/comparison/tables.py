"""A comparison as lines for the terminal, as JSON, and as rows of a page."""

from __future__ import annotations

import calendar
from typing import Any, Final

from mascarin.energyplus.comparison.compared import ComparedRow, ComparedSpan, Comparison

#: Zones of one quantity on the terminal; the others are in JSON and on the page.
_ZONES: Final = 8
_UNITS: Final = {"air": "K", "heating": "%", "cooling": "%", "sun": "%"}
NAMES: Final = {
    "air": "Air temperature",
    "heating": "Heating",
    "cooling": "Cooling",
    "sun": "Sun through windows",
}


def header(comparison: Comparison) -> list[str]:
    """Names of the columns of `cells`."""
    months = comparison.rows[0].months if comparison.rows else ()
    return ["zone", "", "period", *(calendar.month_abbr[span.month] for span in months)]


def cells(row: ComparedRow) -> list[list[str]]:
    """Lines of a row: rms and bias of temperatures; heat of both programs, and their difference."""
    spans = [row.period, *row.months]
    if row.quantity == "air":
        return [
            [row.zone, "rms, K", *(f"{span.rms:.2f}" for span in spans)],
            ["", "bias, K", *(f"{span.bias:+.2f}" for span in spans)],
        ]
    return [
        [row.zone, "Mascarin, kWh", *(f"{span.ours:.1f}" for span in spans)],
        ["", "EnergyPlus, kWh", *(f"{span.theirs:.1f}" for span in spans)],
        ["", "difference, %", *(_percent(span) for span in spans)],
        ["", "rms, W", *(f"{span.rms:.1f}" for span in spans)],
        ["", "bias, W", *(f"{span.bias:+.1f}" for span in spans)],
    ]


def _percent(span: ComparedSpan) -> str:
    return "-" if span.percent is None else f"{span.percent:+.1f}"


def tables(comparison: Comparison, *, most: int = _ZONES) -> list[tuple[str, list[list[str]], int]]:
    """For each quantity its name, lines of cells, and how many zones are not shown.

    Parameters
    ----------
    comparison : Comparison
        From `compare`.
    most : int
        Number of rows of one quantity.
    """
    parts = []
    for quantity, name in NAMES.items():
        rows = [row for row in comparison.rows if row.quantity == quantity]
        if rows:
            lines = [line for row in rows[:most] for line in cells(row)]
            parts.append((name, lines, max(len(rows) - most, 0)))
    return parts


def comparison_report(comparison: Comparison) -> dict[str, Any]:
    """A comparison as JSON.

    Parameters
    ----------
    comparison : Comparison
        From `compare`.

    Returns
    -------
    dict
        Rows by zone and quantity with their months, causes and notes.
    """
    return {
        "folder": str(comparison.run.folder),
        "version": comparison.run.version,
        "rows": [
            {
                "zone": row.zone,
                "quantity": row.quantity,
                "unit": _UNITS[row.quantity],
                "period": _as_json(row.period, row.quantity),
                "months": [_as_json(span, row.quantity) for span in row.months],
            }
            for row in comparison.rows
        ],
        "causes": list(comparison.causes),
        "notes": list(comparison.notes),
    }


def _as_json(span: ComparedSpan, quantity: str) -> dict[str, Any]:
    sizes = {"rms": span.rms, "bias": span.bias, "here": span.ours, "energyplus": span.theirs}
    month = {"month": span.month} if span.month else {}
    percent = {} if quantity == "air" else {"percent": span.percent}
    return month | {key: round(value, 4) for key, value in sizes.items()} | percent

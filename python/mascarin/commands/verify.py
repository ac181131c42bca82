"""The command that verifies the simulation against analytical solutions."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated

from mascarin.commands.options.inputs import AsJson, Flag
from mascarin.commands.options.output import number, print_json, print_table

if TYPE_CHECKING:
    from mascarin.verification.analytical import Check


def verify(*, pcm: Annotated[bool, Flag] = False, as_json: AsJson = False) -> int:
    """Verify against analytical solutions.

    Exact solutions of conduction, phase change, zones, radiation and solar position, each simulated from the
    building description on; further the order of the time scheme, the energy balance and identical results
    of ensembles. Exits with 1 if a number is outside its bounds. docs/verification.md describes each case and
    the source of its bounds.

    Parameters
    ----------
    pcm : bool
        The cases of phase change: fronts, surface heat transfer coefficients, melting ranges, cycles, large
        time steps.

    Returns
    -------
    int
        0, or 1 if a number is outside its bounds.
    """
    from mascarin.progress import Progress
    from mascarin.verification.analytical import run

    with Progress("cases") as progress:
        rows = run("pcm" if pcm else "building", progress)
    if as_json:
        print_json([row.to_dict() for row in rows])
    else:
        print_table(("case", "quantity", "unit", "value", "expected", "min", "max", ""), _lines(rows))
    failed = sum(not row.passed for row in rows)
    held = sum(not row.informs for row in rows)
    print(f"{held - failed} of {held} numbers within their bounds", file=sys.stderr)
    return 1 if failed else 0


def _lines(rows: Sequence[Check]) -> list[tuple[str, ...]]:
    def cell(value: float | None) -> str:
        return "" if value is None else number(float(value))

    return [
        (
            row.name,
            row.quantity,
            row.unit,
            cell(row.value),
            cell(row.expected),
            cell(row.low),
            cell(row.high),
            _word(row),
        )
        for row in rows
    ]


def _word(row: Check) -> str:
    if row.informs:
        return "shown"
    return "passed" if row.passed else "FAILED"

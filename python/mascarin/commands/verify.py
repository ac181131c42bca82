"""The command that holds the simulation against closed answers."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated

from mascarin.commands.inputs import AsJson, Flag
from mascarin.commands.output import number, print_json, print_table

if TYPE_CHECKING:
    from mascarin.verification.analytical import Check


def verify(*, pcm: Annotated[bool, Flag] = False, as_json: AsJson = False) -> int:
    """Hold the simulation against closed answers.

    Exact solutions of conduction, phase change, rooms, radiation and the sun, each simulated by the whole
    chain from the description on, and the promises of this project: order, energy closure, same bits. Ends
    with 1 if any number leaves its bounds. docs/verification.md says what each case is and where its bounds
    come from.

    Parameters
    ----------
    pcm : bool
        The cases of phase change: fronts, films, mushy ranges, cycles, hard steps.

    Returns
    -------
    int
        0, or 1 if a number leaves its bounds.
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

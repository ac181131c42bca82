"""The documentation page of the cases: ``python -m mascarin.verification.analytical.page FILE``."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from mascarin.verification.analytical.catalogue import cases, run
from mascarin.verification.analytical.check import Case, Check

_HEAD: Final = """\
# Verification

Verification compares the simulation with analytical solutions: it shows that the equations are solved
correctly. Whether they are the right equations for a building is the question of validation, by measurements
(see [Calibration](calibration.md) and [Studies](studies.md)). [BESTEST](bestest.md) compares with other
programs.

`mascarin verify` simulates problems with an analytical solution and compares the numbers; `mascarin verify
--pcm` does so for phase change. Each takes seconds and prints a table as below. The exit code is 1 if a
number is outside its bounds. `--json` prints the same rows for programs, as a list of objects with `name`,
`quantity`, `unit`, `value`, `min`, `max`, `expected` and `passed`.

Every case is simulated like the building of a user: YAML, model, climate from a table, engine, results. The
expected values are computed from the analytical solution when the command runs; only published numbers are
fixed. The bounds follow from the discretization or from requirements of this project; the reason is given
with each case. A row without bounds is for information only.
"""


def sentence(check: Check) -> str:
    """Say in a word whether a row is within its bounds."""
    if check.informs:
        return "shown"
    return "passed" if check.passed else "FAILED"


def section(case: Case) -> str:
    """Describe a case in Markdown."""
    return (
        f"### {case.name}\n\n{case.problem}\n\n"
        f"- **Solution:** {case.answer}\n- **Source:** {case.source}\n- **Bounds:** {case.tolerance}\n"
    )


def table(rows: Sequence[Check]) -> str:
    """Write rows as a Markdown table."""

    def cell(value: float | None) -> str:
        return "" if value is None else f"{value:.6g}"

    names = ("case", "quantity", "unit", "value", "expected", "min", "max", "result")
    head = f"| {' | '.join(names)} |\n|{'---|' * len(names)}\n"
    lines = [
        f"| {row.name} | {row.quantity} | {row.unit} | {cell(row.value)} | {cell(row.expected)} | "
        f"{cell(row.low)} | {cell(row.high)} | {sentence(row)} |"
        for row in rows
    ]
    return head + "\n".join(lines) + "\n"


def page() -> str:
    """Write the whole page."""
    parts = [
        _HEAD,
        "## Results of `mascarin verify`\n",
        table(run("building")),
        "## Results of `mascarin verify --pcm`\n",
        table(run("pcm")),
        "## Cases\n",
        *(section(case) for case in cases()),
    ]
    return "\n".join(parts)


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(page(), encoding="utf-8")

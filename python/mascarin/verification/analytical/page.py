"""The page that shows the cases: ``python -m mascarin.verification.analytical.page FILE``."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from mascarin.verification.analytical.catalogue import cases, run
from mascarin.verification.analytical.check import Case, Check

_HEAD: Final = """\
# Verification

`mascarin verify` simulates problems whose answer is known without Mascarin and holds the numbers against
it; `mascarin verify --pcm` does the same for phase change. Each takes seconds, ends with 1 if a number
leaves its bounds, and prints the table below; `--json` gives the same rows to programs, as a list of
objects with `name`, `quantity`, `unit`, `value`, `min`, `max`, `expected` and `passed`.

Every case goes the way a user's building goes: YAML, model, climate from a table, engine, results. What is
expected is computed from the closed form when the command runs; the only figures that are typed in are
published ones. Bounds follow from the discretisation or from what the project demands of itself, and the
reason stands with each case. A row without bounds is shown for information.
"""


def sentence(check: Check) -> str:
    """How a row ended."""
    if check.informs:
        return "shown"
    return "passed" if check.passed else "FAILED"


def section(case: Case) -> str:
    """What a case is, as Markdown."""
    return (
        f"### {case.name}\n\n{case.problem}\n\n"
        f"- **Answer:** {case.answer}\n- **Source:** {case.source}\n- **Bounds:** {case.tolerance}\n"
    )


def table(rows: Sequence[Check]) -> str:
    """Rows as a Markdown table."""

    def cell(value: float | None) -> str:
        return "" if value is None else f"{value:.6g}"

    head = "| case | quantity | unit | value | expected | min | max | |\n|---|---|---|---|---|---|---|---|\n"
    lines = [
        f"| {row.name} | {row.quantity} | {row.unit} | {cell(row.value)} | {cell(row.expected)} | "
        f"{cell(row.low)} | {cell(row.high)} | {sentence(row)} |"
        for row in rows
    ]
    return head + "\n".join(lines) + "\n"


def page() -> str:
    """The whole page."""
    parts = [
        _HEAD,
        "## What `mascarin verify` prints\n",
        table(run("building")),
        "## What `mascarin verify --pcm` prints\n",
        table(run("pcm")),
        "## The cases\n",
        *(section(case) for case in cases()),
    ]
    return "\n".join(parts)


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(page(), encoding="utf-8")

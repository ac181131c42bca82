"""The numbers of the table in the README are those of the pages that measured them."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final, NamedTuple

import pytest

ROOT: Final = Path(__file__).resolve().parents[2]
_NUMBER: Final = re.compile(r"(?<![\w.-])\d+(?:\.\d+)?(?![\w.]*\d)")
#: Rows without a page, with the reason.
WITHOUT_PAGE: Final = {"energy balance of every run": "the bound of each run, which it prints itself"}


class Row(NamedTuple):
    """What was measured, the numbers, and the page that has them."""

    what: str
    numbers: list[str]
    page: str


def rows() -> list[Row]:
    """Rows of the table in the README; `the same` is the page of the row above."""
    table, page = [], ""
    for line in (ROOT / "README.md").read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if not line.startswith("| ") or len(cells) != 3 or cells[0] == "what":
            continue
        linked = re.search(r"\]\((docs/[\w-]+\.md)", cells[2])
        page = linked[1] if linked else page if cells[2] == "the same" else ""
        table.append(Row(cells[0], _NUMBER.findall(cells[1]), page))
    return table


def close(number: str, shown: str) -> bool:
    """Whether a number of a page, in any unit of a thousand, rounds to that of the README."""
    decimals = len(number.partition(".")[2])
    return any(
        abs(float(shown) * factor - float(number)) <= 0.5 * 10.0**-decimals * (1.0 + 1e-9)
        for factor in (1.0, 1e-3)
    )


def test_the_table_is_read() -> None:
    assert len(rows()) > 7
    assert {row.what for row in rows() if not row.page} == set(WITHOUT_PAGE)
    assert close("0.045", "0.0449")
    assert close("0.045", "45")
    assert not close("0.045", "0.046")


@pytest.mark.parametrize("row", [row for row in rows() if row.page], ids=lambda row: row.what[:40])
def test_numbers_of_the_readme_are_those_of_their_page(row: Row) -> None:
    text = (ROOT / row.page).read_text(encoding="utf-8")
    measured = _NUMBER.findall(text)
    assert [number for number in row.numbers if not any(close(number, shown) for shown in measured)] == []

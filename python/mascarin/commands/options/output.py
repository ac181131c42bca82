"""Printing results: JSON for programs, tables for people."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from typing import Any

from mascarin._io.terminal import printable


def print_json(result: Any) -> None:
    """Print a result as JSON; NaN and infinity become null, as JSON has no such numbers."""
    print(json_text(result))


def json_text(result: Any) -> str:
    """A result as JSON; NaN and infinity become null."""
    return json.dumps(_finite(result), indent=2, ensure_ascii=False, allow_nan=False)


def _finite(value: Any) -> Any:
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {str(key): _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return value


def print_table(header: Sequence[str], rows: Sequence[Sequence[str | float]]) -> None:
    """Print rows as a table; numbers, also as texts, are aligned right.

    Parameters
    ----------
    header : sequence of str
        Names of the columns.
    rows : sequence of sequences
        Texts or numbers.
    """
    right = [all(_is_number(row[k]) for row in rows) for k in range(len(header))]
    cells = [list(header), *([number(cell) for cell in row] for row in rows)]
    widths = [max(len(line[k]) for line in cells) for k in range(len(header))]
    for line in cells:
        parts = [
            cell.rjust(width) if is_right else cell.ljust(width)
            for cell, width, is_right in zip(line, widths, right, strict=True)
        ]
        print("  ".join(parts).rstrip())


def _is_number(cell: str | float) -> bool:
    if not isinstance(cell, str):
        return True
    try:
        float(cell)
    except ValueError:
        return False
    return True


def number(cell: str | float) -> str:
    """Format a cell: text as a terminal shows it, numbers with six significant digits."""
    return printable(cell) if isinstance(cell, str) else f"{cell:.6g}"

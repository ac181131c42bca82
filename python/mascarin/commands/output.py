"""How a command prints a result: JSON for programs, a table or lines for people."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any


def print_json(result: Any) -> None:
    """Print a result as JSON; what is not finite becomes null, as JSON has no word for it."""
    print(json.dumps(_finite(result), indent=2, ensure_ascii=False, allow_nan=False))


def _finite(value: Any) -> Any:
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {str(key): _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return value


@contextmanager
def writing(path: Path) -> Iterator[Path]:
    """Give a file to write to that takes the name `path` only once it is whole.

    Whatever goes wrong in between leaves no half a file, and an older one as it was.
    """
    part = path.with_name(f"{path.name}.part")
    try:
        yield part
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def print_table(header: Sequence[str], rows: Sequence[Sequence[str | float]]) -> None:
    """Print rows in columns as wide as they need; numbers are aligned right.

    Parameters
    ----------
    header : sequence of str
        Names of the columns.
    rows : sequence of sequences
        Words or numbers.
    """
    right = [all(not isinstance(row[k], str) for row in rows) for k in range(len(header))]
    cells = [list(header), *([number(cell) for cell in row] for row in rows)]
    widths = [max(len(line[k]) for line in cells) for k in range(len(header))]
    for line in cells:
        parts = [
            cell.rjust(width) if is_right else cell.ljust(width)
            for cell, width, is_right in zip(line, widths, right, strict=True)
        ]
        print("  ".join(parts).rstrip())


def number(cell: str | float) -> str:
    """Cell of a table as text: six significant digits, and no more zeros than are needed."""
    return cell if isinstance(cell, str) else f"{cell:.6g}"

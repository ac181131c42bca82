"""Pages with measured tables: each stands between two comments, where the bench that made it writes it.

<!-- table: NAME -->
...
<!-- end -->
"""

from __future__ import annotations

import os
import platform
import re
from collections.abc import Iterable, Sequence
from pathlib import Path


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table in Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def conditions(days: int) -> str:
    """Machine and versions of a measurement."""
    machine = f"{platform.machine()}, {os.cpu_count()} cores"
    return f"{days} days; {machine}, load {os.getloadavg()[0]:.1f} at the end"


def filled(page: str, name: str, text: str) -> str:
    """The page with a text in the place of that name.

    Raises
    ------
    ValueError
        The page has no such place, or several.
    """
    pattern = rf"(<!-- table: {re.escape(name)} -->\n).*?(<!-- end -->)"
    page, count = re.subn(pattern, lambda found: f"{found[1]}{text}\n{found[2]}", page, flags=re.DOTALL)
    if count != 1:
        raise ValueError(f"no place for the table '{name}'")
    return page


def publish(name: str, text: str, file: Path | None) -> None:
    """Print a text, and write it into a page on demand."""
    print(text, flush=True)
    if file is not None:
        file.write_text(filled(file.read_text(encoding="utf-8"), name, text), encoding="utf-8")

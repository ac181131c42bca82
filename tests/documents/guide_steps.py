"""Steps of the guides in the documentation: what a page says that is to be written where."""

from __future__ import annotations

import re
from pathlib import Path

_STEP = re.compile(
    r"<!-- (new|before|replace|append): ([^\s:]+)(?:: (.*?))? -->\n```\w+\n(.*?)```\n", re.DOTALL
)


def applied(step: re.Match[str], root: Path) -> Path:
    """Do one step of the page in a copy of the project; the file that it changes."""
    verb, place, anchor, text = step.groups()
    file = root / place
    if verb == "new":
        assert not file.exists()
        file.write_text(text, encoding="utf-8")
        return file
    before = file.read_text(encoding="utf-8")
    if verb == "append":
        file.write_text(before + text, encoding="utf-8")
        return file
    assert anchor in before, f"{place} has no '{anchor}'"
    if verb == "replace":
        file.write_text(before.replace(anchor, text.rstrip("\n"), 1), encoding="utf-8")
    else:
        at = before.rfind("\n", 0, before.index(anchor)) + 1
        file.write_text(before[:at] + text + before[at:], encoding="utf-8")
    return file


def steps_of(page: str, section: str = "") -> list[re.Match[str]]:
    """Steps of the page, or of a section of it."""
    text = page if not section else page[page.index(f"## {section}\n") :].split("\n## ", 2)[0]
    return list(_STEP.finditer(text))

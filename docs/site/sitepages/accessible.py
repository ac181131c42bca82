"""Names for controls of the theme that have none, and tables without empty heads, for screen readers."""

from __future__ import annotations

from pathlib import Path
from typing import Final

#: What folds the pages below a section in the table of contents: an arrow without words.
_TOGGLE: Final = '<summary><span class="toctree-toggle"'
_NAMED: Final = '<summary aria-label="Pages of this section"><span class="toctree-toggle"'


def name_toggles(site: Path) -> int:
    """Name the toggles of the table of contents in all pages.

    Parameters
    ----------
    site : Path
        Folder of the pages.

    Returns
    -------
    int
        In how many pages they were.
    """
    return _replace(site, _TOGGLE, _NAMED)


#: The corner of a table of pandas: a head of nothing.
_CORNER: Final = "<th></th>"


def fill_corners(site: Path) -> int:
    """Make empty heads of tables in notebooks plain cells.

    Parameters
    ----------
    site : Path
        Folder of the pages.

    Returns
    -------
    int
        In how many pages they were.
    """
    return _replace(site, _CORNER, "<td></td>")


def _replace(site: Path, old: str, new: str) -> int:
    """Replace a text in all pages; in how many it was."""
    pages = [page for page in site.rglob("*.html") if old in page.read_text(encoding="utf-8")]
    for page in pages:
        page.write_text(page.read_text(encoding="utf-8").replace(old, new), encoding="utf-8")
    return len(pages)

"""The source of the site: the pages of ``docs/`` and of the root in one folder, with tables of contents.

The pages stay plain Markdown that a forge shows as well. Here links between the two folders are changed, and
the names of the files that a page shows (``<!-- file: building.yaml -->``) become captions.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from sitepages import live_pages

DOCS = Path(__file__).resolve().parents[2]
ROOT = DOCS.parent
#: Pages of the root that are pages of the site.
FROM_ROOT = ("CHANGELOG.md", "CONTRIBUTING.md", "RELEASING.md", "SECURITY.md", "SUPPORT.md")
#: Other files that pages link to.
LINKED = ("LICENSE", "CITATION.cff")

_NAMED_FENCE = re.compile(r"^<!-- file: (?P<name>\S+) -->\n+```(?P<language>\w+)\n", re.MULTILINE)
_LINK = re.compile(r"\]\((?P<target>[^)#\s]+)(?P<anchor>#[^)]*)?\)")


class Section(NamedTuple):
    """A part of the table of contents: its title, its Markdown, and the pages that it links to."""

    title: str
    text: str
    pages: tuple[str, ...]

    @property
    def file(self) -> str:
        """Name of its page, without ending."""
        return "section-" + re.sub(r"[^a-z0-9]+", "-", self.title.lower()).strip("-")


def sections(index: str) -> list[Section]:
    """Sections of ``docs/index.md``: each ``##`` heading with the pages listed below it."""
    found = []
    for block in re.split(r"^## ", index, flags=re.MULTILINE)[1:]:
        title, _, text = block.partition("\n")
        targets = (
            link["target"].removeprefix("../") for link in _LINK.finditer(text) if "://" not in link["target"]
        )
        pages = tuple(
            dict.fromkeys(one.rpartition(".")[0] for one in targets if one.endswith((".md", ".ipynb")))
        )
        found.append(Section(title.strip(), text.strip(), pages))
    return found


def tree(entries: list[str] | tuple[str, ...]) -> str:
    """A table of contents for Sphinx that the page itself does not show."""
    return "\n```{toctree}\n:hidden:\n\n" + "\n".join(entries) + "\n```\n"


def site_text(text: str, *, from_root: bool = False) -> str:
    """Markdown of a page with the links and captions of the site."""

    def moved(link: re.Match[str]) -> str:
        target = link["target"].removeprefix("../") if not from_root else link["target"].removeprefix("docs/")
        return f"]({target}{link['anchor'] or ''})"

    def captioned(fence: re.Match[str]) -> str:
        return f"```{{code-block}} {fence['language']}\n:caption: {fence['name']}\n\n"

    return _NAMED_FENCE.sub(captioned, _LINK.sub(moved, text))


def assemble(source: Path, live: Sequence[str] = ()) -> None:
    """Write the pages of the repository below `source`.

    Parameters
    ----------
    source : Path
        Folder of the site's source; made anew.
    live : sequence of str
        Names of the live examples that the site has.
    """
    shutil.rmtree(source, ignore_errors=True)
    source.mkdir(parents=True)
    for page in sorted(DOCS.glob("*.md")):
        text = live_pages.shown(site_text(page.read_text(encoding="utf-8")), live)
        (source / page.name).write_text(text, encoding="utf-8")
    for name in FROM_ROOT:
        text = site_text((ROOT / name).read_text(encoding="utf-8"), from_root=True)
        (source / name).write_text(text, encoding="utf-8")
    for name in LINKED:
        shutil.copy(ROOT / name, source / name)
    for picture in sorted([*DOCS.glob("*.svg"), *DOCS.glob("*.png")]):
        shutil.copy(picture, source / picture.name)
    shutil.copytree(DOCS / "notebooks", source / "notebooks")


def contents(source: Path, generated: dict[str, tuple[str, list[str]]]) -> None:
    """Write the pages of the sections, and the table of contents of the first page.

    Parameters
    ----------
    source : Path
        Folder of the site's source.
    generated : dict of str to tuple
        Sections whose pages are generated, by title: first page, further pages.
    """
    index = source / "index.md"
    text = index.read_text(encoding="utf-8")
    entries: list[str] = []
    for section in sections(text):
        if section.title in generated:
            page, others = generated[section.title]
            entries.append(f"{section.title} <{page}>")
            if others:
                with (source / f"{page}.md").open("a", encoding="utf-8") as file:
                    file.write(tree(others))
            continue
        entries.append(section.file)
        whole = f"# {section.title}\n\n{section.text}\n{tree(section.pages)}"
        (source / f"{section.file}.md").write_text(whole, encoding="utf-8")
    index.write_text(text + tree(entries), encoding="utf-8")

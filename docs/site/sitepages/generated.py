"""All generated pages, and their places in the table of contents."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from sitepages import api, assemble, commands, keys, laws, outputs
from sitepages.snippets import Snippets

_INDEX = """# Reference

Made from the code when this site is built, so that it is complete and agrees with the code.

- [Keys of a building](building-keys.md): unit, limits, default, range, meaning and an example of each.
- [Keys of a study](studies.md#keys): the same for study files.
- [Outputs](outputs.md): every series that a run can record.
- [Commands](commands.md): every command with its options and exit codes.
- [Laws](laws.md): every physical law with its equation, source and range.
- [Python](api/index.md): public classes and functions.
"""


def write(source: Path, live: Sequence[str] = ()) -> None:
    """Assemble the pages of the repository and write the generated ones beside them.

    Parameters
    ----------
    source : Path
        Folder of the site's source; made anew.
    live : sequence of str
        Names of the live examples that the site has.
    """
    pages = {
        "reference": _INDEX,
        "building-keys": keys.page(Snippets(assemble.DOCS)),
        "outputs": outputs.page(),
        "commands": commands.page(),
        "laws": laws.page(),
        **api.pages(),
    }
    assemble.assemble(source, live)
    for name, text in pages.items():
        path = source / f"{name}.md"
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
    assemble.contents(
        source,
        {
            "Examples": ("gallery/index", []),
            "Reference": ("reference", ["building-keys", "outputs", "commands", "laws", "api/index"]),
        },
    )

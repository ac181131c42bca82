"""Physical laws with equation, source and range, from the modules of the engine that implement them."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

from sitepages.assemble import ROOT

PHYSICS: Final = ROOT / "crates" / "engine" / "src" / "physics"
#: Titles of the folders, in the order of the page.
FOLDERS: Final = {
    "pcm": "Phase change",
    "pcm/history": "Phase change that depends on what went before",
    "convection/laws": "Convection at surfaces",
    "longwave": "Long-wave radiation",
    "longwave/skies": "Emission of the clear sky",
    "diffuse/laws": "Diffuse radiation of the sky",
    "leakage/laws": "Infiltration by a pressure test",
    "sorption/laws": "Sorption",
    "imposed/laws": "Temperatures of soil and other surroundings",
    ".": "Sun, air and windows",
    "optics": "Optics of glazings",
}


def head(file: Path) -> str:
    """The comment at the head of a module."""
    lines = []
    for line in file.read_text(encoding="utf-8").splitlines():
        if not line.startswith("//!"):
            break
        lines.append(line.removeprefix("//!").removeprefix(" "))
    return "\n".join(lines).strip()


def laws() -> dict[str, dict[str, str]]:
    """Heads of the modules that name a source: folder -> module -> text."""
    found: dict[str, dict[str, str]] = {folder: {} for folder in FOLDERS}
    for file in sorted(PHYSICS.rglob("*.rs")):
        text = head(file)
        if re.search(r"\b(1[89]|20)\d\d\b", text):  # a publication, by its year
            found[str(file.parent.relative_to(PHYSICS))][file.stem] = text
    return found


def page() -> str:
    """The page: one section for each law."""
    lines = [
        "# Laws",
        "",
        "Each physical law with its equation, its source and its range, as the module of the engine states "
        "it. [The engine](engine.md) has the heat balances that they are part of; `mascarin cite "
        "building.yaml` lists the sources of one building.",
        "",
    ]
    for folder, modules in laws().items():
        lines += [f"## {FOLDERS[folder]}", ""]
        for name, text in modules.items():
            title, _, rest = text.partition("\n")
            place = f"physics/{name}.rs" if folder == "." else f"physics/{folder}/{name}.rs"
            # What a comment of Rust links to is a name of the code.
            rest = re.sub(r"\[`([^`]+)`\](\([^)]*\))?", r"`\1`", rest)
            lines += [
                f"### {title.split(':')[0].split(',')[0].rstrip('.').replace('`', '')}",
                "",
                title,
                rest,
                "",
                f"Module `{place}`.",
                "",
            ]
    return "\n".join(lines) + "\n"

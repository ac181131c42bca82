"""The pictures of docs/design.md and docs/pcm-results.md, from the report of the shipped design study.

``python docs/site/design_pictures.py`` runs the study into a temporary folder (two minutes of two free
cores); with a folder of ``mascarin design reunion-house -o FOLDER`` it reads the report there. Each
picture is a drawing of the report with the part of its style sheet that it uses, for light and dark pages.
"""

from __future__ import annotations

import re
import sys
import tempfile
from pathlib import Path
from typing import Final

from mascarin.design import read_design, run_design
from mascarin.examples import FOLDER as EXAMPLES

DOCS: Final = Path(__file__).resolve().parents[1]
STUDY: Final = EXAMPLES / "reunion_house" / "design.yaml"
#: Each picture: what the description of its drawing begins with.
PICTURES: Final = {
    "design-ranking.svg": r"Difference from the best design, golden",
    "design-map.svg": r"discomfort, K h, tampa",
    "design-cycling.svg": r"living_ceiling\.pcm, tampa",
    "design-fraction.svg": r"design \d+, living_ceiling\.pcm",
}
#: Space around a drawing [px].
_MARGIN: Final = 12.0


def main(folder: Path) -> None:
    """Write the pictures of a report."""
    page = (folder / "report.html").read_text(encoding="utf-8")
    for name, begins in PICTURES.items():
        found = re.search(
            rf'<svg class="[^"]*" viewBox="([^"]*)"[^>]* aria-label="({begins}[^"]*)">(.*?)</svg>', page
        )
        if found is None:
            raise SystemExit(f"{folder}/report.html: no drawing whose description begins with '{begins}'")
        (DOCS / name).write_text(_alone(*found.groups(), page), encoding="utf-8")
        sys.stdout.write(f"{name}: {(DOCS / name).stat().st_size / 1000:.1f} kB, {found[2]}\n")


def _alone(view: str, title: str, content: str, page: str) -> str:
    """One drawing as a file of its own."""
    width, height = (float(number) for number in view.split()[2:])
    box = (-_MARGIN, -_MARGIN, width + 2 * _MARGIN, height + 2 * _MARGIN)
    place = f'x="{box[0]:g}" y="{box[1]:g}" width="{box[2]:g}" height="{box[3]:g}"'
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{" ".join(f"{x:g}" for x in box)}" '
        f'width="{box[2]:g}" height="{box[3]:g}" role="img">\n<title>{title}</title>\n'
        f"<style>{_style(page, content)}</style>\n"
        f'<rect {place} fill="var(--paper)"/>{content}</svg>\n'
    )


def _style(page: str, content: str) -> str:
    """The rules of the page for the classes of a drawing, and the colors that they name."""
    sheet = "".join(re.findall(r"<style[^>]*>(.*?)</style>", page, re.DOTALL))
    sheet = re.sub(r"/\*.*?\*/", "", sheet, flags=re.DOTALL)
    screen = sheet.split("@media print")[0]
    dark = re.search(r"@media \(prefers-color-scheme: dark\)\s*\{\s*:root\s*\{(.*?)\}", screen, re.DOTALL)
    light = re.search(r":root\s*\{([^{}]*--paper[^{}]*)\}", screen)
    if light is None or dark is None:
        raise SystemExit("the style sheet of the report has no colors for light and dark pages")
    classes = {name for names in re.findall(r'class="([^"]*)"', content) for name in names.split()}
    tags = set(re.findall(r"<(\w+)", content))
    rules = []
    for selectors, body in re.findall(r"([^{}@]+)\{([^{}]*)\}", sheet):
        kept = [one for one in map(str.strip, selectors.split(",")) if _fits(one, classes, tags)]
        if kept:
            rules.append(f"{','.join(kept)}{{{body.strip()}}}")
    rules = list(dict.fromkeys(rules))
    used = set(re.findall(r"var\((--[\w-]+)\)", " ".join(rules))) | {"--paper"}
    return (
        f":root{{{_colors(light[1], used)}}}"
        f"@media (prefers-color-scheme:dark){{:root{{{_colors(dark[1], used)}}}}}{''.join(rules)}"
    )


def _fits(selector: str, classes: set[str], tags: set[str]) -> bool:
    """Whether a selector is one tag with classes that a drawing has."""
    found = re.fullmatch(r"(\w*)((?:\.[\w-]+)+)", selector)
    return (
        found is not None and (not found[1] or found[1] in tags) and set(found[2][1:].split(".")) <= classes
    )


def _colors(body: str, used: set[str]) -> str:
    return "".join(
        f"{name}:{value.strip()};" for name, value in re.findall(r"(--[\w-]+):([^;]+);", body) if name in used
    )


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with tempfile.TemporaryDirectory() as made:
            run_design(read_design(STUDY), made)
            main(Path(made))

"""Examples of the documentation as pages in which the model runs, made when the site is built.

A page of ``docs/`` names one where its example is told: ``<!-- live: room -->``. On a forge this is a
comment; on the site it is the live page, folded, so that nothing is loaded before someone opens it. Where the
site is built without the engine for browsers, the place says so.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import mascarin as mc
from mascarin.design import read_design
from mascarin.errors import InputError
from mascarin.examples import box, box_climate, locate, locate_design
from mascarin.pages.live import engine

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.weather import Climate, Measurements

#: Folder of the pages in the site.
FOLDER: Final = "live"
#: What is said where the site has none.
WITHOUT: Final = (
    "the examples of this site do not run in its pages: there is no engine for browsers here "
    "(rustup target add wasm32-unknown-unknown, make build)"
)
MARK: Final = re.compile(r"^<!-- live: (?P<name>[a-z_]+) -->$", re.MULTILINE)


class Example(NamedTuple):
    """A page in which an example runs.

    Attributes
    ----------
    title : str
        What it is, for readers.
    model : callable
        Its building, its climate, and measured columns that it needs.
    options : dict
        Of `mascarin.live_page`.
    """

    title: str
    model: Callable[[], tuple[Building, Climate, Measurements | None]]
    options: dict[str, Any]


def _room() -> tuple[Building, Climate, None]:
    room = mc.new_room(
        "4x3x2.8",
        gap="ventilated",
        ceiling="plasterboard 12.5mm + SP24E 15mm",
        windows=["south:1.2x1.0"],
        place="san-francisco",
    )
    return room, mc.Climate.from_epw("shipped:san-francisco"), None


def _cell() -> tuple[Building, Climate, Measurements | None]:
    study = mc.Study.from_yaml(locate("lgi"))
    return study.building, study.climate, study.context.measurements


def _house() -> tuple[Building, Climate, None]:
    site = read_design(locate_design("reunion-house")).sites[0]
    return site.building, site.climate, None


EXAMPLES: Final = {
    "room": Example(
        "the room under a ventilated roof, with a phase-change ceiling, in San Francisco",
        _room,
        {"start": "07-01", "end": "07-08"},
    ),
    "box": Example(
        "a room of concrete",
        lambda: (box(), box_climate(), None),
        {"parameters": ["surfaces.facade.outside.absorptance"], "step": "1h"},
    ),
    "cell": Example(
        "the LGI cell with its phase-change ceiling, 14 days",
        _cell,
        {
            "start": "2010-09-18", "end": "2010-10-02",
            "parameters": ["surfaces.roof.outside.absorptance", "materials.energain.melting_temperature"],
            "outputs": ["room.air_temperature", "ceiling.inside_temperature"],
        },
    ),
    "house": Example(
        "the light house of the design study",
        _house,
        {"start": "07-01", "end": "07-08"},
    ),
}  # fmt: skip


def write(folder: Path) -> list[str]:
    """Write the pages.

    Parameters
    ----------
    folder : Path
        Where to; made if needed.

    Returns
    -------
    list of str
        Names of those that were written; none without the engine for browsers.
    """
    try:
        engine.read()
    except InputError:
        return []
    folder.mkdir(parents=True, exist_ok=True)
    for name, example in EXAMPLES.items():
        building, climate, measured = example.model()
        options = example.options if measured is None else {**example.options, "measurements": measured}
        mc.live_page(building, climate, folder / f"{name}.html", **options)
    return list(EXAMPLES)


def shown(text: str, written: Sequence[str]) -> str:
    """Markdown of a page with its live examples in the places of the comments.

    Parameters
    ----------
    text : str
        Markdown.
    written : sequence of str
        Names of the pages that there are.
    """

    def place(mark: re.Match[str]) -> str:
        name = mark["name"]
        title = EXAMPLES[name].title
        if name not in written:
            return f"*Here {title} runs in the page, where the site is built with the engine for browsers.*"
        file = f"{FOLDER}/{name}.html"
        return (
            f'<details class="live-example"><summary>Run it here: {title}</summary>\n'
            f'<iframe data-src="{file}" title="Live page: {title}"></iframe>\n'
            f'<p><a href="{file}">Open it as a page of its own</a>, which can be saved and sent.</p>\n'
            "</details>"
        )

    return MARK.sub(place, text)

"""The page of a building: one HTML file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from mascarin import __version__
from mascarin._io import atomic
from mascarin.building import check
from mascarin.building.checks.conductances import BASIS, SUM, TITLE, by_destination, conductances
from mascarin.figures import text
from mascarin.figures.colors import PALETTE
from mascarin.pages.frame.template import Library, environment, frame
from mascarin.pages.view import layers
from mascarin.pages.view.formulas import formulas
from mascarin.pages.view.scene import Facts, scene
from mascarin.pages.view.sun import positions

if TYPE_CHECKING:
    from mascarin.building import Building

THREE: Final = Library(
    "pages/view/vendor/three.iife.min.js",
    "pages/view/vendor/three.LICENSE",
    "The building is drawn by three.js.",
)
_WARNING, _ASSUMED = "warning: ", "assumed: "
#: Rows up to which a table is open.
_MAX_OPEN_ROWS: Final = 30


def write(building: Building, path: Path, step_seconds: float = 900.0) -> Path:
    """Write the page to a file.

    Parameters
    ----------
    building : Building
        The building.
    path : Path
        Where to.
    step_seconds : float
        Time step for which the building is checked. [s]

    Returns
    -------
    Path
        The file.
    """
    return atomic.write(path, render(building, step_seconds))


def render(building: Building, step_seconds: float = 900.0) -> str:
    """Make the page.

    Parameters
    ----------
    building : Building
        The building.
    step_seconds : float
        Time step for which the building is checked. [s]

    Returns
    -------
    str
        HTML.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> "<h1>box</h1>" in render(box())
    True
    """
    lines = check(building, step_seconds)
    warnings = [line.removeprefix(_WARNING) for line in lines if line.startswith(_WARNING)]
    assumed = [line.removeprefix(_ASSUMED) for line in lines if line.startswith(_ASSUMED)]
    shown = scene(building, warnings)
    built = layers.constructions(building)
    sections = [
        {"id": key, "title": title, "content": content}
        for key, title, content in (
            ("warnings", "Warnings", warnings),
            ("zones", "Zones", shown["zones"]),
            ("surfaces", "Surfaces, windows and shades", shown["parts"]),
            ("conductances", TITLE, _conductances(building)),
            ("constructions", "Constructions", built),
            ("formulas", "Laws and outputs written as text", formulas(building)),
            ("assumed", "Assumed values", assumed),
        )
        if content
    ]
    return (
        environment()
        .get_template("pages/view/view.html")
        .render(
            frame(
                styles=["pages/view/view.css"],
                libraries=[THREE],
                scripts=["pages/view/view.js"],
                data={
                    **shown,
                    "sun": positions(building.site),
                    "palette": PALETTE,
                    "constructions": {
                        construction["name"]: number for number, construction in enumerate(built)
                    },
                },
            ),
            title=building.name,
            version=__version__,
            sections=sections,
            facts=_facts(building, warnings),
            schematic=shown["schematic"],
            site=_site(building),
            most=_MAX_OPEN_ROWS,
            assumed=sum(number.assumed for number in building.parameters()),
        )
    )


def _conductances(building: Building) -> dict[str, Any]:
    rows = [
        {
            "destination": entry.destination,
            "element": entry.element,
            "kind": "" if entry.element == SUM else entry.kind,
            "zone": "" if entry.element == SUM else entry.zone,
            "value": text.fixed(entry.value, 2),
        }
        for entry in by_destination(conductances(building))
    ]
    return {"rows": rows, "basis": BASIS} if rows else {}


def _facts(building: Building, warnings: list[str]) -> list[dict[str, Any]]:
    area = sum(float(surface.area or 0.0) for surface in building.surfaces.values())
    glazed = sum(float(window.area or 0.0) for window in building.windows.values())
    facts = [
        ("Zones", str(len(building.zones)), f"{_volume(building)} of air", ""),
        ("Surfaces", str(len(building.surfaces)), text.with_unit(area, "m2"), ""),
    ]
    if building.windows:
        facts.append(("Windows", str(len(building.windows)), text.with_unit(glazed, "m2"), ""))
    facts.append(("Warnings", str(len(warnings)), "of 'mascarin check'", "fail" if warnings else "pass"))
    return [dict(zip(("name", "value", "note", "kind"), fact, strict=True)) for fact in facts]


def _volume(building: Building) -> str:
    return text.with_unit(sum(float(zone.volume or 0.0) for zone in building.zones.values()), "m3")


def _site(building: Building) -> Facts:
    site = building.site
    return [
        ("Latitude", text.with_unit(float(site.latitude), "deg", 5)),
        ("Longitude", text.with_unit(float(site.longitude), "deg", 5)),
        ("Altitude", text.with_unit(float(site.altitude), "m")),
        ("Time zone", str(site.timezone)),
    ]

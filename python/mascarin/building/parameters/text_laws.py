"""Laws of a building that are written as text and are none of convection or melting."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from mascarin.building.parts.air.zone import TextInfiltration
from mascarin.building.parts.materials.text_law import ConductivityLaw, TextLaw, TextSky

if TYPE_CHECKING:
    from mascarin.building.parts.description import Description


def text_laws(building: Description) -> Iterator[tuple[str, TextLaw]]:
    """Laws as text of materials, zones and the sky of a building, with their paths."""
    for name, material in building.materials.items():
        if isinstance(law := getattr(material, "conductivity", None), ConductivityLaw):
            yield f"materials.{name}.conductivity", law
    for name, zone in building.zones.items():
        if isinstance(zone.infiltration, TextInfiltration):
            yield f"zones.{name}.infiltration", zone.infiltration
    if isinstance(building.site.sky, TextSky):
        yield "site.sky", building.site.sky

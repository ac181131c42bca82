"""The sides of a building whose coefficient is written as text."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from mascarin.building.parameters.unused_parameters import has_height, sides
from mascarin.building.parts.envelope.formula_law import FormulaLaw, LawSide
from mascarin.building.parts.openings.window import WindowInside

if TYPE_CHECKING:
    from mascarin.building.parts.description import Description

#: Of air at sea level, where a site has none: laws are judged by their signs and slopes. [kg/m3]
_AIR_DENSITY = 1.2


@dataclass(frozen=True)
class FormulaSide:
    """A side with a law as text: the path of the law, and what the side gives to it."""

    path: str
    law: FormulaLaw
    values: LawSide

    def faults(self) -> Iterator[Any]:
        """What is wrong with the law here."""
        return self.law.faults(tuple(self.path.split(".")), self.values)


def formula_sides(building: Description) -> Iterator[FormulaSide]:
    """Sides of surfaces and windows with a law as text, in the order of the description."""
    density = float(building.site.air_density or _AIR_DENSITY)
    for item in sides(building):
        law = item.side.convection
        if isinstance(law, FormulaLaw):
            side = item.side
            exposed, indoors = (
                side.exposed,
                isinstance(side, WindowInside) or getattr(side, "zone", None) is not None,
            )
            height = float(side.height) if has_height(side) else None  # type: ignore[union-attr, arg-type]
            values = ((exposed.wind, exposed.sun, indoors), (item.tilt, item.area, density, height))
            yield FormulaSide(f"{item.path}.convection", law, values)

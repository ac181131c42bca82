"""The sides of a building whose coefficient is written as text."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from mascarin.building.parameters.unused_parameters import sides
from mascarin.building.parts.envelope.formula_law import FormulaLaw

if TYPE_CHECKING:
    from mascarin.building.parts.description import Description

#: Of air at sea level, where a site has none: laws are judged by their signs and slopes. [kg/m3]
_AIR_DENSITY = 1.2


@dataclass(frozen=True)
class FormulaSide:
    """A side with a law as text: the path of the law, the side's geometry, and whether wind reaches it."""

    path: str
    law: FormulaLaw
    geometry: tuple[float, float, float]
    wind: bool

    def faults(self) -> Iterator[Any]:
        """What is wrong with the law here."""
        return self.law.faults(tuple(self.path.split(".")), self.geometry, wind=self.wind)


def formula_sides(building: Description) -> Iterator[FormulaSide]:
    """Sides of surfaces and windows with a law as text, in the order of the description."""
    density = float(building.site.air_density or _AIR_DENSITY)
    for item in sides(building):
        law = item.side.convection
        if isinstance(law, FormulaLaw):
            wind = bool(item.side.outdoors) and item.side.exposed.wind
            yield FormulaSide(f"{item.path}.convection", law, (item.tilt, item.area, density), wind)

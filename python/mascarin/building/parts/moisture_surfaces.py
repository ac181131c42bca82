"""Sides of surfaces that vapour of a zone reaches, and what is behind each of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mascarin.building.parts.materials.material import Resistance
from mascarin.building.parts.materials.phases import phase

if TYPE_CHECKING:
    from mascarin.building.parts.description import Description
    from mascarin.building.parts.materials.material import Material


@dataclass(frozen=True)
class VapourSide:
    """A side of a surface in a zone.

    Attributes
    ----------
    surface, construction, layer, material : str
        Names of the surface, of its construction, and of the layer at this side and its material.
    side : int
        0 for the outside, 1 for the inside.
    density : float
        Density of the material; 0 for one without. [kg/m3]
    takes_up : bool
        Whether it takes up vapour: the material has sorption data, and the surface is not sealed.
    sealed : bool
        Whether the surface is said to take up none.
    """

    surface: str
    side: int
    construction: str
    layer: str
    material: str
    density: float
    takes_up: bool
    sealed: bool


def vapour_sides(building: Description) -> Iterator[VapourSide]:
    """All sides in zones whose surfaces have convection, in the order of the description."""
    humidity = building.humidity
    if humidity is None:
        return
    for name, surface in building.surfaces.items():
        layers = building.constructions[surface.construction].layers
        for number, side in enumerate(surface.sides):
            if side.zone is None or side.convection is None:
                continue
            layer = layers[0 if number == 0 else -1]
            material = building.materials[layer.material]
            exception = humidity.surfaces.get(name)
            sealed = exception is not None and exception.sealed
            is_sorbing = layer.material in humidity.materials and not isinstance(material, Resistance)
            yield VapourSide(
                surface=name,
                side=number,
                construction=surface.construction,
                layer=layer.name,
                material=layer.material,
                density=_density(material),
                takes_up=is_sorbing and not sealed,
                sealed=sealed,
            )


def _density(material: Material) -> float:
    if isinstance(material, Resistance):
        return 0.0
    return float(phase(material.density, "solid"))

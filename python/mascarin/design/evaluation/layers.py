"""Mass, latent heat and prices of the layers of each design: what needs no run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mascarin.errors import InputError
from mascarin.materials import product

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building

    Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class LayerFacts:
    """The layers of some members.

    Parameters
    ----------
    buildings : sequence of Building, one for each member
        The building of each structure; members of the same structure share the object.
    numbers : mapping of str to ndarray, each of shape (members,)
        Parameters that differ from those of the building. [unit of each]
    labels : mapping of str to sequence of str
        What each member has chosen, by variable.
    """

    buildings: Sequence[Building]
    numbers: Mapping[str, Array]
    labels: Mapping[str, Sequence[str]]

    @property
    def count(self) -> int:
        """Number of members."""
        return len(self.buildings)

    def mass(self, layer: str) -> Array:
        """Mass of a layer of a surface, shape (members,). [kg]"""
        areas = self._of_members(layer, lambda building, surface, _: float(building.surfaces[surface].area))
        return self._per_area(layer) * areas

    def latent(self, layer: str) -> Array:
        """Latent heat of a square metre of a layer, shape (members,). [J/m2]"""
        heats = self._of_members(layer, lambda building, _, k: _latent_heat(building, k[0]))
        return self._per_area(layer) * self._replaced("materials.{m}.latent_heat", layer, heats)

    def products(self, layer: str) -> list[str | None]:
        """Product of the material of a layer, for each member."""
        names = []
        for building in self.buildings:
            material = building.materials[_layer_address(building, layer)[0]]
            names.append(getattr(material, "product", None))
        return names

    def chosen(self, variable: str) -> Sequence[str]:
        """What each member has chosen."""
        return self.labels[variable]

    def _per_area(self, layer: str) -> Array:
        """Mass of a square metre, shape (members,). [kg/m2]"""
        density = self._of_members(layer, lambda building, _, k: _density(building, k[0]))
        for path in ("materials.{m}.density", "materials.{m}.density.solid"):
            density = self._replaced(path, layer, density)
        thickness = self._of_members(layer, _thickness)
        return density * self._replaced("constructions.{c}.layers.{l}.thickness", layer, thickness)

    def _of_members(self, layer: str, read: object) -> Array:
        by_building: dict[int, float] = {}
        for building in self.buildings:
            if id(building) not in by_building:
                surface = layer.partition(".")[0]
                by_building[id(building)] = read(building, surface, _layer_address(building, layer))  # type: ignore[operator]
        return np.array([by_building[id(building)] for building in self.buildings])

    def _replaced(self, path: str, layer: str, values: Array) -> Array:
        """Values of the buildings, or those that the members have instead."""
        replaced = values.copy()
        for k, building in enumerate(self.buildings):
            material, construction, name = _layer_address(building, layer)
            column = self.numbers.get(path.format(m=material, c=construction, l=name))
            if column is not None:
                replaced[k] = column[k]
        return replaced


def _layer_address(building: Building, layer: str) -> tuple[str, str, str]:
    """Material, construction and name of a layer of a surface."""
    surface, _, name = layer.partition(".")
    construction = building.surfaces[surface].construction
    for entry in building.constructions[construction].layers:
        if entry.name == name:
            return entry.material, construction, name
    raise InputError(
        f"found no layer '{name}' in construction '{construction}' of surface '{surface}' in one of the "
        "designs; expected it in all of them. Keep its name in every variant"
    )


def _thickness(building: Building, _: str, address: tuple[str, str, str]) -> float:
    layers = building.constructions[address[1]].layers
    return next(
        float(entry.thickness) for entry in layers if entry.name == address[2] and entry.thickness is not None
    )


def _density(building: Building, material: str) -> float:
    density = getattr(building.materials[material], "density", None)
    if density is None:
        raise InputError(f"material '{material}': found no density, which its mass needs; add density:")
    return float(getattr(density, "solid", density))


def _latent_heat(building: Building, material: str) -> float:
    entry = building.materials[material]
    latent_heat = getattr(entry, "latent_heat", None)
    if latent_heat is not None:
        return float(latent_heat)
    name = getattr(entry, "product", None)
    product_value = None if name is None else product(name).number("latent_heat")
    if product_value is None:
        raise InputError(
            f"material '{material}': found no latent heat beside its table; expected latent_heat: [J/kg], "
            f"which "
            "says how much of the table is melting"
        )
    return float(product_value)

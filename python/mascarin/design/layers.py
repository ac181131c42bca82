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
        areas = self._each(layer, lambda building, surface, _: float(building.surfaces[surface].area))
        return self._per_area(layer) * areas

    def latent(self, layer: str) -> Array:
        """Latent heat of a square metre of a layer, shape (members,). [J/m2]"""
        heats = self._each(layer, lambda building, _, k: _latent_heat(building, k[0]))
        return self._per_area(layer) * self._replaced("materials.{m}.latent_heat", layer, heats)

    def products(self, layer: str) -> list[str | None]:
        """Product of the material of a layer, for each member."""
        found = []
        for building in self.buildings:
            material = building.materials[_place(building, layer)[0]]
            found.append(getattr(material, "product", None))
        return found

    def chosen(self, variable: str) -> Sequence[str]:
        """What each member has chosen."""
        return self.labels[variable]

    def _per_area(self, layer: str) -> Array:
        """Mass of a square metre, shape (members,). [kg/m2]"""
        density = self._each(layer, lambda building, _, k: _density(building, k[0]))
        for path in ("materials.{m}.density", "materials.{m}.density.solid"):
            density = self._replaced(path, layer, density)
        thickness = self._each(layer, _thickness)
        return density * self._replaced("constructions.{c}.layers.{l}.thickness", layer, thickness)

    def _each(self, layer: str, read: object) -> Array:
        known: dict[int, float] = {}
        for building in self.buildings:
            if id(building) not in known:
                surface = layer.partition(".")[0]
                known[id(building)] = read(building, surface, _place(building, layer))  # type: ignore[operator]
        return np.array([known[id(building)] for building in self.buildings])

    def _replaced(self, path: str, layer: str, values: Array) -> Array:
        """Values of the buildings, or those that the members have instead."""
        found = values.copy()
        for k, building in enumerate(self.buildings):
            material, construction, name = _place(building, layer)
            column = self.numbers.get(path.format(m=material, c=construction, l=name))
            if column is not None:
                found[k] = column[k]
        return found


def _place(building: Building, layer: str) -> tuple[str, str, str]:
    """Material, construction and name of a layer of a surface."""
    surface, _, name = layer.partition(".")
    construction = building.surfaces[surface].construction
    for one in building.constructions[construction].layers:
        if one.name == name:
            return one.material, construction, name
    raise InputError(
        f"found no layer '{name}' in construction '{construction}' of surface '{surface}' in one of the "
        "designs; expected it in all of them. Keep its name in every variant"
    )


def _thickness(building: Building, _: str, place: tuple[str, str, str]) -> float:
    layers = building.constructions[place[1]].layers
    return next(float(one.thickness) for one in layers if one.name == place[2] and one.thickness is not None)


def _density(building: Building, material: str) -> float:
    density = getattr(building.materials[material], "density", None)
    if density is None:
        raise InputError(f"material '{material}': found no density, which its mass needs; add density:")
    return float(getattr(density, "solid", density))


def _latent_heat(building: Building, material: str) -> float:
    one = building.materials[material]
    given = getattr(one, "latent_heat", None)
    if given is not None:
        return float(given)
    name = getattr(one, "product", None)
    known = None if name is None else product(name).number("latent_heat")
    if known is None:
        raise InputError(
            f"material '{material}': found no latent heat beside its table; expected latent_heat: [J/kg], "
            f"which "
            "says how much of the table is melting"
        )
    return float(known)

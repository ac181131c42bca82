"""Soil behind surfaces: its ladder, and what the weather gives to it over time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from mascarin.building.parts.materials.material import Resistance
from mascarin.building.parts.materials.phases import phase
from mascarin.building.soil.finite_volumes import SoilGeometry

if TYPE_CHECKING:
    from mascarin.building.parts.description import Description
    from mascarin.building.parts.soil_block import SoilBlock
    from mascarin.building.soil.ladder import SoilLadder


@dataclass(frozen=True)
class SoilCourse:
    """What a block of soil gets from the weather, or is in contact with at its end.

    Attributes
    ----------
    block : str
        Name of the block.
    kind : {"heat_flux", "temperature"}
        Heat by the outdoor air into one of its cells [W/m2], or the temperature behind the outermost one
        [degC].
    cell : int
        Which cell: 0 for the innermost one, 1 for the next.
    geometry : SoilGeometry
        What its ladder follows from.
    behind : float
        Temperature behind the outermost cell. [degC]
    before : (float, float, float) or None
        Mean, amplitude and coldest day of what acts outdoors before the weather begins. [degC], [K], [d]
    radiation : (float, float, float) or None
        Absorptance and emissivity of the ground outdoors [-], and its film [W/(m2 K)]; None where the
        temperature of the air acts alone.
    """

    block: str
    kind: Literal["heat_flux", "temperature"]
    cell: int
    geometry: SoilGeometry
    behind: float
    before: tuple[float, float, float] | None
    radiation: tuple[float, float, float] | None = None

    @property
    def name(self) -> str:
        """Name of its channel; no schedule has one with a space."""
        return heat_of(self.block, self.cell) if self.kind == "heat_flux" else behind_of(self.block)

    @property
    def columns(self) -> tuple[str, ...]:
        """Measured columns: none."""
        return ()

    @property
    def ladder(self) -> SoilLadder:
        """The block as a row of cells."""
        from mascarin.building.soil.ladder import ladder_of

        return ladder_of(self.geometry)


def heat_of(block: str, cell: int) -> str:
    """Name of the channel of the heat by the outdoor air into a cell of a block."""
    return f"soil {block} cell {cell + 1}"


def behind_of(block: str) -> str:
    """Name of the channel of the temperature behind a block."""
    return f"behind soil {block}"


def geometry_of(building: Description, surface: str, block: SoilBlock) -> SoilGeometry:
    """Numbers of the finite volumes of a block below a surface.

    The construction counts with the values that the building has; a run takes those of its own.
    """
    resistance = 0.0
    for layer in building.constructions[building.surfaces[surface].construction].layers:
        material = building.materials[layer.material]
        if isinstance(material, Resistance) or layer.thickness is None:
            resistance += float(getattr(material, "resistance", 0.0))
        else:
            both = [phase(material.conductivity, state) for state in ("solid", "liquid")]
            resistance += float(layer.thickness) / (0.5 * sum(both))
    return SoilGeometry(**block.geometry(resistance))


def soil_of(building: Description, surface: str) -> SoilCourse | None:
    """The heat that the weather gives to the soil behind a surface; None: there is none."""
    name = building.surfaces[surface].outside.soil
    return None if name is None else next(_courses(building, surface, name))


def soil_courses(building: Description) -> Iterator[SoilCourse]:
    """All courses of the blocks that surfaces are on."""
    for surface, described in building.surfaces.items():
        if described.outside.soil is not None:
            yield from _courses(building, surface, described.outside.soil)


def _courses(building: Description, surface: str, name: str) -> Iterator[SoilCourse]:
    block = building.soil_blocks[name]
    geometry, before = geometry_of(building, surface, block), block.before
    years = (
        None if before is None else (float(before.mean), float(before.amplitude), float(before.coldest_day))
    )
    for cell in (0, 1):
        yield SoilCourse(name, "heat_flux", cell, geometry, block.behind, years, block.radiation)
    yield SoilCourse(name, "temperature", 0, geometry, block.behind, years)

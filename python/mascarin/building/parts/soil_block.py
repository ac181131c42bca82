"""Blocks of soil beneath and around a building, as a file describes them."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from mascarin.building.base.number import Number, Remark
from mascarin.building.base.part import Part
from mascarin.building.quantities import soil as q

#: Films of the ground outdoors and of a floor: 1/0.04 and 1/0.17.
_FILMS = "ISO 6946:2017, table 7, downward heat flow"
#: Dry and wet soils have 0.9 to 0.95.
_EMISSIVITY = "Oke 1987, Boundary Layer Climates, table 1.1: soils 0.90 to 0.98; the lower end"
_EXTENT = "Neymark and Judkoff 2008, NREL/TP-550-43388: 15 m in most of the cases"


class SoilEdge(Part):
    """Insulation along the edge of a floor: below it, or down along the outer side of the walls.

    Examples
    --------
    >>> edge = SoilEdge(position="vertical", extent=0.8, thickness=0.08, conductivity=0.035)
    >>> round(edge.resistance, 3)
    2.286
    """

    position: Literal["horizontal", "vertical"] = Field(
        description="horizontal: below the floor; vertical: down from the ground, outside of the walls"
    )
    extent: q.EdgeExtent
    thickness: q.EdgeThickness
    conductivity: q.EdgeConductivity

    @property
    def resistance(self) -> float:
        """Of the insulation; it displaces no soil. [m2 K/W]"""
        return float(self.thickness) / float(self.conductivity)


class OutdoorsBefore(Part):
    """Outdoor air of the years before the weather begins, for the soil that still remembers it.

    Examples
    --------
    >>> float(OutdoorsBefore(mean=10).amplitude)
    0.0
    """

    mean: q.OutdoorMean
    amplitude: q.OutdoorAmplitude = Number(0.0, source=Remark("not given: the same all year"))
    coldest_day: q.ColdestDay = Number(15.0, source=Remark("not given: the middle of January"))


class SoilBlock(Part):
    """Soil below and around a rectangle (or a strip), in three (or two) dimensions.

    It is solved by finite volumes and reduced once, before a run, to a row of a few cells behind the surface
    whose outside is ``soil: NAME``. None of its numbers varies within a compiled run.

    Examples
    --------
    >>> block = SoilBlock(length=12, width=8, wall_thickness=0.3, conductivity=1.5, heat_capacity=2.5e6)
    >>> block.area
    96.0
    """

    length: q.SoilLength | None = Field(
        None,
        description="Length of the floor between its walls; none: a strip, whose width is the area over "
        "half of the perimeter",
    )
    width: q.SoilWidth
    wall_thickness: q.WallThickness
    basement_depth: q.BasementDepth = Number(0.0, source=Remark("not given: a slab on the ground"))
    contact: Literal["floor", "walls", "both"] = Field(
        "both",
        description="What of a basement touches the soil: its floor, its walls below the ground, or both; "
        "nothing passes the rest",
    )
    conductivity: q.SoilConductivity
    heat_capacity: q.SoilHeatCapacity
    inside_film: q.SoilFilm = Number(1.0 / 0.17, source=Remark(_FILMS), assumed=True)
    outdoor_film: q.SoilFilm = Number(1.0 / 0.04, source=Remark(_FILMS), assumed=True)
    absorptance: Annotated[
        q.GroundAbsorptance | None,
        Field(
            description="Part of the sun that the ground outdoors absorbs; none: the temperature of the air "
            "acts, without sun and sky"
        ),
    ] = None
    emissivity: q.GroundEmissivity = Number(0.9, source=Remark(_EMISSIVITY), assumed=True)
    far: q.SoilExtent = Number(15.0, source=Remark(_EXTENT), assumed=True)
    depth: q.SoilExtent = Number(15.0, source=Remark(_EXTENT), assumed=True)
    deep_temperature: Annotated[
        q.DeepTemperature | None, Field(description="Temperature of the bottom; none: no heat passes it")
    ] = None
    edge: SoilEdge | None = Field(
        None, description="Insulation along the edge of the floor; none: there is none"
    )
    before: OutdoorsBefore | None = Field(
        None,
        description="Outdoor air before the weather begins; none: the first year of the weather, again and "
        "again",
    )
    source: str | None = Field(None, description="Where the properties come from")

    @property
    def area(self) -> float | None:
        """Of what touches the soil: floor, walls below the ground, or both; None for a strip. [m2]"""
        if self.length is None:
            return None
        length, width = float(self.length), float(self.width)
        floor, walls = length * width, 2.0 * (length + width) * float(self.basement_depth)
        return {"floor": floor, "walls": walls, "both": floor + walls}[self.contact]

    @property
    def radiation(self) -> tuple[float, float, float] | None:
        """Absorptance and emissivity of the ground outdoors [-], and its film [W/(m2 K)]; None: only air."""
        if self.absorptance is None:
            return None
        return float(self.absorptance), float(self.emissivity), float(self.outdoor_film)

    @property
    def behind(self) -> float:
        """Temperature behind its last cell: of the deep soil, or any where there is none. [degC]"""
        if self.deep_temperature is not None:
            return float(self.deep_temperature)
        return 10.0 if self.before is None else float(self.before.mean)

    def geometry(self, construction: float) -> dict[str, Any]:
        """Numbers of its finite volumes, with the resistance of the construction on it. [m2 K/W]"""
        edge = (0.0, 0.0) if self.edge is None else (float(self.edge.extent), self.edge.resistance)
        horizontal = self.edge is not None and self.edge.position == "horizontal"
        return {
            "length": float("inf") if self.length is None else float(self.length),
            "width": float(self.width),
            "wall": float(self.wall_thickness),
            "basement": float(self.basement_depth),
            "far": float(self.far),
            "depth": float(self.depth),
            "conductivity": float(self.conductivity),
            "capacity": float(self.heat_capacity),
            "inside": 1.0 / (1.0 / float(self.inside_film) + construction),
            "outside": float(self.outdoor_film),
            "deep": self.deep_temperature is not None,
            "horizontal": edge if horizontal else (0.0, 0.0),
            "vertical": (0.0, 0.0) if horizontal else edge,
            "contact": self.contact,
        }

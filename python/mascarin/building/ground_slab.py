"""Heat of a slab on the ground by ISO 13370: soils, edge insulation, transmittance and periodic heat flow."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, Literal

from mascarin.errors import InputError

SLAB: Final = "ISO 13370:2017, slab on ground"
#: Seconds of a year, as the standard has them.
_YEAR: Final = 3.15e7


def require_range(name: str, value: float, limits: tuple[float, float], unit: str) -> None:
    """Refuse a number out of its range."""
    low, high = limits
    if not low <= value <= high:
        raise InputError(f"{name}: found {value:g} {unit}, expected {low:g} to {high:g} {unit}")


@dataclass(frozen=True)
class Soil:
    """Ground below and around a slab.

    Parameters
    ----------
    conductivity : float
        Between 0.1 and 6. [W/(m K)]
    heat_capacity : float
        By volume, between 0.1e6 and 6e6. [J/(m3 K)]
    source : str
        Of both; ISO 13370 where it is one of its soils.

    Examples
    --------
    >>> Soil.of_diffusivity(1.9, 7.1e-7, "measured").heat_capacity
    2676056.338028169
    """

    conductivity: float
    heat_capacity: float
    source: str

    def __post_init__(self) -> None:
        require_range("soil: conductivity", self.conductivity, (0.1, 6.0), "W/(m K)")
        require_range("soil: heat_capacity", self.heat_capacity, (0.1e6, 6.0e6), "J/(m3 K)")

    @classmethod
    def of_diffusivity(cls, conductivity: float, diffusivity: float, source: str) -> Soil:
        """Make a soil of its diffusivity.

        Parameters
        ----------
        conductivity : float
            [W/(m K)]
        diffusivity : float
            Conductivity over heat capacity by volume. [m2/s]
        source : str
            Of both.
        """
        if not diffusivity > 0.0:
            raise InputError(f"soil: found diffusivity {diffusivity:g} m2/s, expected a number above 0")
        return cls(conductivity, conductivity / diffusivity, source)

    @property
    def depth(self) -> float:
        """Periodic penetration depth of a year. [m]"""
        return math.sqrt(_YEAR * self.conductivity / (math.pi * self.heat_capacity))


#: ISO 13370:2017, table 7.
SOILS: Final = {
    "clay": Soil(1.5, 3.0e6, SLAB),
    "sand": Soil(2.0, 2.0e6, SLAB),
    "rock": Soil(3.5, 2.0e6, SLAB),
}


@dataclass(frozen=True)
class EdgeInsulation:
    """Insulation along the edge of a slab.

    Parameters
    ----------
    position : {"horizontal", "vertical"}
        Below the slab along its edge, or down along the foundation.
    extent : float
        Width of a horizontal, depth below ground of a vertical insulation. [m]
    thickness : float
        Of the insulation. [m]
    conductivity : float
        Of the insulation; a foundation of low density counts as one. [W/(m K)]

    Examples
    --------
    >>> round(EdgeInsulation("vertical", 0.8, 0.08, 0.035).additional(SOILS["sand"]), 3)
    4.491
    """

    position: Literal["horizontal", "vertical"]
    extent: float
    thickness: float
    conductivity: float

    def __post_init__(self) -> None:
        if self.position not in ("horizontal", "vertical"):
            raise InputError(f"edge: found position '{self.position}', expected horizontal or vertical")
        require_range("edge: extent", self.extent, (0.05, 10.0), "m")
        require_range("edge: thickness", self.thickness, (0.005, 1.0), "m")
        require_range("edge: conductivity", self.conductivity, (0.005, 1.0), "W/(m K)")

    def additional(self, soil: Soil) -> float:
        """Thickness of soil that resists as much as the insulation does beyond the soil it replaces. [m]"""
        added = self.thickness / self.conductivity - self.thickness / soil.conductivity
        return added * soil.conductivity

    @property
    def reach(self) -> float:
        """Extent, twice that of a vertical insulation: heat passes on both of its sides. [m]"""
        return self.extent if self.position == "horizontal" else 2.0 * self.extent


@dataclass(frozen=True)
class Slab:
    """Heat of a slab on the ground by ISO 13370.

    Parameters
    ----------
    area, perimeter : float
        Of the whole slab. [m2], [m]
    wall_thickness : float
        Of the walls on it. [m]
    soil : Soil
        Below it.
    resistance : float
        Of the floor, with those of both surfaces. [m2 K/W]
    edge : EdgeInsulation or None
        Along its edge.

    Examples
    --------
    >>> slab = Slab(100.0, 40.0, 0.3, SOILS["sand"], 2.71)
    >>> round(slab.transmittance, 4), round(slab.periodic, 2)
    (0.2498, 13.04)
    """

    area: float
    perimeter: float
    wall_thickness: float
    soil: Soil
    resistance: float
    edge: EdgeInsulation | None = None

    @property
    def size(self) -> float:
        """Characteristic dimension: area over half of the perimeter. [m]"""
        return self.area / (0.5 * self.perimeter)

    @property
    def thickness(self) -> float:
        """Soil with the resistance of the floor, and the wall. [m]"""
        return self.wall_thickness + self.soil.conductivity * self.resistance

    @property
    def transmittance(self) -> float:
        """Of the slab, with its edge insulation. [W/(m2 K)]"""
        conductivity, size, thickness = self.soil.conductivity, self.size, self.thickness
        if thickness < size:
            value = 2.0 * conductivity / (math.pi * size + thickness)
            value *= math.log(math.pi * size / thickness + 1.0)
        else:
            value = conductivity / (0.457 * size + thickness)
        return value + 2.0 * self.edge_transmittance / size

    @property
    def edge_transmittance(self) -> float:
        """Linear transmittance of the edge insulation, below zero. [W/(m K)]"""
        if self.edge is None:
            return 0.0
        reach, thicker = self.edge.reach, self.thickness + self.edge.additional(self.soil)
        logarithms = math.log(reach / self.thickness + 1.0) - math.log(reach / thicker + 1.0)
        return -self.soil.conductivity / math.pi * logarithms

    @property
    def periodic(self) -> float:
        """Heat flow by the swing outdoors over its amplitude. [W/K]"""
        soil = self.soil
        value = math.log(soil.depth / self.thickness + 1.0)
        if self.edge is not None:
            beyond = math.exp(-self.edge.reach / soil.depth)
            thicker = self.thickness + self.edge.additional(soil)
            value = (1.0 - beyond) * math.log(soil.depth / thicker + 1.0) + beyond * value
        return 0.37 * self.perimeter * soil.conductivity * value

"""Quantities of blocks of soil: all belong to the structure of the block."""

from __future__ import annotations

from typing import Annotated, Final

from mascarin.building.base.number import Fixed, Limits, Number, Quantity
from mascarin.building.quantities.common import TEMPERATURE

#: Why no number of a block of soil varies within a compiled run.
_REASON: Final = "the block is reduced once with it, before a run; give another value, which reduces it again"


def _structural(unit: str, description: str, limits: Limits) -> Quantity:
    return Quantity(unit, description, Fixed(_REASON), limits)


SoilLength = Annotated[
    Number,
    _structural("m", "Length of the floor between its walls", Limits(at_least=1.0, at_most=500.0)),
]
SoilWidth = Annotated[
    Number,
    _structural("m", "Width of the floor between its walls", Limits(at_least=1.0, at_most=500.0)),
]
WallThickness = Annotated[
    Number, _structural("m", "Thickness of the walls on the ground", Limits(at_least=0.05, at_most=2.0))
]
BasementDepth = Annotated[
    Number, _structural("m", "Depth of the floor below the ground", Limits(at_least=0.0, at_most=20.0))
]
SoilConductivity = Annotated[
    Number, _structural("W/(m K)", "Thermal conductivity of the soil", Limits(at_least=0.1, at_most=6.0))
]
SoilHeatCapacity = Annotated[
    Number,
    _structural("J/(m3 K)", "Heat capacity of the soil by volume", Limits(at_least=0.1e6, at_most=6.0e6)),
]
SoilFilm = Annotated[
    Number,
    _structural(
        "W/(m2 K)", "Heat transfer coefficient, radiation included", Limits(at_least=0.5, at_most=1e5)
    ),
]
GroundAbsorptance = Annotated[
    Number,
    _structural("-", "Part of the sun that the ground outdoors absorbs", Limits(at_least=0.0, at_most=1.0)),
]
GroundEmissivity = Annotated[
    Number,
    _structural("-", "Emissivity of the ground outdoors", Limits(at_least=0.0, at_most=1.0)),
]
SoilExtent = Annotated[Number, _structural("m", "Extent of the soil", Limits(at_least=1.0, at_most=200.0))]
DeepTemperature = Annotated[Number, _structural("degC", "Temperature of the deep soil", TEMPERATURE)]
OutdoorMean = Annotated[Number, _structural("degC", "Yearly mean of the outdoor air", TEMPERATURE)]
OutdoorAmplitude = Annotated[
    Number, _structural("K", "Yearly amplitude of the outdoor air", Limits(at_least=0.0, at_most=60.0))
]
ColdestDay = Annotated[
    Number,
    _structural(
        "d", "Day of the year on which the outdoor air is coldest", Limits(at_least=0.0, at_most=366.0)
    ),
]
EdgeExtent = Annotated[
    Number,
    _structural(
        "m", "Width of a horizontal, depth of a vertical insulation", Limits(at_least=0.05, at_most=10.0)
    ),
]
EdgeThickness = Annotated[
    Number, _structural("m", "Thickness of the insulation", Limits(at_least=0.005, at_most=1.0))
]
EdgeConductivity = Annotated[
    Number, _structural("W/(m K)", "Conductivity of the insulation", Limits(at_least=0.005, at_most=1.0))
]

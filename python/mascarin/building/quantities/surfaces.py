"""Quantities of the two sides of a surface."""

from __future__ import annotations

from typing import Annotated

from mascarin.building.base.number import Limits, Number, Percent, Quantity, Within
from mascarin.building.quantities.common import ABOVE_0_TO_1, FRACTION, TEMPERATURE

Emissivity = Annotated[
    Number,
    Quantity("-", "Long-wave emissivity", Within(0.05, "oxidation, dust and paint"), ABOVE_0_TO_1),
]
Absorptance = Annotated[
    Number,
    Quantity("-", "Solar absorptance", Within(0.1, "soiling and fading; colors are judged by eye"), FRACTION),
]
AreaFactor = Annotated[
    Number,
    Quantity(
        "-",
        "Area in contact with the air over plane area (corrugated sheets)",
        Percent(10, "shape of the profile"),
        Limits(at_least=0.1, at_most=20),
    ),
]
HeatFlux = Annotated[
    Number,
    Quantity(
        "W/m2",
        "Heat flow density given to the surface from outside; negative: taken from it",
        Percent(5, "power and area of a heating foil, or a flux meter"),
        Limits(at_least=-1e5, at_most=1e5),
    ),
]
SkyView = Annotated[
    Number,
    Quantity("-", "Fraction of the sky that is visible", Within(0.1, "trees and neighbors"), FRACTION),
]
GroundView = Annotated[
    Number,
    Quantity(
        "-",
        "Fraction of the ground that is visible, for the sun that it reflects",
        Within(0.1, "what stands on the ground"),
        FRACTION,
    ),
]
ReferenceTemperature = Annotated[
    Number,
    Quantity(
        "degC",
        "Temperature about which long-wave exchange is linearised",
        Within(5, "mean of the period is not known in advance; 1 K is 1 % of the coefficient"),
        TEMPERATURE,
    ),
]

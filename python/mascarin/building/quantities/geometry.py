"""Quantities of areas, directions and positions."""

from __future__ import annotations

from typing import Annotated

from mascarin.building.base.number import Fixed, Limits, Number, Percent, Quantity, Within
from mascarin.building.quantities.common import FRACTION, NOT_NEGATIVE, POSITIVE, TAPE

Volume = Annotated[Number, Quantity("m3", "Volume of air", Percent(5, TAPE), POSITIVE)]
Area = Annotated[Number, Quantity("m2", "Area of the surface", Percent(5, TAPE), POSITIVE)]
Tilt = Annotated[
    Number,
    Quantity(
        "deg",
        "Tilt of the outside normal: 0 up, 90 vertical, 180 down",
        Within(2, "spirit level on a roof"),
        Limits(at_least=0, at_most=180),
    ),
]
Azimuth = Annotated[
    Number,
    Quantity(
        "deg",
        "Azimuth of the outside normal, clockwise from north",
        Within(5, "compass near steel, north of the plan"),
        Limits(at_least=-360, at_most=360),
    ),
]
Coordinate = Annotated[
    Number,
    Quantity(
        "m",
        "Coordinate of a vertex: x east, y north, z up",
        Fixed("fixes the geometry; vary area, tilt, azimuth"),
    ),
]
ViewFactor = Annotated[
    Number,
    Quantity("-", "View factor from one surface to another", Fixed("fixes the exchange factors"), FRACTION),
]
Height = Annotated[
    Number,
    Quantity(
        "m",
        "Height of the surface above ground, for the wind profile",
        Percent(25, "which point of the surface is meant"),
        POSITIVE,
    ),
]
Depth = Annotated[
    Number,
    Quantity(
        "m",
        "Depth of the sensor from the outside",
        Within(0.01, "position of a probe in a drilled hole"),
        NOT_NEGATIVE,
    ),
]

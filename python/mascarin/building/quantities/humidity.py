"""Quantities of the humidity of the air and of the moisture in materials."""

from __future__ import annotations

from typing import Annotated

from mascarin.building.base.number import Fixed, Limits, Number, Percent, Quantity, Span, Within
from mascarin.building.quantities.common import ABOVE_0_TO_1, FRACTION, NOT_NEGATIVE, POSITIVE, TABLES

InitialHumidity = Annotated[
    Number,
    Quantity(
        "-",
        "Relative humidity of airs and materials at the start of a run, or of its repeated first period",
        Within(0.1, "indoor air before the run"),
        ABOVE_0_TO_1,
    ),
]
LewisNumber = Annotated[
    Number,
    Quantity(
        "-",
        "Heat over vapour transfer coefficient of a surface, over the heat capacity of a cubic metre of air",
        Span(0.85, 1.1, "laminar to turbulent air"),
        Limits(above=0.1, at_most=10),
    ),
]
VapourStorage = Annotated[
    Number,
    Quantity(
        "-",
        "Vapour stored in the air and what is in the room, over that of the air alone",
        Span(1.0, 15.0, "empty to furnished"),
        Limits(at_least=1, at_most=1000),
    ),
]
LatentPower = Annotated[
    Number,
    Quantity(
        "W",
        "Latent heat at a schedule of 1",
        Percent(30, "activity and number of persons differ"),
        Limits(at_least=0, at_most=1e7),
    ),
]
VapourRate = Annotated[
    Number,
    Quantity(
        "kg/s",
        "Vapour at a schedule of 1",
        Percent(30, "activity and number of persons differ"),
        Limits(at_least=0, at_most=10),
    ),
]
RelativeHumidity = Annotated[
    Number,
    Quantity(
        "-",
        "Set point of the relative humidity",
        Within(0.05, "offset and hysteresis of a humidistat"),
        ABOVE_0_TO_1,
    ),
]
HumidityRatio = Annotated[
    Number,
    Quantity(
        "kg/kg",
        "Set point of the humidity ratio",
        Percent(10, "offset and hysteresis of a humidistat"),
        Limits(above=0, at_most=0.2),
    ),
]
LatentCapacity = Annotated[
    Number,
    Quantity(
        "W",
        "Maximum latent heat that is taken away or added",
        Percent(20, "rated and actual conditions differ"),
        NOT_NEGATIVE,
    ),
]
SensibleHeatRatio = Annotated[
    Number,
    Quantity(
        "-",
        "Sensible over total heat that a cooling coil takes away",
        Within(0.1, "air flow and humidity of the entering air"),
        ABOVE_0_TO_1,
    ),
]
CoilTemperature = Annotated[
    Number,
    Quantity(
        "degC",
        "Temperature of the coil: the room gets no drier than air saturated at it",
        Within(3, "kind of the unit and its load"),
        Limits(at_least=-30, at_most=40),
    ),
]
VapourRecovery = Annotated[
    Number,
    Quantity(
        "-",
        "Effectiveness of the recovery of vapour, of the smaller flow",
        Within(0.1, "tests and operation differ; leaks in the unit"),
        FRACTION,
    ),
]
ContentFactor = Annotated[
    Number,
    Quantity("-", "Factor of the moisture contents", Within(0.3, TABLES), POSITIVE),
]
VapourResistance = Annotated[
    Number,
    Quantity(
        "-",
        "Vapour resistance factor: of the material over that of still air",
        Percent(30, TABLES),
        Limits(at_least=1, at_most=1e7),
    ),
]
AirThickness = Annotated[
    Number,
    Quantity(
        "m",
        "Paint: thickness of still air of the same resistance to vapour",
        Percent(50, "kind and number of coats"),
        NOT_NEGATIVE,
    ),
]
PenetrationDepth = Annotated[
    Number,
    Quantity("m", "Depth of the layer that takes up vapour", Percent(30, TABLES), POSITIVE),
]
HumidityPeriod = Annotated[
    Number,
    Quantity(
        "h",
        "Period of the swing of humidity, which the depth of the layer follows from",
        Percent(30, "the swing of a day, of a few days or of a season"),
        POSITIVE,
    ),
]
TableHumidity = Annotated[
    Number,
    Quantity("-", "Relative humidity", Fixed("a point of a table; vary the factor of the table"), FRACTION),
]
TableContent = Annotated[
    Number,
    Quantity(
        "kg/m3",
        "Moisture content",
        Fixed("a point of a table; vary the factor of the table"),
        NOT_NEGATIVE,
    ),
]

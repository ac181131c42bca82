"""Quantities of infiltration, ventilation and openings."""

from __future__ import annotations

from typing import Annotated

from mascarin.building.base.number import Fixed, Limits, Number, OnlyGiven, Percent, Quantity, Span, Within
from mascarin.building.quantities.common import FRACTION, NOT_NEGATIVE, POSITIVE

CapacityFactor = Annotated[
    Number,
    Quantity(
        "-",
        "Heat capacity of air and contents divided by that of the air",
        Span(1, 5, "empty to furnished"),
        POSITIVE,
    ),
]
AirChange = Annotated[
    Number,
    Quantity(
        "1/h",
        "Air changes with outdoors",
        Span(0, 1, "sealed to leaky, with windows closed"),
        Limits(at_least=0, at_most=1000),
    ),
]
AirChangePerKelvin = Annotated[
    Number,
    Quantity(
        "1/(h K)",
        "Air changes with outdoors for each kelvin between inside and outside",
        Span(0, 0.02, "stack effect over one story of a leaky wall"),
        Limits(at_least=0, at_most=100),
    ),
]
AirChangePerSpeed = Annotated[
    Number,
    Quantity(
        "1/(h m/s)",
        "Air changes with outdoors for each metre per second of wind",
        Span(0, 0.1, "sheltered and tight to exposed and leaky"),
        Limits(at_least=0, at_most=100),
    ),
]

Ventilation = Annotated[
    Number,
    Quantity(
        "1/h",
        "Air changes of ventilation from outdoors, at the density of the site if 'density' names no other",
        Percent(20, "fans against the resistance of filters and ducts"),
        Limits(at_least=0, at_most=1000),
    ),
]
AirGradient = Annotated[
    Number,
    Quantity(
        "K/m",
        "Vertical gradient of the air temperature of the zone, about its mean at middle height",
        Percent(50, "heaters, openings and sun change it; measured at two heights it is known better"),
        Limits(at_least=-20, at_most=20),
    ),
]
MixingAirChange = Annotated[
    Number,
    Quantity(
        "1/h",
        "Air that a fan moves within the zone, over the volume of the zone",
        Percent(30, "fans blow more or less than their plates say, and a part of it returns at once"),
        Limits(at_least=0, at_most=1000),
    ),
]
VolumeFlow = Annotated[
    Number,
    Quantity(
        "m3/s",
        "Volume flow of air, at the density of the site if 'density' names no other",
        Percent(20, "fans against the resistance of filters and ducts; doors ajar or open"),
        Limits(at_least=0, at_most=1000),
    ),
]
FlowDensity = Annotated[
    Number,
    Quantity(
        "kg/m3",
        "Density of the air that the flow is a volume of",
        Percent(5, "15 K of temperature or 50 hPa between the fan's test and its place"),
        Limits(above=0, at_most=3),
    ),
]
OpeningArea = Annotated[
    Number,
    Quantity("m2", "Free area of the opening", Percent(20, "meshes, blades, opening angle"), POSITIVE),
]
OpeningHeight = Annotated[
    Number,
    Quantity(
        "m",
        "Vertical distance between the middle of the opening and the neutral level",
        Percent(30, "the neutral level depends on all leaks"),
        Limits(at_least=0, at_most=500),
    ),
]
Discharge = Annotated[
    Number,
    Quantity(
        "-",
        "Discharge coefficient of the opening",
        Span(0.4, 0.8, "two-way through one opening to rounded edges"),
        FRACTION,
    ),
]
WindCoefficient = Annotated[
    Number,
    Quantity(
        "-",
        "Effectiveness of the opening for the wind at the mast",
        Span(
            0.05,
            0.6,
            "sheltered, by diagonal wind (0.25 to 0.35), to wind square on the opening (0.5 to 0.6)",
        ),
        FRACTION,
    ),
]
Recovery = Annotated[
    Number,
    Quantity(
        "-",
        "Sensible effectiveness of heat recovery, of the smaller flow",
        Within(0.1, "tests and operation differ; leaks in the unit"),
        FRACTION,
    ),
]
DoorWidth = Annotated[
    Number,
    Quantity("m", "Width of the door", Percent(5, "frame and leaf"), Limits(above=0, at_most=100)),
]
DoorHeight = Annotated[
    Number,
    Quantity("m", "Height of the door", Percent(3, "frame and threshold"), Limits(above=0, at_most=50)),
]
OpenFraction = Annotated[
    Number,
    Quantity("-", "Fraction of the width that is open", Within(0.1, "how far the leaf is open"), FRACTION),
]
LinearTransmittance = Annotated[
    Number,
    Quantity(
        "W/(m K)",
        "Linear thermal transmittance, psi",
        Percent(50, "catalogues against the joint as built: 20 to 50 % (EN ISO 14683)"),
        Limits(at_least=-10, at_most=100),
    ),
]
BridgeLength = Annotated[
    Number, Quantity("m", "Length of the joint", Percent(5, "measured from plans"), NOT_NEGATIVE)
]
PointTransmittance = Annotated[
    Number,
    Quantity(
        "W/K",
        "Point thermal transmittance, chi",
        Percent(50, "catalogues against the fixing as built"),
        Limits(at_least=-100, at_most=1e4),
    ),
]
ConvertedTransmittance = Annotated[
    Number,
    Quantity(
        "W/K",
        "What the conversion to the dimensions of the areas adds to a bridge",
        OnlyGiven("follows from U values and areas: it varies only if a range is given"),
        Limits(at_least=-1e4, at_most=1e4),
    ),
]
AreaExcess = Annotated[
    Number,
    Quantity(
        "m2",
        "Area of the surface as described less its area in the dimensions of psi or chi, at this bridge",
        Fixed("it belongs to the areas, which are structural"),
        Limits(at_least=-1e5, at_most=1e5),
    ),
]
BridgeNumber = Annotated[
    Number,
    Quantity(
        "-", "Number of such bridges", OnlyGiven("counted: it varies only if a range is given"), NOT_NEGATIVE
    ),
]
_CHOSEN = OnlyGiven("chosen for the control: it varies only if a range is given")
VentHeight = Annotated[
    Number,
    Quantity(
        "m",
        "Height of the opening itself: air passes both ways; none: it passes in one direction",
        Percent(10, "frame and opening angle"),
        Limits(above=0, at_most=50),
    ),
]
Elevation = Annotated[
    Number,
    Quantity(
        "m",
        "Height of the middle of the opening above the ground",
        Within(0.1, "measured from plans"),
        Limits(at_least=0, at_most=500),
    ),
]
FlowExponent = Annotated[
    Number,
    Quantity(
        "-",
        "Exponent of the pressure difference in the flow; for other ones than 0.5 the area is that at 4 Pa",
        OnlyGiven("0.5 for openings; 0.6 to 0.7 for leaks"),
        Limits(at_least=0.5, at_most=1.0),
    ),
]
Shelter = Annotated[
    Number,
    Quantity(
        "-",
        "Speed of the wind at the opening over that on the open ground of the site",
        Span(0.3, 1.0, "between close buildings or trees to free"),
        Limits(at_least=0, at_most=2),
    ),
]
SideRatio = Annotated[
    Number,
    Quantity(
        "-",
        "Length of the wall over that of the walls beside it",
        Percent(10, "measured from plans"),
        Limits(at_least=0.1, at_most=10),
    ),
]
PressureCoefficient = Annotated[
    Number,
    Quantity(
        "-",
        "Wind pressure coefficient",
        Fixed("a point of a measured curve; vary the shelter instead"),
        Limits(at_least=-5, at_most=3),
    ),
]
ControlTemperature = Annotated[
    Number, Quantity("degC", "Limit of a control", _CHOSEN, Limits(at_least=-60, at_most=90))
]
ControlDifference = Annotated[
    Number, Quantity("K", "Limit of a control", _CHOSEN, Limits(at_least=-100, at_most=100))
]
ControlSpeed = Annotated[
    Number, Quantity("m/s", "Limit of a control", _CHOSEN, Limits(at_least=0, at_most=110))
]
ControlRain = Annotated[
    Number, Quantity("mm/h", "Limit of a control", _CHOSEN, Limits(at_least=0, at_most=1000))
]
MinimumTime = Annotated[
    Number,
    Quantity("min", "Time for which a control keeps its state", _CHOSEN, Limits(at_least=0, at_most=10080)),
]

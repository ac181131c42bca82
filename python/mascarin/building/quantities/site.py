"""Quantities of the site, its wind and its sky."""

from __future__ import annotations

from typing import Annotated

from mascarin.building.base.number import Fixed, Limits, Number, Percent, Quantity, Span, Within
from mascarin.building.quantities.common import FIT, FRACTION, POSITIVE

Latitude = Annotated[
    Number,
    Quantity(
        "deg",
        "Latitude, north positive",
        Fixed("acts through the position of the sun in the forcing"),
        Limits(at_least=-90, at_most=90),
    ),
]
Longitude = Annotated[
    Number,
    Quantity(
        "deg",
        "Longitude, east positive",
        Fixed("acts through the position of the sun in the forcing"),
        Limits(at_least=-180, at_most=180),
    ),
]
Altitude = Annotated[
    Number,
    Quantity(
        "m",
        "Altitude above sea level; gives the density of the air where none is given",
        Within(50, "height of the site and of the station; 50 m are 0.6 % of pressure"),
        Limits(at_least=-500, at_most=9000),
    ),
]
AirDensity = Annotated[
    Number,
    Quantity(
        "kg/m3",
        "Density of the air in the zones and of the air that flows into them",
        Percent(3, "10 K of temperature or 30 hPa of weather"),
        Limits(above=0, at_most=3),
    ),
]
AirSpecificHeat = Annotated[
    Number,
    Quantity(
        "J/(kg K)",
        "Specific heat of the air in the zones and of the air that flows into them; none: dry air, 1006",
        Percent(2, "0 to 25 g of water vapour in a kilogram of air"),
        Limits(at_least=500, at_most=5000),
    ),
]
SkyExponent = Annotated[
    Number,
    Quantity(
        "-",
        "Exponent of the view factor of the sky, of its long-wave radiation on a tilted surface: 1 for an "
        "isotropic sky, 1.5 for one that is warmer near the horizon; none: 1.5",
        Span(1.0, 1.6, "an isotropic sky, and a clear one (Unsworth & Monteith 1975)"),
        Limits(at_least=0.5, at_most=3.0),
    ),
]
SkyDiurnal = Annotated[
    Number,
    Quantity(
        "W/m2",
        "Infrared radiation of the sky beside that of its model, times the sine of the altitude of the sun "
        "(negative at night); none: 0",
        Within(40.0, "models of the sky are 19 W/m2 wrong within a day (Flerchinger et al. 2009)"),
        Limits(at_least=-150.0, at_most=150.0),
    ),
]
HorizonAzimuth = Annotated[
    Number,
    Quantity(
        "deg",
        "Azimuth of a point of the horizon, clockwise from north",
        Fixed("a point of a surveyed curve"),
        Limits(at_least=0, at_most=360),
    ),
]
HorizonElevation = Annotated[
    Number,
    Quantity(
        "deg",
        "Elevation of a point of the horizon",
        Fixed("a point of a surveyed curve"),
        Limits(at_least=0, at_most=90),
    ),
]
GroundReflectance = Annotated[
    Number,
    Quantity(
        "-",
        "Solar reflectance of the ground",
        Span(0.1, 0.35, "wet asphalt to dry concrete; snow is outside and must be given"),
        FRACTION,
    ),
]
MastHeight = Annotated[
    Number,
    Quantity("m", "Height of the anemometer", Percent(20, "masts of 8 to 12 m are named 10 m"), POSITIVE),
]
WindExponent = Annotated[
    Number,
    Quantity(
        "-",
        "Exponent of the wind profile",
        Within(0.05, "one class of terrain up or down"),
        Limits(at_least=0, at_most=1),
    ),
]
BoundaryLayer = Annotated[
    Number,
    Quantity(
        "m",
        "Thickness of the atmospheric boundary layer",
        Percent(25, "one class of terrain up or down"),
        POSITIVE,
    ),
]
CloudEmissivity = Annotated[
    Number,
    Quantity(
        "-",
        "Long-wave emissivity of the clouds",
        Span(0.8, 1.0, "water clouds are black to long-wave radiation; thin ones are not"),
        Limits(at_least=0, at_most=1),
    ),
]
CloudBase = Annotated[
    Number,
    Quantity(
        "m",
        "Height of the base of the clouds above the ground",
        Span(300, 3000, "WMO-No. 407: low clouds to 2 km, the lower half of the middle ones"),
        Limits(at_least=0, at_most=20000),
    ),
]
CloudCoefficient = Annotated[
    Number, Quantity("-", "Coefficient of the cubic cloud factor on the sky's emissivity", Percent(10, FIT))
]

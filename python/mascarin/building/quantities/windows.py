"""Quantities of panes, gaps, glazings and frames."""

from __future__ import annotations

from typing import Annotated

from mascarin.building.base.number import Fixed, Limits, Number, Percent, Quantity, Within
from mascarin.building.quantities.common import FRACTION, POSITIVE, TAPE

RevealDepth = Annotated[
    Number,
    Quantity(
        "m",
        "Distance of the glass behind the outer plane of its wall",
        Fixed("fixes the geometry of the shadows; compare variants of the building"),
        Limits(above=0, at_most=5),
    ),
]
OverhangLength = Annotated[
    Number,
    Quantity(
        "m",
        "Length that places an overhang over a window",
        Fixed("fixes the geometry of the shadows; compare variants of the building"),
        Limits(at_least=0, at_most=50),
    ),
]
OverhangDepth = Annotated[
    Number,
    Quantity(
        "m",
        "Depth of the overhang before the outer plane of the wall",
        Fixed("fixes the geometry of the shadows; compare variants of the building"),
        Limits(above=0, at_most=50),
    ),
]
PaneThickness = Annotated[
    Number,
    Quantity(
        "m", "Thickness of the pane", Within(2e-4, "tolerance of float glass"), Limits(above=0, at_most=0.2)
    ),
]
GapThickness = Annotated[
    Number,
    Quantity(
        "m",
        "Width of the gap",
        Within(1e-3, "spacers, and bending of the panes"),
        Limits(above=0, at_most=0.5),
    ),
]
GapPressure = Annotated[
    Number,
    Quantity(
        "Pa",
        "Pressure in the gap",
        Percent(20, "sealed at one altitude and temperature, used at another"),
        Limits(above=0, at_most=2e5),
    ),
]
GapConductance = Annotated[
    Number,
    Quantity(
        "W/(m2 K)",
        "Conductance of the gap, convection and radiation together",
        Percent(10, "it changes with the temperatures of the panes"),
        Limits(above=0, at_most=1000),
    ),
]
Transmittance = Annotated[
    Number,
    Quantity(
        "-",
        "Solar transmittance of the pane at normal incidence",
        Percent(3, "batch and dirt"),
        Limits(at_least=1e-3, at_most=1),
    ),
]
Reflectance = Annotated[
    Number,
    Quantity(
        "-", "Solar reflectance of the pane at normal incidence", Percent(10, "batch and dirt"), FRACTION
    ),
]
CurveAngle = Annotated[
    Number,
    Quantity(
        "deg",
        "Angle of incidence of a table of optics",
        Fixed("a point of a measured curve; vary transmittance_scale and absorptance_scale instead"),
        Limits(at_least=0, at_most=90),
    ),
]
CurveOptic = Annotated[
    Number,
    Quantity(
        "-",
        "Transmittance, reflectance or absorptance at a point of a table",
        Fixed("a point of a measured curve; vary transmittance_scale and absorptance_scale instead"),
        FRACTION,
    ),
]
OpticScale = Annotated[
    Number,
    Quantity(
        "-", "Factor on a table of optics", Within(0.03, "batch and dirt"), Limits(above=0, at_most=1.5)
    ),
]
GlazingU = Annotated[
    Number,
    Quantity(
        "W/(m2 K)", "Rated U value of the glazing, air to air", Percent(5, "rounding, ageing"), POSITIVE
    ),
]
SolarHeatGain = Annotated[
    Number,
    Quantity(
        "-",
        "Total solar heat gain of the glazing at normal incidence",
        Within(0.03, "rounding and dirt"),
        Limits(above=0, at_most=0.95),
    ),
]
UnitTransmittance = Annotated[
    Number,
    Quantity(
        "-",
        "Solar transmittance of the whole glazing at normal incidence (EN 410, direct)",
        Percent(3, "batch and dirt"),
        Limits(at_least=1e-3, at_most=0.95),
    ),
]
PaneCount = Annotated[
    Number,
    Quantity(
        "-",
        "Number of panes, for the angular dependence",
        Within(0.5, "often not given"),
        Limits(at_least=1, at_most=6),
    ),
]
GlassCategory = Annotated[
    Number,
    Quantity(
        "-",
        "Category of glass, for the angular dependence: 4 clear, below coated, above tinted",
        Within(1.0, "often not given"),
        Limits(at_least=1, at_most=10),
    ),
]
SurfaceResistance = Annotated[
    Number,
    Quantity(
        "m2 K/W",
        "Surface resistance that a rated U value contains",
        Percent(10, "standards differ"),
        Limits(above=0, at_most=1),
    ),
]
WindowArea = Annotated[
    Number, Quantity("m2", "Area of the window, frame included", Percent(5, TAPE), POSITIVE)
]
BlindTransmittance = Annotated[
    Number,
    Quantity("-", "Solar transmittance of the blind", Within(0.05, "products of one color"), FRACTION),
]
BlindReflectance = Annotated[
    Number,
    Quantity(
        "-", "Solar reflectance of both sides of the blind", Within(0.15, "color, age and dirt"), FRACTION
    ),
]
BlindResistance = Annotated[
    Number,
    Quantity(
        "m2 K/W",
        "Resistance of the closed blind, with the air between it and the glass",
        Percent(40, "air permeability, EN 13125"),
        Limits(at_least=0, at_most=5),
    ),
]
ShutterResistance = Annotated[
    Number,
    Quantity(
        "m2 K/W",
        "Resistance of the shutter itself, without the air behind it",
        Fixed("gives the resistance of the closed blind; vary that"),
        Limits(at_least=0, at_most=5),
    ),
]
BlindCover = Annotated[
    Number,
    Quantity("-", "Part of the glass that the closed blind covers", Within(0.05, "gaps at edges"), FRACTION),
]
BlindToAir = Annotated[
    Number,
    Quantity(
        "-",
        "Part of the sun absorbed by a blind in the room that the air behind it carries into the room",
        Within(0.15, "gaps at the edges, size of the gap"),
        FRACTION,
    ),
]
BlindRadiation = Annotated[
    Number,
    Quantity(
        "W/m2",
        "Irradiance of the window above which the blind is closed",
        Percent(20, "sensors of controls"),
        Limits(at_least=0, at_most=1500),
    ),
]
CavityHeight = Annotated[
    Number,
    Quantity("m", "Height of the gaps of a window", Percent(5, TAPE), POSITIVE),
]
FrameFraction = Annotated[
    Number,
    Quantity(
        "-",
        "Fraction of the frame in the area of the window",
        Within(0.05, "profiles of the same name differ"),
        Limits(above=0, at_most=0.9),
    ),
]
FrameU = Annotated[
    Number,
    Quantity(
        "W/(m2 K)",
        "U value of the frame, air to air, with surface resistances of 0.17 m2 K/W in total",
        Percent(10, "profiles of the same name differ"),
        Limits(above=0, at_most=5.8),
    ),
]
SunShare = Annotated[
    Number,
    Quantity(
        "-",
        "Fraction of the solar radiation that enters the zone",
        Percent(20, "it changes with the position of the sun"),
        FRACTION,
    ),
]

"""Every quantity of the description, one entry each: unit, meaning, default range with its reason, limits.

The default ranges are what a careful person would believe about a value taken from a table or a data
sheet. They are the starting point of a sensitivity analysis; a description may narrow or widen each of them.
"""

from __future__ import annotations

from typing import Annotated

from mascarin.building.number import Fixed, Limits, Number, Percent, Quantity, Span, Within

POSITIVE = Limits(above=0)
NOT_NEGATIVE = Limits(at_least=0)
FRACTION = Limits(at_least=0, at_most=1)
SHARE = Limits(above=0, at_most=1)
TEMPERATURE = Limits(at_least=-100, at_most=1000)

_FIT = "standard error of the published fit and the spread between the sites it was made for"
_TABLES = "spread between tables for the same name, moisture, temperature, ageing"
_GEOMETRY = "a tape measure, and the choice between inside and outside dimensions"

# --- Site ---------------------------------------------------------------------------------------------------

Latitude = Annotated[
    Number,
    Quantity(
        "deg",
        "Latitude, north positive",
        Fixed("acts through the sun's path in the forcing"),
        Limits(at_least=-90, at_most=90),
    ),
]
Longitude = Annotated[
    Number,
    Quantity(
        "deg",
        "Longitude, east positive",
        Fixed("acts through the sun's path in the forcing"),
        Limits(at_least=-180, at_most=180),
    ),
]
Altitude = Annotated[
    Number,
    Quantity(
        "m",
        "Altitude above sea level; gives the density of the air where none is written",
        Within(50, "height of the plot against the station's; 50 m are 0.6 % of pressure"),
        Limits(at_least=-500, at_most=9000),
    ),
]
AirDensity = Annotated[
    Number,
    Quantity(
        "kg/m3",
        "Density of the air in the zones and of the air that enters them",
        Percent(3, "10 K of temperature or 30 hPa of weather"),
        Limits(above=0, at_most=3),
    ),
]
GroundReflectance = Annotated[
    Number,
    Quantity(
        "-",
        "Solar reflectance of the ground",
        Span(0.1, 0.35, "wet asphalt to dry concrete; snow lies outside and has to be written"),
        FRACTION,
    ),
]
MastHeight = Annotated[
    Number,
    Quantity(
        "m", "Height of the anemometer", Percent(20, "masts of 8 to 12 m are all called 10 m"), POSITIVE
    ),
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
SkyCoefficient = Annotated[
    Number, Quantity("-", "Coefficient of the emissivity of the clear sky", Percent(10, _FIT))
]
SkyScale = Annotated[
    Number,
    Quantity(
        "-",
        "Factor on the measured infrared of the sky",
        Within(0.05, "calibration of a pyrgeometer, and its own body's radiation"),
        POSITIVE,
    ),
]
SkyDepression = Annotated[
    Number,
    Quantity(
        "K",
        "Outdoor air temperature less sky temperature",
        Span(3, 20, "overcast to clear and dry; the annual means of ISO 13790 run from 9 to 13 K"),
        Limits(at_least=-10, at_most=60),
    ),
]
CloudCoefficient = Annotated[
    Number, Quantity("-", "Coefficient of the cubic cloud factor on the sky's emissivity", Percent(10, _FIT))
]

# --- Materials ----------------------------------------------------------------------------------------------

Conductivity = Annotated[
    Number,
    Quantity("W/(m K)", "Thermal conductivity", Percent(20, _TABLES), Limits(above=0, at_most=5000)),
]
Density = Annotated[
    Number, Quantity("kg/m3", "Density", Percent(10, "batch and moisture"), Limits(above=0, at_most=25000))
]
# Lead and gold, the lowest in use, have 130 J/(kg K); a value in kJ/(kg K) lies far below the limit.
SpecificHeat = Annotated[
    Number, Quantity("J/(kg K)", "Specific heat", Percent(10, _TABLES), Limits(at_least=100, at_most=20000))
]
# A phase may have next to none of its own where the latent heat or the enthalpy table holds it all.
PhaseSpecificHeat = Annotated[
    Number, Quantity("J/(kg K)", "Specific heat", Percent(10, _TABLES), Limits(above=0, at_most=20000))
]
Resistance = Annotated[
    Number,
    Quantity(
        "m2 K/W",
        "Thermal resistance",
        Percent(50, "air spaces and contacts depend on how they were closed"),
        Limits(above=0, at_most=100),
    ),
]
LatentHeat = Annotated[
    Number,
    Quantity(
        "J/kg",
        "Latent heat of melting",
        Percent(10, "calorimetry between laboratories and the integration limits chosen"),
        Limits(at_least=0, at_most=1e6),
    ),
]
MeltingTemperature = Annotated[
    Number,
    Quantity(
        "degC",
        "Temperature of melting: half is liquid, or (triangle, gumbel) the capacity peaks",
        Within(1, "calorimeters at another rate and sample mass than the wall's"),
        TEMPERATURE,
    ),
]
MeltingWidth = Annotated[
    Number,
    Quantity(
        "K",
        "Half-width w of the melting range: liquid fraction (1 + tanh((T - Tm)/w))/2",
        Percent(50, "the width seen by a calorimeter depends on its heating rate"),
        Limits(above=0, at_most=100),
    ),
]
Gamma = Annotated[
    Number,
    Quantity(
        "-",
        "Steepness gamma of the melting curve; only gamma/delta_t acts, w = 4 delta_t/gamma",
        Percent(50, "as for the width it stands for"),
        Limits(above=0, at_most=1e4),
    ),
]
DeltaT = Annotated[
    Number,
    Quantity(
        "K",
        "Interval delta T of the melting curve; only gamma/delta_t acts, w = 4 delta_t/gamma",
        Percent(10, "a convention that goes with gamma"),
        Limits(above=0, at_most=100),
    ),
]
FreezingTemperature = Annotated[
    Number,
    Quantity(
        "degC",
        "Temperature about which the material freezes, where hysteresis gives it a cooling curve",
        Within(1, "calorimeters at another rate and sample mass than the wall's"),
        TEMPERATURE,
    ),
]
_WIDTH = Percent(50, "the width seen by a calorimeter depends on its heating rate")
EndToMiddle = Annotated[
    Number,
    Quantity("K", "From the middle of the melting range to either end", _WIDTH, Limits(above=0, at_most=100)),
]
Deviation = Annotated[
    Number,
    Quantity("K", "Standard deviation of the latent capacity", _WIDTH, Limits(above=0, at_most=100)),
]
GumbelScale = Annotated[
    Number,
    Quantity("K", "Scale of the Gumbel distribution", _WIDTH, Limits(above=0, at_most=100)),
]
Flank = Annotated[
    Number,
    Quantity(
        "K",
        "From the peak of the latent capacity to the end of melting",
        _WIDTH,
        Limits(above=0, at_most=100),
    ),
]
Continuity = Annotated[
    Number,
    Quantity(
        "-",
        "Continuous derivatives of the liquid fraction",
        Fixed("chooses the polynomial"),
        Limits(at_least=1, at_most=2),
        whole=True,
    ),
]
CurveFraction = Annotated[
    Number,
    Quantity(
        "-",
        "Liquid fraction of a point of the curve",
        Fixed("shapes the curve; vary temperature_shift instead"),
        Limits(at_least=0, at_most=1),
    ),
]
CurveCapacity = Annotated[
    Number,
    Quantity(
        "J/(kg K)",
        "Apparent specific heat of a point of the curve, sensible heat included",
        Fixed("shapes the curve; vary enthalpy_scale instead"),
        Limits(above=0),
    ),
]
CurveTemperature = Annotated[
    Number,
    Quantity(
        "degC",
        "Temperature of a point of the enthalpy curve",
        Fixed("shapes the curve; vary temperature_shift instead"),
        TEMPERATURE,
    ),
]
CurveEnthalpy = Annotated[
    Number,
    Quantity(
        "J/kg",
        "Specific enthalpy of a point of the curve",
        Fixed("shapes the curve; vary enthalpy_scale instead"),
    ),
]
TemperatureShift = Annotated[
    Number,
    Quantity(
        "K",
        "Shift of the enthalpy curve towards higher temperatures",
        Within(1, "calorimeters at another rate and sample mass than the wall's"),
        Limits(at_least=-100, at_most=100),
    ),
]
EnthalpyScale = Annotated[
    Number,
    Quantity("-", "Factor on the enthalpy curve", Within(0.1, "calorimetry between laboratories"), POSITIVE),
]
Thickness = Annotated[
    Number,
    Quantity(
        "m", "Thickness of the layer", Percent(5, "manufacturing and laying"), Limits(above=0, at_most=20)
    ),
]
NodeCount = Annotated[
    Number,
    Quantity(
        "-",
        "Number of finite volumes in the layer",
        Fixed("shapes the mesh"),
        Limits(at_least=1, at_most=1000),
        whole=True,
    ),
]

# --- Geometry -----------------------------------------------------------------------------------------------

Volume = Annotated[Number, Quantity("m3", "Volume of air", Percent(5, _GEOMETRY), POSITIVE)]
Area = Annotated[Number, Quantity("m2", "Area of the surface", Percent(5, _GEOMETRY), POSITIVE)]
Tilt = Annotated[
    Number,
    Quantity(
        "deg",
        "Tilt of the outside normal: 0 up, 90 vertical, 180 down",
        Within(2, "a spirit level on a real roof"),
        Limits(at_least=0, at_most=180),
    ),
]
Azimuth = Annotated[
    Number,
    Quantity(
        "deg",
        "Azimuth of the outside normal, clockwise from north",
        Within(5, "a compass beside steel, a plan's north"),
        Limits(at_least=-360, at_most=360),
    ),
]
Coordinate = Annotated[
    Number,
    Quantity(
        "m",
        "Coordinate of a vertex: x east, y north, z up",
        Fixed("shapes the geometry; vary area, tilt, azimuth"),
    ),
]
ViewFactor = Annotated[
    Number,
    Quantity("-", "View factor from one face to another", Fixed("shapes the exchange factors"), FRACTION),
]
Height = Annotated[
    Number,
    Quantity(
        "m",
        "Height of the face above ground, for the wind profile",
        Percent(25, "which point of the face stands for it"),
        POSITIVE,
    ),
]
Depth = Annotated[
    Number,
    Quantity(
        "m",
        "Depth of the sensor from the outside face",
        Within(0.01, "where a probe ends up when a hole is drilled"),
        NOT_NEGATIVE,
    ),
]

# --- Faces --------------------------------------------------------------------------------------------------

Emissivity = Annotated[
    Number,
    Quantity("-", "Long-wave emissivity", Within(0.05, "oxidation, dust and paint"), SHARE),
]
Absorptance = Annotated[
    Number,
    Quantity(
        "-", "Solar absorptance", Within(0.1, "soiling and fading; colours are judged by eye"), FRACTION
    ),
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
SkyView = Annotated[
    Number, Quantity("-", "Fraction of the sky seen", Within(0.1, "trees and neighbours"), FRACTION)
]
ReferenceTemperature = Annotated[
    Number,
    Quantity(
        "degC",
        "Temperature about which long-wave exchange is linearised",
        Within(5, "the mean of the period is not known beforehand; 1 K is 1 % of the coefficient"),
        TEMPERATURE,
    ),
]
GroundTemperature = Annotated[
    Number,
    Quantity("degC", "Annual mean temperature of the ground", Within(2, "depth and cover"), TEMPERATURE),
]
GroundAmplitude = Annotated[
    Number,
    Quantity(
        "K",
        "Annual amplitude of the ground's temperature",
        Span(0, 5, "metres deep to just below the floor"),
        Limits(at_least=0, at_most=60),
    ),
]
ColdestDay = Annotated[
    Number,
    Quantity(
        "d",
        "Day of the year on which the ground is coldest",
        Within(20, "the lag grows with depth"),
        Limits(at_least=-366, at_most=366),
    ),
]

# --- Air ----------------------------------------------------------------------------------------------------

CapacityFactor = Annotated[
    Number,
    Quantity(
        "-",
        "Heat capacity of air and contents over that of the air alone",
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
        Span(0, 0.02, "stack effect over one storey of a leaky wall"),
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
        "Air changes of ventilation from outdoors, at the density of the site",
        Percent(20, "fans against the resistance of filters and ducts"),
        Limits(at_least=0, at_most=1000),
    ),
]
VolumeFlow = Annotated[
    Number,
    Quantity(
        "m3/s",
        "Volume flow of air at the density of the site",
        Percent(20, "fans against the resistance of filters and ducts; doors ajar or open"),
        Limits(at_least=0, at_most=1000),
    ),
]
OpeningArea = Annotated[
    Number,
    Quantity("m2", "Free area of the opening", Percent(20, "meshes, blades, how far it is opened"), POSITIVE),
]
OpeningHeight = Annotated[
    Number,
    Quantity(
        "m",
        "Vertical distance between the middle of the opening and the neutral level",
        Percent(30, "the neutral level shifts with every other leak"),
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
        "Effectiveness of the opening against the wind at the mast",
        Span(
            0.05,
            0.6,
            "sheltered, by diagonal wind (0.25 to 0.35), to wind square on the opening (0.5 to 0.6)",
        ),
        FRACTION,
    ),
]

# --- Gains, plant, schedules --------------------------------------------------------------------------------

GainPower = Annotated[
    Number,
    Quantity("W", "Heat at full schedule", Percent(30, "name plates against what is drawn"), NOT_NEGATIVE),
]
Radiative = Annotated[
    Number,
    Quantity(
        "-", "Part of the heat that is radiated", Within(0.2, "handbooks give ranges as wide"), FRACTION
    ),
]
SetPoint = Annotated[
    Number,
    Quantity(
        "degC",
        "Air temperature that the plant keeps",
        Within(1, "a thermostat's place, offset and switching difference"),
        Limits(at_least=-60, at_most=90),
    ),
]
Capacity = Annotated[
    Number,
    Quantity(
        "W",
        "Most heat that the plant gives or takes",
        Percent(20, "rated against site conditions"),
        NOT_NEGATIVE,
    ),
]
ScheduledFraction = Annotated[
    Number,
    Quantity(
        "-",
        "Fraction",
        Fixed("acts through the forcing; vary the number that it multiplies"),
        FRACTION,
    ),
]
ScheduledTemperature = Annotated[
    Number,
    Quantity(
        "degC",
        "Temperature",
        Fixed("acts through the forcing; vary a set point without a schedule"),
        Limits(at_least=-60, at_most=90),
    ),
]

# --- Convection ---------------------------------------------------------------------------------------------

Film = Annotated[
    Number,
    Quantity(
        "W/(m2 K)",
        "Film coefficient",
        Percent(50, "published coefficients for the same face differ by half"),
        Limits(at_least=0, at_most=1e5),
    ),
]
FilmPerSpeed = Annotated[
    Number,
    Quantity(
        "W/(m2 K)/(m/s)",
        "Rise of the film coefficient with wind speed",
        Percent(50, "published slopes run from 2 to 6"),
        Limits(at_least=0, at_most=1e3),
    ),
]
ConvectionFactor = Annotated[
    Number,
    Quantity(
        "-",
        "Factor on the correlation",
        Percent(30, "scatter of full-scale measurements about the correlations"),
        NOT_NEGATIVE,
    ),
]
ConvectionLength = Annotated[
    Number,
    Quantity(
        "m",
        "Characteristic length: height of a vertical face, 4 area/perimeter of a horizontal one",
        Percent(25, "faces are no free plates"),
        POSITIVE,
    ),
]
Perimeter = Annotated[
    Number,
    Quantity("m", "Perimeter met by the wind", Percent(20, "whether neighbouring faces count"), POSITIVE),
]
Roughness = Annotated[
    Number,
    Quantity(
        "-",
        "Roughness factor of the forced part",
        Span(1.0, 2.17, "very smooth to very rough"),
        Limits(above=0, at_most=5),
        words={
            "very_rough": 2.17,
            "rough": 1.67,
            "medium_rough": 1.52,
            "medium_smooth": 1.13,
            "smooth": 1.11,
            "very_smooth": 1.0,
        },
    ),
]
PowerConstant = Annotated[
    Number,
    Quantity(
        "W/(m2 K)",
        "Constant part a of a + b |dT|^n + c V^m",
        Span(0, 5, "still air between plates"),
        NOT_NEGATIVE,
    ),
]
PowerBuoyant = Annotated[
    Number,
    Quantity(
        "W/(m2 K^(n+1))",
        "Coefficient b of a + b |dT|^n + c V^m",
        Span(0, 3, "stable air to an upward plume; published values run from 0.5 to 2.3"),
        NOT_NEGATIVE,
    ),
]
PowerExponent = Annotated[
    Number,
    Quantity(
        "-",
        "Exponent n of a + b |dT|^n + c V^m",
        Span(0.2, 0.4, "stable layers 1/5, laminar 1/4, turbulent 1/3"),
        Limits(at_least=0, at_most=2),
    ),
]
PowerForced = Annotated[
    Number,
    Quantity(
        "W/(m2 K (m/s)^m)",
        "Coefficient c of a + b |dT|^n + c V^m",
        Span(0, 6, "sheltered to exposed"),
        NOT_NEGATIVE,
    ),
]
PowerWindExponent = Annotated[
    Number,
    Quantity(
        "-",
        "Exponent m of a + b |dT|^n + c V^m",
        Span(0.5, 1.0, "laminar 1/2, turbulent 0.8, linear fits 1"),
        Limits(at_least=0, at_most=2),
    ),
]

# --- Windows ------------------------------------------------------------------------------------------------

PaneThickness = Annotated[
    Number,
    Quantity(
        "m", "Thickness of the pane", Within(2e-4, "tolerance of float glass"), Limits(above=0, at_most=0.2)
    ),
]
GapThickness = Annotated[
    Number,
    Quantity(
        "m", "Width of the gap", Within(1e-3, "spacers, and panes that bend"), Limits(above=0, at_most=0.5)
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
        Percent(3, "batch, and dirt"),
        Limits(at_least=1e-3, at_most=1),
    ),
]
Reflectance = Annotated[
    Number,
    Quantity(
        "-", "Solar reflectance of the pane at normal incidence", Percent(10, "batch, and dirt"), FRACTION
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
        "Share of the sun at a point of a table of optics",
        Fixed("a point of a measured curve; vary transmittance_scale and absorptance_scale instead"),
        FRACTION,
    ),
]
OpticScale = Annotated[
    Number,
    Quantity(
        "-", "Factor on a table of optics", Within(0.03, "batch, and dirt"), Limits(above=0, at_most=1.5)
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
        Within(0.03, "rounding, and dirt"),
        Limits(above=0, at_most=0.95),
    ),
]
PaneCount = Annotated[
    Number,
    Quantity(
        "-",
        "Number of panes, for the change with the angle",
        Within(0.5, "not always told"),
        Limits(at_least=1, at_most=6),
    ),
]
GlassCategory = Annotated[
    Number,
    Quantity(
        "-",
        "Category of glass, for the change with the angle: 4 clear, below coated, above tinted",
        Within(1.0, "not always told"),
        Limits(at_least=1, at_most=10),
    ),
]
FilmResistance = Annotated[
    Number,
    Quantity(
        "m2 K/W",
        "Film resistance that a rated U value contains",
        Percent(10, "standards differ"),
        Limits(above=0, at_most=1),
    ),
]
WindowArea = Annotated[
    Number, Quantity("m2", "Area of the window, frame included", Percent(5, _GEOMETRY), POSITIVE)
]
CavityHeight = Annotated[
    Number,
    Quantity("m", "Height of the gaps of a window", Percent(5, _GEOMETRY), POSITIVE),
]
FrameFraction = Annotated[
    Number,
    Quantity(
        "-",
        "Share of the frame in the window's area",
        Within(0.05, "profiles of one name differ"),
        Limits(above=0, at_most=0.9),
    ),
]
FrameU = Annotated[
    Number,
    Quantity(
        "W/(m2 K)",
        "U value of the frame, air to air, with films of 0.17 m2 K/W in all",
        Percent(10, "profiles of one name differ"),
        Limits(above=0, at_most=5.8),
    ),
]
SunShare = Annotated[
    Number,
    Quantity(
        "-",
        "Share of the sun let into the zone",
        Percent(20, "it changes with the height of the sun"),
        FRACTION,
    ),
]

"""Quantities of materials, layers and melting."""

from __future__ import annotations

from typing import Annotated

from mascarin.building.base.number import Fixed, Limits, Number, Percent, Quantity, Within
from mascarin.building.quantities.common import POSITIVE, TABLES, TEMPERATURE

Conductivity = Annotated[
    Number,
    Quantity("W/(m K)", "Thermal conductivity", Percent(20, TABLES), Limits(above=0, at_most=5000)),
]
Density = Annotated[
    Number, Quantity("kg/m3", "Density", Percent(10, "batch and moisture"), Limits(above=0, at_most=25000))
]
# The lowest are lead and gold, 130 J/(kg K); a value in kJ/(kg K) is far below the limit.
SpecificHeat = Annotated[
    Number, Quantity("J/(kg K)", "Specific heat", Percent(10, TABLES), Limits(at_least=100, at_most=20000))
]
# It may be close to zero where the latent heat or the enthalpy table includes it.
PhaseSpecificHeat = Annotated[
    Number, Quantity("J/(kg K)", "Specific heat", Percent(10, TABLES), Limits(above=0, at_most=20000))
]
Resistance = Annotated[
    Number,
    Quantity(
        "m2 K/W",
        "Thermal resistance",
        Percent(50, "air spaces and contacts depend on workmanship"),
        Limits(above=0, at_most=100),
    ),
]
LatentHeat = Annotated[
    Number,
    Quantity(
        "J/kg",
        "Latent heat of melting",
        Percent(10, "judgement: calorimetry between laboratories and the integration limits chosen"),
        Limits(at_least=0, at_most=1e6),
    ),
]
MeltingTemperature = Annotated[
    Number,
    Quantity(
        "degC",
        "Melting temperature: half is liquid, or (triangle, gumbel) the capacity has its peak",
        Within(1, "judgement: batches, and calorimeters at another rate and sample mass than in the wall"),
        TEMPERATURE,
    ),
]
CurveEnd = Annotated[
    Number,
    Quantity(
        "K",
        "Distance from the melting temperature at which melting starts or is complete",
        Fixed("the formula is the liquid fraction between the two"),
    ),
]
MeltingWidth = Annotated[
    Number,
    Quantity(
        "K",
        "Half-width w of the melting range: liquid fraction (1 + tanh((T - Tm)/w))/2",
        Percent(50, "the width measured by a calorimeter depends on its heating rate"),
        Limits(above=0, at_most=100),
    ),
]
Gamma = Annotated[
    Number,
    Quantity(
        "-",
        "Steepness gamma of the melting curve; only gamma/delta_t acts, w = 4 delta_t/gamma",
        Percent(50, "as for the width"),
        Limits(above=0, at_most=1e4),
    ),
]
DeltaT = Annotated[
    Number,
    Quantity(
        "K",
        "Interval delta T of the melting curve; only gamma/delta_t acts, w = 4 delta_t/gamma",
        Percent(10, "a convention, given with gamma"),
        Limits(above=0, at_most=100),
    ),
]
FreezingTemperature = Annotated[
    Number,
    Quantity(
        "degC",
        "Temperature about which the material freezes, where hysteresis gives it a cooling curve",
        Within(1, "judgement: batches, and calorimeters at another rate and sample mass than in the wall"),
        TEMPERATURE,
    ),
]
SupercoolingDegree = Annotated[
    Number,
    Quantity(
        "K",
        "How far below its melting temperature a material that has melted wholly nucleates",
        Percent(30, "nucleation depends on purity, container and sample mass"),
        Limits(above=0, at_most=150),
    ),
]
CrystallisationTime = Annotated[
    Number,
    Quantity(
        "s",
        "Time in which the liquid that crystallises falls to 37 % at a constant temperature",
        Percent(50, "growth depends on nucleating agents and container"),
        Limits(at_least=0, at_most=1e7),
    ),
]
CrystallisationRate = Annotated[
    Number,
    Quantity(
        "1/(s K)",
        "Part of the liquid that crystallises per second and kelvin below the end of the melting range",
        Percent(50, "growth depends on nucleating agents and container"),
        Limits(above=0, at_most=1e3),
    ),
]
_WIDTH = Percent(50, "the width measured by a calorimeter depends on its heating rate")
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
        integer=True,
    ),
]
CurveFraction = Annotated[
    Number,
    Quantity(
        "-",
        "Liquid fraction of a point of the curve",
        Fixed("fixes the curve; vary temperature_shift instead"),
        Limits(at_least=0, at_most=1),
    ),
]
CurveCapacity = Annotated[
    Number,
    Quantity(
        "J/(kg K)",
        "Apparent specific heat of a point of the curve, sensible heat included",
        Fixed("fixes the curve; vary enthalpy_scale instead"),
        Limits(above=0),
    ),
]
CurveTemperature = Annotated[
    Number,
    Quantity(
        "degC",
        "Temperature of a point of the enthalpy curve",
        Fixed("fixes the curve; vary temperature_shift instead"),
        TEMPERATURE,
    ),
]
CurveEnthalpy = Annotated[
    Number,
    Quantity(
        "J/kg",
        "Specific enthalpy of a point of the curve",
        Fixed("fixes the curve; vary enthalpy_scale instead"),
    ),
]
TemperatureShift = Annotated[
    Number,
    Quantity(
        "K",
        "Shift of the enthalpy curve towards higher temperatures",
        Within(1, "judgement: batches, and calorimeters at another rate and sample mass than in the wall"),
        Limits(at_least=-100, at_most=100),
    ),
]
EnthalpyScale = Annotated[
    Number,
    Quantity(
        "-",
        "Factor on the enthalpy curve",
        Within(0.1, "judgement: calorimetry between laboratories"),
        POSITIVE,
    ),
]
Thickness = Annotated[
    Number,
    Quantity(
        "m",
        "Thickness of the layer",
        Percent(5, "manufacturing and installation"),
        Limits(above=0, at_most=20),
    ),
]
NodeCount = Annotated[
    Number,
    Quantity(
        "-",
        "Number of finite volumes in the layer",
        Fixed("fixes the mesh"),
        Limits(at_least=1, at_most=1000),
        integer=True,
    ),
]

"""Quantities of internal gains, ideal loads and schedules."""

from __future__ import annotations

from typing import Annotated

from mascarin.building.base.number import Fixed, Limits, Number, OnlyGiven, Percent, Quantity, Span, Within
from mascarin.building.quantities.common import FRACTION, NOT_NEGATIVE

GainPower = Annotated[
    Number,
    Quantity(
        "W",
        "Heat while the schedule is 1; negative: heat is taken away",
        Percent(30, "rated and actual power differ"),
        Limits(at_least=-1e7, at_most=1e7),
    ),
]
Activity = Annotated[
    Number,
    Quantity(
        "W",
        "Heat of the activity of a person, sensible and latent",
        Percent(15, "people of one activity, ISO 8996"),
        # The tables that the sensible part was fitted to.
        Limits(at_least=70.0, at_most=500.0),
    ),
]
Radiative = Annotated[
    Number,
    Quantity("-", "Radiative fraction of the heat", Within(0.2, "range in handbooks"), FRACTION),
]
LoadRadiative = Annotated[
    Number,
    Quantity(
        "-",
        "Part of an ideal load that surfaces get by radiation; none: all of it goes to the air",
        Within(0.2, "range in handbooks"),
        # A load that gives nothing to the air does not hold it.
        Limits(at_least=0.0, at_most=0.95),
    ),
]
SetPointRadiantShare = Annotated[
    Number,
    Quantity(
        "-",
        "Share of the mean radiant temperature in what set points hold; none: they hold the air",
        Span(0.2, 0.6, "thermostats by what they are exposed to; 0.5 is operative in still air, ISO 7726"),
        # A load acts on the air first: with the surfaces alone it would be found by its radiation only.
        Limits(at_least=0.0, at_most=0.9),
    ),
]
SetPoint = Annotated[
    Number,
    Quantity(
        "degC",
        "Set point of the air temperature",
        Within(1, "position, offset and hysteresis of a thermostat"),
        Limits(at_least=-60, at_most=90),
    ),
]
Capacity = Annotated[
    Number,
    Quantity(
        "W",
        "Maximum heating or cooling power",
        Percent(20, "rated and actual conditions differ"),
        NOT_NEGATIVE,
    ),
]
MatPower = Annotated[
    Number,
    Quantity(
        "W/m2",
        "Power of an electric mat per area",
        Percent(5, "name plate"),
        Limits(at_least=0, at_most=1e5),
    ),
]
WaterFlow = Annotated[
    Number,
    Quantity(
        "kg/s",
        "Flow of water through all pipes of the surface",
        Percent(10, "balancing of the circuits"),
        Limits(at_least=0, at_most=1000),
    ),
]
SupplyTemperature = Annotated[
    Number,
    Quantity(
        "degC",
        "Temperature of the water that enters",
        Within(2, "controller and pipes to it"),
        Limits(at_least=-60, at_most=120),
    ),
]
WaterConductance = Annotated[
    Number,
    Quantity(
        "W/(m2 K)",
        "Conductance from the water to the plane per area of the surface",
        Percent(30, "spacing of the pipes and their contact"),
        Limits(at_least=0, at_most=1e4),
    ),
]
Effectiveness = Annotated[
    Number,
    Quantity(
        "-",
        "Fall of the water over its excess at the inlet, at any flow",
        Within(0.1, "spacing and length of the pipes"),
        FRACTION,
    ),
]
WaterSpecificHeat = Annotated[
    Number,
    Quantity(
        "J/(kg K)",
        "Specific heat of the water",
        OnlyGiven("a property of water; less with glycol"),
        Limits(at_least=500, at_most=10000),
    ),
]
ThrottlingRange = Annotated[
    Number,
    Quantity(
        "K",
        "Range of the air temperature from all of the power or flow to nothing",
        Span(0.5, 4, "thermostats of floor heating"),
        Limits(above=0, at_most=50),
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
ScheduledHumidityRatio = Annotated[
    Number,
    Quantity(
        "kg/kg",
        "Humidity ratio",
        Fixed("acts through the forcing; vary a set point without a schedule"),
        Limits(at_least=0, at_most=0.2),
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
ColumnFactor = Annotated[
    Number,
    Quantity(
        "-",
        "Factor of the measured column",
        OnlyGiven("measured: it varies only if a range is given"),
        Limits(at_least=-1000, at_most=1000),
    ),
]
SolarToAir = Annotated[
    Number,
    Quantity(
        "-",
        "Part of the transmitted solar radiation that the air gets at once, from light furniture",
        Span(0.0, 0.3, "empty to densely furnished, with curtains"),
        FRACTION,
    ),
]

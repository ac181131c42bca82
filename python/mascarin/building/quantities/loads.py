"""Quantities of internal gains, ideal loads and schedules."""

from __future__ import annotations

from typing import Annotated

from mascarin.building.number import Fixed, Limits, Number, Percent, Quantity, Within
from mascarin.building.quantities.common import FRACTION, NOT_NEGATIVE

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

"""Quantities of infiltration, ventilation and openings."""

from __future__ import annotations

from typing import Annotated

from mascarin.building.number import Limits, Number, Percent, Quantity, Span
from mascarin.building.quantities.common import FRACTION, POSITIVE

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

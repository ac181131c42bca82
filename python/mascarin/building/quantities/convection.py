"""Quantities of surface heat transfer coefficients."""

from __future__ import annotations

from typing import Annotated

from mascarin.building.base.number import Limits, Number, Percent, Quantity, Span
from mascarin.building.quantities.common import NOT_NEGATIVE, POSITIVE

HeatTransferCoefficient = Annotated[
    Number,
    Quantity(
        "W/(m2 K)",
        "Surface heat transfer coefficient",
        Percent(50, "published coefficients for the same surface differ by half"),
        Limits(at_least=0, at_most=1e5),
    ),
]
HeatTransferCoefficientPerSpeed = Annotated[
    Number,
    Quantity(
        "W/(m2 K)/(m/s)",
        "Increase of the surface heat transfer coefficient with wind speed",
        Percent(50, "published slopes are 2 to 6"),
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
        "Characteristic length: height of a vertical surface, 4 area/perimeter of a horizontal one",
        Percent(25, "surfaces are no free plates"),
        POSITIVE,
    ),
]
Perimeter = Annotated[
    Number,
    Quantity("m", "Perimeter exposed to wind", Percent(20, "whether neighboring surfaces count"), POSITIVE),
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
        "Constant part a of a + b abs(dT)^n + c V^m",
        Span(0, 5, "still air between plates"),
        NOT_NEGATIVE,
    ),
]
PowerBuoyant = Annotated[
    Number,
    Quantity(
        "W/(m2 K^(n+1))",
        "Coefficient b of a + b abs(dT)^n + c V^m",
        Span(0, 3, "stable air to an upward plume; published values are 0.5 to 2.3"),
        NOT_NEGATIVE,
    ),
]
PowerExponent = Annotated[
    Number,
    Quantity(
        "-",
        "Exponent n of a + b abs(dT)^n + c V^m",
        Span(0.2, 0.4, "stable layers 1/5, laminar 1/4, turbulent 1/3"),
        Limits(at_least=0, at_most=2),
    ),
]
PowerForced = Annotated[
    Number,
    Quantity(
        "W/(m2 K (m/s)^m)",
        "Coefficient c of a + b abs(dT)^n + c V^m",
        Span(0, 6, "sheltered to exposed"),
        NOT_NEGATIVE,
    ),
]
PowerWindExponent = Annotated[
    Number,
    Quantity(
        "-",
        "Exponent m of a + b abs(dT)^n + c V^m",
        Span(0.5, 1.0, "laminar 1/2, turbulent 0.8, linear fits 1"),
        Limits(at_least=0, at_most=2),
    ),
]

"""Quantities of the errors of measured weather: gain, offset and clock of a column."""

from __future__ import annotations

from typing import Annotated

from mascarin.building.base.number import Limits, Number, OnlyGiven, Quantity

_STATED = "weather is used as it was read: give a range if the instrument or its clock is uncertain"

ColumnGain = Annotated[
    Number,
    Quantity(
        "-",
        "Factor on the readings of a column of the weather, such as 1.06 for a pyranometer that reads 6 % "
        "too little",
        OnlyGiven(_STATED),
        Limits(at_least=0.01, at_most=100),
    ),
]
ColumnOffset = Annotated[
    Number,
    Quantity(
        "unit of the column",
        "Added to the readings of a column of the weather, after the gain",
        OnlyGiven(_STATED),
        Limits(at_least=-1e5, at_most=1e5),
    ),
]
ColumnClock = Annotated[
    Number,
    Quantity(
        "s",
        "Added to the times of a column of the weather, such as -1800 where the logger was half an hour fast",
        OnlyGiven(_STATED),
        Limits(at_least=-43200, at_most=43200),
    ),
]

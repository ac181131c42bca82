"""Limits and reasons that several quantities have in common."""

from __future__ import annotations

from mascarin.building.base.number import Limits

POSITIVE = Limits(above=0)
NOT_NEGATIVE = Limits(at_least=0)
FRACTION = Limits(at_least=0, at_most=1)
ABOVE_0_TO_1 = Limits(above=0, at_most=1)
TEMPERATURE = Limits(at_least=-100, at_most=1000)

FIT = "standard error of the published fit and the differences between the sites it was fitted to"
TABLES = "differences between tables for the same name, moisture, temperature, ageing"
TAPE = "tape measure, and the choice between inside and outside dimensions"

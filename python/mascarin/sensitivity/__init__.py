"""Which parameters matter, for which output, when and with what certainty.

One call, `plan`, for all methods; each plan knows its runs and how to analyse them, and every analysis is a
`Sensitivity`. `screen` does it for a building.
"""

from __future__ import annotations

from mascarin.sensitivity.building_analysis import factors_of, screen
from mascarin.sensitivity.factors import Factor
from mascarin.sensitivity.methods import METHODS, MethodName, plan
from mascarin.sensitivity.result import Sensitivity
from mascarin.sensitivity.runs import run

__all__ = ["METHODS", "Factor", "MethodName", "Sensitivity", "factors_of", "plan", "run", "screen"]

"""The methods of SALib: RBD-FAST, Sobol' indices, Morris' elementary effects (see `plans`)."""

from __future__ import annotations

from mascarin.sensitivity.salib.collection import SQUARES, MorrisSensitivity, SalibCollector
from mascarin.sensitivity.salib.plans import SalibName, SalibPlan, plan

__all__ = ["SQUARES", "MorrisSensitivity", "SalibCollector", "SalibName", "SalibPlan", "plan"]


def __dir__() -> list[str]:
    return __all__

"""Which parameters matter, for which output, when, and how certain that is.

`sensitivity_analysis` does it for a building, `plan` and `run` for any model. The methods are the spectral
one (first-order indices over time) and, by SALib, RBD-FAST, Sobol' and Morris. Every analysis is a
`Sensitivity`.
"""

from __future__ import annotations

from mascarin.sensitivity.building_analysis import factors_of, sensitivity_analysis
from mascarin.sensitivity.factors import Factor
from mascarin.sensitivity.methods import METHODS, MethodName, collector, plan, run
from mascarin.sensitivity.result import Sensitivity

__all__ = [
    "METHODS",
    "Factor",
    "MethodName",
    "Sensitivity",
    "collector",
    "factors_of",
    "plan",
    "run",
    "sensitivity_analysis",
]


def __dir__() -> list[str]:
    return __all__

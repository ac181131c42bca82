"""Calibration: estimating parameters from measurements, with their uncertainty.

`calibrate` does it for a building. The parts work on plain arrays: a `CalibrationProblem` has parameters,
measured series and a model that is evaluated in batches; `solve` finds the parameters, and `Calibration` is
the result.
"""

from __future__ import annotations

from mascarin.calibration.building_calibration import calibrate
from mascarin.calibration.building_problem import fit_parameter
from mascarin.calibration.cost import Cost
from mascarin.calibration.evaluations import Evaluator, Trace
from mascarin.calibration.problem import CalibrationProblem, FitParameter, FitSensor, require_known
from mascarin.calibration.profile import Profile, plot_profiles, profiles
from mascarin.calibration.result import Calibration, Minimum
from mascarin.calibration.rules import METHODS, MethodName, Rules
from mascarin.calibration.search import solve
from mascarin.calibration.uncertainty import Uncertainty
from mascarin.validation.sensors import Sensor

__all__ = [
    "METHODS",
    "Calibration",
    "CalibrationProblem",
    "Cost",
    "Evaluator",
    "FitParameter",
    "FitSensor",
    "MethodName",
    "Minimum",
    "Profile",
    "Rules",
    "Sensor",
    "Trace",
    "Uncertainty",
    "calibrate",
    "fit_parameter",
    "plot_profiles",
    "profiles",
    "require_known",
    "solve",
]


def __dir__() -> list[str]:
    return __all__

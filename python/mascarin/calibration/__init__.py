"""Fitting parameters to measurements, with honest uncertainty.

The pieces work on plain arrays: a `CalibrationProblem` ties parameters and measured series to a model that is
evaluated in batches, `solve` finds the parameters, and the `Fit` says how certain they are.
"""

from __future__ import annotations

from mascarin.calibration.building_problem import Sensor, calibrate, fit_parameter
from mascarin.calibration.cost import Cost
from mascarin.calibration.evaluations import Evaluator, Trace
from mascarin.calibration.fit import Fit, Minimum
from mascarin.calibration.problem import CalibrationProblem, FitParameter, FitSensor, require_known
from mascarin.calibration.profile import Profile, profiles
from mascarin.calibration.rules import METHODS, MethodName, Rules
from mascarin.calibration.search import solve
from mascarin.calibration.uncertainty import Uncertainty

__all__ = [
    "METHODS",
    "CalibrationProblem",
    "Cost",
    "Evaluator",
    "Fit",
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
    "profiles",
    "require_known",
    "solve",
]

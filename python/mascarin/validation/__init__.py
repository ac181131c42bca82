"""Validation: comparison of simulations with measurements.

`metrics` compares two series, `judge` applies limits, `analyze_residuals` and `diagnose` examine what
remains. All of them work on pandas series or arrays, without a study.
"""

from __future__ import annotations

from mascarin.validation.comparison import METRICS, Metrics, compare_sensors, metrics
from mascarin.validation.criteria import Criterion, Verdict, judge, parse_criteria
from mascarin.validation.diagnosis import diagnose
from mascarin.validation.error_sources import ErrorSources, explain_missed_aims, find_error_sources
from mascarin.validation.observation import Observation, observe
from mascarin.validation.residuals import DriverCorrelation, ResidualAnalysis, analyze_residuals
from mascarin.validation.sensors import Sensor, SensorUncertainty

__all__ = [
    "METRICS",
    "Criterion",
    "DriverCorrelation",
    "ErrorSources",
    "Metrics",
    "Observation",
    "ResidualAnalysis",
    "Sensor",
    "SensorUncertainty",
    "Verdict",
    "analyze_residuals",
    "compare_sensors",
    "diagnose",
    "explain_missed_aims",
    "find_error_sources",
    "judge",
    "metrics",
    "observe",
    "parse_criteria",
]


def __dir__() -> list[str]:
    return __all__

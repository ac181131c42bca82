"""Studies: comparison with measurements, sensitivity analysis, calibration and validation in one run.

An interrupted study continues where it was.
"""

from __future__ import annotations

from mascarin.study.description import Sensor
from mascarin.study.results import StudyResults
from mascarin.study.study import Study

__all__ = ["Sensor", "Study", "StudyResults"]


def __dir__() -> list[str]:
    return __all__

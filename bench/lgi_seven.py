"""The seven parameters of the paper on the LGI cell, as a calibration problem with known true values.

The data are simulated, so that estimates can be compared with the values that the data were made with.
Period, sensors, ranges and step are those of the shipped study, with constant surface heat transfer
coefficients as in the paper.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mascarin.calibration import CalibrationProblem
from mascarin.examples import FOLDER
from mascarin.study import Study

Floats = NDArray[np.float64]

VARIANT = "the paper's seven, 25 outside"
SENSOR_SD = 0.3  # K
#: Position of the true value in each range, from 0 to 1: neither the start of the search nor the middle.
TRUTH = np.array([0.62, 0.35, 0.41, 0.55, 0.33, 0.47, 0.58])


@dataclass(frozen=True, eq=False)
class Seven:
    """The problem without its data, and the true values."""

    problem: CalibrationProblem
    truth: Floats
    clean: Floats

    def measured(self, errors: Floats | None = None) -> CalibrationProblem:
        """The problem with data (T, S) simulated with the true values, plus errors. [K]"""
        data = self.clean if errors is None else self.clean + errors
        sensors = tuple(
            replace(
                s,
                measured=np.where(s.mask, data[:, k], np.nan),
                standard_uncertainty=SENSOR_SD,
                weight=1.0,
            )
            for k, s in enumerate(self.problem.sensors)
        )
        return replace(self.problem, sensors=sensors, identity=f"{self.problem.identity} own data")


def seven() -> Seven:
    """Open the shipped study and make the data."""
    problem = Study(FOLDER / "lgi" / "study.yaml").context.problem(VARIANT)
    truth = problem.values(TRUTH[None])[0]
    return Seven(problem, truth, np.asarray(problem.model(truth[None]))[0])

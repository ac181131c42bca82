"""Records of three sensors without a building: simulated series, uncertain numbers, drawn errors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from mascarin.calibration.errors.day_blocks import DayGrid
from mascarin.calibration.errors.discrepancy import DayData, Discrepancy, hour_basis
from mascarin.diagnosis import (
    Candidate,
    DiagnosisInput,
    ErrorCovariance,
    sensor_candidates,
)
from mascarin.diagnosis.sensor_faults import SensorSeries, stated_errors

Floats = NDArray[np.float64]

STEP = 1800.0
DAYS = 16
N = DAYS * 48
HOURS: Floats = np.arange(N, dtype=np.float64) * STEP / 3600.0
CLOUD = np.repeat(np.random.default_rng(7).uniform(0.3, 1.0, DAYS), 48)
SUN: Floats = CLOUD * np.maximum(np.sin((HOURS % 24.0 - 6.0) / 12.0 * np.pi), 0.0)
SLOW, FAST = (lfilter([1.0 - k], [1.0, -k], SUN) for k in (0.95, 0.7))
#: Simulated room, wall and roof. [degC]
SIMULATED: Floats = np.stack([20.0 + 30.0 * SLOW, 22.0 + 15.0 * FAST, 18.0 + 20.0 * SUN], axis=-1)
NAMES = ("room", "wall", "roof")
U = np.full(3, 0.15)
GRID = DayGrid.of(HOURS, interval=0.5, sensors=3)
#: Effects of two uncertain numbers of the model: the sun that is taken up, and a level. [K]
EFFECTS = 0.1 * np.stack([SIMULATED - SIMULATED.mean(axis=0), np.ones((N, 3))], axis=2)
#: Signatures of another law and of a pyranometer that reads too high, for a size of 1. [K]
LAW = 1.5 * np.stack([np.sin(HOURS * np.pi / 12.0), -np.cos(HOURS * np.pi / 12.0), 0.2 * SUN], axis=-1)
PYRANOMETER = np.stack([3.0 * SLOW, 1.5 * FAST, 2.0 * SUN], axis=-1) * (0.5 + CLOUD[:, None])


def sizes() -> Discrepancy:
    """Sizes of the errors of the model: correlated between sensors."""
    alike = np.array([[1.0, 0.5, 0.3], [0.5, 1.0, 0.5], [0.3, 0.5, 1.0]])
    return Discrepancy(
        0.1**2 * alike, 0.08**2 * alike, 0.1**2 * alike, np.full(3, 0.05**2), np.full(3, 0.05**2), 4.0
    )


COVARIANCE = ErrorCovariance(sizes(), share=0.5, persistence=3.0)


def given(error: Floats | None = None) -> DiagnosisInput:
    """Residuals (N, S) or zeros, with all candidates."""
    mask = np.ones((N, 3), dtype=bool)
    series = SensorSeries(NAMES, SIMULATED, mask, U, STEP, ("degC",) * 3, GRID)
    offsets = np.zeros((N, 3, 3))
    offsets[:, range(3), range(3)] = U
    known = GRID.means(np.concatenate([EFFECTS, offsets], axis=2), mask)[0]
    basis = GRID.means(np.repeat(hour_basis(HOURS)[:, None, :], 3, axis=1), mask)[0]
    residuals = np.zeros((N, 3)) if error is None else error
    mean, count = GRID.means(residuals, mask)
    data = DayData(
        GRID, mean, np.concatenate([known, stated_errors(series)], axis=2), basis, count > 0,
        np.full(3, 0.05**2),
    )  # fmt: skip
    days = np.arange(float(DAYS))
    whole = sensor_candidates(series)
    model = [
        Candidate("form", "form", ("site.sky",), GRID.means(LAW, mask)[0], 1.0, 0.3, detail="brunt"),
        Candidate(
            "input", "gain", ("global_horizontal",), GRID.means(PYRANOMETER, mask)[0], 0.0, 1.0, 10.0, "%"
        ),
    ]
    every = (*whole, *model)
    return DiagnosisInput(data, days, NAMES, U, np.full(3, 3.0), every)


def drawn(seed: int, fault: Floats | float = 0.0) -> DiagnosisInput:
    """Residuals of the fitted model without a cause, plus the effect of a fault (D, H * S)."""
    base = given()
    error = COVARIANCE.draw(base.data, base.days, np.random.default_rng(seed)) + fault
    return replace(base, data=replace(base.data, error=error))


def slots(change: Floats) -> Floats:
    """Means of a change (N, S) by day and slot."""
    return GRID.means(change, np.ones((N, 3), dtype=bool))[0]

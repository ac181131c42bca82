"""Heat loss coefficients of heating tests: of simulated ones with a known truth, and of two real houses."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from numpy.typing import NDArray
from scipy.linalg import expm

from mascarin.calibration.heating_test import HeatingTest, heating_test
from mascarin.errors import InputError

Floats = NDArray[np.float64]

HOURS = np.arange(0.0, 120.0, 0.5)
POWER = 2000.0 * (HOURS % 60.0 < 36.0)
SUN = 400.0 * np.maximum(np.sin((HOURS % 24.0 - 6.0) / 12.0 * np.pi), 0.0)
OUTDOORS = 8.0 + 4.0 * np.sin((HOURS - 9.0) / 12.0 * np.pi)
LOSS, APERTURE, CAPACITIES = 80.0, 2.0, (800.0, 4000.0)  # W/K, m2, Wh/K


def _simulated(seed: int) -> Floats:
    """Air of a house with noise of its states and of the sensor, exact in the steps."""
    inner, outer = 0.2 / LOSS, 0.8 / LOSS
    ci, ce = CAPACITIES
    a = np.array([[-1.0 / (inner * ci), 1.0 / (inner * ci)],
                  [1.0 / (inner * ce), -(1.0 / inner + 1.0 / outer) / ce]])  # fmt: skip
    b = np.array([[0.0, APERTURE / ci, 1.0 / ci], [1.0 / (outer * ce), 0.0, 0.0]])
    whole = expm(np.block([[a, b], [np.zeros((3, 5))]]) * 0.5)
    rng, state, found = np.random.default_rng(seed), np.array([12.0, 11.0]), []
    for k in range(HOURS.size):
        found.append(state[0] + rng.normal(0.0, 0.03))
        state = whole[:2, :2] @ state + whole[:2, 2:] @ np.array([OUTDOORS[k], SUN[k], POWER[k]])
        state = state + rng.normal(0.0, [0.03, 0.01])
    return np.array(found)


def _houses(data: Path) -> Path:
    return data / "heating_tests"


def _within(found: HeatingTest, value: float, error: float) -> None:
    """The reference is a fit of the same kind by other code (`greybox.py`), with its standard error."""
    assert abs(found.heat_loss_coefficient[0] - value) < error
    assert 0.5 * error < found.heat_loss_coefficient[1] < 2.0 * error


def test_armadillo(data_dir: Path) -> None:
    table = pd.read_csv(_houses(data_dir) / "armadillo_H2.csv").iloc[:-1]
    inputs = np.c_[table.T_ext, np.maximum(0.0, table.I_sol - 14.3), table.P_hea]
    inputs[:-1] = 0.5 * (inputs[:-1] + inputs[1:])
    outdoors, sun, power = inputs.T
    _within(heating_test(table.T_int, outdoors, power, sun, interval=1800.0), 51.2, 2.5)


def test_flexhouse_as_means_of_15_minutes(data_dir: Path) -> None:
    table = pd.read_csv(_houses(data_dir) / "flexhouse_PRBS1.csv")
    count = len(table) // 3
    means = table[["Ta", "Ph", "Ps"]].to_numpy()[: 3 * count].reshape(count, 3, 3).mean(axis=1)
    inside = table.yTi.to_numpy()[: 3 * count : 3]
    sun = 1000.0 * np.maximum(means[:, 2], 0.0)
    _within(heating_test(inside, means[:, 0], 1000.0 * means[:, 1], sun, interval=900.0), 194.5, 7.2)


def test_what_cannot_be_used_is_refused() -> None:
    inside = _simulated(0)
    with pytest.raises(InputError, match="found 1 gaps"):
        heating_test(np.where(HOURS == 3.0, np.nan, inside), OUTDOORS, POWER, SUN, interval=1800.0)
    with pytest.raises(InputError, match="expected at least 48 over 24 h"):
        heating_test(inside[:30], OUTDOORS[:30], POWER[:30], SUN[:30], interval=1800.0)
    with pytest.raises(InputError, match="power that is switched"):
        heating_test(inside, OUTDOORS, np.full(HOURS.size, 500.0), SUN, interval=1800.0)
    with pytest.raises(InputError, match="outdoors: found shape"):
        heating_test(inside, OUTDOORS[1:], POWER, SUN, interval=1800.0)

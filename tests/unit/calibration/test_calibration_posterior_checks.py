"""What contradicts a calibration, and how much wider it makes intervals."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from mascarin.calibration import FitParameter
from mascarin.calibration.errors.day_blocks import DayGaussian
from mascarin.calibration.errors.posterior_checks import of_errors, of_estimates, widened, widening
from mascarin.materials.iso_10456 import kind_of, unusual

DAYS = [f"2024-01-0{k}" for k in range(1, 7)]


class Joint:
    """As much of a joint distribution as the checks read."""

    def __init__(self, errors: list[float], names: tuple[str, ...], whitened: np.ndarray[Any, Any]) -> None:
        self.z, self.mean, self.names = np.zeros(1), np.array([0.5, *errors]), names
        # An error of a sensor that would be larger than stated is held at its end.
        self.unlimited = np.array([error if abs(error) > 2.0 else 0.0 for error in errors[:1]])
        self.whitened = whitened


def white(seed: int = 1) -> np.ndarray[Any, Any]:
    return np.random.default_rng(seed).standard_normal((6, 24, 2))


def found_in(joint: Joint) -> list[Any]:
    return of_errors(joint, ["room", "wall"], {"room offset": 0.1}, DAYS)  # type: ignore[arg-type]


def test_whitened_values_of_a_right_model_are_independent_and_of_variance_one() -> None:
    rng, days, size = np.random.default_rng(4), 400, 6
    part = rng.normal(size=(size, size))
    block, columns = part @ part.T + np.eye(size), rng.normal(size=(days, size, 2))
    shared = columns @ rng.normal(size=2)
    values = rng.normal(size=(days, size)) @ np.linalg.cholesky(block).T + shared
    gaussian = DayGaussian(
        np.broadcast_to(block, (days, size, size)), columns, np.ones((days, size), dtype=bool)
    )
    covariance = np.cov(gaussian.whitened(values), rowvar=False)
    np.testing.assert_allclose(covariance, np.eye(size), atol=0.2)
    density = -0.5 * np.nansum(gaussian.whitened(values) ** 2, axis=1)
    away = gaussian.left_out(values) - density
    assert np.ptp(away) < 0.5  # what is left is the logarithm of the determinant, which differs little


@pytest.mark.parametrize("seed", range(20))
def test_errors_as_assumed_contradict_nothing(seed: int) -> None:
    assert found_in(Joint([1.5, -2.5], ("room offset", "numbers, 1"), white(seed))) == []


def test_an_offset_beyond_two_stated_uncertainties_widens_by_its_ratio() -> None:
    (one,) = found_in(Joint([-3.1], ("room offset",), white()))
    assert (one.kind, one.subject) == ("offset", "room offset")
    assert "-0.31" in one.text
    assert "3.1 times" in one.text
    assert widening([one]) == pytest.approx(1.55)
    (far,) = found_in(Joint([6.5], ("room offset",), white()))
    assert math.isinf(widening([far]))


def test_a_day_that_differs_and_errors_that_follow_each_other_are_named() -> None:
    differs = white()
    differs[3] *= 2.5
    assert [(one.kind, one.subject) for one in found_in(Joint([], (), differs))] == [("day", DAYS[3])]
    follows = white()
    follows[:, 1:, 1] = 0.8 * follows[:, 1:, 1] + 0.6 * follows[:, :-1, 1]
    (one,) = found_in(Joint([], (), follows))
    assert (one.kind, one.subject) == ("autocorrelation", "wall")
    assert 1.2 < one.factor < 2.5


def test_concrete_of_a_quarter_watt_is_no_concrete() -> None:
    parameter = FitParameter("materials.concrete.conductivity", 0.1, 2.3, unit="W/(m K)")
    (one,) = of_estimates([parameter], np.array([0.26]), {})
    assert one.kind == "material"
    assert "0.26 W/(m K)" in one.text
    assert "1.15 to 2.5" in one.text
    assert of_estimates([parameter], np.array([1.3]), {}) == []
    assert unusual("materials.concrete.density", 1200.0) is not None
    assert unusual("materials.concrete.density", 2300.0) is None
    for name in ("aerated_concrete", "glass_wool", "layer_1", "lightweight concrete"):
        assert kind_of(name) is None, name


def test_an_estimate_on_its_bound_is_said_and_intervals_stay_within_the_ranges() -> None:
    (one,) = of_estimates([], np.zeros(0), {"zones.room.infiltration": "on its lower bound 0.1 1/h"})
    assert one.kind == "bound"
    assert one.factor == 1.0
    x, ends = np.array([1.0]), np.array([[0.0], [1.5]])
    low, high = widened(np.array([0.8]), x, np.array([1.1]), ends, 10.0)
    assert (low[0], high[0]) == (0.0, 1.5)
    low, high = widened(np.array([0.8]), x, np.array([1.1]), ends, 2.0)
    np.testing.assert_allclose([low[0], high[0]], [0.6, 1.2])

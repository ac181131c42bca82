"""What a sampler moves on: polynomials through runs, bounded quantities as functions of normal numbers."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from mascarin.calibration.sampling.marginals import Marginals
from mascarin.calibration.sampling.response_surface import response_surface


def test_a_polynomial_has_the_degree_that_predicts_best() -> None:
    rng = np.random.default_rng(1)
    points = rng.uniform(size=(300, 3))
    straight = points @ np.array([[1.0, 2.0], [0.5, -1.0], [0.0, 3.0]])
    noisy = response_surface(points, straight + 0.05 * rng.standard_normal((300, 2)))
    assert len(noisy.factors) == 4
    assert noisy.error == pytest.approx(0.05 * np.sqrt(2.0), rel=0.1)
    cubic = response_surface(points, straight * points[:, :1] * points[:, 1:2])
    assert len(cubic.factors) == 20
    assert cubic.error < 1e-6


def test_few_runs_allow_a_straight_line_alone() -> None:
    points = np.random.default_rng(2).uniform(size=(25, 3))
    assert len(response_surface(points, points**3).factors) == 4


def test_a_series_that_never_moves_has_no_direction() -> None:
    points = np.random.default_rng(3).uniform(size=(100, 2))
    shares, derivative = response_surface(points, np.zeros((100, 5))).at(np.array([0.3, 0.4]))
    assert shares.shape == (0,)
    assert derivative.shape == (2, 0)


def test_derivatives_of_a_polynomial() -> None:
    rng = np.random.default_rng(4)
    points = rng.uniform(2.0, 5.0, size=(400, 3))
    series = np.stack([points[:, 0] ** 3, points[:, 0] * points[:, 1] * points[:, 2]], axis=1)
    surface = response_surface(points, series)
    shares, derivative = surface.at(np.array([3.0, 4.0, 2.5]))
    assert shares @ surface.directions == pytest.approx([27.0, 30.0], abs=0.02)
    expected = [[27.0, 10.0], [0.0, 7.5], [0.0, 12.0]]
    np.testing.assert_allclose(derivative @ surface.directions, expected, atol=0.03)


@pytest.mark.parametrize("number", [-6.0, -2.0, 0.0, 1.5, 6.0])
@pytest.mark.parametrize("exponents", [(1.0, 1.0), (1.0, 40.0), (30.0, 2.0), (900.0, 2000.0)])
def test_numbers_and_their_derivatives(number: float, exponents: tuple[float, float]) -> None:
    first, last = (np.full(1, exponent) for exponent in exponents)
    marginals = Marginals(np.full(1, 2.0), np.full(1, 5.0), first, last)
    at, step = np.full(1, number), 1e-4
    value, change, log_change, steep = marginals.stretched(at)
    expected = 2.0 + 3.0 * stats.beta(*exponents).ppf(stats.norm.cdf(number))
    assert value == pytest.approx([expected], rel=1e-9)
    if abs(number) < 5.0:  # farther out the value is rounded to its end
        assert marginals.numbers(value) == pytest.approx(at, abs=1e-6)
        two = marginals.values(at + step) - marginals.values(at - step)
        assert change == pytest.approx(two / (2.0 * step), rel=1e-5)
        ends = [marginals.stretched(at + way * step)[2] for way in (-1.0, 1.0)]
        assert steep == pytest.approx([(ends[1] - ends[0]) / (2.0 * step)], rel=1e-4, abs=1e-5)
        assert log_change == pytest.approx(float(np.log(change[0])), abs=1e-9)


@pytest.mark.parametrize(
    ("mean", "sd"), [(0.5, 100.0), (-0.1, 0.05), (0.4, 0.03)], ids=["uniform", "at an end", "normal"]
)
def test_numbers_of_what_data_leave_are_about_normal(mean: float, sd: float) -> None:
    sample = stats.truncnorm(-mean / sd, (1.0 - mean) / sd, loc=mean, scale=sd)
    draws = np.asarray(sample.rvs(20_000, random_state=5))[:, None]
    numbers = Marginals.of_sample(np.zeros(1), np.ones(1), draws).numbers(draws)[:, 0]
    assert np.quantile(numbers, [0.05, 0.5, 0.95]) == pytest.approx(
        [-1.645, 0.0, 1.645], abs=0.2
    )  # a beta is near, not equal


def test_a_sample_without_spread_is_no_division_by_zero() -> None:
    marginals = Marginals.of_sample(np.zeros(2), np.ones(2), np.tile([0.0, 0.5], (50, 1)))
    assert np.isfinite(marginals.numbers(np.array([0.0, 0.5]))).all()

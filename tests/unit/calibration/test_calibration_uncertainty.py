"""Intervals compared with formulas, and how often they contain the true value."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats
from scipy.signal import lfilter

from mascarin.calibration import (
    Calibration,
    CalibrationProblem,
    FitParameter,
    FitSensor,
    SearchOptions,
    solve,
)

Floats = NDArray[np.float64]

TRUTH = np.array([0.3, 0.5, 0.6])


def _design(times: int, sensors: int) -> Floats:
    """Slow responses, as those of a building to its parameters."""
    rng = np.random.default_rng(5)
    angle = 2.0 * np.pi * np.arange(times)[:, None, None] / 96
    shift = rng.uniform(0.0, 2.0 * np.pi, (2, sensors, 3))
    size = rng.normal(size=(2, sensors, 3))
    drift = np.cumsum(rng.normal(size=(times, sensors, 3)), axis=0) / 50.0
    return np.asarray(size[0] * np.cos(angle + shift[0]) + size[1] * np.cos(2 * angle + shift[1]) + drift)


def _fit(noise: Floats, design: Floats, cost: str = "nll") -> Calibration:
    measured = 20.0 + design @ TRUTH + noise
    parameters = tuple(FitParameter(f"p{k}", -1.0, 2.0) for k in range(3))
    sensors = tuple(FitSensor(f"s{k}", measured[:, k], 0.3) for k in range(measured.shape[1]))
    problem = CalibrationProblem(parameters, sensors, lambda x: 20.0 + np.einsum("tsp,mp->mts", design, x))
    if cost == "nll":
        return solve(problem, options=SearchOptions(starts=1))
    options = SearchOptions(agree=1, reductions=14, together=1)
    return solve(problem, method="hooke-jeeves", cost=cost, options=options)  # type: ignore[arg-type]


def test_white_noise_gives_the_interval_of_linear_regression() -> None:
    design = np.random.default_rng(1).normal(size=(120, 1, 3))
    design[:, 0, 0] = 1.0  # with a constant the residuals have no mean
    noise = 0.3 * np.random.default_rng(2).normal(size=(120, 1))
    fit = _fit(noise, design)
    assert fit.uncertainty.order == (0,)
    x, y = design[:, 0], (design @ TRUTH + noise)[:, 0]
    estimate, squares = np.linalg.lstsq(x, y, rcond=None)[:2]
    sd = np.sqrt(np.diag(np.linalg.inv(x.T @ x)) * squares / (120 - 3))
    quantile = stats.t.ppf(0.975, 120 - 3)
    np.testing.assert_allclose(fit.x, estimate, rtol=1e-6)
    # Where nothing is autocorrelated the simulated quantile is Student's, up to a few of the drawn fits that
    # see an autocorrelation by chance.
    np.testing.assert_allclose(estimate - fit.low, quantile * sd, rtol=2e-3)
    np.testing.assert_allclose(fit.high - estimate, quantile * sd, rtol=2e-3)
    covariance = np.linalg.inv(x.T @ x)
    expected = covariance[1, 2] / math.sqrt(covariance[1, 1] * covariance[2, 2])
    assert fit.correlation[1, 2] == pytest.approx(expected, abs=1e-5)


def test_mean_of_an_autoregressive_series_has_its_known_variance() -> None:
    phi, n = 0.8, 4000
    noise = lfilter([math.sqrt(1.0 - phi**2)], [1.0, -phi], np.random.default_rng(3).normal(size=n + 500))[
        500:
    ]
    problem = CalibrationProblem(
        (FitParameter("level", 15.0, 25.0),),
        (FitSensor("s", 20.0 + noise, 1.0),),
        lambda x: np.tile(x[:, :, None], (1, n, 1)),
    )
    fit = solve(problem, options=SearchOptions(starts=1))
    half = 0.5 * (fit.high[0] - fit.low[0])
    assert half == pytest.approx(1.96 * math.sqrt((1.0 + phi) / (1.0 - phi) / n), rel=0.08)
    assert fit.uncertainty.effective_samples[0] == pytest.approx(n * (1.0 - phi) / (1.0 + phi), rel=0.15)


@pytest.mark.parametrize(
    ("phi", "shared"),
    [(0.0, 0.0), (math.exp(-0.25), 0.0), (math.exp(-0.25), 0.6)],
    ids=["white", "one hour", "one hour, shared by the sensors"],
)
def test_coverage(phi: float, shared: float) -> None:
    design = _design(384, 3)  # four days of quarter hours
    inside = 0
    for seed in range(60):
        rng = np.random.default_rng(seed)
        own = rng.normal(size=(584, 3))
        source = math.sqrt(1.0 - shared) * own + math.sqrt(shared) * rng.normal(size=(584, 1))
        noise = 0.3 * lfilter([math.sqrt(1.0 - phi**2)], [1.0, -phi], source, axis=0)[200:]
        fit = _fit(noise, design)
        inside += int(np.sum((fit.low <= TRUTH) & (fit.high >= TRUTH)))
    assert 0.89 <= inside / 180 <= 0.99


def test_plain_intervals_would_be_far_too_narrow() -> None:
    design = _design(384, 1)
    noise = 0.3 * lfilter([0.31], [1.0, -0.95], np.random.default_rng(4).normal(size=(584, 1)), axis=0)[200:]
    fit = _fit(noise, design)
    plain = np.sqrt(np.diag(np.linalg.inv(design[:, 0].T @ design[:, 0]))) * np.nanstd(fit.residuals)
    assert np.all((fit.high - fit.low) / (2.0 * 1.96 * plain) > 2.0)


def test_an_interval_does_not_depend_on_which_bound_another_estimate_has_reached() -> None:
    """Two columns that are nearly the same, such as a conductivity and an infiltration in a short record."""
    hours = np.arange(96.0)
    f, g = np.sin(hours * np.pi / 12.0), 0.1 * np.cos(hours * np.pi / 5.0)
    design = np.stack([f, f + g], axis=1)
    inside, on_bound = 0, 0
    for seed in range(16):
        measured = design @ np.array([0.1, 0.5]) + 0.2 * np.random.default_rng(seed).normal(size=96)
        problem = CalibrationProblem(
            (FitParameter("first", 0.0, 1.0), FitParameter("second", 0.0, 1.0)),
            (FitSensor("room", measured, 0.2),),
            lambda x: np.einsum("mp,tp->mt", x, design)[:, :, None],
        )
        fit = solve(problem, options=SearchOptions(starts=1))
        if fit.on_bound:
            on_bound += 1
            inside += int(fit.low[1] <= 0.5 <= fit.high[1])
    assert on_bound >= 3
    assert inside == on_bound


@pytest.mark.parametrize("cost", ["rmse", "sd"])
def test_other_costs_have_intervals_of_the_same_size(cost: str) -> None:
    design = _design(384, 3)
    noise = 0.3 * np.random.default_rng(6).normal(size=(384, 3))
    reference, fit = _fit(noise, design), _fit(noise, design, cost)
    np.testing.assert_allclose(fit.x, reference.x, atol=0.02)
    np.testing.assert_allclose(fit.high - fit.low, reference.high - reference.low, rtol=0.3)


def test_a_remaining_bias_is_named() -> None:
    design = _design(384, 2)
    noise = 0.1 * np.random.default_rng(7).normal(size=(384, 2)) + np.array([0.0, 3.0])
    fit = _fit(noise, design)
    assert any("'s1' has a bias of -" in text for text in fit.warnings)


def test_few_independent_residuals_are_named() -> None:
    time = np.arange(300)
    problem = CalibrationProblem(
        tuple(FitParameter(f"p{k}", -2.0, 2.0) for k in range(3)),
        (FitSensor("s", 20.0 + 3.0 * np.sin(time / 60.0), 0.5),),
        lambda x: np.asarray(20.0 + x @ np.stack([np.cos(time / (k + 3.0)) for k in range(3)]))[:, :, None],
    )
    fit = solve(problem, options=SearchOptions(starts=1))
    assert any("independent samples: estimate fewer" in text for text in fit.warnings)

"""The posterior sample compared with analytical solutions: normal, truncated, autocorrelated errors."""

from __future__ import annotations

import builtins
import math
from typing import Any

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
from mascarin.errors import InputError

Floats = NDArray[np.float64]

RULES = SearchOptions(starts=1, moves=700)
HOUR = np.arange(384) / 4.0
DESIGN = np.stack([np.ones(HOUR.size), np.sin(HOUR * np.pi / 12.0)], axis=1)
TRUTH = np.array([20.0, 3.0])


def noise(phi: float) -> Floats:
    drawn = np.random.default_rng(8).normal(size=HOUR.size + 400)
    return np.asarray(0.3 * lfilter([math.sqrt(1.0 - phi**2)], [1.0, -phi], drawn)[400:])


def posed(phi: float, bounds: tuple[float, float] = (-10.0, 10.0), **keywords: Any) -> CalibrationProblem:
    return CalibrationProblem(
        (FitParameter("level", 10.0, 30.0), FitParameter("swing", *bounds, **keywords)),
        (FitSensor("s", DESIGN @ TRUTH + noise(phi), 0.3),),
        lambda x: np.einsum("tp,mp->mt", DESIGN, x)[:, :, None],
    )


def sample_of(problem: CalibrationProblem) -> tuple[Calibration, Floats]:
    fit = solve(problem, method="emcee", options=RULES, seed=3)
    assert fit.samples is not None
    return fit, fit.samples


@pytest.mark.parametrize("phi", [0.0, 0.9])
def test_a_linear_model_has_the_normal_distribution_of_its_covariance(phi: float) -> None:
    plain = solve(posed(phi), options=RULES)
    fit, sample = sample_of(posed(phi))
    sd = np.array([20.0, 20.0]) * plain.uncertainty.sd
    np.testing.assert_allclose(sample.std(axis=0), sd, rtol=0.05)
    np.testing.assert_allclose(sample.mean(axis=0), plain.x, atol=0.15 * sd.min())
    np.testing.assert_allclose(fit.high - fit.low, 3.92 * sd, rtol=0.06)
    if (
        phi
    ):  # ten times as wide as independent errors would have it: sqrt((1 + phi) / (1 - phi)) for the level
        independent = 0.3 / math.sqrt(HOUR.size)
        assert sample[:, 0].std() > 2.5 * independent


def test_a_bound_truncates_the_distribution() -> None:
    _, sample = sample_of(posed(0.0, (3.01, 10.0)))
    free = solve(posed(0.0), options=RULES)
    sd = 20.0 * free.uncertainty.sd[1]
    a = (3.01 - free.x[1]) / sd
    cut = stats.truncnorm(a, (10.0 - free.x[1]) / sd, loc=free.x[1], scale=sd)
    assert sample[:, 1].min() >= 3.01
    assert sample[:, 1].mean() == pytest.approx(cut.mean(), abs=0.1 * sd)
    assert np.quantile(sample[:, 1], 0.9) == pytest.approx(cut.ppf(0.9), abs=0.15 * sd)


def test_a_prior_and_data_of_equal_uncertainty_have_equal_weight() -> None:
    """The mean is the middle of both, the standard deviation smaller by the root of two."""
    sd = 20.0 * solve(posed(0.0), options=RULES).uncertainty.sd[1]
    free = solve(posed(0.0), options=RULES).x[1]
    _, sample = sample_of(posed(0.0, prior=(free + 2.0 * sd, sd)))
    assert sample[:, 1].mean() == pytest.approx(free + sd, abs=0.15 * sd)
    assert sample[:, 1].std() == pytest.approx(sd / math.sqrt(2.0), rel=0.07)


def test_a_short_sample_is_reported() -> None:
    fit = solve(posed(0.0), method="emcee", options=SearchOptions(starts=1, moves=50))
    assert any("the posterior sample is short" in text for text in fit.warnings)


def test_a_missing_package_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = builtins.__import__

    def absent(name: str, *rest: Any, **keywords: Any) -> Any:
        if name == "emcee":
            raise ImportError(name)
        return whole(name, *rest, **keywords)

    monkeypatch.setattr(builtins, "__import__", absent)
    with pytest.raises(InputError, match=r"pip install 'mascarin\[bayes\]'"):
        solve(posed(0.0), method="emcee", options=RULES)

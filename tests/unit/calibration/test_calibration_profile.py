"""Profiles compared with analytical solutions: a parabola, a curved valley, a bound."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from mascarin.calibration import CalibrationProblem, FitParameter, FitSensor, SearchOptions, profiles, solve
from mascarin.errors import InputError

Floats = NDArray[np.float64]

HOUR = np.arange(192) / 4.0
WAVES = np.stack([np.ones(HOUR.size), np.sin(HOUR * np.pi / 12.0), np.sin(HOUR * np.pi / 12.0 + 0.3)], axis=1)
TRUTH = np.array([2.0, 3.0, 1.0])


def linear(prior: tuple[float, float] | None = None) -> CalibrationProblem:
    measured = WAVES @ TRUTH + 0.3 * np.random.default_rng(5).normal(size=HOUR.size)
    parameters = [FitParameter(name, -20.0, 20.0) for name in "ab"]
    return CalibrationProblem(
        (*parameters, FitParameter("c", -20.0, 20.0, prior=prior)),
        (FitSensor("s", measured, 0.3),),
        lambda x: np.einsum("tp,mp->mt", WAVES, x)[:, :, None],
    )


@pytest.mark.parametrize("prior", [None, (1.0, 0.2)])
def test_a_linear_model_has_parabolas_and_the_interval_of_the_fit(prior: tuple[float, float] | None) -> None:
    fit = solve(linear(prior), options=SearchOptions(starts=1))
    for i, profile in enumerate(profiles(fit)):
        sd = 40.0 * fit.uncertainty.sd[i]
        np.testing.assert_allclose(
            profile.rise, ((profile.values - fit.x[i]) / sd) ** 2, rtol=0.01, atol=1e-4
        )
        assert (profile.low, profile.high) == pytest.approx((fit.low[i], fit.high[i]), abs=0.02 * sd)
        assert not profile.words
    # Where one is fixed, the one with the similar effect compensates.
    second = profiles(fit, ["b"])[0]
    assert np.corrcoef(second.values, second.parameter_values[:, 2])[0, 1] < -0.99


def test_it_minimizes_over_the_others_in_a_curved_valley() -> None:
    """exp(-a t) b: each point of the profile compared with a separate search."""
    x = np.linspace(0.0, 3.0, 60)

    def model(p: Floats) -> Floats:
        return np.asarray((p[:, 1:] * np.exp(-p[:, :1] * x))[:, :, None])

    measured = model(np.array([[0.8, 2.0]]))[0, :, 0] + 0.15 * np.random.default_rng(2).normal(size=60)
    pair = (FitParameter("a", 0.0, 8.0), FitParameter("b", 0.1, 12.0))
    sensors = (FitSensor("s", measured, 0.15),)
    fit = solve(CalibrationProblem(pair, sensors, model), options=SearchOptions(starts=1))
    profile = profiles(fit, ["a"])[0]
    rises = []
    for value in profile.values:

        def held(p: Floats, value: float = value) -> Floats:
            return model(np.column_stack([np.full(len(p), value), p]))

        rises.append(
            solve(CalibrationProblem(pair[1:], sensors, held), options=SearchOptions(starts=2)).cost
            - fit.cost
        )
    away = np.abs(profile.values - fit.x[0]) > 1e-6
    ratio = profile.rise[away] / (2.0 * np.array(rises)[away])
    np.testing.assert_allclose(ratio, ratio.mean(), rtol=0.02)


def test_a_side_that_the_data_do_not_bound_is_reported() -> None:
    """A coefficient without effect when large: then the sheet has the temperature of the air."""
    sun = np.maximum(0.0, np.sin(HOUR * np.pi / 12.0))

    def model(p: Floats) -> Floats:
        return np.asarray((20.0 + 1.0 * sun / p)[:, :, None])

    measured = model(np.array([[9.0]]))[0, :, 0] + 0.3 * np.random.default_rng(2).normal(size=HOUR.size)
    one = (FitParameter("film", 1.0, 15.0, unit="W/(m2 K)"),)
    fit = solve(
        CalibrationProblem(one, (FitSensor("s", measured, 0.3),), model), options=SearchOptions(starts=3)
    )
    (profile,) = profiles(fit, points=11)
    assert profile.open_high
    assert not profile.open_low
    assert "film: the data do not bound it above" in profile.words
    assert "the range at 15 W/(m2 K)" in profile.words


def test_values_that_cannot_be_run_are_outside() -> None:
    def model(p: Floats) -> Floats:
        out = np.asarray((p @ WAVES[:, :2].T)[:, :, None])
        out[p[:, 0] > 2.02] = np.nan
        return out

    measured = WAVES[:, :2] @ TRUTH[:2] + 0.3 * np.random.default_rng(5).normal(size=HOUR.size)
    pair = tuple(FitParameter(name, -20.0, 20.0, start=1.9) for name in "ab")
    fit = solve(
        CalibrationProblem(pair, (FitSensor("s", measured, 0.3),), model), options=SearchOptions(starts=1)
    )
    (profile,) = profiles(fit, ["a"])
    assert np.isinf(profile.rise[profile.values > 2.02]).all()
    assert fit.x[0] < profile.high <= 2.02 + 1e-9


def test_refusals() -> None:
    fit = solve(linear(), options=SearchOptions(starts=1))
    with pytest.raises(InputError, match="'d' was not estimated"):
        profiles(fit, ["d"])
    with pytest.raises(InputError, match="points: found 3"):
        profiles(fit, points=3)
    other = solve(linear(), method="hooke-jeeves", cost="rmse", options=SearchOptions(agree=1, sequences=1))
    with pytest.raises(InputError, match="a profile needs a likelihood: found the cost 'rmse'"):
        profiles(other)

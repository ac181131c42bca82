from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import lfilter

from mascarin.errors import InputError
from mascarin.validation.series import (
    autocorrelation,
    autocovariance,
    correlate,
    effective_samples,
    fit_autoregression,
)


def _ar1(phi: float, n: int, seed: int) -> NDArray[np.float64]:
    noise = np.random.default_rng(seed).normal(size=n + 500)
    series: NDArray[np.float64] = lfilter([math.sqrt(1.0 - phi**2)], [1.0, -phi], noise)[500:]
    return series


def test_autocovariance_of_a_short_series_by_hand() -> None:
    x = np.array([1.0, 2.0, 3.0, 6.0])  # deviations -2, -1, 0, 3
    np.testing.assert_allclose(autocovariance(x, 5), [14 / 4, 2 / 4, -3 / 4, -6 / 4, 0.0, 0.0], atol=1e-12)


def test_gaps_leave_the_autocorrelation_where_it_was() -> None:
    x = _ar1(0.8, 20000, 1)
    gappy = x.copy()
    gappy[np.random.default_rng(2).random(x.size) < 0.3] = np.nan
    expected = 0.8 ** np.arange(6)
    np.testing.assert_allclose(autocorrelation(x, 5), expected, atol=0.03)
    np.testing.assert_allclose(autocorrelation(gappy, 5), expected, atol=0.03)


def test_order_and_effective_samples_of_known_processes() -> None:
    white = np.random.default_rng(3).normal(size=2000)
    assert fit_autoregression(white).order == 0
    assert effective_samples(white) == 2000
    first = fit_autoregression(_ar1(0.8, 5000, 4))
    assert first.order == 1
    assert first.coefficients[0] == pytest.approx(0.8, abs=0.02)
    # A mean of n samples of this process is worth n (1 - phi) / (1 + phi) independent ones.
    assert first.effective_samples == pytest.approx(5000 * 0.2 / 1.8, rel=0.1)
    noise = np.random.default_rng(5).normal(size=6000)
    second = fit_autoregression(lfilter([1.0], [1.0, -1.2, 0.5], noise))
    np.testing.assert_allclose(second.coefficients[:2], [1.2, -0.5], atol=0.05)


def test_a_perfect_fit_has_no_autocorrelation_left() -> None:
    model = fit_autoregression(np.zeros(100))
    assert (model.order, model.variance, model.inflation) == (0, 0.0, 1.0)
    assert autocorrelation(np.zeros(100), 3).tolist() == [1.0, 0.0, 0.0, 0.0]


def test_memory_lasts_until_a_disturbance_has_died_away() -> None:
    memory = fit_autoregression(_ar1(0.9, 5000, 6)).memory()
    assert 0.9**memory < 1e-6
    assert memory < 200


def test_unrelated_slow_series_are_not_called_correlated() -> None:
    exceeded = 0
    for seed in range(100):
        r, limit = correlate(_ar1(0.95, 500, 2 * seed), _ar1(0.95, 500, 2 * seed + 1))
        exceeded += abs(r) > limit
    assert exceeded <= 14
    x = _ar1(0.95, 500, 7)
    r, limit = correlate(x + 0.3 * _ar1(0.5, 500, 8), x)
    assert r > 0.9 > limit


def test_too_little_to_correlate() -> None:
    assert math.isnan(correlate([1.0, np.nan, 2.0], [1.0, 2.0, np.nan])[0])
    assert correlate(np.ones(10), np.arange(10.0))[1] == math.inf
    with pytest.raises(InputError, match="1 samples"):
        autocovariance([1.0, np.nan], 1)

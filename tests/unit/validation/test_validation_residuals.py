"""Residuals with one known error: this error must be found, and nothing else."""

from __future__ import annotations

import json
import math

import numpy as np
import pandas as pd
import pytest
from numpy.typing import NDArray
from scipy.signal import lfilter

from mascarin.errors import InputError
from mascarin.validation.residuals import ResidualAnalysis, analyze_residuals

Floats = NDArray[np.float64]

STEP = 900.0
DAYS = 10
HOUR = np.arange(96 * DAYS) * 0.25
SUN = np.maximum(0.0, np.sin((HOUR % 24.0 - 6.0) / 12.0 * np.pi)) * np.repeat(
    [800.0, 300.0, 900.0, 500.0, 850.0, 200.0, 700.0, 900.0, 400.0, 600.0], 96
)


def _red(seed: int, phi: float = 0.97) -> Floats:
    """A slow series without a daily cycle, standard deviation 1."""
    noise = np.random.default_rng(seed).normal(size=HOUR.size + 500)
    return np.asarray(lfilter([math.sqrt(1.0 - phi**2)], [1.0, -phi], noise)[500:])


WIND = np.maximum(0.0, 3.5 + 1.5 * _red(1))
AIR = 24.0 + 4.0 * np.cos((HOUR - 15.0) / 12.0 * np.pi) + _red(2, 0.99)
MEASURED = 26.0 + 5.0 * np.cos((HOUR - 15.0) / 12.0 * np.pi)
NOISE = 0.2 * np.random.default_rng(3).normal(size=HOUR.size)


def _analyzed(error: Floats, measured: Floats = MEASURED, **keywords: object) -> ResidualAnalysis:
    return analyze_residuals(
        measured,
        measured + NOISE + error,
        step=STEP,
        hour=HOUR % 24.0,
        drivers={"sun": SUN, "wind": WIND, "outdoor air": AIR},
        sensor="room",
        **keywords,  # type: ignore[arg-type]
    )


def test_white_noise_is_recognized() -> None:
    e = _analyzed(np.zeros(HOUR.size))
    assert e.white
    assert not any(one.significant for one in e.correlations)
    assert e.effective_samples == e.n == HOUR.size
    assert abs(e.delay) < 1.0


def test_error_that_follows_the_sun() -> None:
    e = _analyzed(0.002 * np.roll(SUN, 4))
    first = e.correlations[0]
    assert (first.driver, first.significant) == ("sun", True)
    assert first.lag == pytest.approx(1.0)
    assert first.slope == pytest.approx(0.002, rel=0.1)
    assert not any(one.significant and one.driver == "wind" for one in e.correlations)


def test_error_that_follows_the_wind() -> None:
    e = _analyzed(-0.3 * (WIND - WIND.mean()))
    assert e.correlations[0].driver == "wind"
    assert e.correlations[0].correlation < -0.8


def test_a_slow_error_of_unknown_cause_is_not_attributed_to_a_driver() -> None:
    attributed = 0
    for seed in range(20):
        e = _analyzed(0.5 * _red(100 + seed))
        assert not e.white
        attributed += any(one.significant for one in e.correlations)
    assert attributed <= 4


def test_autocorrelation_makes_many_values_worth_few() -> None:
    e = _analyzed(0.5 * _red(104))
    assert e.acf[1] > e.acf_limit
    assert e.effective_samples < 0.2 * e.n


def test_hours_of_the_day() -> None:
    burst = np.where((HOUR % 24.0 >= 14.0) & (HOUR % 24.0 < 15.0), 1.5, 0.0)
    e = _analyzed(burst)
    assert e.hour_mean[14] == pytest.approx(1.5, abs=0.1)
    assert e.hour_mean[3] == pytest.approx(0.0, abs=0.1)
    assert e.hour_sd[3] == pytest.approx(0.2, abs=0.05)
    assert e.hour_share > 0.6 > e.hour_limit
    assert int(np.nanargmax(e.hour_mean)) == 14


def test_daily_amplitude_and_phase() -> None:
    late = 26.0 + 4.0 * np.cos((HOUR - 16.0) / 12.0 * np.pi) + 0.05 * HOUR
    e = analyze_residuals(MEASURED, late, step=STEP, hour=HOUR % 24.0, sensor="gap")
    assert e.measured is not None
    assert e.simulated is not None
    assert (e.measured.amplitude, e.measured.peak) == pytest.approx((5.0, 15.0))
    assert (e.simulated.amplitude, e.simulated.peak) == pytest.approx((4.0, 16.0))
    assert e.delay == pytest.approx(60.0)
    early = analyze_residuals(late, MEASURED, step=STEP, hour=HOUR % 24.0, sensor="gap")
    assert early.delay == pytest.approx(-60.0)
    wrapped = analyze_residuals(np.roll(MEASURED, 34), np.roll(MEASURED, 38), step=STEP, hour=HOUR % 24.0)
    assert wrapped.delay == pytest.approx(60.0)


def test_amplitude_delay_and_bias_of_a_cycle_that_is_too_large() -> None:
    swing = 26.0 + 6.5 * np.cos((HOUR - 16.0) / 12.0 * np.pi)
    e = _analyzed(swing - MEASURED)
    assert e.simulated is not None
    assert e.simulated.amplitude == pytest.approx(6.5, abs=0.05)
    assert e.delay == pytest.approx(60.0, abs=1.0)
    assert _analyzed(np.full(HOUR.size, -1.0)).bias == pytest.approx(-1.0 + NOISE.mean())


def test_gaps_change_little() -> None:
    error = 0.002 * SUN
    gappy = MEASURED.copy()
    gappy[200:260] = np.nan
    gappy[::9] = np.nan
    whole, holed = _analyzed(error), _analyzed(error, measured=gappy)
    assert holed.n < whole.n
    assert holed.correlations[0].correlation == pytest.approx(whole.correlations[0].correlation, abs=0.02)
    assert holed.delay == pytest.approx(whole.delay, abs=3.0)
    used = _analyzed(error, use=np.arange(HOUR.size) < 480)
    assert used.n == 480


def test_cumulative_periodogram_of_one_oscillation() -> None:
    wave = np.cos(HOUR / 12.0 * np.pi)
    e = analyze_residuals(MEASURED, MEASURED + wave, step=STEP, hour=HOUR % 24.0)
    at = np.searchsorted(e.frequency, 1.0)
    assert e.frequency[at] == pytest.approx(1.0)
    assert e.cumulative[at - 1] == pytest.approx(0.0, abs=1e-9)
    assert e.cumulative[at] == pytest.approx(1.0)
    assert not e.white


def test_dictionary_is_json() -> None:
    e = _analyzed(0.002 * SUN)
    data = json.loads(json.dumps(e.to_dict(), allow_nan=False))
    assert len(data["hour_mean"]) == 24
    assert data["acf"][0] == 1.0
    assert data["acf_lags"][1] == 0.25
    assert set(data["correlation"]) == {"sun", "wind", "outdoor air"}
    assert data["daily_cycle"]["delay_minutes"] == pytest.approx(e.delay)
    short = analyze_residuals(MEASURED[:48], MEASURED[:48] + NOISE[:48], step=STEP, hour=HOUR[:48])
    assert json.loads(json.dumps(short.to_dict(), allow_nan=False))["hour_mean"][20] is None
    assert short.measured is None
    assert math.isnan(short.delay)


def test_a_constant_driver_has_no_correlation() -> None:
    e = analyze_residuals(
        MEASURED, MEASURED + NOISE, step=STEP, hour=HOUR % 24, drivers={"fan": np.ones(HOUR.size)}
    )
    assert math.isnan(e.correlations[0].correlation)
    assert not e.correlations[0].significant


def test_series_that_cannot_be_analyzed_are_refused() -> None:
    with pytest.raises(InputError, match="23 samples to analyze"):
        analyze_residuals(MEASURED[:23], MEASURED[:23], step=STEP, hour=HOUR[:23])
    with pytest.raises(InputError, match=r"sun \(5,\)"):
        analyze_residuals(MEASURED, MEASURED, step=STEP, hour=HOUR, drivers={"sun": np.ones(5)})
    with pytest.raises(InputError, match="must be positive"):
        analyze_residuals(MEASURED, MEASURED, step=0.0, hour=HOUR)


def test_the_cross_correlation_is_given_at_every_lag() -> None:
    """A residual that follows the sun with a lag of two hours has its strongest correlation at two hours."""
    late = np.roll(SUN, 8) / 900.0
    found = analyze_residuals(np.zeros(HOUR.size), late, step=STEP, hour=HOUR, drivers={"sun": SUN}).to_dict()
    values = found["cross_correlation"]["sun"]
    assert found["cross_lags"][:3] == [0.0, 0.25, 0.5]
    assert found["cross_lags"][int(np.argmax(values))] == 2.0
    assert max(values) == pytest.approx(1.0, abs=1e-9)
    assert values[0] < 0.95


def test_series_with_times_need_neither_step_nor_hour() -> None:
    times = pd.date_range("2024-07-01", periods=HOUR.size, freq="15min", tz="Indian/Reunion")
    error = 0.002 * SUN
    expected = _analyzed(error)
    found = analyze_residuals(
        pd.Series(MEASURED, index=times),
        pd.Series(MEASURED + NOISE + error, index=times),
        drivers={"sun": SUN, "wind": WIND, "outdoor air": AIR},
        sensor="room",
    )
    assert found.to_dict() == expected.to_dict()
    with pytest.raises(InputError, match="found no times"):
        analyze_residuals(MEASURED, MEASURED)


def test_an_analysis_is_shown_shortly() -> None:
    text = repr(_analyzed(0.002 * SUN))
    assert len(text.splitlines()) <= 15
    assert "correlation with sun" in text
    assert "<table>" in _analyzed(0.002 * SUN)._repr_html_()

"""Scatter of readings from a record, and how a stated uncertainty is split by it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mascarin.calibration.errors.stated_errors import only_scatter, shared_errors
from mascarin.measurements import Sensor
from mascarin.measurements.scatter import resolution, scatter

HOURS = np.arange(0.0, 120.0, 0.25)
COURSE = 20.0 + 5.0 * np.sin(HOURS * np.pi / 12.0) + 0.5 * np.sin(HOURS * np.pi / 3.0)


@pytest.mark.parametrize("size", [0.01, 0.05, 0.3])
def test_the_scatter_is_that_of_the_noise_in_the_mean_of_many_records(size: float) -> None:
    noise = np.random.default_rng(3).standard_normal((200, HOURS.size))
    found = np.array([scatter(COURSE + size * row) for row in noise])
    # 480 readings: one record is uncertain by some 8 %, the mean of 200 by 0.6 %.
    assert found.mean() == pytest.approx(size, rel=0.04)
    assert found.std() < 0.12 * size


def test_a_smooth_course_and_slow_errors_are_no_scatter() -> None:
    assert scatter(COURSE) < 1e-3
    rng = np.random.default_rng(1)
    slow = np.zeros(HOURS.size)
    for k in range(1, HOURS.size):  # correlation time of 10 h, standard deviation of 0.3
        slow[k] = math.exp(-0.025) * slow[k - 1] + 0.3 * math.sqrt(1.0 - math.exp(-0.05)) * rng.normal()
    assert scatter(COURSE + slow) < 0.06


def test_a_part_in_which_everything_changes_does_not_count() -> None:
    noise = 0.05 * np.random.default_rng(2).standard_normal(HOURS.size)
    heated = np.where((HOURS % 24.0 > 7.0) & (HOURS % 24.0 < 11.0), 3.0 * np.sin(40.0 * HOURS), 0.0)
    assert scatter(COURSE + noise + heated) == pytest.approx(0.05, rel=0.3)


def test_rounded_readings_scatter_by_their_resolution_at_least() -> None:
    assert scatter(np.round(COURSE, 1)) == pytest.approx(0.1 / math.sqrt(12.0), rel=0.15)
    assert resolution(np.round(COURSE, 1)) == pytest.approx(0.1)
    assert resolution(COURSE) == 0.0


def test_a_short_record_and_gaps_say_nothing_wrong() -> None:
    assert math.isnan(scatter(COURSE[:60]))
    holes = COURSE + 0.05 * np.random.default_rng(5).standard_normal(HOURS.size)
    holes[::90] = np.nan
    assert scatter(holes) == pytest.approx(0.05, rel=0.3)


def test_a_stated_uncertainty_is_an_offset_less_the_scatter_unless_said_otherwise() -> None:
    def error(random: float, **stated: float) -> float:
        sensor = Sensor(column="T", expanded_uncertainty=0.98, **stated)
        u = sensor.uncertainty("degC", "room")
        assert u.absolute == pytest.approx(0.5)
        return shared_errors(sensor, u, random).offset

    assert error(0.3) == pytest.approx(0.4)
    assert error(0.6) == 0.0
    assert error(math.nan) == pytest.approx(0.5)
    assert error(0.3, repeatability=0.4) == pytest.approx(0.3)
    assert error(0.3, offset=0.1) == 0.1
    # What all sensors of a logger share is a part of the stated uncertainty, not beside it.
    assert error(0.0, common=0.3) == pytest.approx(0.4)


def test_only_sensors_that_say_so_have_scatter_alone() -> None:
    assert only_scatter(Sensor("T", expanded_uncertainty=0.3, offset=0.0))
    assert only_scatter(Sensor("T", repeatability=0.1))
    assert not only_scatter(Sensor("T"))
    assert not only_scatter(Sensor("T", standard_uncertainty=0.3, repeatability=0.1))
    assert not only_scatter(Sensor("T", expanded_uncertainty=0.3, offset=0.0, gain=0.01))

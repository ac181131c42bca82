"""Planted faults of sensors are found with their size; in data without a fault nothing is."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import lfilter

from mascarin.tables.quality.filled_values import copied, interpolated
from mascarin.validation.likelihood_ratio import p_value
from mascarin.validation.sensor_faults import Fault, Series, sensor_faults, shifted, white_noise
from mascarin.validation.step_changes import step_changes
from mascarin.validation.whitened_regression import Extra, WhitenedRegression, Whitening

Floats = NDArray[np.float64]

STEP = 900.0
DAYS = 12
N = DAYS * 96
HOUR = np.arange(N) * STEP / 3600.0
CLOUD = np.repeat(np.random.default_rng(7).uniform(0.3, 1.0, DAYS), 96)
SUN = CLOUD * np.maximum(np.sin((HOUR % 24.0 - 6.0) / 12.0 * np.pi), 0.0)
SLOW, FAST = (lfilter([1.0 - k], [1.0, -k], SUN) for k in (0.97, 0.8))
SIMULATED = np.stack([20.0 + 30.0 * SLOW, 22.0 + 15.0 * FAST, 18.0 + 20.0 * SUN], axis=-1)
#: Effects of two parameters: the sun that is taken up, and a level.
EFFECTS = np.stack([SIMULATED - SIMULATED.mean(axis=0), np.ones((N, 3))])
U = np.full(3, 0.15)


def _noise(seed: int) -> Floats:
    drawn = np.random.default_rng(seed).normal(size=(2, N, 3))
    return np.asarray(0.05 * drawn[0] + lfilter([0.03], [1.0, -0.9], drawn[1], axis=0))


def _problem(measured: Floats, simulated: Floats = SIMULATED) -> tuple[WhitenedRegression, Series]:
    offsets = np.zeros((3, N, 3))
    for s in range(3):
        offsets[s, :, s] = 1.0
    columns = np.concatenate([EFFECTS, offsets])
    free = np.tile([-np.inf, np.inf], (5, 1))
    precision = np.concatenate([[16.0, 16.0], U**-2])
    residual = measured - simulated
    plain = WhitenedRegression(
        residual, columns, np.zeros(5), precision, free, Whitening(tuple(np.empty(0) for _ in U))
    )
    left = residual - np.tensordot(plain.solve(range(5)).values, columns, 1)
    joint = WhitenedRegression(residual, columns, np.zeros(5), precision, free, Whitening.of(left))
    return joint, Series(measured, simulated, U, STEP, 450.0, ("degC",) * 3, {})


def _faults(measured: Floats, simulated: Floats = SIMULATED) -> tuple[list[Fault], WhitenedRegression]:
    joint, series = _problem(measured, simulated)
    return sensor_faults(joint, list(range(5)), joint.solve(range(5)), series), joint


def _changes(measured: Floats) -> tuple[list[Fault], WhitenedRegression]:
    joint, series = _problem(measured)
    return step_changes(joint, list(range(5)), joint.solve(range(5)), series), joint


@pytest.mark.parametrize("day", [3, 5, 8])
def test_an_offset_from_some_day_on_is_found_with_its_time(day: int) -> None:
    measured = SIMULATED + _noise(4)
    measured[day * 96 :, 0] += 0.8
    first, joint = _changes(measured)
    found = first[0]
    assert (found.what, found.sensors) == ("offset", (0,))
    assert found.rows is not None
    # With a stated offset either side may be the wrong one; the change and its size are the same.
    at = found.rows[0] or found.rows[1]
    assert abs(at - day * 96) <= 4
    sign = 1.0 if found.rows[0] else -1.0
    assert found.value == pytest.approx(sign * 0.8, abs=4.0 * found.error + 0.02)
    whole = sensor_faults(joint, list(range(5)), joint.solve(range(5)), _problem(measured)[1])
    assert max((one.deviance for one in whole), default=0.0) < found.deviance


def test_a_clock_that_jumps_by_an_hour_is_found() -> None:
    measured = SIMULATED + _noise(5)
    late = shifted(SIMULATED[:, 1], 3600.0, STEP) + _noise(6)[:, 1]
    measured[7 * 96 :, 1] = late[7 * 96 :]
    found = _changes(measured)[0][0]
    assert (found.what, found.sensors, found.value) == ("clock", (1,), 3600.0)
    assert found.rows is not None
    assert abs(found.rows[0] - 7 * 96) <= 32  # at night the series does not change
    assert found.rows[1] == N


def test_columns_exchanged_in_the_middle_of_the_record_are_found() -> None:
    measured = SIMULATED + _noise(7)
    measured[6 * 96 :, [1, 2]] = measured[6 * 96 :, [2, 1]]
    found = _changes(measured)[0][0]
    assert (found.what, found.sensors) == ("swapped", (1, 2))
    assert found.rows is not None
    assert abs(found.rows[0] - 6 * 96) <= 32


def test_a_fault_of_the_whole_record_is_not_taken_for_a_change() -> None:
    measured = SIMULATED + _noise(1)
    measured[:, 0] += 1.0
    whole, joint = _faults(measured)
    partial = step_changes(joint, list(range(5)), joint.solve(range(5)), _problem(measured)[1])
    assert whole[0].what == "offset"
    assert max((one.deviance for one in partial), default=0.0) < whole[0].deviance


def test_in_clean_data_no_change_is_significant() -> None:
    for seed in range(20):
        found, joint = _changes(SIMULATED + _noise(200 + seed))
        null = joint.solve(range(5))
        for fault in found:
            assert fault.solution is not None
            after = joint if fault.residual is None else joint.with_residual(dict(fault.residual))
            p = p_value(
                (joint, null, range(5)), (after, fault.solution, range(5), fault.extra),
                interval=STEP, tried=90, deviance=fault.deviance,
            )  # fmt: skip
            assert p > 0.01


def test_a_clock_is_told_from_other_faults_with_its_delay() -> None:
    measured = SIMULATED + _noise(1)
    measured[:, 1] = shifted(SIMULATED[:, 1], 3600.0, STEP) + _noise(2)[:, 1]
    first = _faults(measured)[0][0]
    assert (first.what, first.sensors) == ("clock", (1,))
    assert first.value == pytest.approx(3600.0, abs=4.0 * first.error)
    assert 5.0 < first.error < 200.0


def test_offset_gain_and_exchanged_columns_are_told_apart() -> None:
    measured = SIMULATED + _noise(1)
    measured[:, 0] += 1.0
    first = _faults(measured)[0][0]
    assert (first.what, first.sensors) == ("offset", (0,))
    assert first.value == pytest.approx(1.0, abs=0.3)
    measured = SIMULATED + _noise(1)
    measured[:, 2] *= 1.05
    first = _faults(measured)[0][0]
    assert (first.what, first.sensors) == ("gain", (2,))
    assert first.value == pytest.approx(0.05, abs=4.0 * first.error)
    measured = (SIMULATED + _noise(1))[:, [0, 2, 1]]
    first = _faults(measured)[0][0]
    assert (first.what, first.sensors) == ("swapped", (1, 2))


def test_a_wrong_parameter_is_no_fault_of_a_sensor() -> None:
    measured = SIMULATED + 0.2 * EFFECTS[0] + _noise(3)
    assert [fault for fault in _faults(measured)[0] if fault.deviance > 15.0] == []


def test_in_clean_data_no_fault_is_significant() -> None:
    for seed in range(20):
        found, joint = _faults(SIMULATED + _noise(100 + seed))
        null = joint.solve(range(5))
        for fault in found:
            assert fault.solution is not None
            p = p_value(
                (joint, null, range(5)), (joint, fault.solution, range(5), fault.extra),
                interval=STEP, tried=90, deviance=fault.deviance,
            )  # fmt: skip
            assert p > 0.01


def test_least_squares_in_a_box_and_its_deviance_by_hand() -> None:
    # One series, one column of ones: the estimate is the mean, the deviance n log of the variance.
    residual = np.array([1.0, 2.0, 3.0, 6.0])[:, None]
    joint = WhitenedRegression(
        residual, np.ones((1, 4, 1)), np.zeros(1), np.zeros(1), np.array([[-10.0, 10.0]]),
        Whitening((np.empty(0),)),
    )  # fmt: skip
    found = joint.solve([0])
    assert found.values[0] == pytest.approx(3.0)
    assert found.deviance == pytest.approx(4.0 * np.log(3.5))
    assert found.standard_error(0) == pytest.approx(np.sqrt(3.5 / 4.0))
    held = joint.solve([], [Extra(0, np.ones(4), limits=(0.0, 2.0))])
    assert held.values[0] == 2.0
    assert held.standard_error(0) == 0.0


def test_many_columns_that_act_alike_are_replaced_by_few_combinations() -> None:
    # 200 columns of 6 series: with the combinations an offset and its evidence are the same.
    random = np.random.default_rng(5)
    n, sensors, many, series = 600, 3, 200, 6
    patterns = np.cumsum(random.normal(size=(series, n, sensors)), axis=1)
    columns = np.tensordot(random.normal(size=(many, series)), patterns, 1) / 50.0
    offsets = np.zeros((sensors, n, sensors))
    offsets[range(sensors), :, range(sensors)] = 1.0
    change = np.concatenate([0.3 * random.normal(size=many), [0.0, 0.0, 0.0]])
    every = np.concatenate([columns, offsets])
    residual = np.tensordot(change, every, 1) + random.normal(0.0, 0.1, (n, sensors))
    residual[:, 1] += 2.0
    free = np.tile([-np.inf, np.inf], (many + sensors, 1))
    precision = np.concatenate([np.full(many, 16.0), np.full(sensors, 100.0)])
    plain = Whitening(tuple(np.empty(0) for _ in range(sensors)))
    joint = WhitenedRegression(residual, every, np.zeros(many + sensors), precision, free, plain)

    few = joint.in_directions([0])

    assert len(few.columns) == 1 + series + sensors
    assert np.array_equal(few.columns[0], columns[0])
    assert np.array_equal(few.columns[-sensors:], offsets)
    extra = [Extra(1, np.ones(n))]
    (one, with_one), (two, with_two) = (
        (p.solve(range(len(p.columns))), p.solve(range(len(p.columns)), extra)) for p in (joint, few)
    )
    assert one.deviance - with_one.deviance > 20.0
    assert two.deviance - with_two.deviance == pytest.approx(one.deviance - with_one.deviance, rel=1e-3)
    assert with_two.values[-1] == pytest.approx(with_one.values[-1], rel=1e-3)
    last = [s.standard_error(s.values.size - 1) for s in (with_one, with_two)]
    assert last[1] == pytest.approx(last[0], rel=1e-3)


@pytest.mark.parametrize("sd", [0.08, 0.3])
def test_the_floor_of_white_noise(sd: float) -> None:
    found, error = white_noise(sd * np.random.default_rng(5).normal(size=N) + SIMULATED[:, 0], STEP)
    assert found == pytest.approx(sd, abs=max(4.0 * error, 0.1 * sd))


def test_filled_stretches() -> None:
    rng = np.random.default_rng(2)
    values = np.round(SIMULATED[:, 0] + 0.05 * rng.normal(size=N), 2)
    assert interpolated(values) == copied(values, STEP) == []
    line = values.copy()
    line[430:455] = np.round(np.linspace(line[430], line[454], 25), 2)
    assert [run[:2] for run in interpolated(line)] == [(431, 454)]
    repeated = values.copy()
    repeated[500:524] = repeated[404:428]
    assert [run[:2] for run in copied(repeated, STEP)] == [(500, 524)]
    # Hourly values that were interpolated everywhere are usual.
    hourly = np.interp(np.arange(N), np.arange(0, N, 4), values[::4])
    assert interpolated(np.round(hourly, 4)) == []

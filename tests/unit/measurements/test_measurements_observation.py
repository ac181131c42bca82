"""Model and measurement at the same instants."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pandas as pd
import pytest

from mascarin.errors import InputError
from mascarin.measurements.observation import Observation, require_comparable


def observation(start: str, count: int, step: str, *kinds: str) -> Observation:
    times = pd.date_range(start, periods=count, freq=step, tz="UTC")
    return Observation(
        times,
        pd.Timedelta(step).total_seconds(),
        np.full((count, len(kinds)), 20.0),
        kinds,
        tuple(f"s{k}" for k in range(len(kinds))),
    )


def records(start: str, values: npt.ArrayLike, step: str) -> tuple[pd.DatetimeIndex, npt.NDArray[np.float64]]:
    array = np.asarray(values, dtype=np.float64)
    return pd.date_range(start, periods=len(array), freq=step, tz="UTC"), array[:, None]


def test_an_instant_is_the_state_at_that_instant() -> None:
    index, run = records("2024-01-01 00:00", [0.0, 6.0, 12.0, 6.0], "1h")
    seen = observation("2024-01-01 00:00", 7, "30min", "instant")
    np.testing.assert_allclose(seen.simulated(index, run)[:, 0], [0, 3, 6, 9, 12, 9, 6])


def test_a_mean_is_the_integral_over_the_interval_from_the_stamp_on() -> None:
    index, run = records("2024-01-01 00:00", [0.0, 6.0, 12.0, 6.0], "1h")
    seen = observation("2024-01-01 00:00", 4, "1h", "mean")
    # The last interval reaches beyond the run.
    np.testing.assert_allclose(seen.simulated(index, run)[:, 0], [3.0, 9.0, 9.0, np.nan])
    # Intervals that begin and end between records: 0:30 to 1:30 is 3..6 and 6..9.
    half = observation("2024-01-01 00:30", 2, "1h", "mean")
    np.testing.assert_allclose(half.simulated(index, run)[:, 0], [6.0, 0.5 * (10.5 + 10.5)])


def test_instants_and_means_stand_side_by_side_for_every_member() -> None:
    index = pd.date_range("2024-01-01", periods=5, freq="15min", tz="UTC")
    line = np.arange(5.0)
    members = np.stack([np.column_stack([line, line]), np.column_stack([2 * line, 2 * line])])
    seen = observation("2024-01-01", 2, "30min", "instant", "mean")
    found = seen.simulated(index, members)
    assert found.shape == (2, 2, 2)
    np.testing.assert_allclose(found[0], [[0.0, 1.0], [2.0, 3.0]])
    np.testing.assert_allclose(found[1], 2.0 * found[0])


def test_values_outside_the_run_are_missing() -> None:
    index, run = records("2024-01-01 01:00", [1.0, 2.0], "1h")
    seen = observation("2024-01-01 00:00", 4, "1h", "instant")
    np.testing.assert_array_equal(seen.simulated(index, run)[:, 0], [np.nan, 1.0, 2.0, np.nan])


def test_another_time_zone_is_the_same_instant() -> None:
    index, run = records("2024-01-01 00:00", [0.0, 6.0], "1h")
    local = observation("2024-01-01 00:30", 1, "1h", "instant")
    moved = Observation(
        local.times.tz_convert("Indian/Reunion"), local.interval, local.measured, local.kinds, local.names
    )
    np.testing.assert_allclose(moved.simulated(index, run), [[3.0]])


def test_rounding_of_a_stamp_does_not_lose_the_last_record() -> None:
    # 1/3 of a minute in floating point: the place of the last record is not a whole number to the bit.
    index = pd.date_range("2024-01-01", periods=4, freq="20s", tz="UTC")
    seen = Observation(index, 20.0, np.zeros((4, 1)), ("instant",), ("s0",))
    assert np.isfinite(seen.simulated(index, np.arange(4.0)[:, None])).all()


def test_a_period_holds_its_start_and_not_its_end() -> None:
    seen = observation("2024-01-01", 4, "1h", "instant")
    use = seen.during(seen.times[1], seen.times[3])
    np.testing.assert_array_equal(use, [False, True, True, False])


def test_a_series_of_a_run_is_sampled() -> None:
    index = pd.date_range("2024-01-01", periods=3, freq="1h", tz="UTC")
    seen = observation("2024-01-01", 3, "30min", "instant")
    np.testing.assert_allclose(seen.sampled(index, np.array([0.0, 2.0, 8.0])), [0.0, 1.0, 2.0])


def test_a_period_without_values_is_refused() -> None:
    seen = observation("2024-01-01", 4, "1h", "instant", "instant")
    measured = seen.measured.copy()
    measured[:2, 1] = np.nan
    gone = Observation(seen.times, seen.interval, measured, seen.kinds, seen.names)
    first = seen.during(seen.times[0], seen.times[2])
    require_comparable(gone, ~first, "corroboration", ["s0", "s1"])
    require_comparable(gone, first, "identification", ["s0"])
    with pytest.raises(InputError, match=r"s1: has no values during the identification .* choose another"):
        require_comparable(gone, first, "identification", ["s0", "s1"])

"""Properties of tables: what was written is read again, and means keep their integral."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mascarin.tables.profile import PiecewiseProfile, pieces_for, steady
from mascarin.tables.steps import Steps
from mascarin.weather import STAGES, Climate, Measurements, Place
from mascarin.weather.forcing import column_means, column_values
from strategies_weather import means, numbers, quick, tables


@quick
@given(table=tables())
def test_a_frame_is_read_as_it_is(table: pd.DataFrame) -> None:
    measured = Measurements.from_table(table)
    pd.testing.assert_frame_equal(
        measured.to_dataframe(), table, check_names=False, check_freq=False, check_index_type=False
    )
    assert measured.index.tz is not None
    assert measured.timezone == str(table.index.tz)  # type: ignore[attr-defined]


@quick
@given(table=tables(), decimal=st.sampled_from([".", ","]))
def test_a_csv_file_is_read_as_it_was_written(table: pd.DataFrame, decimal: Literal[".", ","]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "table.csv"
        written = table.copy()
        # With their offset, stamps are unique also where clocks go back.
        written.insert(0, "time", [stamp.isoformat() for stamp in table.index])
        written.to_csv(path, index=False, sep=";", decimal=decimal)
        measured = Measurements.from_table(path, timezone=str(table.index.tz), decimal=decimal)  # type: ignore[attr-defined]
    assert list(measured.data.columns) == list(table.columns)
    # A row that is missing altogether is not a row of the file, but it is one of the table.
    np.testing.assert_array_equal(measured.data.to_numpy(), table.to_numpy())
    assert (measured.index == table.index).all()


@quick
@given(table=tables(missing=False), late=st.booleans())
def test_values_at_the_stamps_are_those_of_the_table(table: pd.DataFrame, late: bool) -> None:
    measured = Measurements.from_table(table, stamps="end" if late else "start")
    for name in table.columns:
        found = measured.at(str(name), pd.DatetimeIndex(table.index))
        np.testing.assert_array_equal(found, table[name].to_numpy())


@quick
@given(table=tables(missing=False), parts=st.integers(1, 4), late=st.booleans())
def test_means_keep_their_integral_over_coarser_and_finer_intervals(
    table: pd.DataFrame, parts: int, late: bool
) -> None:
    name = str(table.columns[0])
    measured = Measurements.from_table(table, mean=[name], stamps="end" if late else "start")
    length = measured.step_seconds / parts
    fine = pd.date_range(measured.index[0], periods=len(table) * parts, freq=pd.Timedelta(seconds=length))
    found = measured.at(name, fine, length)
    scale = 1.0 + float(np.abs(table[name]).sum())
    assert found.sum() * length == pytest.approx(
        table[name].sum() * measured.step_seconds, abs=1e-9 * scale * 86400
    )
    whole = measured.at(name, measured.index[:1], measured.step_seconds * len(table))
    assert whole[0] == pytest.approx(table[name].mean(), abs=1e-9 * scale)


@quick
@given(of=means())
def test_a_reconstruction_keeps_the_mean_of_every_interval(of: tuple[float, list[float]]) -> None:
    interval, values = of
    nodes = steady(np.array(values), pieces_for(interval), positive=True)
    profile = PiecewiseProfile(0.0, interval, nodes)
    found = profile.means(interval * np.arange(len(values) + 1))
    # Numbers near 1e-308 have fewer digits.
    np.testing.assert_allclose(found, values, rtol=1e-12, atol=1e-12 * max(values) + 1e-300)
    assert nodes.min() >= -1e-9 * (1.0 + max(values))


@quick
@given(of=means(), scheme=st.sampled_from(sorted(STAGES)), parts=st.integers(1, 3))
def test_the_input_of_the_engine_keeps_the_mean_of_every_interval(
    of: tuple[float, list[float]], scheme: str, parts: int
) -> None:
    interval, values = of
    index = pd.date_range("2024-06-01", periods=len(values), freq=pd.Timedelta(seconds=interval), tz="UTC")
    measured = Measurements.from_table(pd.DataFrame({"plane": values}, index=index), mean=["plane"])
    steps = Steps.over(measured.grid.zone, index[0], index[-1], interval / parts, scheme)
    stages = column_values(measured.record, "plane", steps) @ np.array(steps.weights)
    by_interval = stages.reshape(-1, parts).mean(axis=1)
    np.testing.assert_allclose(by_interval, values[:-1], rtol=1e-9, atol=1e-9 * (1.0 + max(values)))
    level = column_means(measured.record, "plane", steps).reshape(-1, parts).mean(axis=1)
    np.testing.assert_allclose(level, values[:-1], rtol=1e-9, atol=1e-9 * (1.0 + max(values)))


@quick
@given(values=st.lists(numbers, min_size=3, max_size=30))
def test_a_climate_gives_its_table_back(values: list[float]) -> None:
    index = pd.date_range("2024-06-01", periods=len(values), freq="1h", tz="Indian/Reunion")
    table = pd.DataFrame({"T": values}, index=index)
    absent = ["radiation", "dew_point", "wind_speed", "wind_direction"]
    stated = {"air_temperature": {"column": "T", "unit": "degC"}}
    climate = Climate.from_table(table, columns=stated, absent=absent)
    columns: dict[str, Any] = {str(name): str(name) for name in climate.data.columns}
    for name in ("air_temperature", "dew_point"):
        columns[name] = {"column": name, "unit": "degC"}
    again = Climate.from_table(climate.to_dataframe(), columns=columns)
    pd.testing.assert_frame_equal(climate.to_dataframe(), again.to_dataframe(), check_freq=False)
    assert climate.site is None
    assert climate.completed(Place(-21.0, 55.5)).data["global_horizontal"].sum() == 0.0

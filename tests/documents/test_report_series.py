from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from mascarin.errors import InputError
from mascarin.pages.study.data.series import Column, Series, moment


def series(n: int = 1000) -> Series:
    rng = np.random.default_rng(3)
    values = 20.0 + 15.0 * rng.normal(size=n)
    values[n // 3 : n // 2] = np.nan
    constant = np.full(n, 7.25)
    empty = np.full(n, np.nan)
    columns = {
        "observed/a": Column(values, "A", "degC"),
        "fitted/a": Column(constant, "A", "degC"),
        "weather/b": Column(empty, "B", "W/m²"),
    }
    return Series("2024-02-28T23:00", 900.0, columns)


def test_packed_series_come_back(tmp_path: Path) -> None:
    before = series()
    before.write(tmp_path / "series.json")
    after = Series.read(tmp_path / "series.json")
    assert (after.start, after.step, len(after)) == (before.start, before.step, 1000)
    for key, column in before.columns.items():
        again = after.columns[key]
        assert (again.label, again.unit) == (column.label, column.unit)
        assert np.array_equal(np.isnan(again.values), np.isnan(column.values))
        extent = 0.0 if np.isnan(column.values).all() else np.nanmax(column.values) - np.nanmin(column.values)
        good = ~np.isnan(column.values)
        assert np.all(np.abs(again.values - column.values)[good] <= extent / 65000.0 / 2.0 + 1e-12)
    assert np.all(after.columns["fitted/a"].values == 7.25)
    assert (tmp_path / "series.json").stat().st_size < 3 * 1000 * 2 * 4 / 3 + 600


def test_time_and_slices() -> None:
    one = series()
    assert one.time(4).isoformat() == "2024-02-29T00:00:00"
    part = one.slice_of("2024-02-29T00:00", "2024-03-01T00:00")
    assert (part.start, part.stop) == (4, 100)
    between = one.slice_of("2024-02-29T00:07", "2024-02-29T00:31")
    assert (between.start, between.stop) == (5, 7)
    assert one.slice_of("2024-01-01T00:00", "2024-02-01T00:00") == slice(0, 0)


def test_thinning_keeps_every_kth_instant() -> None:
    thin = series().thinned(most=1000)
    assert thin.step == 2700.0
    assert len(thin) == 334
    assert thin.columns["observed/a"].values[1] == series().columns["observed/a"].values[3]
    assert series().thinned(most=3000).step == 900.0


def test_lengths_must_agree() -> None:
    columns = {"a": Column(np.zeros(3), "a", ""), "b": Column(np.zeros(4), "b", "")}
    with pytest.raises(InputError, match="different lengths"):
        Series("2024-01-01T00:00", 60.0, columns)


@pytest.mark.parametrize("step", [0.0, -1.0, math.nan])
def test_a_step_must_be_positive(step: float) -> None:
    with pytest.raises(InputError, match="positive number of seconds"):
        Series("2024-01-01T00:00", step)


def test_a_time_with_offset_is_refused() -> None:
    with pytest.raises(InputError, match="has an offset"):
        moment("2024-01-01T00:00+04:00")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("{", "not JSON"),
        ("[]", "holds a list"),
        ('{"start": 1}', "KeyError"),
        (None, "expected a file written by"),
    ],
)
def test_a_bad_file_is_named(tmp_path: Path, content: str | None, message: str) -> None:
    path = tmp_path / "series.json"
    if content is not None:
        path.write_text(content, encoding="utf-8")
    with pytest.raises(InputError, match=message):
        Series.read(path)

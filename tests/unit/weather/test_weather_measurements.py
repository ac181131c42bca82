from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from mascarin.errors import InputError
from mascarin.tables.quality import mask
from mascarin.weather import Measurements


def measured(**options: object) -> Measurements:
    index = pd.date_range("2024-09-04", periods=6, freq="15min")
    frame = pd.DataFrame(
        {"T": [20.0, 21.0, np.nan, 23.0, 24.0, 25.0], "P": [0.0, 10.0, 20.0, 30.0, 40.0, 50.0]}, index=index
    )
    return Measurements.from_table(frame, timezone="Europe/Paris", **({"mean": ["P"]} | options))  # type: ignore[arg-type]


def at(*stamps: str) -> pd.DatetimeIndex:
    return pd.DatetimeIndex([pd.Timestamp(f"2024-09-04 {stamp}", tz="Europe/Paris") for stamp in stamps])


def test_wall_bench_file(data_dir: Path) -> None:
    path = data_dir / "wall_bench" / "wall_bench_2024.csv"
    with pytest.raises(InputError, match=r"wall_bench_2024.csv: timezone: a time zone is required"):
        Measurements.from_table(path)
    measured = Measurements.from_table(path, timezone="Europe/Paris", mean=["Pyr"])
    assert measured.data.shape == (15840, 8)
    assert measured.step_seconds == 60.0
    assert measured.timezone == "Europe/Paris"
    assert measured.kinds["Pyr"] == "mean"
    assert measured.series("T_ext").iloc[0] == pytest.approx(18.084581)
    with pytest.raises(InputError, match=r"no measured column 'T_ext_1'. Did you mean 'T_ext'"):
        measured.series("T_ext_1")


def test_instants_are_compared_at_their_stamp() -> None:
    values = measured().at(
        "T", at("00:00", "00:15", "00:07:30", "00:30", "00:37:30", "00:45", "01:15", "01:30", "02:00")
    )
    expected = [20.0, 21.0, 20.5, np.nan, np.nan, 23.0, 25.0, 25.0, np.nan]
    assert values == pytest.approx(expected, nan_ok=True)


def test_means_are_compared_over_their_interval() -> None:
    data = measured()
    assert data.at("P", at("00:00", "00:15", "01:15", "01:30")) == pytest.approx(
        [0.0, 10.0, 50.0, np.nan], nan_ok=True
    )
    assert data.at("P", at("00:00", "00:30"), 1800.0) == pytest.approx([5.0, 25.0])
    assert data.at("P", at("00:20"), 600.0) == pytest.approx([10.0])
    assert data.at("P", at("00:10"), 900.0) == pytest.approx([(5.0 * 0.0 + 10.0 * 10.0) / 15.0])


def test_stamps_at_the_end_move_means_only() -> None:
    data = measured(stamps="end")
    assert data.at("P", at("00:00")) == pytest.approx([10.0])
    assert data.at("T", at("00:15")) == pytest.approx([21.0])
    assert "means moved to the start" in " ".join(data.provenance)


def test_columns_are_chosen_renamed_and_converted() -> None:
    data = measured(
        columns={"wall": {"column": "T", "unit": "K"}, "G": {"column": "P", "kind": "mean"}}, mean=()
    )
    assert list(data.data.columns) == ["wall", "G"]
    assert data.series("wall").iloc[0] == pytest.approx(20.0 - 273.15)
    assert data.kinds == {"wall": "instant", "G": "mean"}
    with pytest.raises(InputError, match="no column 'Tw'"):
        measured(columns=["Tw"], mean=())
    with pytest.raises(InputError, match="mean: 'Q' is not read"):
        measured(mean=["Q"])


def test_masked_values_are_gone_and_said() -> None:
    data = measured()
    hidden = mask(data.data, data.quality())
    hidden.iloc[3, 0] = True
    masked = data.masked(hidden)
    assert np.isnan(masked.at("T", at("00:45"))[0])
    assert data.at("T", at("00:45"))[0] == 23.0
    assert masked.provenance[-1].endswith("values masked on request: T 2.")

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from mascarin.errors import InputError
from mascarin.pages.study import write_folder
from mascarin.pages.study.data.folder import read_folder

SERIES = """time,room.measured,room.fitted,room.nominal,weather.wind_speed,state.ceiling.pcm_liquid_fraction
2024-01-01T00:00:00+01:00,20.0,20.5,21,3,0.1
2024-01-01T00:15:00+01:00,,20.6,21,3,0.2
2024-01-01T00:30:00+01:00,20.2,20.7,21,4,0.3
"""
METRICS = {"n": 3, "bias": 0.5, "sd": 0.1, "rmse": 0.51}
STUDY = {
    "title": "A room",
    "sensor_info": {"room": {"label": "Room air", "output": "room.air_temperature", "unit": "degC"}},
    "models": {"nominal": {"label": "nominal"}, "fitted": {"label": "fitted"}},
    "periods": {
        "corroboration": {"label": "Held back", "spans": [["2024-01-01T00:00", "2024-01-01T00:45"]]},
        "blind": {"label": "Blind days", "spans": [["2024-01-01T00:00", "2024-01-01T00:45"]]},
    },
    "sensors": {
        "room": {
            "corroboration": {**METRICS, "fitted": METRICS, "nominal": {"n": 0, "sd": None}},
            "blind": {**METRICS, "fitted": METRICS},
        }
    },
}


def folder(path: Path, series: str = SERIES) -> Path:
    (path / "tables").mkdir()
    (path / "tables" / "series.csv").write_text(series, encoding="utf-8")
    (path / "study.json").write_text(json.dumps(STUDY), encoding="utf-8")
    return path


def test_series_get_their_places(tmp_path: Path) -> None:
    _, series = read_folder(folder(tmp_path))
    assert list(series.columns) == [
        "observed/room",
        "fitted/room",
        "nominal/room",
        "weather/wind_speed",
        "state/ceiling.pcm_liquid_fraction",
    ]
    assert (series.start, series.step) == ("2024-01-01T00:00:00", 900.0)
    np.testing.assert_array_equal(series.columns["observed/room"].values, [20.0, np.nan, 20.2])
    assert series.columns["weather/wind_speed"].unit == "m/s"


def test_the_page_shows_each_period_once(tmp_path: Path) -> None:
    page = write_folder(folder(tmp_path)).read_text(encoding="utf-8")
    assert "Held back: fitted" in page
    assert "Blind days" not in page


@pytest.mark.parametrize(
    ("series", "message"),
    [
        ("time,room.measured\n2024-01-01T00:00,1\n", "1 rows; expected at least two"),
        ("time,room.measured\nsoon,1\n2024-01-01,2\n", "soon"),
        ("time,room.measured\n2004-01-01,1\n2024-01-01,2\n2024-01-02,2\n", "not at equal distances"),
        ("time,room.measured\n2024-01-01T00:00,warm\n2024-01-01T00:15,2\n", "warm"),
    ],
)
def test_a_bad_table_is_named(tmp_path: Path, series: str, message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        read_folder(folder(tmp_path, series))
    assert "series.csv" in str(caught.value)


def test_a_missing_table_is_named(tmp_path: Path) -> None:
    out = folder(tmp_path)
    (out / "tables" / "series.csv").unlink()
    with pytest.raises(InputError, match=r"series\.csv.*run it again"):
        write_folder(out)
    assert not (out / "report.html").exists()

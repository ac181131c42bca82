from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from mascarin.errors import InputError
from mascarin.weather import Climate, Place
from mascarin.weather.sun import SunPath
from mascarin.weather.times import epoch_seconds

SITE = Place(45.0, 5.0)


def record(zone: str, *, days: int = 10) -> Climate:
    """A plain sunny record at `SITE`, its stamps in UTC, read in some zone."""
    index = pd.date_range("2024-05-01", periods=24 * days, freq="1h")
    seconds = epoch_seconds(index.tz_localize("UTC"))
    path = SunPath.over(SITE.latitude, SITE.longitude, seconds[0], seconds[-1] + 3600.0)
    fine = path.vector(seconds[:, None] + 3600.0 * (np.arange(12) + 0.5) / 12)[..., 2]
    sun = 900.0 * np.maximum(fine, 0.0).mean(axis=1)
    frame = pd.DataFrame({"T": 15.0, "G": sun, "v": 1.0, "d": 0.0}, index=index)
    return Climate.from_table(
        frame,
        timezone=zone,
        columns={"air_temperature": "T", "global_horizontal": "G", "wind_speed": "v", "wind_direction": "d"},
        absent=["dew_point"],
    )


def test_right_clock_passes() -> None:
    assert record("UTC").completed(SITE).data["direct_normal"].max() > 0.0


@pytest.mark.parametrize(
    ("zone", "hours", "when"),
    [
        ("UTC+1", "1.0", "before"),
        ("UTC-1", "1.0", "after"),
        ("UTC+9", "9.0", "before"),
        ("America/Denver", "6.0", "after"),
    ],
)
def test_wrong_zone_is_refused_with_the_shift(zone: str, hours: str, when: str) -> None:
    words = rf"centered {hours} h {when} solar noon.*time zone \(now {re.escape(zone)}\)"
    with pytest.raises(InputError, match=words):
        record(zone).completed(SITE)


def test_sign_of_the_longitude_is_refused() -> None:
    with pytest.raises(InputError, match="longitude -100"):
        record("UTC").completed(Place(45.0, -5.0 - 95.0))


def test_stamps_taken_for_the_wrong_end_are_refused(data_dir: Path) -> None:
    arguments = {
        "timezone": "UTC+4",
        "time": "AAAAMMJJHH",
        "time_format": "%Y%m%d%H",
        "columns": {
            "air_temperature": "T",
            "dew_point": "TD",
            "wind_speed": "FF",
            "wind_direction": "DD",
            "global_horizontal": {"column": "GLO", "unit": "J/cm2"},
        },
        "latitude": -20.892,
        "longitude": 55.529,
    }
    path = data_dir / "weather" / "gillot_2023_meteo_france.csv"
    Climate.from_table(path, stamps="end", **arguments)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="stamps mark the start or the end"):
        Climate.from_table(path, stamps="start", **arguments)  # type: ignore[arg-type]


def test_the_check_can_be_declined_and_needs_days_and_sun() -> None:
    climate = record("UTC+9")
    with pytest.raises(InputError):
        climate.forcing(SITE, "2024-05-02", "2024-05-03", 3600.0)
    frame = climate.data.rename(columns={"air_temperature": "T", "global_horizontal": "G"})
    columns = {"air_temperature": "T", "global_horizontal": "G"}
    absent = ["dew_point", "wind_speed", "wind_direction"]
    kept = Climate.from_table(frame, timezone="UTC+9", columns=columns, absent=absent, check_sun=False)
    assert kept.forcing(SITE, "2024-05-02", "2024-05-03", 3600.0).shape[0] == 24
    record("UTC+9", days=1).completed(SITE)
    dark = frame.assign(G=0.0)
    Climate.from_table(dark, timezone="UTC+9", columns=columns, absent=absent).completed(SITE)

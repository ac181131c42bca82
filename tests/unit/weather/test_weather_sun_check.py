from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin.errors import InputError
from mascarin.tables.times import epoch_seconds
from mascarin.weather import Climate, Measurements, Place
from mascarin.weather.derived.sun import SunPath

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
        ("UTC+1", "60 min", "earlier than the sun"),
        ("UTC-1", "60 min", "later than the sun"),
        ("UTC+9", "9.0 h", "before solar noon"),
        ("America/Denver", "6.0 h", "after solar noon"),
    ],
)
def test_wrong_zone_is_refused_with_the_shift(zone: str, hours: str, when: str) -> None:
    words = rf"is (?:centered )?{hours} (?:\(.*\) )?{when}.*time zone \(now {re.escape(zone)}\)"
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


def summer_clock(
    declared: str, clock: str = "Europe/Paris", *, start: str = "2023-03-01", days: int = 60
) -> Climate:
    """A record whose stamps follow a clock on the wall, read in another zone."""
    index = pd.date_range(start, periods=24 * days, freq="1h", tz="UTC")
    seconds = epoch_seconds(index)
    path = SunPath.over(SITE.latitude, SITE.longitude, seconds[0], seconds[-1] + 3600.0)
    fine = path.vector(seconds[:, None] + 3600.0 * (np.arange(12) + 0.5) / 12)[..., 2]
    rng = np.random.default_rng(3)
    cloud = np.repeat(rng.uniform(0.2, 1.0, 4 * days), 6)  # changes every six hours
    sun = 900.0 * cloud * np.maximum(fine, 0.0).mean(axis=1)
    written = index.tz_convert(clock).tz_localize(None)
    frame = pd.DataFrame({"T": 15.0, "G": sun, "v": 1.0, "d": 0.0}, index=written)
    return Climate.from_table(
        frame[~written.duplicated()],
        timezone=declared,
        columns={"air_temperature": "T", "global_horizontal": "G", "wind_speed": "v", "wind_direction": "d"},
        absent=["dew_point"],
    ).fill_gaps("2h")


@pytest.mark.parametrize(
    ("start", "date", "when"),
    [("2023-03-01", "2023-0(3|4)", "later"), ("2023-10-01", "2023-1(0|1)", "earlier")],
)
def test_a_clock_of_summer_time_that_is_declared_as_an_offset_is_refused(
    start: str, date: str, when: str
) -> None:
    words = rf"moves by (0\.[89]|1\.[012]) h against the sun about {date}.*{when}.*Europe/Paris"
    with pytest.raises(InputError, match=words):
        summer_clock("UTC+1", start=start).completed(SITE)


def test_the_same_record_in_the_zone_of_the_place_passes() -> None:
    summer_clock("Europe/Paris").completed(SITE)
    summer_clock("UTC+1", "Etc/GMT-1").completed(SITE)


def test_real_years_do_not_jump(data_dir: Path) -> None:
    """Four places from 21 S to 42 N; the same years on a clock of summer time do."""
    for file in sorted((data_dir / "weather").glob("*.epw")):
        head = file.read_text(encoding="utf-8", errors="replace").split("\n")[0].split(",")
        sun = Climate.from_epw(file).data["global_horizontal"]
        frame = pd.DataFrame({"T": 15.0, "G": sun, "v": 1.0, "d": 0.0}).tz_localize(None)
        options: dict[str, Any] = {
            "timezone": f"UTC{float(head[8]):+.0f}",
            "columns": {
                "air_temperature": "T", "global_horizontal": "G", "wind_speed": "v", "wind_direction": "d",
            },
            "absent": ["dew_point"],
            "latitude": float(head[6]),
            "longitude": float(head[7]),
        }  # fmt: skip
        Climate.from_table(frame, **options)
        months = pd.DatetimeIndex(frame.index).month
        summer = (months > 3) & (months < 11)
        frame["G"] = np.where(summer, frame["G"].shift(1, fill_value=0.0), frame["G"])
        with pytest.raises(InputError, match=r"moves by .* h against the sun about .*(-03-|-04-|-10-|-11-)"):
            Climate.from_table(frame, **options)


def test_a_missing_hour_in_spring_is_a_warning() -> None:
    written = pd.date_range("2024-03-30", periods=96, freq="1h", tz="Europe/Paris").tz_localize(None)
    frame = pd.DataFrame({"T": np.arange(96.0)}, index=written)
    [warning] = [n for n in Measurements.from_table(frame, timezone="UTC+1").provenance if "warning" in n]
    assert "one hour is missing after 2024-03-31 01:00" in warning
    assert not [
        n for n in Measurements.from_table(frame, timezone="Europe/Paris").provenance if "warning" in n
    ]

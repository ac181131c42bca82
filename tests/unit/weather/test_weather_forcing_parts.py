"""The forcing of a period in parts, beside that of all its steps."""

from __future__ import annotations

from zoneinfo import ZoneInfo

import numpy as np
import pandas as pd
import pytest

from mascarin.building.base.time_series import ColumnCourse
from mascarin.building.parts.air.schedule import FractionSchedule, Schedule, TemperatureSchedule
from mascarin.tables.steps import Steps
from mascarin.tables.times import epoch_seconds
from mascarin.weather import Climate, Place
from mascarin.weather.derived.sun import SunPath
from mascarin.weather.forcing_source import ForcingSource
from mascarin.weather.schedules import Courses, pieces_of

SITE = Place(45.0, 5.0, 200.0)
PARIS = ZoneInfo("Europe/Paris")
SUN = {
    "global": {"global_horizontal": "G"},
    "both": {"global_horizontal": "G", "diffuse_horizontal": "D"},
    "direct": {"direct_normal": "B", "diffuse_horizontal": "D"},
}


def table(minutes: int, days: int) -> pd.DataFrame:
    """Random weather whose wind turns about north, with numbers of many digits."""
    index = pd.date_range("2020-03-01", periods=days * 24 * 60 // minutes, freq=f"{minutes}min", tz="UTC")
    rng, count = np.random.default_rng(minutes), len(index)
    middles = epoch_seconds(index) + 30.0 * minutes
    sun = SunPath.over(SITE.latitude, SITE.longitude, middles[0], middles[-1])
    clear = np.maximum(sun.vector(middles)[:, 2], 0.0) * rng.uniform(100.0, 900.0, count)
    return pd.DataFrame(
        {
            "T": 10.0 + rng.normal(size=count), "W": rng.uniform(0.0, 360.0, count),
            "G": clear, "D": clear * rng.uniform(0.3, 1.0, count), "B": clear * rng.uniform(0.0, 0.9, count),
            "V": rng.uniform(0.0, 9.0, count), "P": rng.normal(size=count), "Q": rng.uniform(size=count),
        },
        index=index,
    )  # fmt: skip


def climate(minutes: int, days: int, sun: str = "both") -> Climate:
    named = {"air_temperature": "T", "wind_speed": "V", "wind_direction": "W", **SUN[sun]}
    return Climate.from_table(table(minutes, days), columns=named, extra=["P", "Q"], absent=["dew_point"])


def bits(values: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(values).view(np.int64)


@pytest.mark.parametrize(
    ("sun", "minutes", "step", "scheme"),
    [
        ("both", 60, 900.0, "sdirk2"),
        ("global", 60, 450.0, "sdirk2"),
        ("direct", 60, 3600.0, "backward-euler"),
        ("both", 10, 300.0, "backward-euler"),
        ("direct", 15, 3600.0, "sdirk2"),
    ],
)
def test_parts_have_the_bits_of_the_period(sun: str, minutes: int, step: float, scheme: str) -> None:
    """Over the change to summer time, from the first value of the table on and from within it."""
    weather = climate(minutes, 40, sun)
    people = FractionSchedule.model_validate(
        {
            "days": {
                "all": [
                    {"at": "00:00", "value": 0.0},
                    {"at": "06:00", "value": 0.3},
                    {"at": "17:10", "value": 0.7, "ramp_to": 0.1},
                ]
            }
        }
    )
    courses: dict[str, Schedule | ColumnCourse] = {
        "people": people,
        "set point": TemperatureSchedule(value=20.0),
        "heater": ColumnCourse("power", ("P", "Q"), "kW", "people"),
        "inlet": ColumnCourse("temperature", ("Q",), "degC"),
        "lamp": ColumnCourse("power", ("P",), "W"),
    }
    for start, end in (("2020-03-01", "2020-04-09"), ("2020-03-04 05:00", "2020-04-01 01:00")):

        def source() -> ForcingSource:
            return ForcingSource(weather, SITE, ["P", "Q"], Courses(weather, courses, PARIS))

        period = (weather.grid.zone, start, end, step, scheme)
        whole, in_parts = source().at(Steps.over(*period)), source()
        for size in (96, 1000):
            parts = [in_parts.at(steps) for steps in Steps.parts(*period, size)]
            assert len(parts) == -(-len(whole) // size)
            assert np.array_equal(bits(np.concatenate(parts)), bits(whole))


def test_a_typical_year_is_repeated_in_parts() -> None:
    """Three years over 29 February, in parts that begin anywhere in the year."""
    weather = Climate.from_epw("shipped:golden")
    assert weather.site is not None
    source = ForcingSource(weather, weather.site, [], Courses(weather, {}, PARIS))
    period = (weather.grid.zone, "2019-11-03", "2022-02-07", 3600.0, "sdirk2")
    whole = source.at(Steps.over(*period))
    parts = np.concatenate([source.at(steps) for steps in Steps.parts(*period, 1000)])
    assert np.array_equal(bits(parts), bits(whole))


def test_pieces_of_a_schedule_over_years_are_those_of_a_day() -> None:
    """The clocks of Paris change 22 times in eleven years; the pieces are made 400 days at a time."""
    schedule = FractionSchedule.model_validate(
        {
            "days": {
                "all": [
                    {"at": "00:00", "value": 0.0},
                    {"at": "07:30", "value": 1.0},
                    {"at": "19:00", "value": 0.0},
                ]
            }
        }
    )
    first, last = (pd.Timestamp(day, tz=PARIS).timestamp() for day in ("2010-01-01", "2021-01-01"))
    pieces = pieces_of(schedule, PARIS, first, last)
    hours = pd.date_range("2010-01-01 00:01", "2020-12-31 23:01", freq="1h", tz=PARIS)
    seconds = np.asarray([hour.timestamp() for hour in hours]) - first
    minutes = hours.hour * 60 + hours.minute
    expected = (minutes > 7 * 60 + 30) & (minutes < 19 * 60)
    assert np.array_equal(pieces.before(seconds), np.asarray(expected, dtype=np.float64))

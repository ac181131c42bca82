"""Schedules at the stages of steps: clocks, days of the week, holidays, ramps, switches, columns."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest
from numpy.typing import NDArray
from pydantic import TypeAdapter

from building_samples import ROOM
from mascarin.building import Building
from mascarin.building.parts.air.schedule import Schedule
from mascarin.building.reading import parse
from mascarin.errors import InputError
from mascarin.examples import box
from mascarin.simulation import simulate
from mascarin.weather import Climate, parse_timezone, scheduled

GAMMA = 1.0 - np.sqrt(0.5)


def climate(start: str, days: int, **columns: NDArray[np.float64]) -> Climate:
    """Anything at all, hourly; columns called mean... hold means."""
    index = pd.date_range(start, periods=24 * days + 1, freq="1h", tz="UTC")
    channels = ["air_temperature", "dew_point", "cloud_cover", "wind_speed", "wind_direction"]
    channels += ["direct_normal", "diffuse_horizontal"]
    nothing = dict.fromkeys(channels, np.zeros(len(index)))
    return Climate.from_table(
        pd.DataFrame({**nothing, **columns}, index=index),
        timezone="UTC",
        columns={name: name for name in channels},
        extra=list(columns),
        mean=[name for name in columns if name.startswith("mean")],
        instant=[*channels, *(name for name in columns if not name.startswith("mean"))],
    )


def values(
    plain: Any, start: str, end: str, step: float, zone: str = "UTC", **columns: Any
) -> NDArray[np.float64]:
    schedule: Any = TypeAdapter(Schedule).validate_python(plain)
    days = (pd.Timestamp(end) - pd.Timestamp(start)).days + 1
    weather = climate(start, days, **columns)
    found = scheduled(weather, {"s": schedule}, parse_timezone(zone), start, end, step)
    return np.asarray(found[..., 0], dtype=np.float64)


def points(*pairs: Any) -> list[dict[str, Any]]:
    keys = ("at", "value", "ramp_to")
    return [dict(zip(keys, pair, strict=False)) for pair in pairs]


def test_a_temperature_is_taken_before_it_jumps() -> None:
    """A step that ends at 23:00 still has 20; on the ramp the end of each quarter counts."""
    setback = points(("00:00", 10), ("07:00", 10, 20), ("08:00", 20), ("23:00", 10))
    found = values({"kind": "temperature", "days": {"all": setback}}, "2001-01-01", "2001-01-02", 900.0)
    assert found[27:33, 1] == pytest.approx([10, 12.5, 15, 17.5, 20, 20])
    assert found[28, 0] == pytest.approx(10 + 2.5 * GAMMA)
    assert found[90:94, 1] == pytest.approx([20, 20, 10, 10])
    assert found[92, 0] == 10.0


def test_a_fraction_is_its_mean_over_the_step() -> None:
    day = points(("00:00", 0), ("07:05", 1), ("07:12", 0), ("08:00", 0, 1), ("09:00", 1))
    found = values({"kind": "fraction", "days": {"all": day}}, "2001-01-01", "2001-01-02", 900.0)
    assert found[28] == pytest.approx([7 / 15, 7 / 15])
    assert found[32:37, 1] == pytest.approx([0.125, 0.375, 0.625, 0.875, 1.0])
    assert found.mean() == pytest.approx((7 / 60 + 0.5 + 15) / 24)


def test_weeks_and_holidays() -> None:
    """2001-01-01 was a Monday and is a holiday here; the 4th is one by its date."""
    plain = {
        "kind": "fraction",
        "days": {
            "weekdays": points(("00:00", 0.5)),
            "weekends": points(("00:00", 0.1)),
            "friday": points(("00:00", 0.4)),
            "holidays": points(("00:00", 0)),
        },
        "holidays": ["01-01", "2001-01-04", "2002-01-03"],
    }
    found = values(plain, "2001-01-01", "2001-01-08", 86400.0)
    assert found[:, 1] == pytest.approx([0, 0.5, 0.5, 0, 0.4, 0.1, 0.1])


def test_the_clocks_are_those_of_the_site() -> None:
    """Paris: summer time from 2001-03-25 02:00; 08:00 is 07:00 UTC before it and 06:00 after."""
    plain = {"kind": "fraction", "days": {"all": points(("00:00", 0), ("08:00", 1), ("09:00", 0))}}
    found = values(plain, "2001-03-24", "2001-03-27", 3600.0, "Europe/Paris")[:, 1]
    assert np.flatnonzero(found) == pytest.approx([7, 24 + 6, 48 + 6])
    assert found.sum() == pytest.approx(3.0)


def test_a_measured_column() -> None:
    occupied = np.tile([0.0, 0.5], 25)[:49]
    mean = values(
        {"kind": "fraction", "column": "mean_o"}, "2001-01-01", "2001-01-02", 7200.0, mean_o=occupied
    )
    assert mean == pytest.approx(0.25)
    instant = values({"kind": "fraction", "column": "o"}, "2001-01-01", "2001-01-02", 1800.0, o=occupied)
    assert instant[:4, 0] == pytest.approx([0.125, 0.375, 0.375, 0.125])
    warm = values({"kind": "temperature", "column": "w"}, "2001-01-01", "2001-01-02", 1800.0, w=20 + occupied)
    assert warm[:2, 1] == pytest.approx([20.25, 20.5])
    with pytest.raises(InputError, match=r"o is 1\.5 at .* expected 0 \.\. 1"):
        values({"kind": "fraction", "column": "o"}, "2001-01-01", "2001-01-02", 1800.0, o=3 * occupied)
    with pytest.raises(InputError, match=r"schedules\.s\.column: .*no measured column 'p'.* Known: o"):
        values({"kind": "fraction", "column": "p"}, "2001-01-01", "2001-01-02", 1800.0, o=occupied)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{kind: fraction, value: 1.5}", "expected: a number at least 0 and at most 1"),
        ("{kind: fraction}", "exactly one of value, days, seasons, column"),
        ("{kind: fraction, value: 1, column: x}", "exactly one of value, days, seasons, column"),
        ('{kind: fraction, days: {all: [{at: "07:00", value: 1}]}}', 'the first point of a day at "00:00"'),
        (
            '{kind: fraction, days: {all: [{at: "00:00", value: 1}, {at: "09:00", value: 0}, '
            '{at: "08:00", value: 1}]}}',
            'found: "08:00" after "09:00"',
        ),
        (
            '{kind: fraction, days: {all: [{at: "00:00", value: 1}, {at: "24:00", value: 0}]}}',
            "a time of day",
        ),
        ('{kind: fraction, days: {weekdays: [{at: "00:00", value: 1}]}}', "no profile for saturday, sunday"),
        ('{kind: fraction, days: {al: [{at: "00:00", value: 1}]}}', "Did you mean 'all'"),
        (
            '{kind: fraction, days: {all: [{at: "00:00", value: 1}]}, holidays: ["12-25"]}',
            "no profile for them",
        ),
        (
            '{kind: fraction, days: {all: [{at: "00:00", value: 1}], holidays: [{at: "00:00", value: 0}]}}',
            "a profile, but no dates",
        ),
        (
            '{kind: fraction, days: {all: [{at: "00:00", value: 1}], holidays: [{at: "00:00", value: 0}]}, '
            'holidays: ["25.12."]}',
            "a date",
        ),
        ("{kind: switch, value: 1}", "fraction, temperature"),
    ],
)
def test_what_is_no_schedule_is_refused(text: str, message: str) -> None:
    with pytest.raises(InputError) as refusal:
        parse(ROOM + f"schedules:\n  s: {text}\n", "room.yaml")
    assert message in str(refusal.value)
    assert "schedules.s" in str(refusal.value)


def test_seasons_of_a_year() -> None:
    """The last day of a season belongs to it, in every year."""
    plain = {
        "kind": "fraction",
        "seasons": [
            {"until": "02-28", "days": {"all": points(("00:00", 0.2))}},
            {
                "until": "12-31",
                "days": {"weekdays": points(("00:00", 1)), "weekends": points(("00:00", 0.5))},
            },
        ],
    }
    found = values(plain, "2001-02-27", "2001-03-04", 86400.0)
    assert found[:, 1] == pytest.approx([0.2, 0.2, 1.0, 1.0, 0.5])


@pytest.mark.parametrize("ends", [["12-30"], ["06-30", "03-31", "12-31"], []])
def test_seasons_that_are_not_a_year_are_refused(ends: list[str]) -> None:
    seasons = [{"until": end, "days": {"all": points(("00:00", 0.2))}} for end in ends]
    with pytest.raises(ValueError, match='the last one "12-31"'):
        TypeAdapter(Schedule).validate_python({"kind": "fraction", "seasons": seasons})


def test_a_side_of_a_scheduled_temperature_is_ground_of_that_temperature() -> None:
    """A floor over soil of 12 degC, by its schedule and as ground: equal within round-off."""
    plain: dict[str, Any] = box().to_dict()
    plain["schedules"] = {"soil": {"kind": "temperature", "value": 12}}
    floor = {"construction": "wall", "area": 9, "tilt": 180}
    inside = {"zone": "room", "convection": 3, "emissivity": 0.9}
    runs = []
    for outside in ({"ground": {"temperature": 12}}, {"scheduled": "soil"}, {"adiabatic": True}):
        plain["surfaces"]["floor"] = floor | {"outside": outside, "inside": inside}
        run = simulate(
            Building.from_dict(plain),
            climate("2001-01-01", 3),
            start="2001-01-01",
            end="2001-01-03",
            outputs=["room.air_temperature"],
        )
        runs.append(run["room.air_temperature"].to_numpy())
    assert np.abs(runs[0] - runs[1]).max() < 1e-9
    assert np.abs(runs[0] - runs[2]).min() > 0.1


def test_set_points_that_cross_in_one_season_are_refused() -> None:
    plain: dict[str, Any] = box().to_dict()
    seasons = [
        {"until": end, "days": {"all": points(("00:00", value))}}
        for end, value in (("06-30", 20), ("12-31", 27))
    ]
    plain["schedules"] = {"heat": {"kind": "temperature", "seasons": seasons}}
    plain["zones"]["room"] |= {"heating": {"setpoint": {"schedule": "heat"}}, "cooling": {"setpoint": 26}}
    with pytest.raises(
        InputError, match="heating to 27 degC, above cooling to 26 degC, on monday before 12-31"
    ):
        Building.from_dict(plain)

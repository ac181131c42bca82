from __future__ import annotations

from datetime import UTC, datetime, timedelta

import pandas as pd
import pytest

from mascarin.errors import InputError
from mascarin.tables.timezones import fixed_zone, localize, moment, parse_timezone, zone_name

PARIS = parse_timezone("Europe/Paris")


@pytest.mark.parametrize(
    ("text", "hours"),
    [
        ("UTC", 0.0),
        ("UTC+4", 4.0),
        ("UTC-07:00", -7.0),
        ("+05:30", 5.5),
        ("utc-3:30", -3.5),
        ("Indian/Reunion", 4.0),
    ],
)
def test_zones_and_their_offset(text: str, hours: float) -> None:
    zone = parse_timezone(text)
    assert zone.utcoffset(datetime(2024, 1, 1)) == timedelta(hours=hours)
    again = parse_timezone(zone_name(zone))
    assert again.utcoffset(datetime(2024, 1, 1)) == timedelta(hours=hours)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (None, "a time zone is required, found None"),
        ("", "a time zone is required"),
        (4, "a time zone is required, found 4"),
        ("Europe/Pari", "Did you mean 'Europe/Paris'"),
        ("UTC+15", "outside UTC-12"),
        ("CEST!", "no time zone 'CEST!'"),
    ],
)
def test_bad_zones_are_refused(text: object, words: str) -> None:
    with pytest.raises(InputError, match=words.replace("+", r"\+")):
        parse_timezone(text, "logger.csv: timezone")


def test_fixed_zone_from_hours() -> None:
    assert zone_name(fixed_zone(-7.0)) == "UTC-7"
    assert zone_name(fixed_zone(5.75)) == "UTC+5:45"
    assert zone_name(UTC) == "UTC"


def test_stamps_skipped_in_spring_are_named() -> None:
    stamps = pd.date_range("2024-03-31 00:00", periods=8, freq="30min")
    with pytest.raises(InputError) as caught:
        localize(stamps, PARIS, "logger.csv")
    text = str(caught.value)
    assert text.startswith(
        "logger.csv: Europe/Paris skips the local stamps 2024-03-31 02:00, 2024-03-31 02:30 (when "
        "clocks go forward)"
    )
    assert "state timezone: UTC+1" in text


def test_stamps_doubled_in_autumn_are_named() -> None:
    stamps = pd.date_range("2024-10-27 00:00", periods=200, freq="1min")
    with pytest.raises(InputError) as caught:
        localize(stamps, PARIS, "logger.csv")
    text = str(caught.value)
    assert (
        "has twice the local stamps 2024-10-27 02:00, 2024-10-27 02:01, 2024-10-27 02:02 and 57 more" in text
    )
    assert "state timezone: UTC+1" in text
    assert "2024-10-27T02:00+01:00" in text


def test_winter_time_is_named_south_of_the_equator() -> None:
    stamps = pd.DatetimeIndex(["2024-04-07 02:30"])
    with pytest.raises(InputError, match=r"state timezone: UTC\+10"):
        localize(stamps, parse_timezone("Australia/Sydney"), "logger.csv")


def test_moments_are_local_unless_they_say_otherwise() -> None:
    assert (
        moment("2024-07-01 12:00", PARIS, "start").timestamp()
        == datetime(2024, 7, 1, 10, tzinfo=UTC).timestamp()
    )
    assert moment("2024-07-01T12:00+00:00", PARIS, "start").hour == 14
    assert moment(datetime(2024, 1, 1, tzinfo=UTC), PARIS, "start").hour == 1
    for wrong in ("soon", None, float("nan")):
        with pytest.raises(InputError, match="start: "):
            moment(wrong, PARIS, "start")
    with pytest.raises(
        InputError, match="start: 2024-03-31 02:15 does not exist or exists twice in Europe/Paris"
    ):
        moment("2024-03-31 02:15", PARIS, "start")

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from mascarin.errors import InputError
from mascarin.tables.times import epoch_seconds
from mascarin.weather import CHANNELS, IRRADIANCES, STAGES, TEMPERATURES, Climate, Measurements, Place
from mascarin.weather.derived.sun import SunPath

REUNION = Place(-21.34, 55.48, 55.0)
BEAM, SKY, ALL, UP = (
    CHANNELS.index(n) for n in ("direct_normal", "diffuse_horizontal", "global_horizontal", "sun_up")
)


def column(forcing: np.ndarray, name: str) -> np.ndarray:
    return np.asarray(forcing[..., CHANNELS.index(name)])


def step_means(forcing: np.ndarray, scheme: str, place: int) -> np.ndarray:
    return np.asarray(forcing[..., place] @ np.array(STAGES[scheme][1]))


def sky(hours: int = 120, every: str = "1h") -> pd.DataFrame:
    """A made-up record: cloudy sun over Saint-Pierre, means of the hour that starts at the stamp."""
    index = pd.date_range("2010-09-20", periods=hours, freq=every, tz="Indian/Reunion")
    seconds = epoch_seconds(index)
    step = seconds[1] - seconds[0]
    sun = SunPath.over(REUNION.latitude, REUNION.longitude, seconds[0], seconds[-1] + step)
    fine = sun.vector(seconds[:, None] + step * (np.arange(20) + 0.5) / 20)[..., 2]
    random = np.random.default_rng(3)
    clearness = random.uniform(0.2, 0.75, hours)
    total = 1361.0 * clearness * np.maximum(fine, 0.0).mean(axis=1)
    # The lowest sun gives no beam: otherwise some of it would rightly be booked as diffuse.
    part = np.where(np.maximum(fine, 0.0).mean(axis=1) > 0.15, random.uniform(0.2, 0.9, hours), 1.0)
    return pd.DataFrame(
        {
            "air": 22.0 + 5.0 * random.normal(size=hours),
            "dew": 15.0 + random.normal(size=hours),
            "speed": random.uniform(0.0, 8.0, hours),
            "direction": random.uniform(0.0, 360.0, hours),
            "total": total,
            "diffuse": part * total,
            "plane": 0.7 * total,
            "probe": 20.0 + random.normal(size=hours),
        },
        index=index,
    )


def climate(frame: pd.DataFrame) -> Climate:
    return Climate.from_table(
        frame,
        timezone="Indian/Reunion",
        columns={
            "air_temperature": "air",
            "dew_point": "dew",
            "wind_speed": "speed",
            "wind_direction": "direction",
            "global_horizontal": "total",
            "diffuse_horizontal": "diffuse",
        },
        extra=["plane", "probe"],
        mean=["plane"],
        altitude=55.0,
    )


def test_channels_are_those_of_the_engine(repository: Path) -> None:
    source = (repository / "crates" / "engine" / "src" / "input" / "forcing.rs").read_text(encoding="utf-8")
    for place, name in enumerate(CHANNELS):
        assert f"pub const {name.upper()}: usize = {place};" in source
    assert f"CLIMATE_CHANNELS: usize = {len(CHANNELS)};" in source


@pytest.mark.parametrize("scheme", STAGES)
def test_stage_weights_make_a_mean_of_second_order_for_sdirk2(scheme: str) -> None:
    nodes, weights = STAGES[scheme]
    assert sum(weights) == pytest.approx(1.0, abs=1e-15)
    assert nodes[-1] == 1.0
    if scheme == "sdirk2":
        assert sum(c * b for c, b in zip(nodes, weights, strict=True)) == pytest.approx(0.5, abs=1e-15)


@pytest.mark.parametrize("step", [100.0, 900.0, 1200.0, 3600.0])
@pytest.mark.parametrize("scheme", STAGES)
def test_radiation_integral_is_that_of_every_source_interval(step: float, scheme: str) -> None:
    frame = sky()
    forcing = climate(frame).forcing(REUNION, "2010-09-20", "2010-09-25", step, scheme)
    per_hour = round(3600.0 / step)
    for place, name in ((SKY, "diffuse"), (ALL, "total")):
        hourly = step_means(forcing, scheme, place).reshape(-1, per_hour).mean(axis=1)
        assert np.max(np.abs(hourly - frame[name].to_numpy())) < 1e-10


def test_steps_longer_than_the_source_and_not_dividing_it() -> None:
    frame = sky()
    long = climate(frame).forcing(REUNION, "2010-09-20", "2010-09-25", 7200.0)
    assert step_means(long, "sdirk2", ALL) == pytest.approx(
        frame["total"].to_numpy().reshape(-1, 2).mean(axis=1), abs=1e-10
    )
    odd = climate(frame).forcing(REUNION, "2010-09-20", "2010-09-25", 2700.0)
    three_hours = step_means(odd, "sdirk2", ALL).reshape(-1, 4).mean(axis=1)
    assert three_hours == pytest.approx(frame["total"].to_numpy().reshape(-1, 3).mean(axis=1), abs=1e-10)


def test_plane_irradiance_keeps_its_integral_and_sign() -> None:
    frame = sky()
    forcing = climate(frame).forcing(REUNION, "2010-09-20", "2010-09-25", 450.0, channels=["probe", "plane"])
    assert forcing.shape == (960, 2, len(CHANNELS) + 2)
    plane = step_means(forcing, "sdirk2", len(CHANNELS) + 1).reshape(-1, 8).mean(axis=1)
    assert np.max(np.abs(plane - frame["plane"].to_numpy())) < 1e-10
    assert forcing[..., len(CHANNELS) + 1].min() >= 0.0


def test_instants_are_linear_and_exact_at_their_stamps() -> None:
    frame = sky()
    forcing = climate(frame).forcing(
        REUNION, "2010-09-20", "2010-09-24", 1800.0, "backward-euler", channels=["probe"]
    )
    air, probe = forcing[:, 0, 0], forcing[:, 0, len(CHANNELS)]
    assert air[1::2] == pytest.approx(frame["air"].to_numpy()[1:97])
    assert air[0::2] == pytest.approx(0.5 * (frame["air"].to_numpy()[:96] + frame["air"].to_numpy()[1:97]))
    assert probe[1::2] == pytest.approx(frame["probe"].to_numpy()[1:97])


def test_wind_turns_the_short_way() -> None:
    frame = sky()
    frame["direction"] = np.where(np.arange(len(frame)) % 2, 350.0, 20.0)
    forcing = climate(frame).forcing(REUNION, "2010-09-20", "2010-09-21", 1800.0, "backward-euler")
    direction = column(forcing, "wind_direction")[:, 0]
    assert direction[0] == pytest.approx(5.0)
    assert np.all((direction <= 20.0) | (direction >= 350.0))


def test_sun_and_day_are_those_of_the_stage() -> None:
    forcing = climate(sky()).forcing(REUNION, "2010-09-22", "2010-09-23", 900.0)
    nodes = np.array(STAGES["sdirk2"][0])
    start = pd.Timestamp("2010-09-22", tz="Indian/Reunion").timestamp()
    times = start + 900.0 * (np.arange(96)[:, None] + nodes)
    expected = SunPath.over(REUNION.latitude, REUNION.longitude, start, start + 86400.0).vector(times)
    assert np.max(np.abs(forcing[..., UP - 2 : UP + 1] - expected)) < 1e-9
    assert column(forcing, "day_of_year") == pytest.approx(264.0 + (times - start) / 86400.0, abs=1e-9)


def test_a_window_does_not_depend_on_where_it_is_cut() -> None:
    weather = climate(sky())
    whole = weather.forcing(REUNION, "2010-09-20", "2010-09-25", 900.0, channels=["plane"])
    part = weather.forcing(REUNION, "2010-09-21 05:45", "2010-09-23", 900.0, channels=["plane"])
    first = (24 * 4) + 23
    difference = np.abs(whole[first : first + len(part)] - part)
    assert np.nanmax(difference[..., :10]) < 1e-8
    assert np.nanmax(difference[..., 10:]) < 1e-8


def test_beam_needs_the_sun_above_the_horizon() -> None:
    forcing = climate(sky()).forcing(REUNION, "2010-09-20", "2010-09-25", 900.0)
    beam, up = forcing[..., BEAM], forcing[..., UP]
    below = (up <= 0.0) & (up.max(axis=1, keepdims=True) > 0.0)
    assert below.any()
    assert np.all(beam[below] == 0.0)
    assert np.all(forcing[..., SKY] >= 0.0)
    assert beam.max() < 1361.0


def test_instantaneous_irradiance_is_integrated_between_its_stamps() -> None:
    frame = sky(240, "15min")
    weather = Climate.from_table(
        frame,
        timezone="Indian/Reunion",
        columns={"air_temperature": "air", "global_horizontal": "total", "diffuse_horizontal": "diffuse"},
        instant=["global_horizontal", "diffuse_horizontal"],
        absent=["dew_point", "wind_speed", "wind_direction"],
    )
    forcing = weather.forcing(REUNION, "2010-09-20", "2010-09-22", 900.0)
    total = frame["total"].to_numpy()
    assert step_means(forcing, "sdirk2", ALL) == pytest.approx(0.5 * (total[1:193] + total[:192]), abs=1e-10)


def test_gap_is_named_with_channel_file_line_and_remedy(tmp_path: Path) -> None:
    frame = sky()
    frame.loc[frame.index[50:53], "air"] = np.nan
    path = tmp_path / "station.csv"
    frame.to_csv(path, index_label="time")
    weather = Climate.from_table(
        path,
        timezone="Indian/Reunion",
        columns={"air_temperature": "air", "dew_point": "dew", "global_horizontal": "total"},
        absent=["wind_speed", "wind_direction"],
    )
    with pytest.raises(InputError) as caught:
        weather.forcing(REUNION, "2010-09-20", "2010-09-24", 900.0)
    text = str(caught.value)
    assert text.startswith("station.csv:52: air_temperature has no value (NaN) at 2010-09-22 02:00")
    assert "fill_gaps" in text
    # Up to the last good stamp, and from the next one, the record can be used.
    weather.forcing(REUNION, "2010-09-20", "2010-09-22 01:00", 900.0)
    weather.forcing(REUNION, "2010-09-22 05:00", "2010-09-24", 900.0)
    with pytest.raises(InputError, match="NaN"):
        weather.forcing(REUNION, "2010-09-20", "2010-09-22 01:15", 900.0)


@pytest.mark.parametrize(
    ("start", "end", "step", "words"),
    [
        (
            "2010-09-19",
            "2010-09-21",
            900.0,
            "outside the data, which cover 2010-09-20 00:00 .. 2010-09-25 00:00",
        ),
        ("2010-09-20", "2010-09-26", 900.0, "outside the data"),
        ("2010-09-20", "2010-09-20 00:20", 900.0, "not a whole number of steps"),
        ("2010-09-21", "2010-09-20", 900.0, "not a whole number of steps"),
        ("2010-09-20", "2010-09-21", 0.0, "positive length"),
        ("yesterday night", "2010-09-21", 900.0, "is not a date"),
    ],
)
def test_bad_periods_are_refused(start: str, end: str, step: float, words: str) -> None:
    with pytest.raises(InputError, match=words):
        climate(sky()).forcing(REUNION, start, end, step)


def test_unknown_names_are_refused() -> None:
    with pytest.raises(InputError, match="Did you mean 'sdirk2'"):
        climate(sky()).forcing(REUNION, "2010-09-20", "2010-09-21", 900.0, "sdirk")
    with pytest.raises(InputError, match=r"no measured column 'prob'.*Did you mean 'probe'"):
        climate(sky()).forcing(REUNION, "2010-09-20", "2010-09-21", 900.0, channels=["prob"])


def test_measurements_of_another_step_drive_boundaries() -> None:
    index = pd.date_range("2010-09-20", periods=1441, freq="5min", tz="Indian/Reunion")
    ramp = pd.DataFrame({"slab": np.arange(1441.0)}, index=index)
    measured = Measurements.from_table(ramp, timezone="Indian/Reunion")
    forcing = climate(sky()).forcing(
        REUNION, "2010-09-20", "2010-09-25", 900.0, "backward-euler", ["slab"], measured
    )
    assert forcing[:, 0, len(CHANNELS)] == pytest.approx(3.0 * np.arange(1.0, 481.0))


def test_a_year_keeps_the_sums_of_its_file(data_dir: Path) -> None:
    denver = Climate.from_epw(data_dir / "bestest" / "725650TYCST.epw")
    assert denver.site is not None
    forcing = denver.forcing(denver.site, "2001-01-01", "2002-01-01", 900.0)
    assert forcing.shape == (35040, 2, len(CHANNELS))
    assert not np.isnan(forcing).any()
    # BESTEST.md, annual sums of the file: direct 1977.6, diffuse 556.5 kWh/m2.
    assert step_means(forcing, "sdirk2", BEAM).sum() * 0.25e-3 == pytest.approx(1977.6, abs=0.05)
    assert step_means(forcing, "sdirk2", SKY).sum() * 0.25e-3 == pytest.approx(556.5, abs=0.05)
    assert step_means(forcing, "sdirk2", ALL).sum() * 0.25e-3 == pytest.approx(1670.2, rel=0.005)


def test_measured_boundaries_have_the_limits_of_what_they_are_used_for() -> None:
    weather = climate(sky())
    index = pd.date_range("2010-09-20", periods=121, freq="1h", tz="Indian/Reunion")
    kelvin = pd.DataFrame({"slab": 295.15}, index=index)
    measured = Measurements.from_table(kelvin, timezone="Indian/Reunion")
    arguments: tuple[str, str, float, str] = ("2010-09-20", "2010-09-21", 900.0, "sdirk2")
    limits = {"slab": TEMPERATURES, "plane": IRRADIANCES}
    words = r"table:1: slab is 295.15 at 2010-09-20 00:00.*expected -90 .. 150; convert the column to degC"
    with pytest.raises(InputError, match=words):
        weather.forcing(REUNION, *arguments, ["plane", "slab"], measured, limits)
    # The same numbers are an irradiance that may well be.
    kept = weather.forcing(REUNION, *arguments, ["slab"], measured, {"slab": IRRADIANCES})
    assert kept[..., len(CHANNELS)] == pytest.approx(295.15)

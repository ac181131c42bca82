"""The position of the sun as columns of a table, in place of that of place and time."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from mascarin.building.reading import parse
from mascarin.errors import InputError
from mascarin.tables.times import epoch_seconds
from mascarin.weather import CHANNELS, Climate, Place, write_epw
from mascarin.weather.derived.sun import SunPath
from test_building_sun_and_films import BOX

SITE = Place(39.83, -104.65, 1829.0)
EAST = CHANNELS.index("sun_east")
COLUMNS = {
    "air_temperature": "T", "direct_normal": "B", "diffuse_horizontal": "D", "wind_speed": "v",
    "wind_direction": "d", "sun_elevation": "h", "sun_azimuth": "a",
}  # fmt: skip


def table(count: int = 72, every: str = "1h", **columns: Any) -> pd.DataFrame:
    index = pd.date_range("2001-06-20", periods=count, freq=every)
    zeros = np.zeros(count)
    made = {"T": zeros + 20.0, "B": zeros, "D": zeros, "v": zeros + 1.0, "d": zeros, "h": zeros, "a": zeros}
    return pd.DataFrame(made | columns, index=index)


def read(frame: pd.DataFrame, **options: Any) -> Climate:
    return Climate.from_table(
        frame, timezone="UTC-7", columns={**COLUMNS, **options.pop("columns", {})}, absent=["dew_point"],
        **options,
    )  # fmt: skip


def positions(frame: pd.DataFrame, late: float = 0.0) -> dict[str, Any]:
    """Those of the sun at the stamps, or some seconds after them. [deg]"""
    seconds = epoch_seconds(pd.DatetimeIndex(frame.index).tz_localize("Etc/GMT+7")) + late
    sun = SunPath.over(SITE.latitude, SITE.longitude, seconds[0], seconds[-1]).vector(seconds)
    elevation = np.degrees(np.arcsin(sun[:, 2]))
    return {"h": elevation, "a": np.degrees(np.arctan2(sun[:, 0], sun[:, 1])) % 360.0}


def vectors(climate: Climate, step: float = 300.0) -> np.ndarray:
    made = climate.forcing(SITE, "2001-06-20 06:00", "2001-06-22 06:00", step)
    return np.asarray(made[..., EAST : EAST + 3])


@pytest.mark.parametrize("kind", ["instant", "mean"])
def test_positions_of_every_hour_give_the_sun(kind: str) -> None:
    """An hour apart, at the stamps or in the middle of hours: within 0.01 deg of the sun in between."""
    frame = table()
    stated = read(
        frame.assign(**positions(frame, 1800.0 if kind == "mean" else 0.0)),
        **{kind: ["sun_elevation", "sun_azimuth"]},
    )
    bare = Climate.from_table(
        frame, timezone="UTC-7", columns={k: v for k, v in COLUMNS.items() if not k.startswith("sun")},
        absent=["dew_point"],
    )  # fmt: skip
    cosine = np.sum(vectors(stated) * vectors(bare), axis=-1)
    assert np.degrees(np.arccos(np.minimum(cosine, 1.0))).max() < 0.01
    assert np.linalg.norm(vectors(stated), axis=-1) == pytest.approx(1.0, abs=1e-12)


def test_a_sun_that_stands_still_shines_on_planes_by_its_angle() -> None:
    """30 deg above the south, beam 800 W/m2: 400 on the roof, 692.8 W/m2 on the south wall, day and night."""
    climate = read(table(B=np.full(72, 800.0), h=np.full(72, 30.0), a=np.full(72, 180.0)))
    names = ["roof.incident_beam", "south.incident_beam", "sun_altitude", "sun_azimuth"]
    run = mc.simulate(
        parse(BOX, "box.yaml"), climate, start="2001-06-20", end="2001-06-22", initial=20.0, outputs=names
    )
    roof, south, altitude, azimuth = (run[name].to_numpy()[1:] for name in names)
    assert roof == pytest.approx(800.0 * 0.5, rel=1e-5)
    assert south == pytest.approx(800.0 * np.cos(np.radians(30.0)), rel=1e-5)
    assert altitude == pytest.approx(30.0, abs=1e-9)
    assert azimuth == pytest.approx(180.0, abs=1e-9)
    assert any("up to" in note and "deg away" in note for note in run.warnings)


def test_closure_takes_the_stated_elevation() -> None:
    """Global 500 and diffuse 100 W/m2 below a sun of 30 deg: a beam of 800 W/m2."""
    frame = table(G=np.full(72, 500.0), D=np.full(72, 100.0), h=np.full(72, 30.0), a=np.full(72, 180.0))
    names = {name: column for name, column in COLUMNS.items() if name != "direct_normal"}
    climate = Climate.from_table(
        frame, timezone="UTC-7", columns={**names, "global_horizontal": "G"}, absent=["dew_point"]
    )
    assert climate.completed(SITE).data["direct_normal"].to_numpy() == pytest.approx(800.0, rel=1e-9)


def test_azimuths_pass_north() -> None:
    """From 350 to 10 deg within an hour: north in between, not south."""
    azimuth = np.full(72, 350.0)
    azimuth[12:] = 10.0
    climate = read(table(h=np.full(72, 10.0), a=azimuth))
    made = climate.forcing(SITE, "2001-06-20 11:00", "2001-06-20 12:00", 1800.0)
    middle = made[0, -1, EAST : EAST + 3]
    assert middle[0] == pytest.approx(0.0, abs=1e-9)
    assert middle[1] > 0.9


def test_one_angle_alone_is_refused() -> None:
    names = {name: column for name, column in COLUMNS.items() if name != "sun_azimuth"}
    with pytest.raises(InputError, match="found sun_elevation alone, expected sun_elevation and sun_azimuth"):
        Climate.from_table(table(), timezone="UTC-7", columns=names, absent=["dew_point"])


def test_kinds_that_differ_are_refused() -> None:
    with pytest.raises(InputError, match="both be means or both be instants"):
        read(table(), mean=["sun_azimuth"])


def test_a_zenith_angle_is_refused() -> None:
    frame = table()
    angles = positions(frame)
    beam = np.where(angles["h"] > 5.0, 700.0, 0.0)
    right = read(frame.assign(B=beam, **angles))
    assert right.completed(SITE).data["global_horizontal"].max() > 500.0
    wrong = read(frame.assign(B=beam, a=angles["a"], h=90.0 - angles["h"] - 90.0))
    with pytest.raises(InputError, match=r"below the horizon; expected less than 0\.5 %"):
        wrong.completed(SITE)


def test_an_impossible_elevation_is_refused_where_it_stands() -> None:
    elevation = np.full(72, 30.0)
    elevation[30] = 130.0
    climate = read(table(h=elevation))
    with pytest.raises(InputError, match=r"sun_elevation.*130"):
        climate.forcing(SITE, "2001-06-20", "2001-06-22", 900.0)


def test_a_clock_of_the_irradiance_is_refused() -> None:
    climate = read(table(B=np.full(72, 800.0), h=np.full(72, 30.0), a=np.full(72, 180.0)))
    building = parse(BOX + "weather: {columns: {radiation: {gain: 1.0, clock: 0}}}\n", "box.yaml")
    options: dict[str, Any] = {
        "start": "2001-06-20", "end": "2001-06-21", "initial": 20.0, "outputs": ["roof.incident_beam"],
    }  # fmt: skip
    brighter = mc.simulate(building, climate, parameters={"weather.columns.radiation.gain": 1.1}, **options)
    assert brighter["roof.incident_beam"].to_numpy()[1:] == pytest.approx(440.0, rel=1e-5)
    with pytest.raises(InputError, match="states the position of the sun"):
        mc.simulate(building, climate, parameters={"weather.columns.radiation.clock": 60.0}, **options)


def test_an_epw_file_has_no_position(tmp_path: Path) -> None:
    frame = table(8760).set_axis(pd.date_range("2001-01-01", periods=8760, freq="1h"))
    climate = Climate.from_table(
        frame, timezone="UTC-7", columns=COLUMNS, absent=["dew_point"], latitude=SITE.latitude,
        longitude=SITE.longitude,
    )  # fmt: skip
    with pytest.raises(InputError, match="which an EPW file cannot have"):
        write_epw(climate, tmp_path / "a.epw")


def test_a_run_says_its_warnings_about_the_sun_without_the_word() -> None:
    """The terminal writes `warning:` before each of them."""
    climate = read(table(B=np.full(72, 800.0), h=np.full(72, 30.0), a=np.full(72, 180.0)))
    run = mc.simulate(parse(BOX, "box.yaml"), climate, start="2001-06-20", end="2001-06-21", initial=20.0)
    (said,) = (text for text in run.warnings if "deg away" in text)
    assert said.startswith("table: the position of the sun")
    assert any(": warning: the position" in note for note in climate.completed(SITE).provenance)

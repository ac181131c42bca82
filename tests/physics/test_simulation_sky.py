"""Which long-wave emission of the sky a run uses, and how it compares with published values."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mascarin as mc
from mascarin.simulation.preparation.sky import with_sky_of

BUILDING = """\
site: {latitude: 39.83, longitude: -104.65, altitude: 1650, timezone: UTC-7%s}
materials: {board: {conductivity: 0.2, density: 800, specific_heat: 1000}}
constructions: {wall: {layers: [{material: board, thickness: 0.05}]}}
zones: {room: {volume: 30}}
surfaces:
  roof: {construction: wall, area: 12, tilt: 0, outside: {outdoors: true, convection: 15, emissivity: 0.9,
         absorptance: 0.6}, inside: {zone: room, convection: 3, emissivity: 0.9}}
"""
YEAR: dict[str, Any] = {"step": "1h", "outputs": ["sky_temperature"], "first_period": "1h"}


def building(tmp_path: Path, sky: str = "") -> mc.Building:
    (tmp_path / "b.yaml").write_text(BUILDING % sky, encoding="utf-8")
    return mc.load(tmp_path / "b.yaml")


@pytest.fixture(scope="module")
def denver(data_dir: Path) -> mc.Climate:
    return mc.Climate.from_epw(data_dir / "bestest" / "725650TYCST.epw")


def mean_sky(building: mc.Building, climate: mc.Climate) -> float:
    return float(mc.simulate(building, climate, **YEAR)["sky_temperature"].mean())


def test_infrared_of_the_weather_is_used_where_no_sky_is_given(tmp_path: Path, denver: mc.Climate) -> None:
    """Mean of the temperatures (IR/sigma)^(1/4) of the file's column, worked out here from the column."""
    infrared = denver.data["infrared"].to_numpy()
    expected = np.mean((infrared / 5.670374419e-8) ** 0.25) - 273.15
    assert expected == pytest.approx(-2.03, abs=0.01)
    assert mean_sky(building(tmp_path), denver) == pytest.approx(expected, abs=0.05)


def test_the_mean_sky_of_denver_is_within_the_reference_programs(tmp_path: Path, denver: mc.Climate) -> None:
    """Programs of Standard 140 find -5.9 to -2.0 degC as the mean of the year in Denver."""
    found = mean_sky(building(tmp_path, ", sky: martin_berdahl"), denver)
    assert -5.9 < found < -2.0


def test_overcast_sky_of_martin_and_berdahl(tmp_path: Path, denver: mc.Climate) -> None:
    """Ten tenths of cloud: 1 - (1 - clear) (1 - e^(-1200/8200)); the factor of other authors gave 0.82."""
    table = denver.data
    dew = table["dew_point"].to_numpy()
    clear = 0.711 + 0.56 * dew / 100 + 0.73 * (dew / 100) ** 2
    overcast = 1.0 - (1.0 - clear) * (1.0 - np.exp(-1200.0 / 8200.0))
    assert overcast.mean() == pytest.approx(0.96, abs=0.005)
    cover = table["cloud_cover"].to_numpy()
    air = table["air_temperature"].to_numpy() + 273.15
    emissivity = clear + (overcast - clear) * cover / 10.0
    expected = np.mean(air * emissivity**0.25) - 273.15
    found = mean_sky(building(tmp_path, ", sky: martin_berdahl"), denver)
    assert found == pytest.approx(expected, abs=0.05)


@pytest.mark.parametrize("sky", [", sky: brunt", ", cloud: factor", ", sky: {kind: offset, depression: 8}"])
def test_what_the_building_gives_is_kept(tmp_path: Path, denver: mc.Climate, sky: str) -> None:
    given = building(tmp_path, sky)
    assert with_sky_of(given, denver) is given


def test_parameters_of_the_model_keep_the_model(tmp_path: Path, denver: mc.Climate) -> None:
    plain = building(tmp_path)
    assert with_sky_of(plain, denver, ["site.sky.a"]).site.sky.kind == "martin_berdahl"
    options: dict[str, Any] = {"start": "2001-07-01", "end": "2001-07-02", "outputs": ["sky_temperature"]}
    swept = mc.sweep(plain, denver, {"site.sky.a": [0.6, 0.7]}, **options)["sky_temperature"].mean("time")
    assert swept[1] - swept[0] > 5.0
    run = mc.simulate(plain, denver, parameters={"site.sky.a": 0.6}, **options)
    assert float(run["sky_temperature"].mean()) == pytest.approx(float(swept[0]), abs=1e-9)


def test_a_diurnal_part_is_the_sine_of_the_altitude_of_the_sun(tmp_path: Path, denver: mc.Climate) -> None:
    """Emission with it less that without, beside the altitude of the sun by pvlib."""
    import pvlib

    options: dict[str, Any] = {
        "start": "2001-06-20", "end": "2001-06-23", "step": "30min", "outputs": ["sky_temperature"],
    }  # fmt: skip
    plain, more = (
        mc.simulate(building(tmp_path, f", sky: martin_berdahl{key}"), denver, **options)
        for key in ("", ", sky_diurnal: 30")
    )
    emission = [5.670374419e-8 * (run["sky_temperature"] + 273.15) ** 4 for run in (plain, more)]
    times = plain.index
    altitude = pvlib.solarposition.get_solarposition(times, 39.83, -104.65)["elevation"]
    expected = 30.0 * np.sin(np.radians(altitude))
    difference = np.asarray(emission[1] - emission[0])
    assert expected.min() < -10.0
    assert expected.max() > 28.0
    assert np.abs(difference - expected.to_numpy())[1:].max() < 0.1


def test_an_isotropic_sky_cools_walls_more(tmp_path: Path, denver: mc.Climate) -> None:
    """A wall receives 1/2 of the radiation of an isotropic sky, and 0.354 of one that is warmer below."""
    text = (
        (BUILDING % "")
        .replace("tilt: 0,", "tilt: 90, azimuth: 0,")
        .replace("absorptance: 0.6", "absorptance: 0")
    )
    means = []
    for key in (", sky_exponent: 1.5", ", sky_exponent: 1.0", ""):
        site = f"timezone: UTC-7, sky: {{kind: offset, depression: 20}}{key}"
        (tmp_path / "b.yaml").write_text(text.replace("timezone: UTC-7", site), encoding="utf-8")
        options: dict[str, Any] = {**YEAR, "outputs": ["roof.outside_temperature"], "end": "2001-03-01"}
        run = mc.simulate(mc.load(tmp_path / "b.yaml"), denver, start="2001-01-01", **options)
        means.append(float(run["roof.outside_temperature"].mean()))
    assert means[0] == pytest.approx(means[2], abs=1e-9)
    # 0.9 s 4 T^3 20 K (0.5 - 0.354), over film and radiation, 15 + 0.9 4 s T^3; the room takes a little.
    slope = 4.0 * 5.670374419e-8 * 262.0**3
    assert means[0] - means[1] == pytest.approx(0.9 * slope * 20.0 * 0.1464 / (15.0 + 0.9 * slope), rel=0.15)

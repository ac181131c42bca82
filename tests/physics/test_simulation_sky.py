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

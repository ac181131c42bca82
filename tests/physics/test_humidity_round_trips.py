"""One definition of relative humidity, over water also below 0 degC, on every way through the program.

Measured relative humidity to an EPW file and back, to a TMY3 file and back, to the air of a room, to a unit
for co-simulation, and to indices of comfort. The reference is Hyland & Wexler over water (ASHRAE Fundamentals
2017, ch. 1, eq. 6), written in `test_humidity`.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from fmu_support import simulated
from mascarin.fmu import export
from mascarin.weather import CHANNELS, write_epw
from test_humidity import room, saturation
from test_weather_readers import tmy3

HOURS = 8760
#: An ice pressure in place of one over water would lower the vapour by 1 % for each kelvin below 0 degC.
_PLACE: Any = {"latitude": 39.83, "longitude": -104.65, "altitude": 0.0}


@pytest.fixture(scope="module")
def damp() -> pd.DataFrame:
    """A year of hours from -30 to 36 degC, at 4 to 100 % relative humidity."""
    hours = np.arange(HOURS)
    return pd.DataFrame(
        {
            "air": 3.0 + 33.0 * np.sin(2 * np.pi * hours / 977.0),
            "rh": 52.0 + 48.0 * np.sin(2 * np.pi * hours / 61.0),
        },
        index=pd.date_range("2001-01-01", periods=HOURS, freq="1h", tz="UTC"),
    )


def _climate(table: pd.DataFrame) -> mc.Climate:
    absent = ["wind_speed", "wind_direction", "radiation"]
    columns = {"air_temperature": "air", "relative_humidity": "rh", "pressure": "pressure"}
    table = table.assign(pressure=101_325.0)
    return mc.Climate.from_table(table, timezone="UTC", columns=columns, absent=absent, **_PLACE)


def _vapour(climate: mc.Climate, first: str = "2001-01-02", last: str = "2001-12-30") -> np.ndarray:
    """Vapour pressure at the end of each hour by the dew point that the engine gets. [Pa]"""
    forcing = climate.forcing(room().site, first, last, 3600.0, "backward-euler")
    return np.array([saturation(celsius) for celsius in forcing[:, -1, CHANNELS.index("dew_point")]])


def _expected(table: pd.DataFrame) -> np.ndarray:
    """That of the table at the same times. [Pa]"""
    part = table["2001-01-02 01:00":"2001-12-30 00:00"]
    saturated = np.array([saturation(celsius) for celsius in part["air"]])
    return np.asarray(saturated * part["rh"].to_numpy() / 100.0, dtype=np.float64)


def test_a_dew_point_holds_the_measured_vapour(damp: pd.DataFrame) -> None:
    np.testing.assert_allclose(_vapour(_climate(damp)), _expected(damp), rtol=1e-9)


def test_an_epw_file_gives_the_measured_vapour_back(damp: pd.DataFrame, tmp_path: Path) -> None:
    file = tmp_path / "damp.epw"
    write_epw(_climate(damp), file)
    fields = [line.split(",") for line in file.read_text(encoding="utf-8").splitlines()[8:]]
    # Rounded to a whole percent; a row has the values at the end of its hour.
    written = np.array([float(field[8]) for field in fields])
    assert np.abs(written[:-1] - damp["rh"].to_numpy()[1:]).max() <= 0.5 + 1e-6
    again = mc.Climate.from_epw(file)
    # Half of the last digit of the dew point, 0.005 K, is 0.08 % of the vapour at -50 degC.
    np.testing.assert_allclose(_vapour(again), _expected(damp), rtol=8e-4)
    # The same year as TMY3, from the fields of the file.
    table = tmp_path / "damp.csv"
    lines = tmy3(file.read_text(encoding="utf-8").splitlines())
    lines[0] = '000001,"DAMP",XX,0.0,39.830,-104.650,0'
    table.write_text("\n".join(lines) + "\n", encoding="utf-8")
    np.testing.assert_array_equal(_vapour(mc.Climate.from_tmy(table)), _vapour(again))


@pytest.mark.parametrize(("air", "rh"), [(-18.0, 70.0), (-3.0, 40.0), (21.0, 55.0)])
def test_a_room_full_of_outdoor_air_has_its_humidity(air: float, rh: float, tmp_path: Path) -> None:
    """Run, unit for co-simulation and comfort; the room is as warm as the air, with the same vapour."""
    times = pd.date_range("2001-01-01", periods=73, freq="1h", tz="UTC")
    table = pd.DataFrame({"air": air, "rh": rh}, index=times)
    weather = _climate(table)
    names = ["room.relative_humidity", "room.air_temperature", "room.mean_radiant_temperature"]
    simulation = mc.Simulation(room(infiltration=20.0), weather, step="1h", initial=air, outputs=names)
    run = simulation.run()
    assert run["room.air_temperature"].to_numpy() == pytest.approx(air, abs=1e-9)
    assert run["room.relative_humidity"].to_numpy()[-1] == pytest.approx(rh / 100.0, rel=1e-9)
    forcing = simulation.compiled.forcing[-1, -1]
    vapour = saturation(forcing[CHANNELS.index("dew_point")])
    assert vapour == pytest.approx(saturation(air) * rh / 100.0, rel=1e-9)
    unit = tmp_path / "room.fmu"
    export(simulation, unit)
    np.testing.assert_array_equal(simulated(unit, simulation), run.records)
    for humidity in ("simulated", "outdoor"):
        rated = run.comfort("room", weather, index="givoni", humidity=humidity).to_dataframe()
        assert rated["relative_humidity"].to_numpy()[-1] == pytest.approx(rh, rel=1e-6)

"""Relative humidity goes in and comes out by one formula, over water, in Python and in the engine."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from mascarin import _engine
from mascarin.physics import (
    dew_point,
    humidity_of_dew_point,
    humidity_ratio,
    relative_humidity,
    saturation_pressure,
    vapour_pressure,
)

ROOT = Path(__file__).resolve().parents[2]


def test_saturation_over_water_and_over_ice() -> None:
    """Sonntag 1990 (WMO-No. 8) at -20 and 20 degC, Pa: 125.6 over water, 103.3 over ice, 2339."""
    assert saturation_pressure([-20.0, 20.0]) == pytest.approx([125.59, 2339.2], rel=1e-3)
    assert _engine.condensing_pressure(np.array([-20.0, 20.0])) == pytest.approx([103.26, 2338.8], rel=1e-3)


def test_wet_bulb_and_shapes() -> None:
    """25 degC, 50 %, 1013.25 hPa: 17.889 degC by psychrolib; shapes are broadcast."""
    ratio = humidity_ratio([[25.0]], [50.0, 50.0])
    assert ratio.shape == (1, 2)
    wet = _engine.wet_bulb(np.array([25.0]), ratio[0, :1], np.array([101_325.0]))
    assert wet == pytest.approx([17.889], abs=1e-3)
    assert saturation_pressure(20.0).shape == ()
    assert np.isnan(dew_point([20.0, np.nan], 50.0)).tolist() == [False, True]
    with pytest.raises(_engine.EngineInputError, match="one length"):
        _engine.humidity_ratio(np.ones(2), np.ones(3))


def test_functions_are_inverse_to_each_other() -> None:
    temperature = np.linspace(-60.0, 60.0, 121)[:, None]
    humidity = np.array([0.1, 1.0, 20.0, 66.6, 100.0])
    dew = dew_point(temperature, humidity)
    assert humidity_of_dew_point(temperature, dew) == pytest.approx(
        np.broadcast_to(humidity, dew.shape), rel=1e-10
    )
    ratio = humidity_ratio(temperature, humidity, 90_000.0)
    assert relative_humidity(temperature, ratio, 90_000.0) == pytest.approx(
        np.broadcast_to(humidity, dew.shape), rel=1e-12
    )
    assert vapour_pressure(ratio, 90_000.0) == pytest.approx(saturation_pressure(dew), rel=1e-10)


def room() -> mc.Building:
    """A room that holds the vapour of the outdoor air at its temperature."""
    sky = {"kind": "offset", "depression": 0.0}
    outside = {"outdoors": True, "convection": 15, "longwave": "none", "emissivity": 0.9, "absorptance": 0.5}
    plain: dict[str, Any] = {
        "name": "room",
        "site": {"latitude": 48, "longitude": 2, "altitude": 0, "timezone": "UTC", "sky": sky},
        "materials": {"sheet": {"conductivity": 50.0, "density": 100, "specific_heat": 100}},
        "constructions": {"sheet": {"layers": [{"material": "sheet", "thickness": 0.001}]}},
        "zones": {"room": {"volume": 10, "infiltration": 60, "longwave": "none"}},
        "humidity": {},
        "surfaces": {
            "wall": {
                "construction": "sheet", "area": 10, "tilt": 90, "azimuth": 0, "outside": outside,
                "inside": {"zone": "room", "convection": 3, "emissivity": 0.9},
            }
        },
    }  # fmt: skip
    return mc.Building.from_dict(plain)


def stated(name: str) -> dict[str, str]:
    """A column of a channel with its unit."""
    unit = "%" if name == "relative_humidity" else "Pa" if name == "pressure" else "degC"
    return {"column": name, "unit": unit}


def table(column: str, values: Any, air: Any) -> mc.Climate:
    index = pd.date_range("2024-01-01", periods=len(air), freq="1h", tz="UTC")
    frame = pd.DataFrame({"air_temperature": air, column: values, "pressure": 95_000.0}, index=index)
    names = [str(name) for name in frame]
    return mc.Climate.from_table(
        frame, timezone="UTC", columns={name: stated(name) for name in names}, instant=names,
        absent=["radiation", "wind_speed", "wind_direction"],
    )  # fmt: skip


@pytest.mark.parametrize("air", [-60.0, -40.0, -20.0, -15.0, -5.0, -0.5, 0.0, 0.005, 5.0, 20.0, 35.0, 60.0])
@pytest.mark.parametrize("humidity", [1.0, 45.0, 80.0, 99.0])
def test_measured_humidity_comes_back_from_a_room(air: float, humidity: float) -> None:
    """By relative humidity and by dew point; the room is as warm as the outdoor air and holds its vapour."""
    temperatures = np.full(25, air)
    names = ["room.relative_humidity", "room.dew_point", "room.humidity_ratio"]
    dew = float(dew_point(air, humidity))
    for climate in (
        table("relative_humidity", humidity, temperatures),
        table("dew_point", dew, temperatures),
    ):
        run = mc.simulate(room(), climate, step="1h", outputs=names, initial=air)
        relative, point, ratio = run.records[-1]
        assert relative == pytest.approx(0.01 * humidity, rel=1e-9)
        assert point == pytest.approx(dew, abs=1e-8)
        assert ratio == pytest.approx(float(humidity_ratio(air, humidity, 95_000.0)), rel=1e-9)


def test_frost_forms_where_the_air_is_saturated_over_ice() -> None:
    """Air of -10 degC is saturated over ice at 91 % over water: above it walls as cold have frost."""
    names = ["room.relative_humidity", "wall.inside_condensation", "wall.inside_relative_humidity"]
    for humidity, flag in ((85.0, 0.0), (95.0, 1.0)):
        climate = table("relative_humidity", humidity, np.full(25, -10.0))
        run = mc.simulate(room(), climate, step="1h", outputs=names, initial=-10.0)
        assert run.records[-1].tolist() == pytest.approx([0.01 * humidity, flag, 0.01 * humidity], rel=1e-9)


#: Constants of saturation, of the ratio of molar masses and of the heat of evaporation, as they are written.
CONSTANTS = (
    r"61[01]\.\d+|6\.1[01]\d*|17\.(?:62\d*|27\d*|50\d*)|22\.(?:46|587)\d*|24[03]\.(?:12|04|5|97)\d*|237\.[37]"
    r"|0\.62(?:2|19\d+)|2501(?:\.\d+)?|2500\.[1-9]\d*|5\.?800[._]?22\d*|5\.?674[._]?53\d*|1\.391_?4\d*"
)
ALLOWED = ("crates/engine/src/physics/", "python/mascarin/verification/", "crates/engine/tests/")


def test_formulas_of_moist_air_are_written_once() -> None:
    """No constant of a saturation pressure outside of the physics of the engine and of closed forms."""
    pattern = re.compile(rf"(?<![\w.])(?:{CONSTANTS})(?![\w.])")
    places = []
    for folder, ending in (("crates", "rs"), ("python", "py"), ("bench", "py"), ("docs", "py")):
        for file in sorted((ROOT / folder).rglob(f"*.{ending}")):
            where = file.relative_to(ROOT).as_posix()
            if "/target/" in where or where.startswith(ALLOWED):
                continue
            for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                if pattern.search(line):
                    places.append(f"{where}:{number}: {line.strip()}")
    assert not places
    physics = (ROOT / "crates/engine/src/physics/psychrometrics.rs").read_text(encoding="utf-8")
    assert pattern.search(physics)

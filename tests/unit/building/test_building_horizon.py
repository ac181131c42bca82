"""The horizon of a site: by hand."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin.building import Building
from mascarin.errors import InputError
from mascarin.simulation.preparation.objectives import Mean
from mascarin.simulation.run import simulate
from mascarin.simulation.simulation import Simulation
from mascarin.weather import Climate
from test_simulation_zones import box

OUTPUTS = ["wall.incident_solar", "roof.incident_solar"]


def house(horizon: Sequence[Sequence[float]], **site: Any) -> Building:
    """A wall to the north, where the sun is at noon, and a roof; nothing is reflected from the ground."""
    side = {"outdoors": True, "convection": 20, "emissivity": 0.9, "absorptance": 0.6}
    both = {
        name: {
            "construction": "wall", "area": 10, "tilt": tilt, "azimuth": 0,
            "outside": side, "inside": {"zone": "room", "convection": 4},
        }
        for name, tilt in (("wall", 90), ("roof", 0))
    }  # fmt: skip
    building = box({"room": {"infiltration": 0}}, surfaces=both)
    changes = {"ground_reflectance": 0, "diffuse": "isotropic", "horizon": horizon} | site
    return building.replace({f"site.{key}": value for key, value in changes.items()})


def climate(direct: float, diffuse: float) -> Climate:
    """Two days with the sun's path of the site and constant radiation."""
    index = pd.date_range("2001-03-20", periods=49, freq="1h", tz="UTC")
    level = np.ones(len(index))
    channels = {"air_temperature": 0 * level, "dew_point": -5 * level, "cloud_cover": 10 * level}
    channels |= {"wind_speed": level, "wind_direction": 0 * level}
    channels |= {"direct_normal": direct * level, "diffuse_horizontal": diffuse * level}
    return Climate.from_table(
        pd.DataFrame(channels | {"yard": 0 * level}, index=index),
        timezone="UTC",
        columns={name: name for name in channels},
        extra=["yard"],
        instant=[*channels, "yard"],
    )


def noon(building: Building, weather: Climate) -> np.ndarray[Any, np.dtype[np.float64]]:
    results = simulate(building, weather, step="1h", outputs=OUTPUTS)
    return np.array([float(results[name].sel(time="2001-03-21 12:00Z")) for name in OUTPUTS])


@pytest.mark.parametrize("degrees", [10.0, 35.0])
def test_a_level_horizon_hides_a_part_of_the_sky(degrees: float) -> None:
    """cos^2 h of it for a roof, 1 - (2/pi)(h + sin h cos h) for a wall; the quadrature is good to 0.2 %."""
    h, weather = np.radians(degrees), climate(0.0, 100.0)
    parts = noon(house([[0, degrees]]), weather) / noon(house([]), weather)
    expected = [1 - 2 / np.pi * (h + np.sin(h) * np.cos(h)), np.cos(h) ** 2]
    assert parts == pytest.approx(expected, abs=2e-3)
    assert noon(house([]), weather) == pytest.approx([50, 100], rel=1e-9)


def test_the_sun_behind_the_horizon() -> None:
    """At the equinox the sun rises in the east: a hill of 30 deg there hides it in the morning only."""
    hill = [[0, 0], [15, 0], [20, 30], [95, 30], [100, 0]]
    weather = climate(500.0, 0.0)
    free, hidden = (
        simulate(house(points), weather, step="1h", outputs=OUTPUTS)["roof.incident_solar"]
        for points in ([], hill)
    )
    lost, hour = (free - hidden).to_numpy(), free["time"].dt.hour.to_numpy()
    # The sun is 30 deg high 2 h 20 min after it rose at six: sin h = cos 35 deg sin(15 deg t).
    assert hidden.to_numpy()[(hour > 5) & (hour < 9)] == pytest.approx(0.0, abs=1e-9)
    assert lost[(hour > 6) & (hour < 9)].min() > 20
    assert lost[hour > 10] == pytest.approx(0.0, abs=1e-9)


def test_slopes_by_tilt_agree_with_differences() -> None:
    building = house([[0, 10], [120, 30], [250, 5]])
    simulation = Simulation(building, climate(300.0, 150.0), step="1h", outputs=["wall.incident_solar"])
    slopes = simulation.gradient(Mean("wall.incident_solar")).slopes
    for path, step in (("surfaces.wall.tilt", 1e-3), ("surfaces.wall.azimuth", 1e-3)):
        value = building.parameter(path).value
        high, low = (
            float(simulation.run({path: value + sign * step})["wall.incident_solar"].mean())
            for sign in (1, -1)
        )
        assert slopes[path] == pytest.approx((high - low) / (2 * step), rel=1e-4), path


@pytest.mark.parametrize(
    ("horizon", "words"),
    [
        ([[90, 5], [60, 5]], "azimuth 60 after 90"),
        ([[90, 5], [360, 5]], "write 0 in place of 360"),
        ([[90, 95]], "site.horizon"),
        ([[90]], "site.horizon"),
    ],
)
def test_refusals(horizon: Sequence[Sequence[float]], words: str) -> None:
    with pytest.raises(InputError, match=r"site\.horizon") as error:
        house(horizon)
    assert words in str(error.value)

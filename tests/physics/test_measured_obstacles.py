"""Obstacles in front of a measured irradiance: what they take, by closed forms."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin.building import Building
from mascarin.building.checks.overview import check
from mascarin.building.parameters.unused_parameters import without_effect
from mascarin.errors import InputError
from mascarin.simulation.preparation.objectives import Mean
from mascarin.simulation.simulation import Simulation
from mascarin.weather import CHANNELS, Climate

MEASURED = 400.0
REFLECTANCE = 0.3
#: A strip of a south wall, 2 cm high, as good as a point of it.
STRIP = [[-2, 0, 1], [2, 0, 1], [2, 0, 1.02], [-2, 0, 1.02]]
#: 3 m deep, 1.74 m above the strip, without ends.
OVERHANG = [[-300, 0, 2.75], [300, 0, 2.75], [300, -3, 2.75], [-300, -3, 2.75]]
#: Angle of its edge from the zenith.
EDGE = np.arctan2(3.0, 2.75 - 1.01)


def strip(outside: Mapping[str, Any] | None = None, **more: Any) -> Building:
    """The strip under an overhang, with a measured irradiance."""
    side = {"outdoors": True, "convection": 15, "emissivity": 0.9, "absorptance": 0.6, "irradiance": "G"}
    site = {"latitude": 40, "longitude": 0, "altitude": 0, "timezone": "UTC", "diffuse": "isotropic"}
    wall = {
        "construction": "shell", "vertices": STRIP, "inside": {"adiabatic": True},
        "outside": side | dict(outside or {}),
    }  # fmt: skip
    plain = {
        "name": "strip",
        "site": site | {"ground_reflectance": REFLECTANCE} | more.pop("site", {}),
        "materials": {"board": {"conductivity": 0.16, "density": 800, "specific_heat": 1000}},
        "constructions": {"shell": {"layers": [{"material": "board", "thickness": 0.1}]}},
        "surfaces": {"wall": wall},
        "shades": {"overhang": {"vertices": OVERHANG}},
    }
    return Building.from_dict(plain | more)


def weather(beam: float, diffuse: float, day: str = "2001-06-18") -> Climate:
    """A day of constant direct normal and diffuse radiation, and of a measured irradiance."""
    index = pd.date_range(day, periods=25, freq="1h", tz="UTC")
    table = pd.DataFrame(
        {
            "air_temperature": 15.0, "dew_point": 5.0, "wind_speed": 1.0, "wind_direction": 0.0,
            "direct_normal": beam, "diffuse_horizontal": diffuse, "G": MEASURED,
        },
        index=index,
    )  # fmt: skip
    names = [name for name in table.columns if name != "G"]
    return Climate.from_table(
        table, timezone="UTC", columns={name: name for name in names}, extra=["G"], instant=[*names, "G"],
        check_sun=False,
    )  # fmt: skip


def simulation(building: Building, climate: Climate) -> Simulation:
    return Simulation(
        building, climate, step="1h", scheme="backward-euler", initial=15.0,
        outputs=["wall.incident_solar"],
    )  # fmt: skip


def found(building: Building, climate: Climate) -> tuple[dict[str, Any], Any]:
    """What acts, by channel, and irradiance of the strip at each hour."""
    run = simulation(building, climate)
    rows = climate.forcing(building.site, run.start, run.end, 3600.0, "backward-euler", ["G"])[:, -1]
    return dict(zip(CHANNELS, rows.T, strict=False)), run.run()["wall.incident_solar"].to_numpy()[1:]


def test_of_diffuse_radiation_the_overhang_leaves_the_cosine_of_its_edge() -> None:
    """An endless overhang hides the sky from the zenith to its edge: of 1/2 cos(edge)/2 is left."""
    _, left = found(strip(), weather(0.0, 100.0))
    ground = 0.5 * REFLECTANCE
    expected = MEASURED * (0.5 * np.cos(EDGE) + ground) / (0.5 + ground)
    assert left == pytest.approx(np.full(len(left), expected), rel=5e-3)


def test_without_radiation_in_the_climate_it_is_diffuse() -> None:
    """The split is then that of an isotropic sky; nothing of what was measured is lost."""
    _, dark = found(strip(), weather(0.0, 0.0))
    _, diffuse = found(strip(), weather(0.0, 100.0))
    assert dark == pytest.approx(diffuse, rel=1e-9)


def test_the_sun_above_below_and_behind() -> None:
    """Above its edge the beam is hidden, below it is there, behind the wall there is none."""
    seen = np.zeros(3, dtype=int)
    for day in ("2001-02-10", "2001-06-18"):
        row, left = found(strip(), weather(500.0, 100.0, day))
        facing, up = np.maximum(-row["sun_north"], 0.0), np.maximum(row["sun_up"], 0.0)
        beam = row["direct_normal"] * facing * (up > 0.0)
        sky, ground = 0.5 * row["diffuse_horizontal"], 0.5 * REFLECTANCE * row["global_horizontal"]
        # Angle of the sun from the zenith, in the plane across the wall.
        profile = np.arctan2(facing, np.maximum(up, 1e-9))
        lit = profile > EDGE
        expected = MEASURED * (beam * lit + sky * np.cos(EDGE) + ground) / (beam + sky + ground)
        clear = np.abs(profile - EDGE) > 0.02
        assert left[clear] == pytest.approx(expected[clear], rel=6e-3)
        behind = (beam == 0.0) & (up > 0.0)
        seen += [int((lit & (beam > 0.0)).sum()), int((~lit & (beam > 0.0)).sum()), int(behind.sum())]
    assert (seen > 1).all()


def test_behind_obstacles_it_is_used_as_it_is() -> None:
    for climate in (weather(0.0, 100.0), weather(500.0, 100.0)):
        _, left = found(strip({"behind_obstacles": True}), climate)
        assert left == pytest.approx(np.full(len(left), MEASURED))
        assert (found(strip(), climate)[1] < MEASURED).all()


def test_a_horizon_takes_its_part() -> None:
    """A level horizon leaves a wall 1 - 2/pi (h + sin h cos h) of the isotropic sky, and no sun below it."""
    h = np.radians(30.0)
    left = 1.0 - 2.0 / np.pi * (h + np.sin(h) * np.cos(h))
    building = strip(shades={}, site={"horizon": [[0, 30]]})
    _, got = found(building, weather(0.0, 100.0))
    ground = 0.5 * REFLECTANCE
    assert got == pytest.approx(
        np.full(len(got), MEASURED * (0.5 * left + ground) / (0.5 + ground)), rel=5e-3
    )
    row, got = found(building, weather(500.0, 100.0))
    up, direct, total = row["sun_up"], row["direct_normal"], row["global_horizontal"]
    hidden = (up < np.sin(h) - 0.01) & (up > 0.01)
    sky = 0.5 * row["diffuse_horizontal"]
    free_facade = direct * np.maximum(-row["sun_north"], 0.0) + sky + 0.5 * REFLECTANCE * total
    expected = MEASURED * (sky * left + 0.5 * REFLECTANCE * (total - direct * up)) / free_facade
    assert got[hidden] == pytest.approx(expected[hidden], rel=5e-3)


def test_slopes_and_members() -> None:
    """What obstacles leave depends on the reflectance of the ground, with its derivative, in any pack."""
    run = simulation(strip(), weather(500.0, 100.0))
    path = "site.ground_reflectance"
    assert path not in without_effect(run.building)
    assert path in without_effect(strip({"behind_obstacles": True}))
    slope = run.gradient(Mean("wall.incident_solar")).slopes[path]
    high, low = (
        float(run.run({path: REFLECTANCE + step})["wall.incident_solar"].mean()) for step in (1e-5, -1e-5)
    )
    assert slope == pytest.approx((high - low) / 2e-5, rel=1e-5)
    samples = np.tile(run.vector({}), (9, 1))
    samples[:, run.position(path)] = np.linspace(0.1, 0.5, 9)
    records, _, failures = run.ensemble(samples)
    assert failures == []
    for member in range(9):
        assert np.array_equal(run.run_vector(samples[member]).records, records[member])


def test_check_says_what_acts() -> None:
    lines = [line for line in check(strip()) if line.startswith("measured irradiance")]
    assert lines == [
        "measured irradiance: wall, outside, by column G, of the free plane: overhang takes a part of beam "
        "and diffuse radiation, which are split as in the climate"
    ]
    behind = check(strip({"behind_obstacles": True}))
    assert "measured irradiance: wall, outside, by column G, behind its obstacles: used as it is" in behind
    free = check(strip(shades={}))
    assert "measured irradiance: wall, outside, by column G: nothing stands in front of it" in free


def test_the_key_needs_an_irradiance() -> None:
    with pytest.raises(
        InputError, match=r"surfaces.wall.outside.behind_obstacles\s+found: 'behind_obstacles'"
    ):
        strip({"irradiance": None, "behind_obstacles": True})


def test_a_horizon_needs_a_direction() -> None:
    wall = {
        "construction": "shell", "area": 4, "tilt": 90, "inside": {"adiabatic": True},
        "outside": {
            "outdoors": True, "convection": 15, "emissivity": 0.9, "absorptance": 0.6, "irradiance": "G",
        },
    }  # fmt: skip
    with pytest.raises(InputError, match=r"surfaces.wall.azimuth\s+found: nothing, where the horizon"):
        strip(shades={}, surfaces={"wall": wall}, site={"horizon": [[0, 30]]})

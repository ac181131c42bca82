"""Reveals and overhangs of windows by numbers: the sunlit part by hand, the same as shades, refusals."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin.building import Building
from mascarin.building.reading import parse
from mascarin.errors import InputError
from mascarin.simulation.run import simulate
from mascarin.weather import Climate

WIDTH, HEIGHT = 2.0, 1.25
CORNERS: list[list[float]] = [[1, 0, 1], [1 + WIDTH, 0, 1], [1 + WIDTH, 0, 1 + HEIGHT], [1, 0, 1 + HEIGHT]]
STEPS = 48


def house(drawn: bool, window: dict[str, Any] | None = None, **more: Any) -> Building:
    """A room with a window to the south, described by vertices or by its area."""
    shape: dict[str, Any] = {"area": 12.0, "tilt": 90, "azimuth": 180}
    if drawn:
        shape = {"vertices": [[0, 0, 0], [4, 0, 0], [4, 0, 3], [0, 0, 3]]}
    pane: dict[str, Any] = {"area": WIDTH * HEIGHT, "cavity_height": HEIGHT}
    tree = {
        "name": "room",
        "site": {
            "latitude": 40, "longitude": 0, "altitude": 0, "timezone": "UTC", "ground_reflectance": 0.0,
            "diffuse": "isotropic",
        },
        "materials": {"board": {"conductivity": 0.2, "density": 800, "specific_heat": 1000}},
        "constructions": {"wall": {"layers": [{"material": "board", "thickness": 0.1}]}},
        "glazings": {"glass": {"kind": "simple", "u_value": 2.0, "solar_heat_gain": 0.6}},
        "zones": {"room": {"volume": 40, "longwave": "none"}},
        "surfaces": {
            "south": {
                "construction": "wall", **shape,
                "outside": {"outdoors": True, "convection": 15, "emissivity": 0.9, "absorptance": 0.6},
                "inside": {"zone": "room", "convection": 3, "emissivity": 0.9, "absorptance": 0.6},
            }
        },
        "windows": {
            "pane": {
                "surface": "south", "glazing": "glass", **({"vertices": CORNERS} if drawn else pane),
                "outside": {"convection": 15}, "inside": {"convection": 3}, **(window or {}),
            }
        },
        **more,
    }  # fmt: skip
    return parse(json.dumps(tree), "room.yaml")


def beam(diffuse: float = 0.0) -> Climate:
    """A beam of 700 W/m2 all day, half-hourly."""
    index = pd.date_range("2001-03-10", periods=2 * STEPS + 1, freq="30min", tz="UTC")
    level = np.ones(len(index))
    channels = {
        "air_temperature": 15 * level, "dew_point": 5 * level, "wind_speed": 2 * level,
        "direct_normal": (700 if diffuse == 0.0 else 0) * level,
        "diffuse_horizontal": diffuse * level,
        "cloud_cover": 0 * level, "wind_direction": 0 * level,
    }  # fmt: skip
    return Climate.from_table(
        pd.DataFrame(channels, index=index),
        timezone="UTC",
        columns={name: name for name in channels},
        instant=list(channels),
        latitude=40,
        longitude=0,
        check_sun=False,
    )


def incident(building: Building, climate: Climate) -> np.ndarray[Any, np.dtype[np.float64]]:
    results = simulate(
        building,
        climate,
        start="2001-03-10",
        end="2001-03-11",
        step="30min",
        scheme="backward-euler",
        initial=15.0,
        outputs=["pane.incident_solar"],
    )
    assert results.energy.closes
    return np.asarray(results["pane.incident_solar"].values)[-STEPS:]


#: A deep reveal.
REVEAL: dict[str, Any] = {"reveal": 0.3}
#: Window, depth of its reveal, depth of its overhang and its gap. [m]
CASES: list[tuple[dict[str, Any], float, tuple[float, float] | None]] = [
    ({"reveal": 0.16}, 0.16, None),
    ({"overhang": {"depth": 0.8, "gap": 0.2, "extension": 30}}, 0.0, (0.8, 0.2)),
]


@pytest.mark.parametrize("drawn", [True, False])
@pytest.mark.parametrize(("window", "reveal", "overhang"), CASES)
def test_the_sunlit_part_is_that_of_the_shadow_angles(
    drawn: bool, window: dict[str, Any], reveal: float, overhang: tuple[float, float] | None
) -> None:
    """With the angles of the sun off the normal, a reveal d leaves ``(1 - d tan a/W)(1 - d tan p/H)``."""
    climate = beam()
    bare, shaded = (incident(house(drawn, each), climate) for each in (None, window))
    forcing = climate.forcing(house(drawn).site, "2001-03-10", "2001-03-11", 1800.0, "backward-euler")
    east, north, up = (forcing[:, -1, place] for place in (11, 12, 13))
    bright = (bare > 50.0) & (north < -0.2)
    assert bright.sum() > 12
    side, profile = np.abs(east[bright]) / -north[bright], up[bright] / -north[bright]
    sunlit = np.clip(1 - reveal * side / WIDTH, 0, 1) * np.clip(1 - reveal * profile / HEIGHT, 0, 1)
    if overhang is not None:
        depth, gap = overhang
        sunlit = 1 - np.clip(depth * profile - gap, 0, HEIGHT) / HEIGHT
    assert shaded[bright] / bare[bright] == pytest.approx(sunlit, abs=2e-6)
    assert sunlit.min() < 0.9


def test_vertices_and_area_give_the_same() -> None:
    window = {"reveal": 0.2, "overhang": {"depth": 0.5, "gap": 0.1, "extension": 0.3}}
    for climate in (beam(), beam(100.0)):
        drawn, by_area = (incident(house(each, window), climate) for each in (True, False))
        assert drawn == pytest.approx(by_area, abs=1e-6)


def test_the_sky_that_a_reveal_hides() -> None:
    """Diffuse radiation: less by a reveal, by one part at all times; and as by shades with its corners."""
    climate = beam(100.0)
    bare, shaded = (incident(house(True, each), climate) for each in (None, REVEAL))
    ratio = shaded[bare > 1.0] / bare[bare > 1.0]
    assert ratio.max() - ratio.min() < 1e-9
    assert 0.6 < ratio[0] < 0.9
    ends = [*CORNERS[1:], CORNERS[0]]
    shades = {
        f"edge{k}": {"vertices": [a, b, [b[0], -0.3, b[2]], [a[0], -0.3, a[2]]]}
        for k, (a, b) in enumerate(zip(CORNERS, ends, strict=True))
    }
    assert shaded == pytest.approx(incident(house(True, shades=shades), climate), rel=1e-9)


def test_a_reveal_shades_its_window_alone() -> None:
    climate = beam()
    walls = [
        simulate(
            house(True, window), climate, start="2001-03-10", end="2001-03-11", step="30min", initial=15.0,
            outputs=["south.incident_solar"],
        )
        for window in (None, REVEAL)
    ]  # fmt: skip
    first, second = (np.asarray(each["south.incident_solar"].values) for each in walls)
    assert np.array_equal(first, second)


def test_refused_reveals_and_overhangs() -> None:
    with pytest.raises(InputError, match="reveal"):
        house(True, {"reveal": 0})
    with pytest.raises(InputError, match="above 0"):
        house(True, {"overhang": {"depth": 0}})
    flat = house(False).replace({"surfaces.south.tilt": 10})
    with pytest.raises(InputError, match=r"overhang of a window of tilt 10 deg"):
        flat.replace({"windows.pane.overhang": 0.5})
    number = house(False, {"reveal": 0.16}).windows["pane"].reveal
    assert number is not None
    assert number.structural

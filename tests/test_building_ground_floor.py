"""Floors on the ground by ISO 13370: by hand, and over a year."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin.building import Building, check, on_ground
from mascarin.errors import InputError
from mascarin.simulation.run import simulate
from mascarin.weather import Climate
from test_simulation_zones import box

SLAB: dict[str, Any] = {"area": 100, "perimeter": 40, "wall_thickness": 0.3}
OUTDOORS: dict[str, Any] = {"mean": 10, "amplitude": 8, "coldest_day": 20}


def room(thickness: float = 0.1) -> Building:
    """A room held at 20 degC with a floor of foam (0.04 W/(m K)) and the surface resistance of ISO 6946."""
    floor = {
        "construction": "floor", "area": 100, "tilt": 180, "outside": {"ground": {"mean": 10}},
        "inside": {"zone": "room", "convection": 1 / 0.17},
    }  # fmt: skip
    layers = {"floor": {"layers": [{"material": "foam", "thickness": thickness}]}}
    return box(
        {"room": {"infiltration": 0, "held": 20}}, surfaces={"floor": floor}, constructions=layers
    ).replace({"surfaces.wall_room.area": 1e-3})


def test_the_transmittance_by_hand() -> None:
    """B = 5 m, d = 0.3 + 2 (0.17 + 2.5 + 0.04) = 5.72 m > B: U = 2/(0.457 x 5 + 5.72) = 0.2498 W/(m2 K)."""
    floor = on_ground(room(), "floor", **SLAB, **OUTDOORS)
    lines = "\n".join(check(floor))
    assert "U 0.250 W/(m2 K)" in next(line for line in lines.splitlines() if "surface floor" in line)
    # H = 0.37 x 40 x 2 ln(3.1672/5.72 + 1) W/K over A U.
    depth = math.sqrt(3.15e7 * 2 / (math.pi * 2e6))
    swing = 0.37 * 40 * 2 * math.log(depth / 5.72 + 1) / (100 * 2 / (0.457 * 5 + 5.72))
    path = "surfaces.floor.outside.ground"
    assert floor.parameter(f"{path}.amplitude").value == pytest.approx(8 * swing)
    assert floor.parameter(f"{path}.coldest_day").value == pytest.approx(20 + 365 / 12)
    assert Building.from_dict(floor.to_dict()) == floor


def test_the_other_branch_of_the_transmittance() -> None:
    """Without much insulation d < B: U = 2 k/(pi B + d) ln(pi B/d + 1)."""
    building = on_ground(
        room(0.02), "floor", area=400, perimeter=80, wall_thickness=0.3, soil="clay", **OUTDOORS
    )
    size, thickness = 10.0, 0.3 + 1.5 * (0.17 + 0.5 + 0.04)
    u_value = 3.0 / (math.pi * size + thickness) * math.log(math.pi * size / thickness + 1)
    below = building.parameter("materials.floor_below.resistance").value
    assert 1 / (0.17 + 0.5 + 0.5 / 1.5 + below) == pytest.approx(u_value, rel=1e-12)


def test_the_heat_of_a_year() -> None:
    """Mean U A (20 - 10) and the swing of the standard, a month after that of the outdoor air."""
    building = on_ground(room(), "floor", **SLAB, **OUTDOORS)
    index = pd.date_range("2001-01-01", "2003-01-01 06:00", freq="6h", tz="UTC")
    level = np.ones(len(index))
    channels = {"air_temperature": 20 * level, "dew_point": 0 * level, "cloud_cover": 0 * level}
    channels |= {"wind_speed": level, "wind_direction": 0 * level}
    channels |= {"direct_normal": 0 * level, "diffuse_horizontal": 0 * level}
    climate = Climate.from_table(
        pd.DataFrame(channels | {"yard": 20 * level}, index=index),
        timezone="UTC",
        columns={name: name for name in channels},
        extra=["yard"],
        instant=[*channels, "yard"],
    )
    results = simulate(
        building, climate, start="2001-01-01", end="2002-12-31", step="6h", outputs=["room.net_load"]
    )
    load = results["room.net_load"].to_numpy()[-4 * 365 :]
    angle = 2 * np.pi * np.arange(len(load)) / len(load)
    cosine, sine = (2 * (load * wave).mean() for wave in (np.cos(angle), np.sin(angle)))
    u_value = 2 / (0.457 * 5 + 5.72)
    assert load.mean() == pytest.approx(u_value * 100 * 10, rel=2e-3)
    depth = math.sqrt(3.15e7 * 2 / (math.pi * 2e6))
    swing = 0.37 * 40 * 2 * math.log(depth / 5.72 + 1) * 8
    assert math.hypot(cosine, sine) == pytest.approx(swing, rel=0.05)
    latest = math.atan2(sine, cosine) / (2 * np.pi) * 365
    assert latest == pytest.approx(20 + 365 / 12, abs=15)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"surface": "base"}, "no surface 'base', expected one of wall_room, floor"),
        ({"soil": "mud"}, "found soil 'mud', expected one of clay, sand, rock"),
        ({"perimeter": 0}, "found perimeter 0, expected a number above 0"),
        ({"area": 0.2, "perimeter": 40}, "expected a slab with insulation, or a larger one"),
    ],
)
def test_refusals(changes: dict[str, Any], words: str) -> None:
    given = {"surface": "floor", **SLAB, **OUTDOORS} | changes
    building = room(0.0001) if "area" in changes else room()
    with pytest.raises(InputError) as error:
        on_ground(building, given.pop("surface"), **given)
    assert words in str(error.value)

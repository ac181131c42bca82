"""Floors on the ground by ISO 13370: by hand, and over a year."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin.building import Building, EdgeInsulation, Soil, check, on_ground
from mascarin.building.ground_slab import SOILS, Slab
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
        ({"area": -1}, "found area -1, expected a number above 0"),
        ({"perimeter": None}, "found neither perimeter nor aspect, expected one of them"),
        ({"aspect": 2}, "found perimeter and aspect, expected one of them"),
        ({"perimeter": None, "aspect": 0.5}, "aspect: found 0.5 -, expected 1 to 100 -"),
        ({"wall_thickness": -0.1}, "wall_thickness: found -0.1 m, expected 0 to 3 m"),
        ({"inside_resistance": 2}, "inside_resistance: found 2 m2 K/W, expected 0 to 1 m2 K/W"),
        ({"outside_resistance": -1}, "outside_resistance: found -1 m2 K/W, expected 0 to 1 m2 K/W"),
        ({"area": 0.2, "perimeter": 40}, "expected a slab with insulation, or a larger one"),
    ],
)
def test_refusals(changes: dict[str, Any], words: str) -> None:
    given = {"surface": "floor", **SLAB, **OUTDOORS} | changes
    building = room(0.0001) if changes.get("area") == 0.2 else room()
    with pytest.raises(InputError) as error:
        on_ground(building, given.pop("surface"), **given)
    assert words in str(error.value)


@pytest.mark.parametrize(
    ("part", "words"),
    [
        (lambda: Soil(0.0, 2e6, "none"), "soil: conductivity: found 0 W/(m K), expected 0.1 to 6 W/(m K)"),
        (lambda: Soil(2.0, 1.0, "none"), "soil: heat_capacity: found 1 J/(m3 K), expected 100000 to 6e+06"),
        (
            lambda: Soil.of_diffusivity(2.0, 0.0, "none"),
            "found diffusivity 0 m2/s, expected a number above 0",
        ),
        (
            lambda: EdgeInsulation("slanted", 1, 0.1, 0.04),  # type: ignore[arg-type]
            "found position 'slanted', expected horizontal or vertical",
        ),
        (lambda: EdgeInsulation("vertical", 0, 0.1, 0.04), "edge: extent: found 0 m, expected 0.05 to 10 m"),
        (lambda: EdgeInsulation("vertical", 1, 0, 0.04), "edge: thickness: found 0 m"),
        (lambda: EdgeInsulation("vertical", 1, 0.1, 5), "edge: conductivity: found 5 W/(m K)"),
    ],
)
def test_refusals_of_soil_and_edge(part: Callable[[], object], words: str) -> None:
    with pytest.raises(InputError) as error:
        part()
    assert words in str(error.value)


@pytest.mark.parametrize(
    ("inside", "outside", "conductivity", "expected"),
    [
        (100.0, 100.0, 1.9, 2420.96),
        (7.95, None, 1.9, 2093.64),
        (7.95, 100.0, 1.9, 2070.14),
        (7.95, 11.95, 1.9, 1920.19),
        (100.0, 100.0, 0.5, 653.81),
    ],
)
def test_films_and_soil(inside: float, outside: float | None, conductivity: float, expected: float) -> None:
    """A slab of 12 by 12 m below walls of 0.24 m, 20 K: U A dT of the formula by hand [W]."""
    outer = 0.0 if outside is None else 1.0 / outside
    size, thickness = 6.0, 0.24 + conductivity * (1.0 / inside + outer)
    logarithm = math.log(math.pi * size / thickness + 1.0)
    by_hand = 2.0 * conductivity / (math.pi * size + thickness) * logarithm * 144.0 * 20.0
    assert by_hand == pytest.approx(expected, abs=0.01)
    slab = Slab(144.0, 48.0, 0.24, Soil(conductivity, 2.682e6, "case"), 1.0 / inside + outer)
    assert slab.transmittance * 144.0 * 20.0 == pytest.approx(by_hand, rel=1e-12)


def test_edge_insulation_by_hand() -> None:
    """Linear transmittance, mean transmittance and periodic coefficient of ISO 13370, annexes C and D."""
    soil, plain = SOILS["sand"], Slab(100.0, 40.0, 0.3, SOILS["sand"], 0.5 + 0.21)
    thickness = 0.3 + 2.0 * 0.71
    added = (0.1 / 0.04 - 0.1 / 2.0) * 2.0
    depth = math.sqrt(3.15e7 * 2.0 / (math.pi * 2e6))
    for position, reach in (("horizontal", 1.0), ("vertical", 2.0)):
        edge = EdgeInsulation(position, 1.0, 0.1, 0.04)  # type: ignore[arg-type]
        slab = Slab(100.0, 40.0, 0.3, soil, 0.71, edge)
        linear = (
            -2.0 / math.pi * (math.log(reach / thickness + 1.0) - math.log(reach / (thickness + added) + 1.0))
        )
        assert slab.edge_transmittance == pytest.approx(linear, rel=1e-12)
        assert linear < 0.0
        # The heat of the edge over the whole slab: P psi / A.
        assert slab.transmittance == pytest.approx(plain.transmittance + 40.0 * linear / 100.0, rel=1e-12)
        beyond = math.exp(-reach / depth)
        periodic = (1.0 - beyond) * math.log(depth / (thickness + added) + 1.0)
        periodic += beyond * math.log(depth / thickness + 1.0)
        assert slab.periodic == pytest.approx(0.37 * 40.0 * 2.0 * periodic, rel=1e-12)
        assert slab.periodic < plain.periodic


def test_aspect_in_place_of_a_perimeter() -> None:
    """A slab of 36 by 4 m has 80 m of walls; its length over its width is 9."""
    given = {**OUTDOORS, "wall_thickness": 0.3}
    by_aspect = on_ground(room(), "floor", area=144, aspect=9, **given)
    by_perimeter = on_ground(room(), "floor", area=144, perimeter=80, **given)
    path = "materials.floor_below.resistance"
    assert by_aspect.parameter(path).value == pytest.approx(by_perimeter.parameter(path).value, rel=1e-12)


def test_soil_and_edge_are_in_the_building() -> None:
    """Numbers of a soil with its source are parameters by path; the edge lowers loss and swing."""
    soil = Soil.of_diffusivity(1.2, 6e-7, "probe in the garden")
    edge = EdgeInsulation("vertical", 0.8, 0.08, 0.035)
    plain = on_ground(room(0.02), "floor", **SLAB, **OUTDOORS, soil=soil)
    building = on_ground(room(0.02), "floor", **SLAB, **OUTDOORS, soil=soil, edge=edge)
    conductivity = building.parameter("materials.floor_soil.conductivity")
    assert (conductivity.value, conductivity.source) == (1.2, "probe in the garden")
    heat = [building.parameter(f"materials.floor_soil.{key}").value for key in ("density", "specific_heat")]
    assert heat[0] * heat[1] == pytest.approx(1.2 / 6e-7)
    below = "materials.floor_below.resistance"
    assert building.parameter(below).value > plain.parameter(below).value
    slab = Slab(100, 40, 0.3, soil, 0.17 + 0.5 + 0.04, edge)
    amplitude = building.parameter("surfaces.floor.outside.ground.amplitude").value
    assert amplitude == pytest.approx(8 * slab.periodic / (100 * slab.transmittance))
    assert Building.from_dict(building.to_dict()) == building

"""Odd but legal geometry: what `check` accepts, runs; a derived value without meaning is named."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin.building import Building
from mascarin.building.checks.overview import check
from mascarin.errors import InputError
from mascarin.simulation.simulation import Simulation
from mascarin.weather import Climate
from test_building_self_shading import block

GLAZING = {
    "kind": "panes",
    "panes": [{"thickness": 0.004, "emissivity": 0.84, "transmittance": 0.8, "reflectance": 0.08}] * 2,
    "gaps": [{"thickness": 0.016, "gas": "air"}],
}
FILMS = ("iso15099", "tarp", "alamdari_hammond", 3.0)
OUTER = ("doe2", "tarp", "mowitt", 15.0)


def weather(beam: float, diffuse: float) -> Climate:
    """A day in March of constant radiation, with a wind from the south-west."""
    table = pd.DataFrame(
        {
            "air_temperature": 15.0, "dew_point": 5.0, "wind_speed": 1.0, "wind_direction": 225.0,
            "direct_normal": beam, "diffuse_horizontal": diffuse,
        },
        index=pd.date_range("2001-03-18", periods=25, freq="1h", tz="UTC"),
    )  # fmt: skip
    columns = {name: name for name in table.columns}
    return Climate.from_table(table, timezone="UTC", columns=columns, instant=list(columns), check_sun=False)


def described(surfaces: dict[str, Any], windows: dict[str, Any], **more: Any) -> Building:
    return Building.from_dict(
        {
            "name": "odd",
            "site": {"latitude": 40, "longitude": 0, "altitude": 1829, "timezone": "UTC"},
            "materials": {"board": {"conductivity": 0.16, "density": 800, "specific_heat": 1000}},
            "constructions": {"shell": {"layers": [{"material": "board", "thickness": 0.1}]}},
            "glazings": {"double": GLAZING},
            "zones": {"room": {"volume": 48, "infiltration": 0.3}},
            "surfaces": surfaces,
            "windows": windows,
            **more,
        }
    )


def tilted(rng: np.random.Generator, width: float, depth: float) -> np.ndarray[Any, Any]:
    """A frame of a plane that rises towards its back: level, vertical, hanging, or in between."""
    angle = rng.choice([0.0, 1e-7, 0.5, 15.0, 45.0, 60.0, 89.9999, 90.0, 120.0, 179.5, 180.0])
    turn = np.radians(rng.choice([0.0, 90.0, 37.0]))
    along = np.array([np.cos(turn), np.sin(turn), 0.0])
    level = np.array([-np.sin(turn), np.cos(turn), 0.0])
    up = np.cos(np.radians(angle)) * level + np.sin(np.radians(angle)) * np.array([0.0, 0.0, 1.0])
    return np.array([along * width, up * depth])


def placed(frame: np.ndarray[Any, Any], corners: list[list[float]], foot: float) -> list[list[float]]:
    return [[float(x) for x in np.array([0.0, 0.0, foot]) + np.array(at) @ frame] for at in corners]


def odd(seed: int) -> Building:
    """A surface of any direction with a window of any shape in it, and a floor without vertices."""
    rng = np.random.default_rng(seed)
    width, depth = rng.choice([0.02, 0.5, 4.0, 60.0]), rng.choice([0.02, 1.0, 3.0])
    frame, foot = tilted(rng, width, depth), float(rng.choice([-3.0, 0.0, 2.5]))
    shapes: list[list[list[float]]] = [
        [[0.2, 0.2], [0.8, 0.2], [0.8, 0.8], [0.2, 0.8]],
        [[0.2, 0.2], [0.8, 0.2], [0.5, 0.9]],
        [[0.1, 0.49], [0.9, 0.49], [0.9, 0.51], [0.1, 0.51]],
        [[0.2, 0.2], [0.8, 0.2], [0.8, 0.8], [0.5, 0.5], [0.2, 0.8]],
    ]
    shape = shapes[rng.integers(len(shapes))]
    wall = placed(frame, [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], foot)
    inner, outer = FILMS[rng.integers(len(FILMS))], OUTER[rng.integers(len(OUTER))]
    inside = {"zone": "room", "convection": inner, "emissivity": 0.9, "absorptance": 0.5}
    outside = {"outdoors": True, "convection": outer, "emissivity": 0.9, "absorptance": 0.6}
    floor = {
        "construction": "shell", "area": float(rng.choice([0.01, 16.0])), "tilt": 180, "inside": inside,
        "outside": {"adiabatic": True},
    }  # fmt: skip
    window = {
        "surface": "wall", "glazing": "double", "vertices": placed(frame, shape, foot),
        "outside": {"convection": outer}, "inside": {"convection": inner},
    }  # fmt: skip
    surfaces = {"wall": {"construction": "shell", "vertices": wall, "outside": outside, "inside": inside}}
    openings = {
        "opening": {
            "zone": "room", "area": 0.1, "height": float(rng.choice([0.0, 1e-6, 1.2])), "discharge": 0.6,
            "wind_coefficient": float(rng.choice([0.0, 0.25])),
        }
    }  # fmt: skip
    if rng.integers(2):
        return described(surfaces | {"floor": floor}, {"window": window}, openings=openings)
    height = rng.choice([1e-6, 0.3, 3.0])
    vents = {
        "low": {
            "zone": "room", "azimuth": 90.0, "area": 0.1, "height": float(height), "elevation": 0.0,
            "pressure": str(rng.choice(["low_rise", "none"])),
        },
        "high": {"zone": "room", "azimuth": 270.0, "area": 1e-6, "elevation": 60.0, "pressure": "none"},
    }  # fmt: skip
    return described(surfaces | {"floor": floor}, {"window": window}, vents=vents)


def made(seed: int) -> tuple[Building | None, str]:
    """The building, or why it is refused."""
    try:
        return odd(seed), ""
    except InputError as error:
        return None, str(error)


def test_most_are_accepted_and_refusals_name_what_was_written() -> None:
    refusals = [made(seed) for seed in range(40)]
    refused = [said for building, said in refusals if building is None]
    assert len(refused) < 20, refused
    for said in refused:
        assert "surfaces.wall" in said or "windows.window" in said
        assert "samples" not in said
        assert "member" not in said


@pytest.mark.parametrize("seed", range(40))
def test_what_check_accepts_runs(seed: int) -> None:
    building, _ = made(seed)
    if building is None:
        return
    check(building)
    outputs = ["room.air_temperature", "window.incident_solar", "window.transmitted_solar"]
    run = Simulation(
        building,
        weather(600.0, 120.0),
        step="1h",
        start="2001-03-18",
        end="2001-03-18 12:00",
        outputs=outputs,
    ).run()
    assert np.isfinite(run.records).all()


@pytest.mark.parametrize("roof_tilt", ["level", "sloped"])
@pytest.mark.parametrize("sun", ["area", "floor", "geometry"])
def test_a_skylight_of_any_distribution_of_the_sun(sun: str, roof_tilt: str) -> None:
    surfaces = block("room", (0, 0), (4, 4), 3)
    vertices: list[list[float]] = [[1, 1, 3], [2, 1, 3], [2, 2, 3], [1, 2, 3]]
    if roof_tilt == "sloped":
        for wall in surfaces.values():
            wall["vertices"] = [[x, y, 3 + y if z == 3 else z] for x, y, z in wall["vertices"]]
        vertices = [[x, y, 3 + y] for x, y, _ in vertices]
    surfaces = {name.removeprefix("room_"): wall for name, wall in surfaces.items()}
    window = {
        "surface": "roof", "glazing": "double", "vertices": vertices, "outside": {"convection": 15},
        "inside": {"convection": "iso15099"},
    }  # fmt: skip
    zones = {"room": {"infiltration": 0.3, "sun": sun}}
    constructions = {"shell": {"layers": [{"material": "board", "thickness": 0.1}]}}
    building = described(surfaces, {"skylight": window}, zones=zones, constructions=constructions)
    check(building)
    run = Simulation(
        building, weather(600.0, 120.0), step="1h", start="2001-03-18", end="2001-03-19",
        outputs=["skylight.incident_solar", "skylight.transmitted_solar", "room.air_temperature"],
    ).run()  # fmt: skip
    names = ("skylight.incident_solar", "skylight.transmitted_solar", "room.air_temperature")
    incident, transmitted, air = (run[name].to_numpy() for name in names)
    assert np.isfinite(air).all()
    area = float(building.windows["skylight"].area or 0.0)
    assert (transmitted >= 0.0).all()
    assert (transmitted <= 0.75 * area * incident + 1e-9).all()
    assert transmitted.max() > 200.0


def skylight(vertices: list[list[float]], wall: dict[str, Any]) -> Building:
    inside = {"zone": "room", "convection": 3, "emissivity": 0.9, "absorptance": 0.5}
    outside = {"outdoors": True, "convection": 15, "emissivity": 0.9, "absorptance": 0.6}
    surfaces = {"roof": {"construction": "shell", "outside": outside, "inside": inside} | wall}
    window = {
        "surface": "roof", "glazing": "double", "vertices": vertices, "outside": {"convection": 15},
        "inside": {"convection": 3},
    }  # fmt: skip
    return described(surfaces, {"skylight": window})


def test_the_gap_of_a_level_window_has_the_edge_of_a_square() -> None:
    roof = [[0, 0, 3], [4, 0, 3], [4, 4, 3], [0, 4, 3]]
    building = skylight([[1, 1, 3], [3, 1, 3], [3, 3, 3], [1, 3, 3]], {"vertices": roof})
    assert float(building.windows["skylight"].cavity_height or 0.0) == pytest.approx(2.0)


def test_the_gap_of_a_sloped_window_has_its_length_along_the_slope() -> None:
    """3 m across and 4 m high is 5 m along the slope."""
    roof = [[0, 0, 0], [4, 0, 0], [4, 3, 4], [0, 3, 4]]
    inner = [[1, 0.6, 0.8], [3, 0.6, 0.8], [3, 2.4, 3.2], [1, 2.4, 3.2]]
    building = skylight(inner, {"vertices": roof})
    assert float(building.windows["skylight"].cavity_height or 0.0) == pytest.approx(3.0)


def test_a_derived_value_without_meaning_names_what_was_written() -> None:
    """A level outline with a tilt of 90 deg has no height: the length of the correlation would be zero."""
    level = {"vertices": [[0, 0, 3], [4, 0, 3], [4, 4, 3], [0, 4, 3]], "tilt": 90, "azimuth": 0}
    inside = {"zone": "room", "convection": "iso15099", "emissivity": 0.9}
    outside = {"outdoors": True, "convection": 15, "emissivity": 0.9, "absorptance": 0.6}
    wall = {"construction": "shell", "outside": outside, "inside": inside} | level
    with pytest.raises(InputError) as caught:
        described({"roof": wall}, {})
    said = str(caught.value)
    assert "surfaces.roof.inside.convection" in said
    assert "found: 0 m (height of the vertices)" in said
    assert "samples" not in said
    assert "member" not in said

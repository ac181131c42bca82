"""Air of a zone that is warmer above than below, as convection at its surfaces sees it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from mascarin.building import Building
from mascarin.errors import InputError
from mascarin.simulation.preparation.objectives import Mean
from mascarin.simulation.simulation import Simulation
from simulation_samples import hours
from test_flow_density import OUTDOOR, climate

AREA, HEIGHT, GRADIENT = 12.0, 2.5, 2.0
FILM = {"floor": 1.5, "ceiling": 3.0, "wall": 2.5}
#: From the inner surface to outdoors [W/(m2 K)].
OUTWARD = 1.0 / (0.1 / 0.04 + 1.0 / 20.0)


def room(gradient: Any = GRADIENT, *, law: Any = None, vertices: bool = True, **zone: Any) -> Building:
    """A room of 4 x 3 x 2.5 m of light boards to air of a measured temperature, without radiation."""
    corners: dict[str, Any] = {
        "floor": [(0, 0, 0), (0, 3, 0), (4, 3, 0), (4, 0, 0)],
        "ceiling": [(0, 0, 2.5), (4, 0, 2.5), (4, 3, 2.5), (0, 3, 2.5)],
        "wall": [(0, 0, 0), (4, 0, 0), (4, 0, 2.5), (0, 0, 2.5)],
    }
    plain: dict[str, dict[str, Any]] = {
        "floor": {"area": AREA, "tilt": 180, "azimuth": 0},
        "ceiling": {"area": AREA, "tilt": 0, "azimuth": 0},
        "wall": {"area": 10, "tilt": 90, "azimuth": 180},
    }
    surfaces = {
        name: {
            "construction": "board",
            **({"vertices": corners[name]} if vertices else plain[name]),
            "outside": {"measured": "yard", "convection": 20},
            "inside": {"zone": "room", "convection": FILM[name] if law is None else law},
        }
        for name in corners
    }
    stratified = {} if gradient is None else {"air_gradient": gradient}
    return Building.from_dict(
        {
            "site": {"latitude": -35, "longitude": 0, "altitude": 55, "timezone": "UTC"},
            "materials": {"foam": {"conductivity": 0.04, "density": 20, "specific_heat": 1000}},
            "constructions": {"board": {"layers": [{"material": "foam", "thickness": 0.1}]}},
            "zones": {"room": {"volume": 30, "infiltration": 0, "longwave": "none", **stratified, **zone}},
            "surfaces": surfaces,
        }
    )


def simulation(building: Building, **columns: Any) -> Simulation:
    outputs = [output.name for output in building.outputs()]
    return Simulation(building, climate(2, **columns), step="15min", outputs=outputs)


@pytest.mark.parametrize("vertices", [True, False])
def test_the_steady_load_by_hand(vertices: bool) -> None:
    """Each surface loses ``A U (T + G z - T_out)``: ceiling and floor are 1.25 m from the middle."""
    results = simulation(room(vertices=vertices, held=20.0)).run()
    levels = {"floor": -HEIGHT / 2, "ceiling": HEIGHT / 2, "wall": 0.0}
    areas = {"floor": AREA, "ceiling": AREA, "wall": 10.0}
    expected = 0.0
    for name, level in levels.items():
        u = 1.0 / (1.0 / OUTWARD + 1.0 / FILM[name])
        air = 20.0 + GRADIENT * level
        expected += areas[name] * u * (air - OUTDOOR)
        inside = air - u / FILM[name] * (air - OUTDOOR)
        assert float(results[f"{name}.inside_temperature"][-1]) == pytest.approx(inside, abs=1e-6)
        assert float(results[f"{name}.inside_convection"][-1]) == pytest.approx(FILM[name], rel=1e-9)
    assert float(results["room.heating_load"][-1]) == pytest.approx(expected, rel=1e-9)
    assert float(results["room.floor_air_temperature"][-1]) == pytest.approx(17.5, abs=1e-9)
    assert float(results["room.ceiling_air_temperature"][-1]) == pytest.approx(22.5, abs=1e-9)
    assert results.energy.closure < 1e-9


def test_natural_convection_sees_the_air_in_front_of_the_surface() -> None:
    """The coefficient of a law by difference is that of the surface against its own air."""
    results = simulation(room(law="tarp", held=20.0)).run()
    for name, shift in (("floor", -2.5), ("ceiling", 2.5), ("wall", 0.0)):
        surface = float(results[f"{name}.inside_temperature"][-1])
        coefficient = float(results[f"{name}.inside_convection"][-1])
        flux = coefficient * (20.0 + shift - surface)
        assert flux == pytest.approx(OUTWARD * (surface - OUTDOOR), rel=1e-6), name
    assert results.energy.closure < 1e-9


def test_no_gradient_is_the_room_without_one() -> None:
    """A gradient of zero changes results by less than the tolerance of the iteration."""
    wave = 5 + 8 * np.sin(hours(2) / 9000.0)
    for law in (None, "tarp"):
        stated, plain = (simulation(room(gradient, law=law), yard=wave).run() for gradient in (0.0, None))
        for name in ("room.air_temperature", "ceiling.inside_temperature"):
            np.testing.assert_allclose(np.asarray(stated[name]), np.asarray(plain[name]), rtol=0, atol=1e-7)


@pytest.mark.parametrize("law", [None, "tarp", "beausoleil_morrison"])
def test_slopes_and_members(law: Any) -> None:
    """Forward and reverse slopes by the gradient agree with differences; members equal runs bit for bit."""
    building = room(law=law, gains={"heater": {"power": 300, "radiative": 0.3}}, mixing_air_change=10)
    wave = 5 + 8 * np.sin(hours(2) / 9000.0)
    output, path = "room.air_temperature", "zones.room.air_gradient.gradient"
    run = Simulation(building, climate(2, yard=wave), step="15min", outputs=[output])
    step = 1e-4
    ends = [run.run({path: GRADIENT + sign * step})[output] for sign in (1, -1)]
    difference = float(ends[0].mean() - ends[1].mean()) / (2 * step)
    assert abs(difference) > 1e-3
    assert run.gradient(Mean(output)).slopes[path] == pytest.approx(difference, rel=1e-4)
    assert float(run.jacobian([path])[f"d {output}"].mean()) == pytest.approx(difference, rel=1e-4)
    points = pd.DataFrame({path: [GRADIENT + step, GRADIENT - step]})
    members = mc.sweep(building, run.climate, points, step="15min", outputs=[output])
    for row, end in enumerate(ends):
        np.testing.assert_array_equal(np.asarray(members[output][row]), np.asarray(end))


def test_a_column_gives_the_gradient() -> None:
    """Two thermometers give it: the records follow the column in each step."""
    course = 1.5 + np.sin(hours(2) / 9000.0)
    results = simulation(room({"column": "dT"}), dT=course).run()
    apart = np.asarray(results["room.ceiling_air_temperature"]) - np.asarray(
        results["room.floor_air_temperature"]
    )
    assert apart.min() < 0.6 * HEIGHT < 2.4 * HEIGHT < apart.max()


def test_a_zone_without_height_is_refused() -> None:
    building = room(vertices=False).replace({"surfaces.floor.tilt": 90})
    with pytest.raises(InputError, match=r"air_gradient.*no floor"):
        building.to_engine()
    with pytest.raises(InputError, match="gradient"):
        room({"column": "dT", "unit": "degC"})
    with pytest.raises(InputError, match="stratified"):
        mc.state_space(room())

"""Heat between two layers of a surface, beside closed forms."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

import mascarin as mc
from mascarin.building import Building
from mascarin.building.reading import parse
from mascarin.errors import InputError
from mascarin.simulation.preparation.objectives import Mean
from mascarin.simulation.preparation.options import Scheme
from mascarin.simulation.run import simulate
from mascarin.simulation.simulation import Simulation
from mascarin.simulation.steady import steady
from test_boundary_freedom import weather

AREA, OUTER, INNER = 4.0, 8.0, 5.0
#: Thickness [m], conductivity [W/(m K)], heat capacity [J/(m3 K)].
BOARD, SCREED = (0.08, 0.04, 30.0 * 1400.0), (0.05, 1.2, 2000.0 * 1000.0)
FLOW, WATER, CONDUCTANCE = 0.02, 4180.0, 15.0

#: Without those that lose latent heat.
SCHEMES: tuple[Scheme, ...] = ("sdirk2", "linearly-implicit", "backward-euler")


def layered(layers: list[Any], source: Mapping[str, Any], **more: Any) -> Building:
    """A wall of 4 m2 between air of two columns, with a heat source after its first layer."""
    tree = {
        "name": "wall",
        "site": {"latitude": 40, "longitude": 0, "altitude": 0, "timezone": "UTC"},
        "materials": {
            "board": {"conductivity": BOARD[1], "density": 30, "specific_heat": 1400},
            "screed": {"conductivity": SCREED[1], "density": 2000, "specific_heat": 1000},
            "wax": {
                "kind": "pcm", "conductivity": [0.22, 0.18], "density": 855, "latent_heat": 71000,
                "specific_heat": {"solid": 3134, "liquid": 2833}, "melting_temperature": 26,
                "law": {"kind": "tanh", "width": 2},
            },
        },
        "constructions": {"wall": {"layers": layers}},
        "surfaces": {
            "wall": {
                "construction": "wall", "area": AREA, "tilt": 90, "azimuth": 0,
                "outside": {"measured": "T_o", "convection": OUTER},
                "inside": {"measured": "T_i", "convection": INNER},
            }
        },
        "heat_sources": {"mat": {"surface": "wall", "after": "board", **source}},
        **more,
    }  # fmt: skip
    return parse(json.dumps(tree), "wall.yaml")


TWO_LAYERS = [{"material": "board", "thickness": BOARD[0]}, {"material": "screed", "thickness": SCREED[0]}]
PIPES = {"flow": FLOW, "supply": 35.0, "conductance": CONDUCTANCE}
NAMES = ["mat.heat", "mat.plane_temperature", "wall.outside_temperature", "wall.inside_temperature"]


def plane_conductances() -> tuple[float, float]:
    """From the plane to the air outside and inside. [W/(m2 K)]"""
    return 1 / (1 / OUTER + BOARD[0] / BOARD[1]), 1 / (1 / INNER + SCREED[0] / SCREED[1])


def test_electric_heat_divides_by_the_resistances() -> None:
    """``T_p = (q + K_o T_o + K_i T_i)/(K_o + K_i)``."""
    out, into = plane_conductances()
    state = steady(layered(TWO_LAYERS, {"electric": 60.0}), weather(1, T_o=-5.0, T_i=20.0), outputs=NAMES)
    plane = (60.0 + out * -5.0 + into * 20.0) / (out + into)
    assert state.values["mat.plane_temperature"] == pytest.approx(plane, abs=1e-9)
    inner, outer = 20.0 + into * (plane - 20.0) / INNER, -5.0 + out * (plane + 5.0) / OUTER
    assert state.values["wall.inside_temperature"] == pytest.approx(inner, abs=1e-9)
    assert state.values["wall.outside_temperature"] == pytest.approx(outer, abs=1e-9)
    assert state.values["mat.heat"] == pytest.approx(60.0 * AREA, abs=1e-9)
    assert state.flows["sources"] == pytest.approx(60.0 * AREA, abs=1e-9)
    assert state.flows["boundary"] == pytest.approx(-60.0 * AREA, abs=1e-7)


@pytest.mark.parametrize("supply", [35.0, 14.0])
@pytest.mark.parametrize("exchange", [{"conductance": CONDUCTANCE}, {"effectiveness": 0.6}])
def test_water_in_balance(supply: float, exchange: dict[str, float]) -> None:
    """``q = m c_p eps (T_s - T_p)``, heating and cooling; water leaves at ``T_s - q A/(m c_p)``."""
    out, into = plane_conductances()
    rate = FLOW * WATER / AREA
    eps = exchange.get("effectiveness", 1 - math.exp(-CONDUCTANCE / rate))
    pipes = {"flow": FLOW, "supply": supply, **exchange}
    names = [*NAMES, "mat.return_temperature"]
    state = steady(layered(TWO_LAYERS, {"water": pipes}), weather(1, T_o=18.0, T_i=22.0), outputs=names)
    water = rate * eps
    plane = (water * supply + out * 18.0 + into * 22.0) / (water + out + into)
    assert state.values["mat.plane_temperature"] == pytest.approx(plane, abs=1e-9)
    heat = AREA * water * (supply - plane)
    assert state.values["mat.heat"] == pytest.approx(heat, abs=1e-8)
    assert state.flows["sources"] == pytest.approx(heat, abs=1e-8)
    assert state.values["mat.return_temperature"] == pytest.approx(supply - heat / (FLOW * WATER), abs=1e-9)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_heat_goes_into_both_halves_of_a_thick_wall(scheme: Scheme) -> None:
    """A plane in a thick wall rises by ``q sqrt(t/(pi k rho c))``: half of the heat to either side."""
    layers = [
        {"name": name, "material": "screed", "thickness": 1.0, "nodes": 400} for name in ("board", "screed")
    ]
    names = ["mat.plane_temperature"]
    building = layered(layers, {"electric": 100.0})
    results = simulate(
        building, weather(0.5, T_o=20.0, T_i=20.0), step="1min", outputs=names, initial=20.0, scheme=scheme
    )
    rise = results[names[0]].to_numpy()[1:] - 20.0
    t = 60.0 * np.arange(1, len(rise) + 1)
    exact = 100.0 * np.sqrt(t / (np.pi * SCREED[1] * SCREED[2]))
    assert rise[120:] == pytest.approx(exact[120:], rel=2e-3)
    assert results.energy.into["sources"] == pytest.approx(100.0 * AREA * t[-1], rel=1e-12)
    # Heat stored is the difference of the contents of 800 cells.
    assert results.energy.closure < 1e-11
    assert not results.warnings


def swing(days: float = 2) -> Any:
    t = np.arange(int(24 * days) + 1)
    day = np.sin(2 * np.pi * t / 24)
    return weather(
        days, T_o=5.0 + 5.0 * day[: len(t)], T_i=21.0 + day[: len(t)], T_s=32.0 + 4 * day[: len(t)]
    )


def melting(**source: Any) -> Building:
    """Board, wax, pipes, wax, screed: wax below and above the plane."""
    layers = [
        {"name": "under", "material": "board", "thickness": 0.05},
        {"name": "board", "material": "wax", "thickness": 0.01},
        {"name": "over", "material": "wax", "thickness": 0.015},
        {"material": "screed", "thickness": 0.03},
    ]
    return layered(layers, source or {"water": {**PIPES, "supply": {"column": "T_s"}}})


@pytest.mark.parametrize("scheme", SCHEMES)
def test_latent_heat_around_the_plane_balances(scheme: Scheme) -> None:
    names = [*NAMES, "wall.board_liquid_fraction", "wall.over_liquid_fraction"]
    results = simulate(melting(), swing(), step="15min", outputs=names, initial=21.0, scheme=scheme)
    fractions = results[names[-1]].to_numpy()
    assert fractions.max() > 0.9
    assert fractions.min() < 0.1
    assert results.energy.closure < 1e-12
    assert results.energy.into["sources"] > 0.0


def test_pipes_cool_and_the_step_converges() -> None:
    """With a quarter of the step the temperature of the plane stays, to the second order."""
    planes = []
    for minutes in (30, 15, 7.5):
        run = simulate(melting(), swing(), step=60 * minutes, outputs=NAMES, initial=21.0)
        planes.append(run["mat.plane_temperature"].to_numpy()[:: round(30 / minutes)][-20:])
    coarse, fine = np.abs(planes[0] - planes[1]).max(), np.abs(planes[1] - planes[2]).max()
    assert fine < coarse / 2
    assert fine < 0.1


VARIED: dict[str, tuple[dict[str, Any], list[str]]] = {
    "electric": ({"electric": 40.0}, ["heat_sources.mat.electric.power"]),
    "water": (
        {"water": PIPES},
        [
            "heat_sources.mat.water.flow.flow", "heat_sources.mat.water.supply.temperature",
            "heat_sources.mat.water.conductance", "heat_sources.mat.water.specific_heat",
            "surfaces.wall.area", "constructions.wall.layers.over.thickness",
        ],
    ),
    "effectiveness": (
        {"water": {"flow": FLOW, "supply": 35.0, "effectiveness": 0.6}},
        ["heat_sources.mat.water.effectiveness", "heat_sources.mat.water.flow.flow"],
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", VARIED)
def test_slopes_agree_with_differences(case: str) -> None:
    source, paths = VARIED[case]
    names = ["mat.heat", "wall.inside_temperature"]
    simulation = Simulation(melting(**source), swing(), step="15min", outputs=names, initial=21.0)
    jacobian = simulation.jacobian(paths)
    reverse = {name: simulation.gradient(Mean(name)).slopes for name in names}
    for k, path in enumerate(paths):
        value = float(simulation.building.parameter(path).value)
        h = 1e-4 * abs(value)
        ends = [simulation.run({path: value + sign * h}).records for sign in (1, -1)]
        difference = (ends[0] - ends[1]) / (2 * h)
        for i, name in enumerate(names):
            size = np.abs(difference[:, i]).max()
            assert jacobian[f"d {name}"].to_numpy()[k] == pytest.approx(difference[:, i], abs=1e-5 * size), (
                path
            )
            mean = float(jacobian[f"d {name}"].to_numpy()[k].mean())
            assert reverse[name][path] == pytest.approx(mean, rel=1e-9)


def room(source: Mapping[str, Any], **more: Any) -> Building:
    """A room between a heated floor and walls, without radiation."""
    inside = {"zone": "room", "convection": INNER, "emissivity": 0.9}
    plain = layered(TWO_LAYERS, {"electric": 1.0}).to_dict()
    wall = plain["surfaces"]["wall"]
    plain["heat_sources"] = {"mat": {"surface": "wall", "after": "board", **source}}
    plain["zones"] = {"room": {"volume": 12, "longwave": "none"}}
    plain["surfaces"] = {
        "wall": wall | {"inside": inside},
        "shell": wall | {"area": 20, "inside": inside, "outside": {"measured": "T_o", "convection": OUTER}},
    }
    return parse(json.dumps(plain | more), "room.yaml")


AIR = "room.air_temperature"


@pytest.mark.parametrize("mode", ["heating", "cooling"])
def test_a_thermostat_throttles(mode: str) -> None:
    """The heat is ``P (1/2 + (T_set - T)/range)`` within the range, and what the room loses."""
    sign = 1.0 if mode == "heating" else -1.0
    pipes = {"flow": 0.05, "supply": 20.0 + 15.0 * sign, "effectiveness": 0.9}
    thermostat = {"zone": "room", "setpoint": 20.0, "range": 4.0, "mode": mode}
    building = room({"water": pipes, "thermostat": thermostat})
    names = [AIR, "mat.heat", "mat.plane_temperature"]
    outdoors = 20.0 - 6.0 * sign
    run = simulate(building, weather(30, T_o=outdoors, T_i=20.0), step="15min", outputs=names, initial=20.0)
    air, heat, plane = (float(run[name].to_numpy()[-1]) for name in names)
    asked = 0.5 + sign * (20.0 - air) / 4.0
    assert 0.05 < asked < 0.95
    rate = 0.05 * WATER * 0.9 * asked
    assert heat == pytest.approx(rate * (pipes["supply"] - plane), rel=1e-6)
    loss = 20.0 / (1 / INNER + SCREED[0] / SCREED[1] + BOARD[0] / BOARD[1] + 1 / OUTER)
    out, into = plane_conductances()
    gain = AREA * into * (plane - air)
    assert gain == pytest.approx(loss * (air - outdoors), rel=1e-4)
    assert heat == pytest.approx(gain + AREA * out * (plane - outdoors), rel=1e-4)
    assert run.energy.closure < 1e-12


def test_slopes_go_through_the_thermostat() -> None:
    thermostat = {"zone": "room", "setpoint": 20.0, "range": 6.0, "mode": "heating"}
    building = room({"electric": 90.0, "thermostat": thermostat})
    simulation = Simulation(
        building, weather(3, T_o=12.0, T_i=20.0), step="15min", outputs=[AIR], initial=19.5
    )
    slopes = simulation.gradient(Mean(AIR)).slopes
    for path in ("thermostat.setpoint.temperature", "thermostat.range", "electric.power"):
        name = f"heat_sources.mat.{path}"
        value = float(building.parameter(name).value)
        h = 1e-4 * value
        high, low = (float(simulation.run({name: value + s * h})[AIR].mean()) for s in (1, -1))
        assert slopes[name] == pytest.approx((high - low) / (2 * h), rel=1e-5), path


def test_a_control_turns_on_and_off() -> None:
    controls = {"cold": {"zone": "room", "indoor_below": {"open": 19.0, "close": 21.0}}}
    building = room({"electric": 120.0, "control": "cold"}, controls=controls)
    run = simulate(
        building,
        weather(3, T_o=10.0, T_i=20.0),
        step="5min",
        outputs=[AIR, "mat.heat", "cold.open"],
        initial=20.0,
    )
    heat, is_on = run["mat.heat"].to_numpy()[1:], run["cold.open"].to_numpy()[1:]
    assert set(np.unique(is_on)) == {0.0, 1.0}
    assert heat == pytest.approx(120.0 * AREA * is_on, abs=1e-12)
    assert run.energy.closure < 1e-12


def test_schedules_and_columns_drive_it() -> None:
    half = {"half": {"kind": "fraction", "value": 0.5}, "warm": {"kind": "temperature", "value": 33}}
    climate = weather(1, T_o=5.0, T_i=20.0, q=0.06, m=72.0)
    heats = []
    for source in (
        {"electric": {"power": 120.0, "schedule": "half"}},
        {"electric": {"column": "q", "unit": "kW/m2"}},
    ):
        schedules = half if "power" in source["electric"] else {}
        run = simulate(
            layered(TWO_LAYERS, source, schedules=schedules), climate, step="1h", outputs=["mat.heat"]
        )
        heats.append(run["mat.heat"].to_numpy()[-1])
    assert heats == pytest.approx([60.0 * AREA] * 2, rel=1e-12)
    plain = steady(layered(TWO_LAYERS, {"water": PIPES | {"supply": 33}}), climate, outputs=NAMES).values
    driven = {**PIPES, "flow": {"column": "m", "unit": "kg/h"}, "supply": {"schedule": "warm"}}
    same = steady(layered(TWO_LAYERS, {"water": driven}, schedules=half | {}), climate, outputs=NAMES).values
    assert same == pytest.approx(plain, rel=1e-12)


def test_members_have_the_bits_of_a_run_alone() -> None:
    path = "heat_sources.mat.water.conductance"
    values = [2.0, 5.0, 9.0, 14.0, 30.0, 80.0, 200.0, 500.0, 900.0]
    given: Any = {"outputs": NAMES, "initial": 21.0, "step": "15min"}
    together = mc.sweep(melting(), swing(), {path: values}, **given)
    for k, value in enumerate(values):
        alone = simulate(melting().replace({path: value}), swing(), **given)
        for name in NAMES:
            assert np.array_equal(together[name].to_numpy()[k], alone[name].to_numpy()), (value, name)


def test_apparent_capacity_conserves_in_its_own_way() -> None:
    """The scheme of the comparison counts other latent heat, but all heat of the pipes."""
    run = simulate(melting(electric=30.0), swing(), outputs=NAMES, initial=21.0, scheme="apparent-capacity")
    assert run.energy.into["sources"] == pytest.approx(30.0 * AREA * 49 * 3600.0, rel=1e-12)


def test_a_start_from_given_temperatures_has_the_plane() -> None:
    """The profile between two faces in their steady state stays as it is."""
    wall, climate = layered(TWO_LAYERS, {"electric": 0.0}), weather(1, T_o=5.0, T_i=20.0)
    values = steady(wall, climate, outputs=NAMES).values
    faces = [values["wall.outside_temperature"], values["wall.inside_temperature"]]
    run = simulate(wall, climate, outputs=NAMES, initial={"surfaces": {"wall": faces}})
    planes = run["mat.plane_temperature"].to_numpy()
    assert planes == pytest.approx(np.full(len(planes), values["mat.plane_temperature"]), abs=1e-9)


@pytest.mark.parametrize(
    ("source", "message"),
    [
        (
            {"electric": 60.0, "after": "screed"},
            r"mat\.after(?s:.)*another one behind it: board",
        ),
        ({}, "neither 'electric' nor 'water'"),
        ({"electric": 60.0, "water": PIPES}, "both 'electric' and 'water'"),
        ({"water": {"flow": 0.1, "supply": 30}}, "neither 'conductance' nor 'effectiveness'"),
        ({"water": PIPES | {"effectiveness": 0.5}}, "both 'conductance' and 'effectiveness'"),
        ({"electric": -5.0}, r"heat_sources\.mat\.electric"),
        ({"electric": 5.0, "thermostat": {"zone": "hall", "setpoint": 20, "mode": "heating"}}, "'hall'"),
        ({"electric": 5.0, "surface": "roof"}, "'roof'"),
        ({"electric": 5.0, "layer": "board"}, "after: LAYER"),
    ],
)
def test_bad_sources_are_named(source: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        layered(TWO_LAYERS, source)


def test_a_linear_model_refuses_it() -> None:
    plain = layered(TWO_LAYERS, {"electric": 60.0}).to_dict()
    del plain["materials"]["wax"]
    with pytest.raises(InputError, match="heat source mat"):
        mc.state_space(Building.from_dict(plain))

"""Gains, ventilation, air paths, openings and ideal loads: balances that can be checked by hand."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pandas as pd
import pytest
from numpy.typing import NDArray

from mascarin.building import Building
from mascarin.building.parts.site_air import density
from mascarin.building.reading import parse
from mascarin.errors import InputError
from mascarin.physics import AIR_SPECIFIC_HEAT
from mascarin.simulation.results import Results
from mascarin.simulation.run import simulate
from mascarin.simulation.simulation import Simulation
from mascarin.weather import Climate
from simulation_samples import hours

#: Thickness over conductivity, and both films: what a square metre of wall lets through [W/(m2 K)].
U = 1.0 / (0.1 / 0.04 + 1.0 / 20.0 + 1.0 / 4.0)


def box(zones: dict[str, Any], **more: Any) -> Building:
    """Rooms with 30 m2 of light wall each to air of a measured temperature, without radiation."""
    walls = {
        f"wall_{name}": {
            "construction": "wall",
            "area": 30,
            "tilt": 90,
            "azimuth": 0,
            "outside": {"measured": "yard", "convection": 20},
            "inside": {"zone": name, "convection": 4},
        }
        for name in zones
    }
    plain = {
        "site": {"latitude": -35, "longitude": 0, "altitude": 55, "timezone": "UTC"},
        "materials": {"foam": {"conductivity": 0.04, "density": 20, "specific_heat": 1000}}
        | more.pop("materials", {}),
        "constructions": {"wall": {"layers": [{"material": "foam", "thickness": 0.1}]}}
        | more.pop("constructions", {}),
        "zones": {name: {"volume": 50, "longwave": "none"} | zone for name, zone in zones.items()},
        "surfaces": walls | more.pop("surfaces", {}),
        **more,
    }
    return parse(json.dumps(plain), "box.yaml")


def dark(outdoor: NDArray[np.float64], wind: float = 3.0, **columns: NDArray[np.float64]) -> Climate:
    """Hourly outdoor air, the same in the measured column, without a sun."""
    level = np.ones(len(outdoor))
    frame = pd.DataFrame(
        {
            "air_temperature": outdoor,
            "yard": outdoor,
            "dew_point": outdoor - 5,
            "cloud_cover": 0 * level,
            "wind_speed": wind * level,
            "wind_direction": 0 * level,
            "direct_normal": 0 * level,
            "diffuse_horizontal": 0 * level,
            **columns,
        },
        index=pd.date_range("2001-01-01", periods=len(outdoor), freq="1h", tz="UTC"),
    )
    extra = ["yard", *columns]
    channels = [str(name) for name in frame.columns if name not in extra]
    return Climate.from_table(
        frame,
        timezone="UTC",
        columns={name: name for name in channels},
        extra=extra,
        instant=[*channels, *extra],
    )


def run(
    building: Building, outdoor: float = 0.0, days: float = 2, step: str = "15min", **options: Any
) -> Results:
    """A run in outdoor air of one temperature; every output recorded."""
    climate = dark(np.full(len(hours(days)), outdoor))
    outputs = [output.name for output in building.outputs()]
    return simulate(building, climate, step=step, outputs=outputs, **options)


def last(results: Results, name: str) -> float:
    return float(results[name][-1])


def test_the_steady_heating_load_equals_the_losses() -> None:
    """UA dT and the heat of the outdoor air that enters, minus the gain."""
    building = box(
        {
            "room": {
                "infiltration": 0.5,
                "ventilation": {"fan": {"flow": 0.02}},
                "gains": {"lamp": {"power": 100, "radiative": 0.4}},
                "heating": {"setpoint": 20},
            }
        }
    )
    air = density(building.site) * AIR_SPECIFIC_HEAT * (0.5 * 50 / 3600 + 0.02)
    results = run(building)
    assert last(results, "room.air_temperature") == pytest.approx(20.0, abs=1e-8)
    # A part of the radiated heat leaves through the wall, depending on its surface heat transfer coefficient.
    through = 100 * 0.4 * (1.0 - U / 4.0)
    expected = (30 * U + air) * 20 - 60 - through
    assert last(results, "room.heating_load") == pytest.approx(expected, rel=1e-6)
    assert results.energy.relative_residual < 1e-10
    assert last(results, "room.air_changes") == pytest.approx(0.5 + 0.02 * 3600 / 50, rel=1e-9)


SETBACK = {
    "kind": "temperature",
    "days": {
        "all": [{"at": "00:00", "value": 10}, {"at": "07:00", "value": 20}, {"at": "23:00", "value": 10}]
    },
}


def heavy(**plant: Any) -> Building:
    """The box with a slab and a partition inside it, heated with a setback at night."""
    slab = {"construction": "slab", "area": 20, "tilt": 180, "azimuth": 0, "outside": {"adiabatic": True}}
    concrete = {"conductivity": 1.1, "density": 1400, "specific_heat": 1000}
    return box(
        {"room": {"infiltration": 0.5, "heating": {"setpoint": {"schedule": "setback"}, **plant}}},
        schedules={"setback": SETBACK},
        surfaces={"slab": slab | {"inside": {"zone": "room", "convection": 3}}},
        materials={"concrete": concrete},
        constructions={"slab": {"layers": [{"material": "concrete", "thickness": 0.08}]}},
    )


def test_a_setback_neither_overshoots_nor_alternates() -> None:
    """From 10 to 20 degC in one step; the daily heat is the same with steps of 15 min and of 1 min."""
    heats = {}
    for step, minutes in (("15min", 15), ("1min", 1)):
        results = run(heavy(), days=2, step=step)
        air, load = (results[f"room.{name}"].to_numpy() for name in ("air_temperature", "heating_load"))
        assert air.max() < 20.0 + 1e-7
        first, last_ = 31 * 60 // minutes, 47 * 60 // minutes  # 07:00 to 23:00 of the second day
        assert np.abs(air[first + 1 : last_ + 1] - 20.0).max() < 1e-7
        # One peak, then ever less: no load takes back what the one before gave.
        assert (np.diff(load[first + 1 : last_ + 1]) < 1e-3).all()
        assert results.energy.relative_residual < 1e-10
        assert results.heat("room.heating_load") == pytest.approx(results.energy.into["heating"], rel=1e-12)
        assert results.hourly("room.heating_load").sum() * 3600 == pytest.approx(
            results.energy.into["heating"]
        )
        heats[step] = results.energy.into["heating"]
    assert heats["15min"] == pytest.approx(heats["1min"], rel=0.01)


def test_the_air_leaves_its_set_point_when_ideal_loads_reach_their_capacity() -> None:
    building = box({"room": {"heating": {"setpoint": 20, "capacity": 200}}})
    results = run(building, days=4)
    assert last(results, "room.heating_load") == pytest.approx(200.0, rel=1e-12)
    assert last(results, "room.air_temperature") == pytest.approx(200.0 / (30 * U), rel=1e-6)


def test_ideal_loads_are_zero_where_they_are_not_available() -> None:
    never = {"kind": "fraction", "value": 0}
    building = box({"room": {"heating": {"setpoint": 20, "schedule": "never"}}}, schedules={"never": never})
    results = run(building, outdoor=7.0, days=4)
    assert last(results, "room.air_temperature") == pytest.approx(7.0, abs=1e-6)
    assert results.energy.into["heating"] == 0.0


def test_there_is_no_load_between_the_set_points() -> None:
    zone = {"heating": {"setpoint": 20}, "cooling": {"setpoint": 26}, "gains": {"lamp": {"power": 75}}}
    for outdoor, expected in ((15.0, 15.0 + 75 / (30 * U)), (22.0, 26.0), (0.0, 20.0)):
        results = run(box({"room": zone}), outdoor=outdoor, days=4)
        assert last(results, "room.air_temperature") == pytest.approx(expected, abs=1e-5)
        loss = 30 * U * (expected - outdoor) - 75
        assert last(results, "room.heating_load") == pytest.approx(max(loss, 0.0), abs=1e-3)
        assert last(results, "room.cooling_load") == pytest.approx(max(-loss, 0.0), abs=1e-3)


def test_three_zones_in_a_row_by_hand() -> None:
    """Air paths a-b-c, each zone with its wall: three balances of three unknowns."""
    paths = {
        "ab": {"between": ["a", "b"], "flow": 0.01},
        "bc": {"between": ["c", "b"], "flow": 0.03},
    }
    building = box({"a": {"gains": {"stove": {"power": 400}}}, "b": {}, "c": {}}, air_paths=paths)
    results = run(building, outdoor=5.0, days=10)
    heat = density(building.site) * AIR_SPECIFIC_HEAT
    ab, bc, wall = 0.01 * heat, 0.03 * heat, 30 * U
    matrix = [[wall + ab, -ab, 0], [-ab, wall + ab + bc, -bc], [0, -bc, wall + bc]]
    expected = 5.0 + np.linalg.solve(np.array(matrix), np.array([400.0, 0.0, 0.0]))
    found = [last(results, f"{zone}.air_temperature") for zone in "abc"]
    assert found == pytest.approx(list(expected), abs=1e-5)
    assert results.energy.into["interzone"] == pytest.approx(0.0, abs=1e-6)
    assert results.energy.relative_residual < 1e-10


def test_an_opening_by_hand() -> None:
    """Steady: the lamp's heat leaves by the wall and by `rho c Q dT`, Q from wind and buoyancy."""
    opening = {"zone": "room", "area": 0.2, "height": 0.4, "discharge": 0.6, "wind_coefficient": 0.25}
    building = box({"room": {"gains": {"lamp": {"power": 1500}}}}, openings={"slot": opening})
    results = run(building, outdoor=10.0, days=3)
    rise = last(results, "room.air_temperature") - 10.0
    flow = 0.2 * np.sqrt((0.25 * 3.0) ** 2 + 0.6**2 * 2 * 9.80665 * 0.4 * rise / (283.15 + rise / 2))
    heat = density(building.site) * AIR_SPECIFIC_HEAT * flow
    assert (30 * U + heat) * rise == pytest.approx(1500.0, rel=1e-5)
    assert last(results, "room.air_changes") == pytest.approx(3600 * flow / 50, rel=1e-4)
    assert results.energy.into["ventilation"] < 0.0
    assert results.energy.relative_residual < 1e-10


def test_a_sheltered_floor_is_at_air_temperature() -> None:
    """Without sun and sky, an adiabatic surface has the temperature of the air."""
    sheltered = {"sun": False, "wind": False, "sky": False}
    outside = {"outdoors": True, "convection": "mowitt", "emissivity": 0.9}
    floor = {"construction": "wall", "area": 10, "tilt": 180, "inside": {"adiabatic": True}}
    building = box(
        {"room": {}},
        surfaces={
            "floor": floor | {"outside": outside | {"exposure": sheltered}},
            "roof": floor | {"outside": outside | {"absorptance": 0.6}, "tilt": 0},
        },
    )
    results = run(building, outdoor=10.0, days=4)
    assert last(results, "floor.outside_temperature") == pytest.approx(10.0, abs=1e-6)
    assert last(results, "roof.outside_temperature") < 8.0


def test_a_gain_that_ends_within_a_step_keeps_its_heat() -> None:
    points = [{"at": "00:00", "value": 0}, {"at": "07:05", "value": 1}, {"at": "07:12", "value": 0}]
    building = box(
        {"room": {"gains": {"kettle": {"power": 1000, "schedule": "tea"}}}},
        schedules={"tea": {"kind": "fraction", "days": {"all": points}}},
    )
    for step in ("15min", "1h"):
        assert run(building, days=2, step=step).energy.into["gains"] == pytest.approx(
            2 * 1000 * 7 * 60, rel=1e-9
        )


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"zones.room.ventilation": {"fan": {"schedule": "office"}}}, "found: ventilation without a flow"),
        ({"zones.room.cooling": {"setpoint": 15}}, "found: heating to 20 degC, above cooling to 15 degC"),
        ({"zones.room.gains.lamp": {"power": 5, "schedule": "ofice"}}, "Did you mean 'office'"),
        ({"zones.room.gains.lamp": {"power": 5, "schedule": "warm"}}, "a schedule of kind fraction"),
        ({"zones.room.heating.setpoint": {"schedule": "office"}}, "a schedule of kind temperature"),
        ({"zones.room.heating.setpoint": "warm"}, "setpoint"),
    ],
)
def test_impossible_zones_are_refused(changes: dict[str, Any], message: str) -> None:
    building = box(
        {"room": {"heating": {"setpoint": 20}, "gains": {"lamp": {"power": 5}}, "ventilation": {}}},
        schedules={
            "office": {"kind": "fraction", "value": 0.5},
            "warm": {"kind": "temperature", "value": 30},
        },
    )
    with pytest.raises(InputError, match=message):
        building.replace(changes)


def test_set_points_that_cross_in_a_member_are_refused() -> None:
    building = box({"room": {"heating": {"setpoint": 20}, "cooling": {"setpoint": 26}}})
    climate = dark(np.zeros(25))
    simulation = Simulation(building, climate, step="1h")
    with pytest.raises(InputError, match=r"zones\.room: found heating to 27 degC above cooling to 26 degC"):
        simulation.run({"zones.room.heating.setpoint": 27.0})


def test_set_points_of_a_measured_column_that_cross_are_refused() -> None:
    wish = np.where(np.arange(25) == 7, 30.0, 20.0)
    schedules = {"wish": {"kind": "temperature", "column": "wish"}}
    zone = {"heating": {"setpoint": {"schedule": "wish"}}, "cooling": {"setpoint": 26}}
    with pytest.raises(InputError, match=r"from 2001-01-01 06:00; expected a set point of heating"):
        Simulation(box({"room": zone}, schedules=schedules), dark(np.zeros(25), wish=wish), step="1h")

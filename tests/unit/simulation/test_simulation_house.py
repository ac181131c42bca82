"""Fans, doors, bridges, pressure tests, measured powers, held zones: balances to check by hand."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mascarin.building import Building
from mascarin.building.parts.site_air import density
from mascarin.errors import InputError
from mascarin.physics import AIR_SPECIFIC_HEAT
from mascarin.simulation.preparation.objectives import Mean
from mascarin.simulation.results import Results
from mascarin.simulation.run import simulate
from mascarin.simulation.simulation import Simulation
from simulation_samples import hours
from test_simulation_zones import U, box, dark, last

UA = 30 * U
LEAKS = {"infiltration": 0}


def heat(building: Building) -> float:
    """Heat capacity of a cubic metre of air [J/(m3 K)]."""
    return density(building.site) * AIR_SPECIFIC_HEAT


def run(building: Building, outdoor: float = 0.0, days: float = 4, **columns: Any) -> Results:
    t = hours(days)
    level = np.ones(len(t))
    climate = dark(outdoor * level, **{name: level * value for name, value in columns.items()})
    return simulate(building, climate, step="15min", outputs=[one.name for one in building.outputs()])


def test_a_power_from_a_column_is_the_mean_of_its_steps() -> None:
    """A heater that runs every other hour: the energy is that of the column, in kW and with a factor."""
    building = box(
        {
            "room": LEAKS
            | {"gains": {"heater": {"column": "P", "unit": "kW", "factor": 0.5, "radiative": 0.3}}}
        }
    )
    t = hours(4)
    power = np.where(np.arange(len(t)) % 2 == 0, 2.0, 0.0)
    climate = dark(0.0 * t, P=power)
    results = simulate(building, climate, step="15min", end="2001-01-05")
    # Instants are joined by straight lines: 1 kW in the mean.
    assert results.energy.into["gains"] == pytest.approx(0.5 * 1000 * 4 * 86400, rel=1e-9)
    assert results.energy.closes


def test_a_negative_power_cools() -> None:
    building = box({"room": LEAKS | {"gains": {"duct": {"power": -70}, "heater": {"column": "P"}}}})
    assert last(run(building, P=-30.0), "room.air_temperature") == pytest.approx(-100 / UA, rel=1e-5)


def test_a_zone_held_at_a_column_needs_its_losses() -> None:
    """Heating and cooling at the measured temperature; the power is UA (T - T_o)."""
    building = box({"room": LEAKS | {"held": {"column": "T_room"}}})
    for measured in (22.0, -5.0):
        results = run(building, T_room=measured)
        assert last(results, "room.air_temperature") == pytest.approx(measured, abs=1e-8)
        power = last(results, "room.heating_load") - last(results, "room.cooling_load")
        assert power == pytest.approx(UA * measured, rel=1e-5)


@pytest.mark.parametrize("share", [0.3, 0.6])
def test_a_radiative_share_of_an_ideal_load(share: float) -> None:
    """The wall gets its part at once: Q = UA T + the part that goes out through the wall.

    ``(1 - r) Q = h (T - Ts)`` and ``r Q + h (T - Ts) = k Ts`` in W/m2, with the wall and its outer film k.
    """
    building = box({"room": {"infiltration": 0, "held": {"temperature": 20, "radiative": share}}})
    level = np.ones(len(hours(4)))
    results = simulate(
        building, dark(0 * level), step="15min", outputs=["room.net_load", "room.air_temperature"]
    )
    k = 1 / (0.1 / 0.04 + 1 / 20)
    expected = 30 * 20 / ((1 - share) / 4 + 1 / k)
    assert last(results, "room.air_temperature") == pytest.approx(20, abs=1e-9)
    assert last(results, "room.net_load") == pytest.approx(expected, rel=1e-6)
    assert results.energy.closure < 1e-12


def test_heating_radiates_and_cooling_does_not() -> None:
    """Outdoors warm, then cold: each load has its own share."""
    plants = {"heating": {"setpoint": 20, "radiative": 0.5}, "cooling": {"setpoint": 20.001}}
    building = box({"room": {"infiltration": 0} | plants, "other": {"infiltration": 0, "held": 20}})
    level = np.ones(len(hours(4)))
    k = 1 / (0.1 / 0.04 + 1 / 20)
    for outdoor, expected in ((0.0, 600 / (0.5 / 4 + 1 / k)), (40.0, -30 * U * 19.999)):
        results = simulate(building, dark(outdoor * level), step="15min", outputs=["room.net_load"])
        assert last(results, "room.net_load") == pytest.approx(expected, rel=1e-5)


def test_a_column_with_a_schedule() -> None:
    """A measured power is an input in the first two days only, then the room is held."""
    phases = {
        "driven": {
            "kind": "fraction",
            "seasons": [
                {"until": "01-02", "days": {"all": [{"at": "00:00", "value": 1}]}},
                {"until": "12-31", "days": {"all": [{"at": "00:00", "value": 0}]}},
            ],
        },
        "held": {
            "kind": "fraction",
            "seasons": [
                {"until": "01-02", "days": {"all": [{"at": "00:00", "value": 0}]}},
                {"until": "12-31", "days": {"all": [{"at": "00:00", "value": 1}]}},
            ],
        },
    }
    heater = {"column": "P", "schedule": "driven"}
    zone = {"infiltration": 0, "gains": {"heater": heater}, "held": {"column": "T_room", "when": "held"}}
    level = np.ones(len(hours(4)))
    climate = dark(0 * level, P=100 * level, T_room=18 * level)
    building = box({"room": zone}, schedules=phases)
    results = simulate(building, climate, step="15min", end="2001-01-05", outputs=["room.net_load"])
    assert results.energy.into["gains"] == pytest.approx(100 * 2 * 86400, rel=1e-9)
    before = results["room.net_load"].sel(time=slice("2001-01-01 00:00Z", "2001-01-03 00:00Z"))
    assert float(abs(before).max()) == 0.0
    assert last(results, "room.net_load") == pytest.approx(30 * U * 18, rel=1e-4)


def test_a_boundary_is_the_mean_of_several_columns() -> None:
    walls = {
        "wall_room": {
            "construction": "wall", "area": 30, "tilt": 90, "azimuth": 0,
            "outside": {"measured": ["east", "west", "yard"], "convection": 20},
            "inside": {"zone": "room", "convection": 4},
        }
    }  # fmt: skip
    results = run(box({"room": LEAKS}, surfaces=walls), outdoor=3.0, east=10.0, west=20.0)
    assert last(results, "room.air_temperature") == pytest.approx(11.0, abs=1e-4)


BRIDGES = {
    "edges": {"psi": 0.05, "length": 20},
    "posts": {"chi": 0.5, "number": 4, "measured": ["east", "west"]},
    "soil": {"psi": 0.1, "length": 30, "ground": {"temperature": 12}},
}


def test_thermal_bridges_are_conductances() -> None:
    """1 W/K to outdoors, 2 W/K to 15 degC, 3 W/K to 12 degC, beside the wall."""
    building = box({"room": LEAKS | {"thermal_bridges": BRIDGES}})
    results = run(building, outdoor=2.0, east=10.0, west=20.0)
    expected = (UA * 2 + 1 * 2 + 2 * 15 + 3 * 12) / (UA + 6)
    assert last(results, "room.air_temperature") == pytest.approx(expected, abs=1e-4)
    assert results.energy.into["bridges"] > 0
    assert results.energy.closes


def test_a_bridge_between_zones() -> None:
    """Heat from the warm room through 3 W/K: the attic has UA to outdoors."""
    zones = {
        "room": LEAKS | {"held": 20, "thermal_bridges": {"joint": {"chi": 3, "zone": "attic"}}},
        "attic": LEAKS,
    }
    results = run(box(zones))
    assert last(results, "attic.air_temperature") == pytest.approx(20 * 3 / (3 + UA), rel=1e-5)
    assert results.energy.into["interzone"] == pytest.approx(0.0, abs=1e-3)


FANS: dict[str, Any] = {
    "air_paths": {
        "overflow": {"between": ["living", "bath"], "column": "V", "unit": "m3/h", "one_way": True}
    },
    "ventilation_units": {
        "unit": {
            "supply": {"living": {"column": "V", "unit": "m3/h"}},
            "exhaust": {"bath": {"column": "V", "unit": "m3/h"}},
            "temperature": {"column": "T_supply"},
        }
    },
}


def test_a_unit_with_measured_flow_and_temperature() -> None:
    """120 m3/h at 18 degC through two rooms that lose by UA."""
    building = box({"living": LEAKS, "bath": LEAKS}, **FANS)
    results = run(building, V=120.0, T_supply=18.0)
    flow = heat(building) * 120 / 3600
    living = 18 * flow / (flow + UA)
    assert last(results, "living.air_temperature") == pytest.approx(living, rel=1e-5)
    assert last(results, "bath.air_temperature") == pytest.approx(living * flow / (flow + UA), rel=1e-5)
    assert last(results, "living.air_changes") == pytest.approx(120 / 50, rel=1e-9)
    assert last(results, "bath.air_changes") == pytest.approx(0.0, abs=1e-12)


def test_heat_recovery_of_the_smaller_flow() -> None:
    """Supply 0.02, exhaust 0.03 m3/s at 20 degC: e 0.02 c (20 - T_o) is recovered, the rest leaks in."""
    zones = {"room": LEAKS | {"held": 20, "makeup_air": "outdoors"}}
    units = {"unit": {"supply": {"room": 0.02}, "exhaust": {"room": 0.03}, "recovery": 0.75}}
    building = box(zones, ventilation_units=units)
    needed = 20 * (UA + heat(building) * (0.03 - 0.75 * 0.02))
    assert last(run(building), "room.heating_load") == pytest.approx(needed, rel=1e-5)


def test_a_door_by_temperature_difference() -> None:
    zones = {"warm": LEAKS | {"held": 20}, "cold": LEAKS}
    door = {"width": 0.9, "height": 2.0, "discharge": 0.6, "open": 0.5}
    results = run(box(zones, air_paths={"door": {"between": ["warm", "cold"], "door": door}}))
    cold = last(results, "cold.air_temperature")
    building = box(zones)
    whole = heat(building) * 0.6 * 0.45 * 2 / 3 * np.sqrt(9.80665 * 2 / 293.15)
    assert UA * cold == pytest.approx(whole * (20 - cold) ** 1.5, rel=1e-4)


@pytest.mark.parametrize(
    ("test", "changes"),
    [
        (2.0, 0.14),
        ({"kind": "factor", "n50": 2, "factor": 0.1}, 0.2),
        # 2.2 0.08^0.65 10 sqrt(0.15) sqrt(0.000145 20 + 0.000174 3^2) 1/h
        ({"kind": "stack_wind", "n50": 2.2}, 2.2 * 0.08**0.65 * 10 * np.sqrt(0.15 * (0.0029 + 0.001566))),
    ],
)
def test_infiltration_by_a_pressure_test(test: Any, changes: float) -> None:
    building = box({"room": {"infiltration": {"blower_door": test}, "held": 20}})
    results = run(building)
    assert last(results, "room.air_changes") == pytest.approx(changes, rel=1e-6)
    needed = 20 * (UA + heat(building) * 50 * changes / 3600)
    assert last(results, "room.heating_load") == pytest.approx(needed, rel=1e-5)


def test_slopes_by_path_agree_with_differences() -> None:
    """Forward and reverse slopes of a mean temperature by numbers of every new part."""
    living = {"gains": {"heater": {"column": "P"}}, "thermal_bridges": BRIDGES}
    bath = {"infiltration": {"blower_door": {"kind": "stack_wind", "n50": 2.2}}}
    leaky = {"makeup_air": "outdoors"}
    zones = {"living": LEAKS | living | leaky, "bath": bath | leaky}
    door = {"between": ["living", "bath"], "door": {"width": 1, "height": 2, "open": 0.5}}
    more = FANS | {"air_paths": FANS["air_paths"] | {"door": door}}
    building = box(zones, **more)
    # Away from balances, where slopes differ to both sides.
    flows = {"ventilation_units.unit.exhaust.bath.factor": 1.2, "air_paths.overflow.factor": 0.9}
    building = building.with_values(flows)
    t = hours(2)
    wave = np.sin(t / 9000.0)
    columns: dict[str, Any] = {
        "P": 300 + 200 * wave,
        "V": 100 + 20 * wave,
        "T_supply": 17 + wave,
        "east": 5 + wave,
        "west": 9 - wave,
    }
    climate = dark(3 + 4 * wave, **columns)
    names = ["living.air_temperature", "bath.air_temperature"]
    simulation = Simulation(building, climate, step="15min", outputs=names)
    paths = [
        "zones.living.gains.heater.factor",
        "zones.living.thermal_bridges.edges.psi",
        "zones.living.thermal_bridges.posts.chi",
        "zones.living.thermal_bridges.soil.length",
        "zones.living.thermal_bridges.soil.ground.mean",
        "zones.bath.infiltration.blower_door.n50",
        "zones.bath.infiltration.blower_door.wind",
        "air_paths.overflow.factor",
        "air_paths.door.door.open",
        "ventilation_units.unit.supply.living.factor",
        "ventilation_units.unit.exhaust.bath.factor",
    ]
    slopes = simulation.gradient(Mean("bath.air_temperature")).slopes
    for path in paths:
        value = building.parameter(path).value
        step = 1e-4 * value
        high, low = (
            float(simulation.run({path: value + sign * step})["bath.air_temperature"].mean())
            for sign in (1, -1)
        )
        assert slopes[path] == pytest.approx((high - low) / (2 * step), rel=2e-4, abs=1e-7), path


def test_flows_that_do_not_balance_in_time_are_refused_with_the_numbers() -> None:
    columns = {"V": 120.0, "T_supply": 18.0}
    building = box({"living": LEAKS, "bath": LEAKS}, **FANS).with_values(
        {"ventilation_units.unit.exhaust.bath.factor": 0.5}
    )
    with pytest.raises(InputError) as error:
        run(building, **columns)
    text = str(error.value)
    assert "zones.bath" in text
    assert "0.033333 m3/s of air enters and 0.016667 m3/s leaves" in text
    assert "makeup_air: outdoors" in text
    assert "air_paths.overflow +0.033333" in text
    open_to_leaks = building.replace({"zones.bath.makeup_air": "outdoors"})
    assert last(run(open_to_leaks, **columns), "bath.air_temperature") > 0


def test_a_column_that_is_missing_is_named() -> None:
    with pytest.raises(InputError, match="no measured column 'P'"):
        run(box({"room": LEAKS | {"gains": {"heater": {"column": "P"}}}}))

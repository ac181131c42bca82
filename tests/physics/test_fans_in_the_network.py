"""Fans whose flow the openings of a pressure network make up."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from mascarin.building import Building
from mascarin.building.parts.site_air import density
from mascarin.errors import InputError
from mascarin.physics import AIR_SPECIFIC_HEAT
from mascarin.simulation.simulation import Simulation
from test_openings import last, rooms, run, weather
from test_simulation_derivatives import both_ways, misses

DISCHARGE, GRAVITY = 0.65, 9.80665


def with_fan(way: str = "exhaust", flow: float = 1.0, **zone: Any) -> Building:
    """The two rooms, with a fan in the second."""
    plain = rooms().to_dict()
    plain["zones"]["b"] |= {"makeup_air": "vents"} | zone
    plain["ventilation_units"] = {"fan": {way: {"b": flow}}}
    return Building.from_dict(plain)


def test_a_fan_draws_through_openings_beside_and_behind_each_other() -> None:
    """1 m3/s by 0.5 m2, and by 0.5 and 1.5 m2 in a row: `1/sqrt(1/0.5^2 + 1/1.5^2) = 0.474342 m2`."""
    results = run(with_fan(), weather(air_temperature=20.0, wind_speed=0.0), step="1h")
    in_a_row = 0.474341649
    direct = 0.5 / (0.5 + in_a_row)
    assert results["leeward.inflow"][0] == pytest.approx(direct, rel=1e-5)
    assert results["windward.inflow"][0] == pytest.approx(1.0 - direct, rel=1e-5)
    assert results["door.outflow"][0] == pytest.approx(1.0 - direct, rel=1e-5)
    assert results["leeward.outflow"][0] == results["windward.outflow"][0] == 0.0
    assert results["b.air_changes"][0] == pytest.approx(3600 * direct / 50, rel=1e-4)
    assert results.energy.closes


def test_a_supply_fan_drives_the_same_air_out() -> None:
    results = run(with_fan("supply"), weather(air_temperature=20.0, wind_speed=0.0), step="1h")
    direct = 0.5 / (0.5 + 0.474341649)
    assert results["leeward.outflow"][0] == pytest.approx(direct, rel=1e-5)
    assert results["windward.outflow"][0] == pytest.approx(1.0 - direct, rel=1e-5)
    assert results["leeward.inflow"][0] == 0.0
    assert results.energy.closes


@pytest.mark.parametrize("flow", [0.05, 0.4])
def test_a_fan_against_stack(flow: float) -> None:
    """A room of 30 degC, outdoors 10 degC: what the fan takes and the upper opening loses enters below.

    Below 0.12 m3/s or so, air leaves by the upper opening, above it enters by both.
    """
    plain = rooms().to_dict()
    plain["zones"] = {"a": plain["zones"]["a"] | {"held": 30, "gains": {}, "makeup_air": "vents"}}
    plain["surfaces"] = {"north": plain["surfaces"]["north"]}
    opening = {"zone": "a", "pressure": "none"}
    plain["vents"] = {
        "low": opening | {"area": 0.2, "elevation": 0.5},
        "high": opening | {"area": 0.1, "elevation": 3.0},
    }
    plain["ventilation_units"] = {"fan": {"exhaust": {"a": flow}}}
    building = Building.from_dict(plain)
    results = run(building, weather(air_temperature=10.0, wind_speed=0.0), step="1h", initial=30.0)
    site = density(building.site)
    warm, cold = (site * 288.15 / (273.15 + celsius) for celsius in (30.0, 10.0))

    def outflow(pressure: float, area: float, height: float) -> float:
        """Volume of air of the site out of the room at a pressure above that of outdoors at the ground."""
        difference = pressure - (warm - cold) * GRAVITY * height
        of = warm if difference > 0.0 else cold
        return float(np.sign(difference) * DISCHARGE * area * np.sqrt(2.0 * of * abs(difference)) / site)

    def balance(pressure: float) -> float:
        return outflow(pressure, 0.2, 0.5) + outflow(pressure, 0.1, 3.0) + flow

    pressure = brentq(balance, -50.0, 50.0, xtol=1e-13)
    for name, area, height in (("low", 0.2, 0.5), ("high", 0.1, 3.0)):
        expected = outflow(pressure, area, height)
        net = last(results, f"{name}.outflow") - last(results, f"{name}.inflow")
        assert net == pytest.approx(expected, rel=1e-4), name
    assert (last(results, "high.outflow") > 0.0) == (flow < 0.1)
    # The air that leaves is warmed by 20 K.
    leaving = flow + last(results, "high.outflow")
    walls = last(results, "north.inside_flux") * 20.0
    capacity = site * AIR_SPECIFIC_HEAT
    assert last(results, "a.heating_load") == pytest.approx(leaving * capacity * 20.0 - walls, rel=2e-3)
    assert results.energy.closes


def test_a_fan_between_rooms_is_made_up_by_the_door_and_the_windows() -> None:
    """Back by the door of 1.5 m2, and by two windows in a row, 0.5/sqrt(2) m2."""
    plain = rooms().to_dict()
    for zone in plain["zones"].values():
        zone["makeup_air"] = "vents"
    plain["air_paths"] = {"fan": {"between": ["a", "b"], "one_way": True, "flow": 1.0}}
    results = run(Building.from_dict(plain), weather(air_temperature=20.0, wind_speed=0.0), step="1h")
    by_windows = 0.5 / np.sqrt(2.0)
    through_the_door = 1.5 / (1.5 + by_windows)
    assert results["door.inflow"][0] == pytest.approx(through_the_door, rel=1e-5)
    assert results["windward.inflow"][0] == pytest.approx(1.0 - through_the_door, rel=1e-5)
    assert results["leeward.outflow"][0] == pytest.approx(1.0 - through_the_door, rel=1e-5)
    assert results.energy.closes


def test_vapour_leaves_with_the_air_of_a_fan() -> None:
    """1 g/s of vapour in 1 m3/s: 0.8 g/kg above the air that enters, in the steady state."""
    plain = with_fan().to_dict()
    plain["humidity"] = {"zones": {"b": {"gains": {"kettle": {"rate": 1e-3}}}}}
    plain["zones"]["b"] |= {"held": 20}
    building = Building.from_dict(plain)
    climate = weather(air_temperature=20.0, wind_speed=0.0)
    results = run(building, climate, ["a.humidity_ratio", "b.humidity_ratio"], step="1h", initial=20.0)
    outdoors = last(results, "a.humidity_ratio")
    mass = density(building.site)
    assert last(results, "b.humidity_ratio") - outdoors == pytest.approx(1e-3 / mass, rel=2e-2)
    assert results.vapour is not None
    assert results.vapour.closes
    assert results.energy.closes


def test_derivatives_by_the_flow_of_a_fan() -> None:
    simulation = Simulation(
        with_fan(flow=0.2), weather(hours=13), step="30min", initial=20.0,
        outputs=["a.air_temperature", "door.outflow"],
    )  # fmt: skip
    assert "ventilation_units.fan.exhaust.b.flow" in simulation.paths
    reverse, forward = both_ways(simulation)
    np.testing.assert_allclose(reverse, forward, rtol=0.0, atol=1e-9 * np.abs(forward).max())
    assert set(misses(simulation)) <= {"surfaces.north.azimuth", "surfaces.south.azimuth"}


def test_make_up_air_needs_a_vent() -> None:
    plain = with_fan().to_dict()
    plain["vents"] = {}
    with pytest.raises(InputError, match="'vents' in a zone that no vents join with outdoors"):
        Building.from_dict(plain)

"""A heat flux at a surface, emissivity where it acts, hot outdoor air, sun in rooms without windows."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin.building import Building
from mascarin.building.parameters.unused_parameters import without_effect
from mascarin.building.parts.site_air import density
from mascarin.building.reading import parse
from mascarin.errors import InputError
from mascarin.physics import AIR_SPECIFIC_HEAT
from mascarin.simulation.preparation.objectives import Mean
from mascarin.simulation.results import Results
from mascarin.simulation.run import simulate
from mascarin.simulation.simulation import Simulation
from mascarin.weather import Climate
from simulation_samples import hours
from test_simulation_zones import box

#: Air of 80 degC looks like one in degF without its unit.
STATED = {"air_temperature": {"column": "air_temperature", "unit": "degC"}}
CONDUCTIVITY, DENSITY, HEAT = 1.75, 2300.0, 900.0


def weather(days: float, air: float = 20.0, **columns: Any) -> Climate:
    t = hours(days)
    level = np.ones(len(t))
    calm = ("cloud_cover", "wind_speed", "wind_direction", "direct_normal", "diffuse_horizontal")
    channels = {"air_temperature": air * level, "dew_point": 5.0 * level, **dict.fromkeys(calm, 0.0 * level)}
    extra = {name: value * level for name, value in columns.items()}
    index = pd.date_range("2001-01-01", periods=len(t), freq="1h", tz="UTC")
    return Climate.from_table(
        pd.DataFrame(channels | extra, index=index),
        timezone="UTC",
        columns={**{name: name for name in channels}, **STATED},
        extra=list(extra),
        instant=[*channels, *extra],
    )


def slab(outside: Any, thickness: float = 0.2, inside: Any = None, nodes: int = 10, **more: Any) -> Building:
    """One wall of concrete of 2 m2."""
    material = {"conductivity": CONDUCTIVITY, "density": DENSITY, "specific_heat": HEAT}
    layer = {"material": "concrete", "thickness": thickness, "nodes": nodes}
    tree = {
        "name": "slab",
        "site": {"latitude": 40, "longitude": 0, "altitude": 0, "timezone": "UTC"},
        "materials": {"concrete": material},
        "constructions": {"wall": {"layers": [layer]}},
        "surfaces": {
            "wall": {
                "construction": "wall", "area": 2, "tilt": 90, "azimuth": 0, "outside": outside,
                "inside": inside or {"measured": "T", "convection": 5},
            }
        },
        **more,
    }  # fmt: skip
    return parse(json.dumps(tree), "slab.yaml")


def run(building: Building, climate: Climate, initial: Any = "repeat", step: str = "15min") -> Results:
    names = ["wall.outside_temperature", "wall.inside_temperature"]
    return simulate(building, climate, step=step, outputs=names, initial=initial)


@pytest.mark.parametrize(
    "flux",
    [
        {"heat_flux": 60.0},
        {"heat_flux": {"flux": 120.0, "schedule": "half"}},
        {"heat_flux": {"column": "q", "unit": "kW/m2"}},
        {"heat_flux": {"column": "q", "unit": "kW/m2", "factor": -1.0}},
    ],
)
def test_a_flux_in_balance(flux: dict[str, Any]) -> None:
    """60 W/m2 through 0.2 m of concrete and a film of 5 W/(m2 K) to air of 20 degC."""
    building = slab(flux, schedules={"half": {"kind": "fraction", "value": 0.5}})
    results = run(building, weather(4, T=20.0, q=0.06))
    sign = -1.0 if isinstance(flux["heat_flux"], dict) and "factor" in flux["heat_flux"] else 1.0
    inner = 20.0 + sign * 60.0 / 5.0
    outer = inner + sign * 60.0 * 0.2 / CONDUCTIVITY
    assert float(results["wall.inside_temperature"].to_numpy()[-1]) == pytest.approx(inner, abs=0.02)
    assert float(results["wall.outside_temperature"].to_numpy()[-1]) == pytest.approx(outer, abs=0.02)
    assert results.energy.closure < 1e-9


def test_a_flux_into_a_thick_wall() -> None:
    """100 W/m2 into a wall of 20 degC: the surface rises by ``2 q sqrt(t/(pi k rho c))``."""
    building = slab({"heat_flux": 100.0}, thickness=2.0, nodes=400)
    results = run(building, weather(0.5, T=20.0), initial=20.0, step="5min")
    found = results["wall.outside_temperature"].to_numpy()[1:] - 20.0
    t = 300.0 * np.arange(1, len(found) + 1)
    rise = 2 * 100.0 * np.sqrt(t / (np.pi * CONDUCTIVITY * DENSITY * HEAT))
    assert found[11:] == pytest.approx(rise[11:], rel=0.01)
    # All of it is counted, and stored.
    assert results.energy.into["boundary"] == pytest.approx(2.0 * 100.0 * t[-1], rel=1e-6)
    assert results.energy.closure < 1e-9


def test_slopes_by_a_flux_agree_with_differences() -> None:
    building = slab({"heat_flux": {"column": "q", "factor": 0.9}})
    climate = weather(2, T=20.0, q=50.0)
    simulation = Simulation(building, climate, step="15min", outputs=["wall.outside_temperature"])
    path = "surfaces.wall.outside.heat_flux.factor"
    slopes = simulation.gradient(Mean("wall.outside_temperature")).slopes
    high, low = (
        float(simulation.run({path: 0.9 + sign * 1e-3})["wall.outside_temperature"].mean())
        for sign in (1, -1)
    )
    assert slopes[path] == pytest.approx((high - low) / 2e-3, rel=1e-5)


def test_a_flux_and_a_temperature_on_one_side_are_refused() -> None:
    for other in ({"measured": "T"}, {"ground": {"mean": 10}}, {"adiabatic": True}):
        with pytest.raises(InputError, match="heat flux or a temperature beside it, not both"):
            slab({"heat_flux": 10.0, **other})
    with pytest.raises(InputError, match="'convection' on a side facing heat_flux"):
        slab({"heat_flux": 10.0, "convection": 5})
    with pytest.raises(InputError, match=r"heat_flux\.unit"):
        slab({"heat_flux": {"column": "q", "unit": "W"}})


def test_emissivity_is_needed_where_it_acts() -> None:
    inside = {"zone": "room", "convection": 3}
    room: Any = {"zones": {"room": {"volume": 30, "longwave": "none"}}}
    outside = {"outdoors": True, "convection": 8, "absorptance": 0.5}
    building = slab(outside | {"longwave": "none"}, inside=inside, **room)
    results = simulate(building, weather(1), outputs=["room.air_temperature"])
    assert results.energy.closes
    with pytest.raises(InputError, match=r"(?s)emissivity.*nothing.*needed on a side facing outdoors"):
        slab(outside, inside=inside, **room)


def test_outdoor_air_of_80_degc() -> None:
    room: Any = {"zones": {"room": {"volume": 30, "longwave": "none"}}}
    outside = {"outdoors": True, "convection": 8, "absorptance": 0.5, "longwave": "none"}
    building = slab(outside, inside={"zone": "room", "convection": 3}, **room)
    results = simulate(building, weather(3, air=80.0), outputs=["room.air_temperature"])
    assert float(results["room.air_temperature"].to_numpy()[-1]) == pytest.approx(80.0, abs=0.1)
    with pytest.raises(InputError, match=r"-90 \.\. 80 degC"):
        simulate(building, weather(1, air=81.0), outputs=["room.air_temperature"])


@pytest.mark.parametrize(
    "sun", ["area", "floor", "geometry", {"kind": "shares", "shares": {"wall_room": 1.0}}]
)
def test_a_distribution_of_sun_that_does_not_enter(sun: Any) -> None:
    """`sun:` in a room without windows changes nothing: a room keeps it when it loses its windows."""
    plain, stated = (box({"room": {"infiltration": 0.5} | extra}) for extra in ({}, {"sun": sun}))
    climate = weather(1, yard=5.0)
    airs = [simulate(each, climate, outputs=["room.air_temperature"]) for each in (plain, stated)]
    first, second = (np.asarray(run["room.air_temperature"].values) for run in airs)
    assert np.array_equal(first, second)
    reasons = without_effect(stated)
    assert isinstance(sun, str) or reasons["zones.room.sun.shares.wall_room"] == "no sun enters the zone"


def test_a_zone_of_air_alone() -> None:
    """A plenum that gets 36 m3/h from a room at 20 degC, 2 air changes from outdoors and 20 W of a fan."""
    plenum = {"volume": 5, "infiltration": 2.0, "gains": {"fan": {"power": 20}}}
    paths = {"grille": {"between": ["room", "plenum"], "flow": 0.01}}
    building = box({"room": {"held": 20}}).replace({"zones.plenum": plenum, "air_paths": paths})
    names = ["plenum.air_temperature", "plenum.mean_radiant_temperature"]
    results = simulate(building, weather(2, air=0.0, yard=0.0), outputs=names)
    air = density(building.site) * AIR_SPECIFIC_HEAT
    expected = (20.0 + 20.0 * 0.01 * air) / (air * (0.01 + 2.0 * 5 / 3600))
    assert [float(results[name].to_numpy()[-1]) for name in names] == pytest.approx([expected] * 2, rel=1e-6)
    assert results.energy.closure < 1e-9
    with pytest.raises(InputError, match=r"0\.3 in a zone that no surface faces"):
        building.replace({"zones.plenum.gains.fan.radiative": 0.3})


@pytest.mark.parametrize("step", ["15min", "5min"])
def test_means_of_hours_as_set_points_and_boundaries(step: str) -> None:
    """The air, joined by straight lines, has the means of the table; so has the heat through the wall."""
    count = 240
    random = np.random.default_rng(1).normal(size=count)
    frame = pd.DataFrame(
        {
            "T": 10.0, "yard": 5.0 + 4.0 * random, "inner": 18.0 + 3.0 * (np.arange(count) % 24 > 8),
        },
        index=pd.date_range("2001-01-01", periods=count, freq="1h"),
    )  # fmt: skip
    climate = Climate.from_table(
        frame, timezone="UTC", columns={"air_temperature": "T"}, extra=["yard", "inner"],
        mean=["yard", "inner"], absent=["dew_point", "wind_speed", "wind_direction", "radiation"],
    )  # fmt: skip
    same = {"setpoint": {"column": "inner"}}
    building = box({"room": {"heating": same, "cooling": same}})
    names = ["room.air_temperature", "wall_room.outside_temperature", "room.net_load"]
    results = simulate(building, climate, step=step, outputs=names)
    air = results["room.air_temperature"].to_numpy()
    count_an_hour = (len(air) - 1) // count
    hourly = (0.5 * (air[1:] + air[:-1])).reshape(count, count_an_hour).mean(axis=1)
    # The first hour begins with the air of the periodic start.
    assert hourly[1:] == pytest.approx(frame["inner"].to_numpy()[1:], abs=1e-9)
    # Of days, the mean load is that of the mean temperatures through films and 0.1 m of foam.
    conductance = 30.0 / (1.0 / 20.0 + 0.1 / 0.04 + 1.0 / 4.0)
    load = results["room.net_load"].to_numpy()[1:].mean()
    expected = conductance * (frame["inner"].mean() - frame["yard"].mean())
    assert load == pytest.approx(expected, rel=0.01)

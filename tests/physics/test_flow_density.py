"""Flows as volumes of the air of the site, outdoors, of a zone, or of a density."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest

from mascarin.building import Building
from mascarin.building.checks.overview import check
from mascarin.building.parts.site_air import density
from mascarin.errors import InputError
from mascarin.physics import AIR_SPECIFIC_HEAT
from mascarin.simulation.preparation.objectives import Mean
from mascarin.simulation.results import Results
from mascarin.simulation.run import simulate
from mascarin.simulation.simulation import Simulation
from mascarin.weather import Climate
from simulation_samples import hours
from test_simulation_zones import U, box, last

UA = 30 * U
GAS = 287.055
#: Outdoor air of -10 degC [degC], pressure [Pa] and dew point [degC] of the weather.
OUTDOOR, PRESSURE, DEW_POINT = -10.0, 95_000.0, -12.0


def climate(days: float = 3, outdoor: Any = OUTDOOR, **columns: Any) -> Climate:
    """Constant weather without sun and wind, hourly; `columns` are measured."""
    t = hours(days)
    level = np.ones(len(t))
    channels = {
        "air_temperature": outdoor * level,
        "dew_point": DEW_POINT * level,
        "pressure": PRESSURE * level,
        "wind_speed": 3.0 * level,
    }
    calm = ("cloud_cover", "wind_direction", "direct_normal", "diffuse_horizontal")
    channels |= dict.fromkeys(calm, 0.0 * level)
    extra = {"yard": OUTDOOR * level} | {name: value * level for name, value in columns.items()}
    index = pd.date_range("2001-01-01", periods=len(t), freq="1h", tz="UTC")
    return Climate.from_table(
        pd.DataFrame(channels | extra, index=index),
        timezone="UTC",
        columns={name: name for name in channels},
        extra=list(extra),
        instant=[*channels, *extra],
    )


def run(building: Building, **columns: Any) -> Results:
    names = [each.name for each in building.outputs()]
    return simulate(building, climate(**columns), step="15min", outputs=names)


def outdoor_density() -> float:
    """``P/(R T (1 + 1.6078 W))``, vapour pressure over water after Sonntag 1990. [kg/m3]"""
    kelvin = DEW_POINT + 273.15
    terms = -6096.9385 / kelvin + 16.635794 - 2.711193e-2 * kelvin + 1.673952e-5 * kelvin**2
    vapour = 100.0 * np.exp(terms + 2.433502 * np.log(kelvin))
    ratio = 0.621945 * vapour / (PRESSURE - vapour)
    return float(PRESSURE / (GAS * (OUTDOOR + 273.15) * (1.0 + 1.607861 * ratio)))


def densities(building: Building, zone: float) -> dict[Any, float]:
    return {
        None: density(building.site),
        "site": density(building.site),
        "outdoors": outdoor_density(),
        "zone": PRESSURE / (GAS * (zone + 273.15)),
        1.2: 1.2,
    }


@pytest.mark.parametrize("choice", [None, "site", "outdoors", "zone", 1.2])
@pytest.mark.parametrize(
    ("key", "flow"),
    [
        ("infiltration", {"constant": 2.0}),
        ("infiltration", {"blower_door": {"n50": 20.0, "factor": 0.1, "kind": "factor"}}),
        ("infiltration", {"formula": "2 + 0*dT"}),
        ("ventilation", {"air_changes": 2.0}),
        ("ventilation", {"flow": 100 / 3600}),
        ("unit", {"flow": 100 / 3600}),
        ("unit", {"column": "V", "unit": "m3/h"}),
    ],
)
def test_the_heat_of_a_flow_by_hand(choice: Any, key: str, flow: dict[str, Any]) -> None:
    """100 m3/h of outdoor air into a room of 50 m3 at 20 degC: 30 (UA + V rho c) W."""
    flow = flow | ({} if choice is None else {"density": choice})
    zone: dict[str, Any] = {"held": 20, "infiltration": 0, "volume": 50}
    more: dict[str, Any] = {}
    if key == "unit":
        more = {"ventilation_units": {"fan": {"supply": {"room": flow}, "exhaust": {"room": flow}}}}
    else:
        zone |= {key: flow if key == "infiltration" else {"fan": flow}}
    building = box({"room": zone}, **more)
    results = run(building, V=100.0)
    passing = densities(building, 20.0)[choice] * 100 / 3600 * AIR_SPECIFIC_HEAT
    load = last(results, "room.heating_load")
    assert load == pytest.approx(30 * (UA + passing), rel=3e-5)
    site = density(building.site)
    expected = 2.0 * densities(building, 20.0)[choice] / site
    assert last(results, "room.air_changes") == pytest.approx(expected, rel=1e-4)
    assert results.energy.closure < 1e-9


@pytest.mark.parametrize("one_way", [False, True])
@pytest.mark.parametrize("choice", [None, "outdoors", "zone", 1.2])
def test_air_between_zones_by_hand(choice: Any, one_way: bool) -> None:
    """A room at 20 degC gives 60 m3/h to the next room, both ways or through it and out."""
    flow: dict[str, Any] = {"flow": 60 / 3600} | ({} if choice is None else {"density": choice})
    path = {"between": ["warm", "cold"], "one_way": one_way, **flow}
    building = box(
        {"warm": {"held": 20, "infiltration": 0}, "cold": {"infiltration": 0}}
        | ({} if not one_way else {"warm": {"held": 20, "infiltration": 0, "makeup_air": "outdoors"},
                                   "cold": {"infiltration": 0, "makeup_air": "outdoors"}}),
        air_paths={"between": path},
    )  # fmt: skip
    results = run(building)
    cold = last(results, "cold.air_temperature")
    air = densities(building, 20.0)
    of_zone = air["zone"] if one_way else 0.5 * (air["zone"] + densities(building, cold)["zone"])
    passing = (of_zone if choice == "zone" else air[choice]) * 60 / 3600 * AIR_SPECIFIC_HEAT
    # What enters the cold room leaves it again, to the warm one or outdoors.
    assert UA * (cold - OUTDOOR) == pytest.approx(passing * (20 - cold), rel=1e-4)
    assert results.energy.closure < 1e-9
    assert results.energy.into["interzone"] == pytest.approx(0.0, abs=1e-3)


def test_slopes_by_path_agree_with_differences() -> None:
    """Forward and reverse slopes of flows of air of their own density, in rooms whose temperature moves."""
    zones: dict[str, Any] = {
        "room": {
            "infiltration": {"constant": 1.0, "wind": 0.1, "density": "outdoors"},
            "ventilation": {
                "fan": {"air_changes": 1.5, "density": 1.2},
                "duct": {"flow": 0.02, "density": "zone"},
            },
            "gains": {"heater": {"column": "P"}},
        },
        "hall": {"infiltration": {"constant": 0.4, "density": "zone"}},
    }
    hatch = {"between": ["room", "hall"], "flow": 0.05, "density": "zone"}
    building = box(zones, air_paths={"hatch": hatch})
    wave = np.sin(hours(2) / 9000.0)
    weather = climate(2, outdoor=5 + 8 * wave, P=500.0 + 300.0 * wave)
    outputs = ["room.air_temperature", "hall.air_temperature"]
    simulation = Simulation(building, weather, step="15min", outputs=outputs)
    paths = [
        "zones.room.infiltration.constant",
        "zones.room.infiltration.wind",
        "zones.room.ventilation.fan.air_changes",
        "zones.room.ventilation.fan.density.constant",
        "zones.room.ventilation.duct.flow",
        "zones.room.gains.heater.factor",
        "zones.hall.infiltration.constant",
        "air_paths.hatch.flow",
        "zones.room.volume",
        "site.altitude",
    ]
    slopes = simulation.gradient(Mean("hall.air_temperature")).slopes
    forward = simulation.jacobian(paths)
    for path in paths:
        value = building.parameter(path).value
        step = 1e-4 * value
        runs = [simulation.run({path: value + sign * step})["hall.air_temperature"] for sign in (1, -1)]
        difference = float(runs[0].mean() - runs[1].mean()) / (2 * step)
        assert slopes[path] == pytest.approx(difference, rel=2e-4, abs=1e-7), path
        column = float(forward["d hall.air_temperature"].sel(parameter=path).mean())
        assert column == pytest.approx(difference, rel=2e-4, abs=1e-7), path


def test_flows_of_different_air_do_not_balance() -> None:
    """0.02 m3/s in at 1.2 kg/m3 and out at the density of the site, or as the air of the zone: refused."""

    def fan(supply: Any, exhaust: Any) -> Building:
        unit = {"supply": {"room": supply}, "exhaust": {"room": exhaust}}
        return box({"room": {"held": 20}}, ventilation_units={"unit": unit})

    at = {"flow": 0.02, "density": 1.2}
    with pytest.raises(InputError, match=r"as much air in as out(?s:.)*do not balance each other"):
        fan(at, 0.02)
    with pytest.raises(InputError, match="volumes at 'density: outdoors'"):
        fan({"flow": 0.02, "density": "outdoors"}, {"flow": 0.02, "density": "zone"})
    building = fan(at, {"flow": 0.02 * 1.2 / density(box({"room": {}}).site)})
    assert "counted as a volume of air of 1.2 kg/m3" in "\n".join(check(building))


@pytest.mark.parametrize(
    ("density", "text"), [("indoors", "site"), (0, "above 0"), ({"kind": "constant"}, "constant")]
)
def test_refused_densities(density: Any, text: str) -> None:
    with pytest.raises(InputError, match=text):
        box({"room": {"infiltration": {"constant": 1, "density": density}}})


def test_a_door_has_no_density() -> None:
    door = {"between": ["a", "b"], "door": {"width": 1, "height": 2}, "density": "zone"}
    with pytest.raises(InputError, match="door and density"):
        box({"a": {}, "b": {}}, air_paths={"door": door})


@pytest.mark.parametrize("choice", ["site", "outdoors", "zone", 1.2, {"value": 1.2, "range": [1.1, 1.3]}])
def test_a_description_is_read_back_as_written(choice: Any) -> None:
    building = box({"room": {"infiltration": {"constant": 1, "density": choice}}})
    assert Building.from_dict(building.to_dict()) == building

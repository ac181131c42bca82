"""People: their sensible heat and their vapour by the temperature of the air."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy.optimize import brentq

import mascarin as mc
from mascarin.building.checks.humidity import humidity_warnings
from mascarin.building.checks.overview import check
from mascarin.building.parts.site_air import density
from mascarin.errors import InputError
from mascarin.physics import AIR_SPECIFIC_HEAT, LATENT_HEAT
from mascarin.simulation.preparation.objectives import Mean
from mascarin.simulation.simulation import Simulation
from simulation_samples import hours
from test_flow_density import OUTDOOR, UA, climate, run
from test_simulation_zones import box, last

POWER, ACTIVITY = 2400.0, 120.0


def crowded(radiative: float = 0.0, **more: Any) -> Any:
    people = {"power": POWER, "activity": ACTIVITY, "radiative": radiative}
    return box({"room": {"infiltration": 1.0, "gains": {"people": people}}}, **more)


def sensible_share(m: float, t: float) -> float:
    """Sensible part of the heat of a person, term by term from the coefficients of the source. [-]"""
    constant = 6.461927 + 0.946892 * m + 0.0000255737 * m * m
    linear = 7.139322 - 0.0627909 * m + 0.0000589172 * m * m
    square = -0.198550 + 0.000940018 * m - 0.00000149532 * m * m
    return float(np.clip((constant + linear * t + square * t * t) / m, 0.0, 1.0))


@pytest.mark.parametrize(
    ("air", "share"), [(-40.0, 1.0), (-5.0, 1.0), (24.0, None), (31.0, None), (45.0, 0.0)]
)
def test_the_heat_of_people_in_air_of_a_temperature(air: float, share: float | None) -> None:
    """The load of a held room: all of their heat in the cold, none in the heat, the formula between."""
    room: dict[str, Any] = {"infiltration": 1.0, "held": air}
    people = {"power": POWER, "activity": ACTIVITY}
    loads = [
        last(results, "room.heating_load") - last(results, "room.cooling_load")
        for results in (run(box({"room": room})), run(box({"room": room | {"gains": {"people": people}}})))
    ]
    expected = POWER * (sensible_share(ACTIVITY, air) if share is None else share)
    assert loads[0] - loads[1] == pytest.approx(expected, rel=1e-6, abs=1e-4)


@pytest.mark.parametrize("radiative", [0.0, 0.3])
def test_a_room_settles_where_people_give_what_it_loses(radiative: float) -> None:
    """``P s(T) = (UA + V rho c)(T - T_out)``; what is radiated reaches the air by the wall's own surface."""
    building = crowded(radiative)
    results = run(building)
    passing = density(building.site) * 50 / 3600 * AIR_SPECIFIC_HEAT

    def lack(air: float) -> float:
        heat = POWER * sensible_share(ACTIVITY, air)
        # A radiated watt leaves by the wall without the inside film between: the share that stays inside.
        film = 30 * 4.0
        outward = 30 / (0.1 / 0.04 + 1 / 20)
        inward = film / (film + outward)
        to_air = heat * (1 - radiative) + heat * radiative * inward
        return to_air - (UA + passing) * (air - OUTDOOR)

    balance = brentq(lack, -10.0, 60.0, xtol=1e-10)
    assert 20.0 < balance < 36.0
    assert last(results, "room.air_temperature") == pytest.approx(balance, abs=2e-3)
    assert results.energy.closure < 1e-9


def test_their_vapour_is_the_other_part() -> None:
    """Held at 24 degC, less heating and more vapour outdoors add up to all heat of people."""
    people = {"power": POWER, "activity": ACTIVITY}
    building = box(
        {"room": {"infiltration": 5.0, "held": 24.0, "gains": {"people": people}}},
        humidity={"zones": {"room": {"gains": {"people": people}}}},
    )
    results = run(building)
    ratio = last(results, "room.humidity_ratio")
    dry_air = density(building.site) * 5.0 * 50 / 3600
    outdoors = run(box({"room": {"infiltration": 5.0, "held": 24.0}}, humidity={}))
    before = last(outdoors, "room.humidity_ratio")
    latent = dry_air * (ratio - before) * LATENT_HEAT
    sensible = last(outdoors, "room.heating_load") - last(results, "room.heating_load")
    share = sensible_share(ACTIVITY, 24.0)
    assert sensible == pytest.approx(POWER * share, rel=1e-6)
    assert latent == pytest.approx(POWER * (1.0 - share), rel=2e-3)


def test_slopes_and_members() -> None:
    """Slopes are those of differences, forward and reverse; members equal runs bit for bit."""
    building = crowded(0.3)
    wave = np.sin(hours(2) / 9000.0)
    output = "room.air_temperature"
    simulation = Simulation(building, climate(2, outdoor=8 + 8 * wave), step="15min", outputs=[output])
    paths = ["zones.room.gains.people.power", "zones.room.gains.people.activity"]
    slopes = simulation.gradient(Mean(output)).slopes
    forward = simulation.jacobian(paths)
    runs = {}
    for path in paths:
        value = building.parameter(path).value
        step = 1e-4 * value
        ends = [simulation.run({path: value + sign * step})[output] for sign in (1, -1)]
        runs[path] = ends[0]
        difference = float(ends[0].mean() - ends[1].mean()) / (2 * step)
        assert slopes[path] == pytest.approx(difference, rel=2e-4), path
        column = float(forward[f"d {output}"].sel(parameter=path).mean())
        assert column == pytest.approx(difference, rel=2e-4), path
    values = {path: building.parameter(path).value for path in paths}
    points = pd.DataFrame([values | {path: value * (1 + 1e-4)} for path, value in values.items()])
    members = mc.sweep(building, simulation.climate, points, step="15min", outputs=[output])
    for row, path in enumerate(paths):
        np.testing.assert_array_equal(np.asarray(members[output][row]), np.asarray(runs[path]))


@pytest.mark.parametrize(
    ("gain", "words"),
    [
        ({"power": 100, "activity": 20}, "70"),
        ({"rate": 1e-5, "activity": 120}, "power"),
    ],
)
def test_what_is_no_activity_is_refused(gain: dict[str, Any], words: str) -> None:
    """Below the tables of people, and vapour that is no heat."""
    zones: dict[str, Any] = {"room": {}}
    humidity: dict[str, Any] = {"zones": {"room": {"gains": {"people": gain}}}}
    with pytest.raises(InputError, match=words):
        box(zones, humidity=humidity)


def test_people_who_are_stated_in_one_section_alone_are_said() -> None:
    """Heat and vapour of the same people stand in two sections: a difference is a warning."""
    people = {"power": POWER, "activity": ACTIVITY}
    both = {"room": {"gains": {"people": people}}}
    apart = "do not belong together"
    same = box(both, humidity={"zones": both})
    assert not any(apart in line for line in humidity_warnings(same))
    for zones, humid in ((both, {}), ({"room": {}}, {"zones": both})):
        (line,) = [line for line in humidity_warnings(box(zones, humidity=humid)) if apart in line]
        assert "2400 W" in line
        assert "0 W" in line
    assert any("from people at 120 W each, sensible part" in line for line in check(same))
    assert any("from people at 120 W each, latent part" in line for line in check(same))


def test_people_with_two_schedules_are_said() -> None:
    """The same power by other hours; schedules of other names with the same values are the same."""
    schedules = {
        name: {"kind": "fraction", "days": {"all": [{"at": "00:00", "value": 0}, {"at": hour, "value": 1}]}}
        for name, hour in (("office", "08:00"), ("work", "08:00"), ("night", "20:00"))
    }
    apart = "do not come at the same time"

    def said(heat: str | None, vapour: str | None) -> list[str]:
        people = {"power": POWER, "activity": ACTIVITY}
        zones, humid = (
            {"room": {"gains": {"people": people if name is None else people | {"schedule": name}}}}
            for name in (heat, vapour)
        )
        building = box(zones, humidity={"zones": humid}, schedules=schedules)
        return [line for line in humidity_warnings(building) if apart in line]

    assert said("office", "office") == said(None, None) == said("office", "work") == []
    (line,) = said("office", "night")
    assert "(night, office)" in line
    (line,) = said("office", None)
    assert "(no schedule, office)" in line

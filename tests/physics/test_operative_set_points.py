"""Set points that hold an operative temperature: closed forms, derivatives, several zones."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest

import mascarin as mc
from mascarin.building import Building
from mascarin.errors import InputError
from mascarin.simulation.preparation.objectives import Mean
from mascarin.weather import Climate
from test_boundary_freedom import weather

#: Films [W/(m2 K)], resistance of the wall [m2 K/W], its area [m2] and the set point [degC].
INSIDE, OUTSIDE, RESISTANCE, AREA, HELD = 3.0, 20.0, 2.0, 40.0, 21.0
#: Outdoor air [degC].
OUTDOORS = -5.0
#: Emissivity of the wall, and the slope of black emission at 20 degC, 4 sigma T^3 [W/(m2 K)].
EMISSIVITY, SLOPE = 0.9, 4.0 * 5.670374419e-8 * 293.15**3


def cell(share: float | None, radiative: float = 0.0, rooms: int = 1) -> dict[str, Any]:
    """Cells of one light wall each, with heating; two of them share a wall."""
    wall = {
        "construction": "wall", "area": AREA, "tilt": 90, "azimuth": 0,
        "outside": {"outdoors": True, "convection": OUTSIDE, "longwave": "none", "absorptance": 0.5},
    }  # fmt: skip
    inside = {"convection": INSIDE, "emissivity": EMISSIVITY, "absorptance": 0.5}
    zone: dict[str, Any] = {"volume": 50, "heating": {"setpoint": HELD}}
    if radiative:
        zone["heating"]["radiative"] = radiative
    if share is not None:
        zone["setpoint_radiant_share"] = share
    d: dict[str, Any] = {
        "name": "cell",
        "site": {"latitude": 48, "longitude": 10, "altitude": 0, "timezone": "UTC+1"},
        "materials": {"wool": {"conductivity": 0.05, "density": 20, "specific_heat": 1000}},
        "constructions": {"wall": {"layers": [{"material": "wool", "thickness": 0.05 * RESISTANCE}]}},
        "zones": {f"z{k}": copy.deepcopy(zone) for k in range(rooms)},
        "surfaces": {f"s{k}": wall | {"inside": {"zone": f"z{k}"} | inside} for k in range(rooms)},
    }
    if rooms == 2:
        sides = {"outside": {"zone": "z0"} | inside, "inside": {"zone": "z1"} | inside}
        d["surfaces"]["between"] = {"construction": "wall", "area": 10, "tilt": 90, "azimuth": 90, **sides}
    return d


def closed_load(outdoors: float, share: float, radiative: float) -> float:
    """Load of the cell in steady state [W]: the wall, and what the held temperature sees of the film.

    With the load ``P = A q``, ``q = U' (T_s - T_o)`` and ``h (T_a - T_s) = (1 - f) q`` the held
    temperature is ``(1 - s) T_a + s (T_s + f q/(e h_r))``.
    """
    wall = RESISTANCE + 1.0 / OUTSIDE
    seen = (1.0 - share) * (1.0 - radiative) / INSIDE + share * radiative / (SLOPE * EMISSIVITY)
    return AREA * (HELD - outdoors) / (wall + seen)


@pytest.mark.parametrize("share", [0.0, 0.3, 0.5, 0.9])
@pytest.mark.parametrize("radiative", [0.0, 0.4])
@pytest.mark.parametrize("scheme", ["sdirk2", "backward-euler", "linearly-implicit"])
def test_the_load_of_a_steady_cell_is_the_closed_one(share: float, radiative: float, scheme: Any) -> None:
    run = mc.simulate(
        Building.from_dict(cell(share, radiative)), _cold(), step="1h", scheme=scheme,
        outputs=["z0.heating_load", "z0.air_temperature", "z0.mean_radiant_temperature"],
    )  # fmt: skip
    last = run["z0.heating_load"].to_numpy()[-1]
    assert last == pytest.approx(closed_load(OUTDOORS, share, radiative), rel=1e-6)
    held = (1 - share) * run["z0.air_temperature"] + share * run["z0.mean_radiant_temperature"]
    assert np.abs(held - HELD).max() < 1e-4
    assert run.energy.relative_residual < 1e-10


@pytest.mark.parametrize("capacity", [None, 1e9])
@pytest.mark.parametrize(("plant", "sign"), [("heating", 1.0), ("cooling", -1.0)])
def test_an_emitter_gives_no_more_than_the_surfaces_emit(plant: str, sign: float, capacity: Any) -> None:
    """``e A sigma T^4`` at 20 degC, a fourth of T in the mean radiant temperature: 95 % radiation."""
    d = cell(None)
    del d["zones"]["z0"]["heating"]
    d["zones"]["z0"][plant] = {"setpoint": 20.0 + sign * 30.0, "radiative": 0.95}
    if capacity:
        d["zones"]["z0"][plant]["capacity"] = capacity
    outputs = ["z0.net_load", "z0.mean_radiant_temperature", "s0.inside_temperature"]
    run = mc.simulate(Building.from_dict(d), _cold(), step="1min", outputs=outputs, initial=20.0)
    load, radiant, surface = run.records.T
    emitted = EMISSIVITY * AREA * 5.670374419e-8 * 293.15**4
    assert (sign * load).max() == pytest.approx(emitted / 0.95, rel=1e-9)
    assert (sign * (radiant - surface)).max() == pytest.approx(293.15 / 4.0, rel=1e-9)
    assert run.energy.relative_residual < 1e-10


def test_without_a_share_the_air_is_held() -> None:
    """The same numbers as in a building that says nothing; with a share of 0 the air is held, too."""
    runs = [mc.simulate(Building.from_dict(cell(share)), _cold(), step="1h") for share in (None, 0.0)]
    assert runs[0]["z0.air_temperature"].to_numpy()[-1] == pytest.approx(HELD, abs=1e-9)
    assert runs[1].records == pytest.approx(runs[0].records, abs=1e-4)


@pytest.mark.parametrize("radiative", [0.0, 0.4])
def test_two_rooms_are_held_together(radiative: float) -> None:
    """Rooms alike have the same load; of 17 and 21 degC each is held."""
    d = cell(0.5, radiative, rooms=2)
    names = [f"z{k}.{name}" for k in (0, 1) for name in ("heating_load", "operative_temperature")]
    run = mc.simulate(Building.from_dict(d), _cold(), step="1h", outputs=names)
    seen = [run[name].to_numpy()[-1] for name in names]
    assert seen[1] == pytest.approx(HELD, abs=1e-6)
    assert seen[3] == pytest.approx(HELD, abs=1e-6)
    assert seen[0] == pytest.approx(seen[2], rel=1e-9)
    d["zones"]["z1"]["heating"]["setpoint"] = 17
    run = mc.simulate(Building.from_dict(d), _cold(), step="1h", outputs=names)
    assert np.abs(run["z0.operative_temperature"] - HELD).max() < 1e-4
    assert np.abs(run["z1.operative_temperature"] - 17).max() < 1e-4
    assert run.energy.relative_residual < 1e-10


@pytest.mark.parametrize("radiative", [0.0, 0.4])
def test_the_slope_of_a_steady_load_is_the_closed_one(radiative: float) -> None:
    """``dP/ds = P ((1 - f)/h - f/(e h_r))/(1/U' + ...)``, exactly."""
    share, path = 0.4, "zones.z0.setpoint_radiant_share"
    simulation = mc.Simulation(
        Building.from_dict(cell(share, radiative)), _cold(), step="1h", outputs=["z0.heating_load"]
    )
    load = closed_load(OUTDOORS, share, radiative)
    by_share = (1.0 - radiative) / INSIDE - radiative / (SLOPE * EMISSIVITY)
    expected = load**2 / (AREA * (HELD - OUTDOORS)) * by_share
    slope = simulation.jacobian([path])["d z0.heating_load"].sel(parameter=path).to_numpy()[-1]
    assert slope == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("radiative", [0.0, 0.4])
def test_slopes_agree_with_differences(radiative: float) -> None:
    """Forward and reverse, by the share, the set point, the radiative part, a film and an emissivity."""
    d = cell(0.4, radiative, rooms=2)
    d["zones"]["z1"] |= {"cooling": {"setpoint": 22}, "gains": {"lamp": {"power": 2500, "radiative": 0.3}}}
    paths = ["zones.z0.setpoint_radiant_share", "zones.z1.setpoint_radiant_share"]
    paths += ["zones.z0.heating.setpoint.temperature", "surfaces.s1.inside.convection.coefficient"]
    paths += ["surfaces.s0.inside.emissivity", *(["zones.z0.heating.radiative"] if radiative else [])]
    names = ["z0.heating_load", "z1.cooling_load", "z1.mean_radiant_temperature"]
    options: dict[str, Any] = {"step": "1h", "initial": 12.0, "end": "2001-01-02"}
    simulation = mc.Simulation(Building.from_dict(d), _cold(), outputs=names, **options)
    slopes = simulation.jacobian(paths)
    values = {path: float(simulation.building.parameter(path).value) for path in paths}
    for path in paths:
        step = 2e-3 * max(values[path], 0.1)
        high, low = (simulation.run({path: values[path] + sign * step}) for sign in (1, -1))
        for name in names:
            expected = (high[name].to_numpy() - low[name].to_numpy()) / (2 * step)
            found = slopes[f"d {name}"].sel(parameter=path).to_numpy()
            scale = max(float(np.abs(expected).max()), 1e-3)
            assert np.abs(found - expected).max() < 5e-4 * scale, (path, name)
    for name in names:
        gradient = simulation.gradient(Mean(name))
        for path in paths:
            forward = float(slopes[f"d {name}"].sel(parameter=path).mean())
            assert gradient.slopes[path] == pytest.approx(forward, rel=1e-8, abs=1e-9), (path, name)


def test_members_of_an_ensemble_have_the_bits_of_runs_alone() -> None:
    building = Building.from_dict(cell(0.4, 0.3, rooms=2))
    samples = {"zones.z0.setpoint_radiant_share": [0.0, 0.2, 0.5, 0.7, 0.9]}
    options: dict[str, Any] = {"outputs": ["z0.heating_load", "z1.heating_load"], "step": "1h"}
    members = mc.sweep(building, _cold(), samples, **options)
    simulation = mc.Simulation(building, _cold(), **options)
    for k, share in enumerate(samples["zones.z0.setpoint_radiant_share"]):
        alone = simulation.run({"zones.z0.setpoint_radiant_share": share})
        for name in options["outputs"]:
            np.testing.assert_array_equal(members[name].isel(member=k).to_numpy(), alone[name].to_numpy())


def test_an_emitter_is_in_the_mean_radiant_temperature() -> None:
    """A watt radiated into the cell adds ``1/(e A h_r)`` to the mean of its surfaces."""
    radiative = 0.6
    names = ["heating_load", "mean_radiant_temperature", "operative_temperature", "air_temperature"]
    run = mc.simulate(
        Building.from_dict(cell(None, radiative)), _cold(), step="1h",
        outputs=[f"z0.{name}" for name in names] + ["s0.inside_temperature"],
    )  # fmt: skip
    load, radiant, operative, air, surface = run.records[-1]
    rise = radiative * load / (EMISSIVITY * AREA * SLOPE)
    assert rise > 1.0
    assert radiant - surface == pytest.approx(rise, rel=1e-6)
    assert operative == pytest.approx(0.5 * (air + radiant), abs=1e-9)


def test_a_share_that_acts_on_nothing_is_refused() -> None:
    d = cell(0.5)
    del d["zones"]["z0"]["heating"]
    with pytest.raises(InputError, match="zone without heating and cooling"):
        Building.from_dict(d)
    d = cell(0.5)
    d["zones"]["hall"] = {"volume": 30, "heating": {"setpoint": 20}, "setpoint_radiant_share": 0.5}
    with pytest.raises(InputError, match="a zone that no surface faces"):
        Building.from_dict(d)
    with pytest.raises(InputError, match="setpoint_radiant_share"):
        Building.from_dict(cell(0.95))


def _cold() -> Climate:
    """Three days of constant cold without sun and wind."""
    return weather(3, air=OUTDOORS)

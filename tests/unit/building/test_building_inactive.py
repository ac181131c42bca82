"""Numbers without effect have a reason, and no others."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from building_samples import everything, room
from mascarin import _engine
from mascarin.building import Building
from mascarin.building.outputs import locations
from mascarin.building.parts import measured_sun


def inactive(building: Building) -> dict[str, str]:
    return {p.path: p.reason for p in building.parameters() if p.reason and not p.structural}


def test_in_a_room() -> None:
    assert set(inactive(room())) == {
        *(f"site.wind.{key}" for key in ("mast_height", "mast_exponent", "mast_layer", "exponent", "layer")),
        "surfaces.rest.azimuth",
        "surfaces.rest.tilt",
    }


def test_in_everything() -> None:
    assert set(inactive(everything()[0])) == {
        "surfaces.ceiling.azimuth",
        "surfaces.ceiling.inside.convection.downward.c",
        "surfaces.ceiling.inside.convection.downward.m",
        "surfaces.ceiling.inside.convection.upward.c",
        "surfaces.ceiling.inside.convection.upward.m",
        "surfaces.ceiling.tilt",
        "surfaces.east.outside.emissivity",
        "surfaces.floor.azimuth",
        "surfaces.floor.inside.convection.wind",
        "surfaces.floor.tilt",
        "surfaces.held.azimuth",
        "surfaces.held.tilt",
        "surfaces.mass.azimuth",
        "surfaces.mass.tilt",
        "surfaces.north.azimuth",
        "surfaces.north.tilt",
        "glazings.clear.panes.2.emissivity.outside",
        "windows.hatch.cavity_height",
        "windows.hatch.outside.height",
        "windows.light.cavity_height",
        "windows.pane.outside.height",
    }


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"site.sky": "offset"}, "site.cloud.c1"),
        ({"surfaces.south.outside.longwave": "none"}, "site.sky.a"),
        ({"surfaces.south.outside.longwave": "none"}, "surfaces.south.outside.emissivity"),
        ({"surfaces.south.outside.irradiance": "G"}, "site.ground_reflectance"),
        ({"surfaces.south.tilt": 0}, "site.ground_reflectance"),
        ({"surfaces.south.tilt": 0}, "surfaces.south.azimuth"),
        ({"surfaces.south.outside.height": 2}, "surfaces.south.outside.height"),
        ({"zones.room.longwave": "none"}, "surfaces.south.inside.emissivity"),
    ],
)
def test_a_choice_makes_numbers_inactive(changes: dict[str, object], path: str) -> None:
    assert path in inactive(room().replace(changes))
    assert path not in inactive(room())


@pytest.mark.parametrize("film", ["mowitt", "doe2"])
def test_a_height_and_a_wind_correlation_make_the_profile_active(film: str) -> None:
    building = room().replace({"surfaces.south.outside.convection": film, "surfaces.south.outside.height": 2})
    assert set(inactive(building)) == {"surfaces.rest.azimuth", "surfaces.rest.tilt"}


def weather(channels: list[str], steps: int) -> npt.NDArray[np.float64]:
    """Two warm days on the southern tropic in steps of a quarter of an hour, made up."""
    hour = 0.25 * np.arange(steps)
    swing, sun = np.sin(np.pi * (hour - 9) / 12), np.sin(np.pi * (hour - 6) / 12)
    up = np.clip(sun, 0, None)
    east = np.cos(np.pi * (hour - 6) / 12)
    length = np.sqrt(east**2 + 0.3**2 + sun**2)
    scheduled = {
        "schedule day": 0.5 + 0.3 * swing,
        "schedule always": np.full(steps, 0.9),
        "schedule cool": 26 - swing,
        "schedule warm": np.full(steps, 25.0),
    }
    columns = [
        *(24 + 5 * swing, 15 + 2 * swing, 4 + 2 * swing, 380 + 20 * swing),
        *(3 + 2 * swing, (15 * hour) % 360, np.full(steps, 101_000.0)),
        *(800.0 * (up > 0), 100 * up, 900 * up, np.full(steps, 1367.0)),
        *(east / length, 0.3 / length, sun / length, 200 + hour / 24),
        *(300 * up if name.startswith("G") else scheduled.get(name, 24 + 4 * swing) for name in channels),
    ]
    return np.ascontiguousarray(
        np.stack(np.broadcast_arrays(*columns), axis=-1)[:, None, :].repeat(2, axis=1)
    )


@pytest.mark.parametrize("case", range(len(everything())))
def test_the_engine_agrees(case: int) -> None:
    """Each number, varied within its range, changes a result or the energy balance, or has a reason."""
    building = everything()[case]
    engine = building.to_engine(900)
    outputs = [{"kind": output.kind, **output.place} for output in building.outputs()]
    options = {
        "dt": 900.0,
        "scheme": "sdirk2",
        "initial": 24.0,
        "outputs": json.dumps(outputs),
        "warmup_steps": 0,
        "warmup_tolerance": 0.01,
        "warmup_max_cycles": 1,
        "record_from": 0,
        "record_every": 1,
    }
    plan, forcing = _engine.Plan(engine.json), weather(engine.channels, 96)
    moved = np.repeat(engine.values[None], 1 + len(engine.paths), axis=0)
    parameters = [building.parameter(path) for path in engine.paths]
    for row, parameter in enumerate(parameters):
        moved[row + 1, row] = parameter.high if parameter.high > parameter.value else parameter.low
    records, _, failures = plan.ensemble(moved, forcing, options)
    assert not failures
    changed = np.abs(records[1:] - records[0]).max(axis=(1, 2)) > 0.0

    def exchanged(values: npt.NDArray[np.float64]) -> dict[str, float]:
        return turnover(plan.simulate_into(values, forcing, options, 96, lambda _: None))

    nominal = exchanged(engine.values)
    for row, parameter in enumerate(parameters):
        if parameter.reason is None and not changed[row]:
            changed[row] = exchanged(moved[row + 1].copy()) != nominal
        # The engine's wind never falls below 1 mm/s, so that c V^m moves a result a little even in still air.
        calm = parameter.reason == "there is no wind on this side" and parameter.path.endswith(".c")
        # A nucleation needs a day on which all melts, which this weather need not have.
        calm |= ".hysteresis." in parameter.path
        assert calm or changed[row] == (parameter.reason is None), (parameter.path, parameter.reason)


def turnover(run: dict[str, Any]) -> dict[str, float]:
    """The ledger of a run [J]."""
    return {key: value for key, value in run.items() if isinstance(value, float)}


def test_all_surfaces_are_looked_through_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """However many ask: in a row of 1000 rooms, each of 5000 surfaces looked through all."""
    looked, sides = [0], measured_sun._sides

    def counted(building: Building) -> Any:
        looked[0] += 1
        return sides(building)

    monkeypatch.setattr(measured_sun, "_sides", counted)
    building = room()
    assert len(building.surfaces) > 1
    assert inactive(building)
    assert looked[0] <= 2  # for measured irradiances, and for their paths
    assert locations._lit_zones(building) is locations._lit_zones(building)

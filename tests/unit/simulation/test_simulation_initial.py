"""The initial state: given or measured temperatures, and linear interpolation for the rest."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from mascarin import cli
from mascarin.building import Building
from mascarin.errors import InputError
from mascarin.examples import STUDIES
from mascarin.simulation.preparation.initial import MeasuredStart
from mascarin.simulation.preparation.initial_state import (
    Ambient,
    GivenStart,
    InitialTemperatures,
    Known,
    given,
    profile,
    walls,
)
from mascarin.simulation.run import simulate
from mascarin.simulation.simulation import Simulation
from mascarin.study import Study
from mascarin.verification.analytical import setup
from mascarin.weather import Climate, Measurements
from simulation_samples import LINEAR, measured, read, weather
from study_support import BUILDING, STUDY, Bench, logger_table

#: A wall of two materials and a resistance between two surfaces of given temperature.
WALL = """\
materials:
  foam: {conductivity: 0.03, density: 30, specific_heat: 1400}
  stone: {conductivity: 1.5, density: 2000, specific_heat: 900}
  gap: {kind: resistance, resistance: 0.18}
constructions:
  wall: {layers: [{material: stone, thickness: 0.15}, {material: gap}, {material: foam, thickness: 0.06}]}
surfaces:
  wall: {construction: wall, area: 1, tilt: 90, outside: {measured: warm}, inside: {measured: cold}}
sensors: {stone: {surface: wall, depth: 0.07}, foam: {surface: wall, depth: 0.19}}
"""

WAX = """\
materials:
  wax: {kind: pcm, density: 800, conductivity: [0.25, 0.15], specific_heat: 2000, latent_heat: 2.0e+5,
        melting_temperature: 26, law: {kind: linear, width: 1},
        hysteresis: {model: curve_track, freezing_temperature: 22}}
constructions: {slab: {layers: [{material: wax, thickness: 0.01, nodes: 4}]}}
surfaces:
  slab: {construction: slab, area: 1, tilt: 0, outside: {measured: face}, inside: {adiabatic: true}}
"""

GLAZED = """\
name: glazed
site: {latitude: 40, longitude: 0, altitude: 0, timezone: UTC, sky: {kind: offset, depression: 10}}
materials: {stone: {conductivity: 1.5, density: 2000, specific_heat: 900}}
constructions: {wall: {layers: [{material: stone, thickness: 0.2, nodes: 3}]}}
glazings:
  triple: {kind: panes, panes: [{thickness: 0.004, emissivity: 0.84, transmittance: 0.83, reflectance: 0.075},
                   {thickness: 0.004, emissivity: 0.84, transmittance: 0.83, reflectance: 0.075,
                    density: 2500, specific_heat: 750},
                   {thickness: 0.004, emissivity: 0.84, transmittance: 0.83, reflectance: 0.075}],
           gaps: [{thickness: 0.016, gas: argon}, {conductance: 4}]}
  rated: {kind: simple, u_value: 1.1, solar_heat_gain: 0.6}
zones: {room: {volume: 40}}
surfaces:
  front: {construction: wall, area: 20, tilt: 90, azimuth: 180,
          outside: {outdoors: true, convection: 15, emissivity: 0.9, absorptance: 0.5},
          inside: {zone: room, convection: 3, emissivity: 0.9, absorptance: 0.5}}
  inner: {construction: wall, area: 20, tilt: 90, azimuth: 0,
          outside: {adiabatic: true},
          inside: {zone: room, convection: 3, emissivity: 0.9, absorptance: 0.5}}
windows:
  big: {glazing: triple, surface: front, area: 4, frame: {fraction: 0.2, u_value: 2},
        outside: {convection: 15}, inside: {convection: 3}}
  small: {glazing: rated, surface: front, area: 1, outside: {convection: 15}, inside: {convection: 3}}
"""

NOW = Ambient(outdoors=4.0, day=15.0, columns={"yard": 10.0})


@pytest.fixture(scope="module")
def linear(tmp_path_factory: pytest.TempPathFactory) -> Building:
    return read(LINEAR, tmp_path_factory.mktemp("linear"))


@pytest.fixture(scope="module")
def climate() -> Climate:
    return weather(3, **measured(3))


def laid(building: Building, **known: Any) -> tuple[dict[str, list[float]], dict[str, float]]:
    """Temperatures of the cells of each surface and window, and of the airs."""
    nodes = building.to_engine(3600.0, {}).nodes
    found = walls(building, nodes)
    start = profile(building, found, given(GivenStart(**known), found, building), NOW)
    cells = iter(start.cells)
    parts = {wall.name: [next(cells) for _ in wall.cells] for wall in found}
    assert next(cells, None) is None
    return parts, dict(zip(building.zones, start.air, strict=True))


# --- given ---


def test_a_steady_profile_stays() -> None:
    held = setup.climate(3600.0, {"warm": np.full(49, 41.0), "cold": np.full(49, 13.0)})
    outputs = ["stone.temperature", "foam.temperature", "wall.interface_1_temperature", "wall.inside_flux"]
    run = simulate(
        setup.building(WALL), held, step="1h", end=held.index[-1],
        outputs=outputs, initial={"surfaces": {"wall": [41.0, 13.0]}},
    )  # fmt: skip
    whole = 0.15 / 1.5 + 0.18 + 0.06 / 0.03
    line = [41.0 - 28.0 * r / whole for r in (0.07 / 1.5, 0.28 + 0.04 / 0.03, 0.1)]
    assert np.abs(run.records - [*line, 28.0 / whole]).max() < 1e-9
    assert run.provenance.start.startswith("given: wall 41 to 13 degC; all others")
    assert "from below" not in run.provenance.start


def test_one_temperature_for_each_zone_and_surface_is_one_everywhere(
    linear: Building, climate: Climate
) -> None:
    everywhere = simulate(linear, climate, step="1h", initial=21)
    each = {"zones": {"sunny": 21, "shady": 21}, "surfaces": dict.fromkeys(linear.surfaces, 21)}
    assert np.array_equal(simulate(linear, climate, step="1h", initial=each).records, everywhere.records)


def test_temperatures_that_are_not_given_are_interpolated(linear: Building) -> None:
    parts, air = laid(linear, zones={"sunny": 24.0, "shady": 18.0}, surfaces={"roof": [30.0, 20.0]})
    assert air == {"sunny": 24.0, "shady": 18.0}
    board, foam = 0.012 / 0.16, 0.05 / 0.03
    whole = board + foam + 0.15 + board
    first = 0.5 * board / linear.to_engine(3600.0, {}).nodes["wall", "board"]
    # Surface resistances of ISO 6946 outdoors and in the room; none at a surface of given temperature.
    assert parts["north"][0] == pytest.approx(4.0 + 20.0 * (0.04 + first) / (0.04 + whole + 0.13), abs=1e-12)
    assert parts["roof"][0] == pytest.approx(30.0 - 10.0 * first / whole, abs=1e-12)
    assert np.mean(parts["between"]) == pytest.approx(21.0, abs=1e-12)
    assert parts["south"][0] == pytest.approx(10.0 + 8.0 * (0.13 + first) / (0.13 + whole + 0.13), abs=1e-12)
    # The ground has a given temperature: no surface resistance.
    last = 0.5 * 0.125 / len(parts["floor"])
    assert parts["floor"][-1] == pytest.approx(14.0 + 4.0 * (0.125 - last) / (0.125 + 0.13), abs=1e-12)


@pytest.mark.parametrize(
    ("known", "airs"),
    [
        ({"zones": {"sunny": 26}}, {"sunny": 26.0, "shady": 26.0}),
        ({"zones": {"sunny": 26}, "default": 19}, {"sunny": 26.0, "shady": 19.0}),
        ({"default": 19, "surfaces": {"roof": 25}}, {"sunny": 19.0, "shady": 19.0}),
    ],
)
def test_airs_that_are_not_given(
    linear: Building, known: Mapping[str, Any], airs: Mapping[str, float]
) -> None:
    assert laid(linear, **known)[1] == airs


def test_windows_and_adiabatic_walls_have_a_start(tmp_path: Path) -> None:
    building = read(GLAZED, tmp_path)
    parts, _ = laid(building, zones={"room": 20.0}, surfaces={"big": [6.0, 18.0]})
    assert parts["inner"] == [20.0] * 3
    # The inner sides of its outer panes: 4 mm of glass behind surface resistances of 0.04 and 0.13 m2 K/W.
    inner = 1 / 1.1 - 0.13 - 0.004
    assert parts["small"] == pytest.approx([4.0 + 16.0 * 1.1 * 0.044, 4.0 + 16.0 * 1.1 * inner], abs=1e-12)
    pane, gaps = 0.004, (0.17, 0.25)
    places = np.cumsum([pane, gaps[0], pane / 2, pane / 2, gaps[1]])
    whole = 3 * pane + sum(gaps)
    assert parts["big"] == pytest.approx(6.0 + 12.0 * places / whole, abs=1e-12)
    # The engine has as many cells, or it would refuse; after some hours the room has forgotten too.
    runs = [
        simulate(building, weather(1), step="10min", outputs=["big.inside_temperature"],
                 initial={"zones": {"room": 20}, "surfaces": {"front": 12, "inner": 20, "big": big}})
        for big in ([6, 18], [30, 30])
    ]  # fmt: skip
    difference = np.abs(runs[0].records - runs[1].records)[:, 0]
    assert difference[0] > 3.0
    assert difference[60] < 0.02


def test_a_phase_change_layer_starts_on_its_heating_curve() -> None:
    """Half molten at 26 degC, where the freezing curve is still liquid."""
    held = setup.climate(3600.0, {"face": np.full(25, 26.0)})
    run = simulate(
        setup.building(WAX), held, step="1h", end=held.index[-1],
        outputs=["slab.wax_liquid_fraction"], initial={"surfaces": {"slab": 26}},
    )  # fmt: skip
    assert run.records[0, 0] == pytest.approx(0.5, abs=1e-12)
    assert run.provenance.start.endswith("phase-change layers on the heating curve")


@pytest.mark.parametrize(
    ("initial", "words"),
    [
        ({"zones": {"suny": 21}}, "zones.suny: found 'suny'.*Did you mean 'sunny'"),
        ({"zones": {"sunny": 21}, "surfaces": {"rof": 21}}, "surfaces.rof.*Did you mean 'roof'"),
        ({"surfaces": {"roof": 21}}, "found no air temperature in sunny, shady"),
        ({"zones": {"sunny": 500}}, "zones.sunny"),
        ({"zones": {"sunny": True}}, "zones.sunny"),
        ({"surfaces": {"roof": [1, 2, 3]}}, "surfaces.roof"),
        ({"zone": {"sunny": 20}}, "the key 'zone'"),
        ({}, "found: no temperature"),
        ("measured", "a MeasuredStart"),
    ],
)
def test_an_impossible_start_is_refused(linear: Building, climate: Climate, initial: Any, words: str) -> None:
    with pytest.raises(InputError, match=rf"(?s)^initial.*{words}"):
        Simulation(linear, climate, initial=initial)


# --- ensembles and derivatives ---


def test_all_members_have_the_same_initial_state_and_derivatives_treat_it_as_constant(
    linear: Building, climate: Climate
) -> None:
    path = "materials.foam.conductivity"
    trial = Simulation(
        linear, climate, step="1h", end="2001-01-02", outputs=["sunny.air_temperature"],
        initial={"zones": {"sunny": 25, "shady": 17}},
    )  # fmt: skip
    nominal, nudge = linear.parameter(path).value, 1e-6
    vectors = np.array([trial.vector({path: nominal + d}) for d in (-nudge, 0.0, nudge)])
    records, _, failures = trial.ensemble(vectors)
    assert not failures
    assert (records[:, 0, 0] == 25.0).all()
    assert np.array_equal(records[1], trial.run().records)
    _, slopes = trial.jacobian_vector([path])
    middle = (records[2] - records[0]) / (2.0 * nudge)
    assert np.abs(slopes[0] - middle).max() < 1e-5 * np.abs(middle).max()
    trajectory = trial.trajectory()
    back = trajectory.pull(np.eye(1, 25, 24).T)[trial.position(path)]
    assert back == pytest.approx(slopes[0, 24, 0], rel=1e-9)


# --- measured ---

SENSORS = {
    "sunny.air_temperature": "sunny",
    "shady.air_temperature": ["shady a", "shady b"],
    "north.outside_temperature": "face",
    "deep.temperature": "deep",
    "between.inside_temperature": "partition",
    "north.inside_flux": "flux",
}


def table(**changes: object) -> Measurements:
    """A day of constant measurements every 15 min; changes replace columns."""
    index = pd.date_range("2001-01-01", periods=96, freq="15min", tz="UTC")
    values = {"sunny": 23.0, "shady a": 17.0, "shady b": 19.0, "face": 9.0, "deep": 15.0, "partition": 20.0}
    return Measurements.from_table(
        pd.DataFrame({**values, "flux": 3.0, **changes}, index=index), timezone="UTC"
    )


def test_a_measured_start_has_the_measured_temperatures(linear: Building, climate: Climate) -> None:
    late = np.full(96, 23.0)
    late[:3] = np.nan
    late[3] = 22.0  # the first value that there is
    one = np.full(96, 19.0)
    one[:5] = np.nan  # the other column stands for it
    start = MeasuredStart(table(sunny=late, **{"shady b": one}), SENSORS)
    trial = Simulation(linear, climate, step="1h", initial=start)
    initial = trial.initial
    assert isinstance(initial, InitialTemperatures)
    assert initial.air == (22.0, 17.0)
    wall = walls(linear, linear.to_engine(3600.0, {}).nodes)[0]
    at = wall.at_depth(0.03)
    assert at == pytest.approx(0.012 / 0.16 + 0.018 / 0.03)
    expected = np.interp(wall.cells, [0.0, at, wall.whole + 0.13], [9.0, 15.0, 22.0])
    assert initial.cells[: len(wall.cells)] == pytest.approx(expected, abs=1e-12)
    said = trial.run().provenance.start
    assert said.startswith(
        "measured from 2001-01-01 00:00: sunny.air_temperature 22, shady.air_temperature 17,"
    )
    assert "flux" not in said


def test_the_mean_of_sensors_at_one_place_is_used(linear: Building) -> None:
    found = walls(linear, linear.to_engine(3600.0, {}).nodes)
    ends = ((0.0, 20.0), (0.0, 24.0), (found[0].whole, 22.0))
    flat = profile(linear, found, Known({"sunny": 20.0}, {"north": ends}), NOW)
    assert flat.cells[: len(found[0].cells)] == pytest.approx([22.0] * len(found[0].cells))


@pytest.mark.parametrize(
    ("changes", "sensors", "words"),
    [
        (
            {"deep": np.nan},
            SENSORS,
            "no value of 'deep' .deep.temperature. within an hour from 2001-01-01 00:00",
        ),
        ({"face": 290.0}, SENSORS, "found 290 in 'face' .north.outside_temperature."),
        ({}, {"deep.temperature": "deep"}, "found no sensor in the air of sunny or shady"),
        ({}, {"sunny.air_temperature": "suny"}, "no measured column 'suny'"),
        ({}, {"suny.air_temperature": "sunny"}, "found no such output"),
    ],
)
def test_an_impossible_measured_start_is_refused(
    linear: Building, climate: Climate, changes: Mapping[str, Any], sensors: Mapping[str, Any], words: str
) -> None:
    with pytest.raises(InputError, match=words):
        Simulation(linear, climate, initial=MeasuredStart(table(**changes), sensors))


# --- studies ---


@pytest.fixture(scope="module")
def wall(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    folder = tmp_path_factory.mktemp("wall")
    (folder / "building.yaml").write_text(BUILDING, encoding="utf-8")
    (folder / "study.yaml").write_text(STUDY, encoding="utf-8")
    logger_table(folder / "building.yaml").to_csv(folder / "logger.csv")
    return Bench(folder)


def started(bench: Bench, name: str, initial: str, text: str | None = None) -> Path:
    study = bench.folder / name
    study.write_text(f"initial: {initial}\n" + (text or bench.study.read_text("utf-8")), "utf-8")
    return study


def test_a_study_starts_as_its_file_says(wall: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    for initial, words in (
        ("measured", "measured from 2023-03-01 00:00: wall.interface_1_temperature "),
        ("{surfaces: {wall: [3, 21]}}", "given: wall 3 to 21 degC; "),
    ):
        cli.main(["validate", str(started(wall, "started.yaml", initial)), "--json"])
        assert json.loads(capsys.readouterr().out)["start"].startswith(words)


@pytest.mark.parametrize(
    ("initial", "words"),
    [
        ("cold", "bad.yaml:1: initial\n  found: 'cold'\n  expected: repeat, measured, a temperature"),
        ("mesured", "Did you mean 'measured'"),
        ("{surfaces: {wal: 20}}", "bad.yaml:1: initial.surfaces.wal: found 'wal'.* Did you mean 'wall'"),
        ("{surfaces: {wall: [20, warm]}}", r"bad.yaml:1: initial.surfaces.wall.1\n  found: 'warm'"),
        ("{}", "bad.yaml:1: initial.zones\n  found: no temperature"),
        ("300", "bad.yaml:1: initial\n  found: 300"),
    ],
)
def test_a_study_with_a_bad_start_is_refused(wall: Bench, initial: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        Study(started(wall, "bad.yaml", initial))


def test_a_sensor_without_a_first_value_is_named(wall: Bench) -> None:
    logger = pd.read_csv(wall.folder / "logger.csv")
    logger.loc[:9, "core"] = np.nan
    logger.to_csv(wall.folder / "late.csv", index=False)
    text = wall.study.read_text("utf-8").replace("logger.csv", "late.csv")
    with pytest.raises(
        InputError, match=r"late.yaml:1: initial: found no value of 'core' .core.temperature."
    ):
        Study(started(wall, "late.yaml", "measured", text))
    shown = text.replace("uncertainty: 0.3", "uncertainty: 0.3, use: false")
    assert (
        "core"
        not in Study(started(wall, "shown.yaml", "measured", shown))
        .context.models.over_record()
        .run()
        .provenance.start
    )


def test_the_lgi_cell_starts_at_its_first_measured_values(tmp_path: Path) -> None:
    folder = STUDIES["lgi"].parent
    for name in ("building.yaml", "lgi_virtual.csv"):
        shutil.copy(folder / name, tmp_path)
    text = (folder / "study.yaml").read_text("utf-8")
    (tmp_path / "study.yaml").write_text("initial: measured\n" + text, "utf-8")
    study = Study(tmp_path / "study.yaml")
    simulation = study.context.models.over_record()
    run = Simulation(
        study.building, study.climate, step="15min", start=simulation.start, end="2010-08-01 06:00",
        outputs=[output.name for output in simulation.outputs], measurements=study.measurements,
        initial=study.context.models.initial,
    ).run()  # fmt: skip
    first = {
        name: study.measurements.at(sensor.columns[0], run.index[:1])[0]
        for name, sensor in study.plan.sensors.items()
    }
    start = {name: float(run.records[0, k]) for k, name in enumerate(first)}
    for name in ("room_air", "gap_air"):
        assert start[name] == first[name]
    # Faces balance with airs and radiation, half a cell from the line: 0.05 K on the ceiling.
    for name in ("plasterboard", "interface", "pcm_top", "steel"):
        assert start[name] == pytest.approx(first[name], abs=0.06)
    fraction = [output.name for output in run.outputs].index("ceiling.energain_liquid_fraction")
    assert 0.6 < run.records[0, fraction] < 0.9


def test_the_public_name() -> None:
    assert mc.MeasuredStart is MeasuredStart

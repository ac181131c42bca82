"""Units for co-simulation: what an importing program gets is what a run gives, to the bit."""

from __future__ import annotations

import zipfile
from pathlib import Path

import fmpy
import numpy as np
import pytest
import yaml
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu

from fmu_support import HOUR, Unit, heated, instance, simulated, undefined_symbols, winter
from mascarin import cli
from mascarin.building import Building
from mascarin.commands.options.tables import run_inputs
from mascarin.errors import InputError
from mascarin.examples import FOLDER
from mascarin.fmu import export
from mascarin.fmu.inputs import channels_of
from mascarin.fmu.units import BaseUnit, base_unit
from mascarin.simulation import Simulation
from test_openings import controlled, weather

LGI = FOLDER / "lgi"
STEP = 900.0


@pytest.fixture(scope="module")
def cell() -> Simulation:
    """The LGI cell over 92 days: phase change with hysteresis, two zones, beams of the sun."""
    from mascarin.building import load

    building = load(LGI / "building.yaml")
    climate, measured = run_inputs(
        building, LGI / "study.yaml", None, columns=[], timezone=None, stamps="start"
    )
    return Simulation(building, climate, measurements=measured, start="2010-08-01", end="2010-11-01")


@pytest.fixture(scope="module")
def room(tmp_path_factory: pytest.TempPathFactory) -> Simulation:
    """Heated room over two winter days."""
    outputs = [
        "room.air_temperature",
        "room.heating_load",
        "room.operative_temperature",
        "wall.inside_flux",
        "wall.incident_solar",
    ]
    building = heated(tmp_path_factory.mktemp("building"))
    return Simulation(building, winter(), step="30min", end="2024-01-12", outputs=outputs)


@pytest.fixture(scope="module")
def unit_file(room: Simulation, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The heated room, of which schedules and outdoor air are inputs."""
    file = tmp_path_factory.mktemp("unit") / "room.fmu"
    export(room, file, inputs=["schedules.*", "weather.air_temperature"])
    return file


def test_the_cell_is_that_of_a_run_over_92_days_to_the_bit(cell: Simulation, tmp_path: Path) -> None:
    file = tmp_path / "cell.fmu"
    export(cell, file)
    assert validate_fmu(str(file)) == []
    assert file.stat().st_size < 5e6
    assert np.array_equal(simulated(file, cell), cell.run().records)


def test_version_2_gives_the_same(room: Simulation, tmp_path: Path) -> None:
    file = tmp_path / "ü b.fmu"
    export(room, file, version="2.0")
    assert validate_fmu(str(file)) == []
    assert np.array_equal(simulated(file, room), room.run().records)
    with zipfile.ZipFile(file) as archive:
        library = next(name for name in archive.namelist() if name.startswith("binaries/"))
        assert not undefined_symbols(archive.read(library))


def test_vents_and_their_controls_are_those_of_a_run_to_the_bit(tmp_path: Path) -> None:
    """The network of pressures, the state of the controls, and the wind, which is an input of the unit."""
    building = controlled()
    names = ["a.air_temperature", "windward.inflow", "door.outflow", "night.open"]
    simulation = Simulation(building, weather(), step="15min", outputs=names)
    file = tmp_path / "vents.fmu"
    export(simulation, file, inputs=["weather.wind_speed"])
    expected = simulation.run().records
    assert set(expected[:, -1]) == {0.0, 1.0}
    assert np.array_equal(simulated(file, simulation), expected)


def test_a_block_of_soil_is_that_of_a_run_to_the_bit(tmp_path: Path) -> None:
    """The soil follows the weather that the unit was made with; the wind is an input."""
    tree = yaml.safe_load(heated(tmp_path).to_yaml())
    tree["soil_blocks"] = {
        "below": {
            "width": 5,
            "wall_thickness": 0.3,
            "conductivity": 1.5,
            "heat_capacity": 2.5e6,
            "before": {"mean": 6, "amplitude": 8, "coldest_day": 15},
        }
    }
    tree["surfaces"]["floor"] = {
        "construction": "wall",
        "area": 20,
        "tilt": 180,
        "outside": {"soil": "below"},
        "inside": {"zone": "room", "convection": 3, "emissivity": 0.9},
    }
    names = ["room.air_temperature", "room.heating_load", "floor.inside_temperature"]
    simulation = Simulation(Building.from_dict(tree), winter(), step="30min", end="2024-01-12", outputs=names)
    file = tmp_path / "soil.fmu"
    export(simulation, file, inputs=["weather.wind_speed"])
    expected = simulation.run().records
    assert np.ptp(expected[:, 2]) > 0.01
    assert np.array_equal(simulated(file, simulation), expected)


def test_only_schedules_as_inputs_give_the_run_to_the_bit(room: Simulation, tmp_path: Path) -> None:
    file = tmp_path / "room.fmu"
    export(room, file, inputs=["schedules.*"])
    channels = [channel for channel in channels_of(room) if channel.name.startswith("schedules.")]
    times = 2 * STEP * np.arange(len(room.compiled.forcing))
    columns = [("time", np.float64), *((channel.name, np.float64) for channel in channels)]
    signals = np.array(
        [
            (time, *(room.compiled.forcing[k, 0, channel.position] for channel in channels))
            for k, time in enumerate(times)
        ],
        dtype=columns,
    )
    # FMPy interpolates: at the times of the steps it gives the values themselves.
    assert np.array_equal(simulated(file, room, input=signals), room.run().records)


def test_inputs_without_a_signal_hold_the_first_values_of_their_tables(
    room: Simulation, tmp_path: Path
) -> None:
    """As the page says: the unit gives the run of a room whose schedules are constant."""
    file = tmp_path / "room.fmu"
    export(room, file, inputs=["schedules.*"])
    positions = [c.position for c in channels_of(room) if c.name.startswith("schedules.")]
    first = room.compiled.forcing[0, 0, positions]
    assert (room.compiled.forcing[:, :, positions] != first).any()
    held = simulated(file, room)
    names = [c.name for c in channels_of(room) if c.name.startswith("schedules.")]
    signals = np.array(
        [(0.0, *first), (1e9, *first)], dtype=[("time", float), *((name, float) for name in names)]
    )
    assert np.array_equal(held, simulated(file, room, input=signals))
    assert not np.array_equal(held, room.run().records)


def test_the_sun_as_inputs(room: Simulation, tmp_path: Path) -> None:
    """Without beam the sky is isotropic (Hay and Davies 1980): a wall gets half of it, and half of the fifth
    of the global radiation that the ground reflects, which follows from it."""
    file = tmp_path / "room.fmu"
    export(room, file, inputs=["weather.d*", "weather.air_temperature"])
    with instance(file) as unit:
        unit.start(**{"weather.direct_normal": 0.0, "weather.diffuse_horizontal": 100.0})
        assert "weather.infrared" not in unit.references
        unit.run(["wall.incident_solar"], 0, 24, 2 * STEP)
        assert unit.get("wall.incident_solar") == pytest.approx([100.0 * (0.5 + 0.5 * 0.2)], rel=1e-12)
        # Air at -20 degC cools the room, which is heated to 20.5 degC by the power that holds it there.
        unit.set({"weather.air_temperature": -20.0})
        before = unit.get("room.heating_load")[0]
        unit.run(["room.heating_load"], 24, 30, 2 * STEP)
        assert unit.get("room.heating_load")[0] > before + 300.0
        assert unit.get("room.air_temperature") == pytest.approx([20.5], abs=1e-6)


def test_parameters_by_path(room: Simulation, unit_file: Path, tmp_path: Path) -> None:
    file = tmp_path / "room.fmu"
    export(room, file, parameters=["zones.room.*"])
    described = fmpy.read_model_description(str(file))
    found = {v.name: v for v in described.modelVariables if v.causality == "parameter"}
    volume = found["zones.room.volume"]
    assert (float(volume.start), volume.unit, float(volume.min)) == (50.0, "m3", 1e-12)
    assert all(name.startswith("zones.room.") for name in found)
    changed = {"zones.room.volume": 30.0, "zones.room.gains.people.power": 500.0}
    assert np.array_equal(simulated(file, room, start_values=changed), room.run(changed).records)


def test_states_are_kept_and_restored_in_another_instance(room: Simulation, unit_file: Path) -> None:
    names = [output.name for output in room.outputs]
    setting = {"weather.air_temperature": -3.0, "zones.room.volume": 40.0}
    with instance(unit_file) as unit:
        unit.start(**setting)
        unit.run(names, 0, 20, 2 * STEP)
        state = unit.saved()
        at_state = unit.get(*names)
        expected = unit.run(names, 20, 50, 2 * STEP)
        unit.restore(state)
        assert unit.get("time", *names) == [20 * 2 * STEP, *at_state]
        assert np.array_equal(unit.run(names, 20, 50, 2 * STEP), expected)
    with instance(unit_file) as other:
        other.start()
        other.restore(state)
        assert other.get("weather.air_temperature", "zones.room.volume") == [-3.0, 40.0]
        assert np.array_equal(other.run(names, 20, 50, 2 * STEP), expected)
        for damaged in (state[:-8], state[8:], b"", state[:8] + b"\0" * 8 + state[16:], state + b"12345678"):
            with pytest.raises(FMICallException):
                other.restore(damaged)
        assert "was not saved by this unit" in other.heard[-1][1]
        # Nothing was lost.
        assert other.get("time") == [50 * 2 * STEP]


def test_a_communication_step_may_hold_several_internal_steps(room: Simulation, tmp_path: Path) -> None:
    file = tmp_path / "room.fmu"
    export(room, file)
    with instance(file) as unit:
        unit.start()
        found = unit.run(["room.air_temperature"], 0, 24, 2 * HOUR)
    assert np.array_equal(found[:, 0], room.run().records[4::4, 0])


def refused(unit: Unit, status: int, call: str, *arguments: object) -> str:
    """The message of a call that ends with a status."""
    with pytest.raises(FMICallException) as caught:
        getattr(unit.slave, call)(*arguments)
    assert caught.value.status == status
    assert unit.heard[-1][0] == status
    return unit.heard[-1][1]


DISCARD, ERROR = 2, 3


def test_what_cannot_be_used_is_refused_with_a_reason(unit_file: Path) -> None:
    with instance(unit_file) as unit:
        unit.start()
        outdoor, volume = unit.references["weather.air_temperature"], unit.references["zones.room.volume"]
        warm, room = unit.references["schedules.warm"], unit.references["room.air_temperature"]
        before = unit.get("weather.air_temperature")
        for value in (400.0, float("nan")):
            text = refused(unit, DISCARD, "setFloat64", [warm, outdoor], [19.0, value])
            assert "'weather.air_temperature': found" in text
            assert "expected a value from -90 to 80 degC" in text
        # One of two that is refused: none is set.
        assert unit.get("weather.air_temperature", "schedules.warm") == [*before, 17.0]
        text = refused(unit, ERROR, "setFloat64", [volume], [30.0])
        assert "'zones.room.volume' is a parameter and cannot be set while steps are made" in text
        assert "is an output" in refused(unit, ERROR, "setFloat64", [room], [20.0])
        assert "expected one from 0 to" in refused(unit, ERROR, "getFloat64", [99999])
        text = refused(unit, ERROR, "doStep", 0.0, 1000.0)
        assert "communication step of 1000 s, expected a multiple of the internal step of 1800 s" in text
        assert "the unit is at 0 s" in refused(unit, ERROR, "doStep", 1800.0, 1800.0)
        assert "where the weather of the unit ends" in refused(unit, ERROR, "doStep", 0.0, 3 * 86400.0)
        unit.set({"schedules.warm": 27.5})
        text = refused(unit, DISCARD, "doStep", 0.0, 1800.0)
        assert "zones.room: found heating to 27.5 degC above cooling to 26 degC at 0 s" in text
        # It goes on once the reason is gone.
        unit.set({"schedules.warm": 21.0})
        unit.slave.doStep(0.0, 1800.0)
        assert unit.get("time") == [1800.0]
        assert "does not have this function" in refused(unit, ERROR, "enterEventMode")


def test_start_and_stop_are_within_the_weather(unit_file: Path) -> None:
    for at, stop, words in (
        (100.0, None, "the start is at 100 s, expected a multiple of the internal step"),
        (4 * 86400.0, None, "where the weather of the unit ends"),
        (0.0, 4 * 86400.0, "the stop is at 345600 s"),
    ):
        with instance(unit_file) as unit:
            with pytest.raises(FMICallException):
                unit.start(at=at, stop=stop)
            assert words in unit.heard[-1][1]
    with instance(unit_file) as unit:
        unit.start(at=86400.0)
        assert unit.get("time") == [86400.0]
        unit.slave.doStep(86400.0, 3600.0)
        unit.slave.terminate()
        assert "relative residual of the energy balance" in unit.heard[-1][1]


def test_damaged_units_are_refused(room: Simulation, unit_file: Path, tmp_path: Path) -> None:
    changes = (
        ("run.json", b'{"format": 2}'),
        ("building.json", b"{"),
        ("forcing.bin", b"MASCARIN" + b"\0" * 80),
        ("forcing.bin", None),
    )
    # In a folder each: a library that is loaded is not written over.
    for k, (name, change) in enumerate(changes):
        folder = tmp_path / str(k)
        unit = Unit(unit_file, folder)
        file = folder / "resources" / name
        if change is None:
            file.unlink()
        else:
            file.write_bytes(change)
        with pytest.raises(Exception, match="Failed to instantiate"):
            unit.start()
        assert name in unit.heard[-1][1]
    other = Unit(unit_file, tmp_path / "other")
    other.slave.guid = "{other}"
    with pytest.raises(Exception, match="Failed to instantiate"):
        other.start()
    assert "library and model description are not of one unit" in other.heard[-1][1]


def test_what_a_unit_cannot_be_is_refused_before_it_is_written(room: Simulation, tmp_path: Path) -> None:
    file = tmp_path / "room.fmu"
    with pytest.raises(
        InputError, match=r"--input: found 'schedules.cold', expected one of the inputs .* schedule"
    ):
        export(room, file, inputs=["schedules.cold"])
    with pytest.raises(InputError, match=r"--parameter: found 'zones.attic.\*'"):
        export(room, file, parameters=["zones.attic.*"])
    with pytest.raises(InputError, match=r"--fmi: found '1\.0', expected one of 3\.0, 2\.0"):
        export(room, file, version="1.0")  # type: ignore[arg-type]
    assert not file.exists()


def test_the_command(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    call = ["fmu", str(LGI / "building.yaml"), "--weather", str(LGI / "study.yaml"), "--end", "2010-08-02"]
    assert cli.main([*call, "-o", "cell.fmu", "--output", "room.*", "--input", "weather.*"]) == 0
    err = capsys.readouterr().err
    assert "wrote cell.fmu" in err
    assert "inputs hold until they are set, also where nothing is connected: weather.air_temperature " in err
    assert "warning" not in err
    described = fmpy.read_model_description("cell.fmu")
    inputs = [v.name for v in described.modelVariables if v.causality == "input"]
    assert "weather.direct_normal" in inputs
    assert not any("global" in name or "sun" in name for name in inputs)
    first = Path("cell.fmu").read_bytes()
    assert cli.main([*call, "-o", "cell.fmu", "--output", "room.*", "--input", "weather.*"]) == 0
    assert Path("cell.fmu").read_bytes() == first
    for words, message in (
        (["-o", "cell.zip"], "expected a file ending in .fmu"),
        (["-o", "none/cell.fmu"], "expected an existing folder"),
        (["-o", "cell.fmu", "--output", "attic.air_temperature"], "attic.air_temperature"),
        (["-o", "cell.fmu", "--fmi", "1.0"], "--fmi"),
    ):
        assert cli.main([*call, *words]) == 2
        assert message in capsys.readouterr().err
    assert Path("cell.fmu").read_bytes() == first


def test_units_in_base_units() -> None:
    assert base_unit("W/(m2 K)") == BaseUnit({"kg": 1, "s": -3, "K": -1})
    assert base_unit("m2 K/W") == BaseUnit({"K": 1, "kg": -1, "s": 3})
    assert base_unit("1/(h m/s)") == BaseUnit({"m": -1}, 1 / 3600.0)
    assert base_unit("degC") == BaseUnit({"K": 1}, offset=273.15)
    assert base_unit("furlong") is None

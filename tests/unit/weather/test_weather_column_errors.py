"""Gain, offset and clock of columns of the weather: runs, derivatives, calibration by path."""

from __future__ import annotations

import pickle
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from mascarin.building import Building
from mascarin.calibration import SearchOptions, solve
from mascarin.cli import main
from mascarin.errors import InputError
from mascarin.examples import box
from mascarin.measurements import Sensor
from mascarin.sensitivity import sensitivity_analysis
from mascarin.weather.records.channels import CHANNELS, RADIATION
from skies import NAMES, sky

GAIN, CLOCK = "weather.columns.radiation.gain", "weather.columns.radiation.clock"
WARM, LATE = "weather.columns.air_temperature.offset", "weather.columns.air_temperature.clock"
OUTPUT = "room.air_temperature"
PERIOD = {"start": "2024-03-03", "end": "2024-03-09", "step": "30min", "initial": 15.0, "outputs": [OUTPUT]}


@pytest.fixture(autouse=True)
def _without_cache(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MASCARIN_CACHE", "off")


def frame(late: str = "0min", names: tuple[str, ...] = NAMES[:1], gain: float = 1.0) -> pd.DataFrame:
    """Ten days of a clear sky at 45 N 5 E, with air, wind and humidity."""
    record = sky(
        np.random.default_rng(8), 45.0, 5.0, "mixed", late=pd.Timedelta(late).total_seconds(), names=names
    )
    seconds = record.grid.start + 1800.0 * np.arange(record.grid.count)
    hours = seconds / 3600.0
    return pd.DataFrame(
        {
            "air_temperature": 12.0 + 6.0 * np.sin((hours - 9.0) * np.pi / 12.0),
            "dew_point": 4.0,
            "wind_speed": 2.0 + np.sin(hours / 7.0),
            "wind_direction": 200.0,
            **{name: gain * record.columns[name] for name in names},
        },
        index=pd.to_datetime(seconds, unit="s", utc=True),
    )


def climate(table: pd.DataFrame, **options: object) -> mc.Climate:
    return mc.Climate.from_table(table, columns={str(n): str(n) for n in table}, **options)  # type: ignore[arg-type]


def building(**columns: Mapping[str, object]) -> Building:
    place = {"site.latitude": 45.0, "site.longitude": 5.0, "site.altitude": 200.0, "site.timezone": "UTC"}
    return box().replace({**place, "weather": {"columns": columns}} if columns else place)


def test_a_column_that_is_right_changes_no_bit() -> None:
    weather = climate(frame())
    plain = mc.simulate(building(), weather, **PERIOD)  # type: ignore[arg-type]
    stated = mc.simulate(building(radiation={}, wind_speed={}), weather, **PERIOD)  # type: ignore[arg-type]
    assert np.array_equal(plain.records, stated.records)


def test_a_gain_is_that_of_the_table() -> None:
    """A pyranometer that reads 6 % too little, corrected by its gain, is the right one."""
    right, low = frame(), frame(gain=1.0 / 1.06)
    wanted = mc.simulate(building(), climate(right), **PERIOD)  # type: ignore[arg-type]
    corrected = building(global_horizontal={"gain": 1.06})
    got = mc.simulate(corrected, climate(low), **PERIOD)  # type: ignore[arg-type]
    assert np.allclose(got.records, wanted.records, atol=1e-9)
    raw = mc.simulate(building(), climate(low), **PERIOD)  # type: ignore[arg-type]
    assert np.abs(raw.records - wanted.records).max() > 0.1


@pytest.mark.parametrize("names", [NAMES[:1], NAMES])
def test_a_clock_is_the_shift_of_the_table(names: tuple[str, ...]) -> None:
    """A clock of the whole weather is what `shift` does, also for a shift that is no whole step."""
    late = frame("25min", names)
    moved = late.set_index(pd.DatetimeIndex(late.index) - pd.Timedelta("25min"))
    wanted = mc.Simulation(building(), climate(moved, check_sun=False), **PERIOD)  # type: ignore[arg-type]
    corrected = building().replace({"weather": {"clock": -1500.0}})
    got = mc.Simulation(corrected, climate(late), **PERIOD)  # type: ignore[arg-type]
    for name in ("air_temperature", "wind_speed", *RADIATION):
        k = CHANNELS.index(name)
        assert np.allclose(got.compiled.forcing[..., k], wanted.compiled.forcing[..., k], atol=1e-6), name
    with pytest.raises(InputError, match="does not follow the sun"):
        mc.Simulation(building(), climate(late), **PERIOD)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="does not follow the sun"):
        mc.Simulation(building().replace({"weather": {"clock": 1500.0}}), climate(late), **PERIOD)  # type: ignore[arg-type]


def test_values_by_path_are_those_of_the_building() -> None:
    """A run by a vector, a member of an ensemble and a building of its own give the same bits."""
    described = building(radiation={}, air_temperature={})
    simulation = mc.Simulation(described, climate(frame()), **PERIOD)  # type: ignore[arg-type]
    paths = [GAIN, CLOCK, WARM, LATE]
    values = np.array([[1.06, 0.0, 0.0, 0.0], [1.0, 400.0, 0.5, 0.0], [1.0, 0.0, 0.0, -700.0]])
    vectors = simulation.varied(paths, values)
    members = simulation.ensemble(np.vstack([vectors, vectors[:1], simulation.vector({})]))
    assert not members.failures
    for k, row in enumerate(values):
        own = described.replace(dict(zip(paths, row.tolist(), strict=True)))
        alone = mc.simulate(own, climate(frame()), **PERIOD)  # type: ignore[arg-type]
        assert np.array_equal(members.records[k], alone.records)
        assert np.array_equal(members.records[k], simulation.run_vector(vectors[k]).records)
    assert np.array_equal(members.records[3], members.records[0])
    assert np.array_equal(members.records[4], simulation.run().records)
    sent = pickle.loads(pickle.dumps(simulation.compiled))  # noqa: S301 (its own)
    assert np.array_equal(sent.ensemble(vectors).records, members.records[:3])


def test_derivatives_are_those_of_runs() -> None:
    """Those by the weather are differences, forward and in reverse; a change of 2 % follows them."""
    described = building(radiation={}, air_temperature={})
    weather, free = climate(frame(names=NAMES)), {**PERIOD, "initial": "repeat"}
    simulation = mc.Simulation(described, weather, **free)  # type: ignore[arg-type]
    paths, steps = [GAIN, "zones.room.volume", WARM, LATE], [0.02, 0.2, 0.1, 120.0]
    records, slopes = simulation.jacobian_vector(paths)
    assert np.allclose(records, simulation.run().records)
    run = simulation.trajectory()
    for path, step, slope in zip(paths, steps, slopes, strict=True):
        value = described.parameter(path).value
        ends = [simulation.run({path: value + way * step}).records for way in (1.0, -1.0)]
        difference = (ends[0] - ends[1]) / (2.0 * step)
        assert np.abs(slope - difference).max() <= 0.02 * np.abs(difference).max(), path
        pulled = run.pull(np.ones_like(run.records))[simulation.position(path)]
        assert pulled == pytest.approx(slope.sum(), rel=1e-6, abs=1e-9)


def test_a_pyranometer_and_its_clock_are_calibrated() -> None:
    """Planted errors of the weather are estimated beside a parameter of the building."""
    truth = building(radiation={"gain": 1.08, "clock": 600.0})
    weather, volume = climate(frame(names=NAMES), check_sun=False), "surfaces.facade.outside.absorptance"
    period = {**PERIOD, "outputs": [OUTPUT, "facade.outside_temperature"]}
    run = mc.simulate(truth.replace({volume: 0.5}), weather, **period)  # type: ignore[arg-type]
    noise = np.random.default_rng(1).normal(size=run.records.shape)
    table = pd.DataFrame(run.records + 0.02 * noise, index=run.index, columns=["room", "wall"])
    ranges = {"gain": {"value": 1.0, "range": [0.9, 1.1]}, "clock": {"value": 0.0, "range": [-1800, 1800]}}
    fit = mc.calibrate(
        building(radiation=ranges), weather, mc.Measurements.from_table(table),
        sensors={
            OUTPUT: Sensor("room", standard_uncertainty=0.02, offset=0),
            "facade.outside_temperature": Sensor("wall", standard_uncertainty=0.02, offset=0),
        },
        vary={GAIN: (0.9, 1.1), CLOCK: (-1800.0, 1800.0)},
        parameters={volume: 0.5}, step="30min", start="2024-03-05", end="2024-03-09", warm_up="2d",
    )  # fmt: skip
    assert fit.x[0] == pytest.approx(1.08, abs=0.004)
    assert fit.x[1] == pytest.approx(600.0, abs=40.0)
    assert fit.building.parameter(GAIN).value == fit.x[0]


def test_sensitivity_varies_what_has_a_range() -> None:
    described = building(radiation={"gain": {"value": 1.0, "range": [0.95, 1.05]}}, wind_speed={})
    names = [p.path for p in described.parameters() if p.path.startswith("weather.") and p.varies]
    assert names == [GAIN]
    found = sensitivity_analysis(
        described, climate(frame()), outputs=[OUTPUT], vary=[GAIN, "surfaces.facade.outside.absorptance"],
        method="morris", start="2024-03-03", end="2024-03-06", step="1h", samples=6, replicates=3,
    )  # fmt: skip
    table = found.to_dataframe()
    assert set(table[table["significant"]].iloc[:, 1]) == {GAIN, "surfaces.facade.outside.absorptance"}


@pytest.mark.parametrize(
    ("columns", "text"),
    [
        ({"globl_horizontal": {}}, "Did you mean 'global_horizontal'"),
        ({"relative_humidity": {}}, "write dew_point"),
        ({"direct_normal": {"gain": 1.1}}, "It is derived from the others"),
        ({"air_temperature": {"gain": 10.0}}, "corrected values from .* expected -90 to 80 degC"),
    ],
)
def test_what_cannot_be_corrected_is_refused(columns: dict[str, dict[str, object]], text: str) -> None:
    with pytest.raises(InputError, match=text):
        mc.Simulation(building(**columns), climate(frame()), **PERIOD)  # type: ignore[arg-type]


def test_irradiances_have_one_clock() -> None:
    weather = climate(frame(names=NAMES))
    with pytest.raises(InputError, match=r"State the clock under weather\.columns\.radiation"):
        mc.Simulation(building(global_horizontal={"clock": 60.0}), weather, **PERIOD)  # type: ignore[arg-type]
    mc.Simulation(building(radiation={"clock": 60.0}), weather, **PERIOD)  # type: ignore[arg-type]


def test_a_channel_that_is_absent_has_no_error() -> None:
    table = frame().drop(columns="wind_speed")
    weather = mc.Climate.from_table(table, columns={str(n): str(n) for n in table}, absent=["wind_speed"])
    with pytest.raises(InputError, match="has no measured wind_speed"):
        mc.Simulation(building(wind_speed={"gain": 0.8}), weather, **PERIOD)  # type: ignore[arg-type]


def test_the_turn_of_a_typical_year() -> None:
    """A clock moves a year that represents any year over its turn."""
    weather = mc.Climate.shipped("golden")
    site = weather.site
    assert site is not None
    place = {"site.latitude": site.latitude, "site.longitude": site.longitude, "site.timezone": "UTC-7"}
    described = box().replace({**place, "weather": {"clock": 0.0, "columns": {"air_temperature": {}}}})
    simulation = mc.Simulation(
        described, weather, start="2001-12-30", end="2002-01-03", step="1h", outputs=[OUTPUT]
    )
    moved = simulation.compiled.forcing_at(simulation.vector({"weather.clock": -3600.0}))
    k = CHANNELS.index("air_temperature")
    assert np.allclose(moved[:-1, -1, k], simulation.compiled.forcing[1:, -1, k], atol=1e-9)
    assert np.isfinite(moved[..., k]).all()


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A logger whose pyranometer reads 8 % too little, a room that was measured, and its building."""
    weather = frame(names=NAMES)
    run = mc.simulate(building(), climate(weather), **{**PERIOD, "start": "2024-03-02", "end": "2024-03-11"})  # type: ignore[arg-type]
    table = weather.assign(**{name: weather[name] / 1.08 for name in NAMES}).round(4)
    noise = 0.02 * np.random.default_rng(2).normal(size=len(run.index))
    table["room"] = pd.Series(run.records[:, 0] + noise, index=run.index)
    table.index = pd.DatetimeIndex(table.index).tz_localize(None)
    table.loc["2024-03-02":"2024-03-10"].to_csv(tmp_path / "logger.csv", index_label="time")
    building().to_yaml(tmp_path / "box.yaml")
    columns = {name: name for name in weather}
    (tmp_path / "study.yaml").write_text(
        "name: a pyranometer\nbuilding: box.yaml\nclimate:\n  measured:\n    table: logger.csv\n    "
        f"timezone: UTC\n    columns: {columns}\n"
        "weather: {columns: {radiation: {gain: {value: 1.0, range: [0.8, 1.2]}}}}\n"
        "sensors:\n  room: {column: room, output: room.air_temperature, standard_uncertainty: 0.02, "
        "offset: 0}\n"
        "step: 30min\nperiods:\n  identification: [2024-03-04, 2024-03-07]\n"
        "identification: {starts: 1, parameters: {weather.columns.radiation.gain: }}\n"
        "sensitivity: {method: morris, samples: 4, replicates: 3, step: 1h, interval: 1h}\n"
    )
    return tmp_path


def test_a_study_identifies_the_gain(folder: Path) -> None:
    study = mc.Study(folder / "study.yaml")
    assert study.building.parameter(GAIN).high == 1.2
    problem = study.context.problem()
    assert problem.paths == (GAIN,)
    fit = solve(problem, options=SearchOptions(starts=1))
    assert fit.x[0] == pytest.approx(1.08, abs=0.01)


def test_the_command_line_takes_them_by_path(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    columns = [piece for name in frame(names=NAMES) for piece in ("--column", f"{name}={name}")]
    table = ["--weather", str(folder / "logger.csv"), *columns, "--timezone", "UTC", "--step", "1h"]
    stated = ["--set", f"{GAIN}=1.08", "--output", OUTPUT, "--out", str(folder / "a.csv")]
    assert main(["run", str(folder / "box.yaml"), *table, *stated]) == 0
    assert main(["run", str(folder / "box.yaml"), *table, *stated[2:-1], str(folder / "b.csv")]) == 0
    warm, plain = (pd.read_csv(folder / name, comment="#").iloc[:, -1].mean() for name in ("a.csv", "b.csv"))
    assert warm > plain + 0.02
    capsys.readouterr()

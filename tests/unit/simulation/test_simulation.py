from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from mascarin import cli
from mascarin.building import Building
from mascarin.errors import InputError, SolverError
from mascarin.examples import FOLDER
from mascarin.physics import globe_temperature
from mascarin.simulation.results import Results
from mascarin.simulation.run import simulate
from mascarin.simulation.simulation import Simulation
from mascarin.simulation.unused_parameters import inactive_parameters
from mascarin.verification.analytical import setup, zones
from mascarin.weather import Climate, Measurements
from simulation_samples import LINEAR, hours, measured, read, weather


@pytest.fixture(scope="module")
def linear(tmp_path_factory: pytest.TempPathFactory) -> Building:
    return read(LINEAR, tmp_path_factory.mktemp("linear"))


@pytest.fixture(scope="module")
def climate() -> Climate:
    return weather(3, **measured(3))


@pytest.fixture(scope="module")
def everything() -> Building:
    return setup.building(zones.EVERYTHING)


@pytest.fixture(scope="module")
def island() -> Climate:
    return setup.climate(setup.HOUR, zones.island_weather(4))


# --- period, step, outputs ---


def test_rows_are_the_start_and_the_end_of_every_step(linear: Building, climate: Climate) -> None:
    run = simulate(linear, climate, start="2001-01-02", end="2001-01-03", step="15min")
    assert len(run.index) == len(run.records) == 97
    assert run.index[0] == pd.Timestamp("2001-01-02", tz="UTC")
    assert run.index[-1] == pd.Timestamp("2001-01-03", tz="UTC")


def test_step_in_words_and_seconds_are_the_same(linear: Building, climate: Climate) -> None:
    words, number = (
        simulate(linear, climate, step=step, end="2001-01-02").records for step in ("30min", 1800)
    )
    assert np.array_equal(words, number)


def test_usual_outputs(everything: Building, island: Climate) -> None:
    run = simulate(everything, island, step="1h", end="2001-01-02", initial=23.0)
    names = list(run)
    assert names[:2] == ["gap.air_temperature", "room.air_temperature"]
    assert "ceiling.energain_liquid_fraction" in names
    assert "ceiling.interface_1_temperature" in names
    assert not any(name.endswith("_flux") for name in names)


def test_an_output_by_its_alias(everything: Building, island: Climate) -> None:
    name = "ceiling.energain_board_temperature"
    run = simulate(everything, island, step="1h", end="2001-01-02", initial=23.0, outputs=[name])
    assert list(run) == [name]  # under the name that was asked for
    assert np.array_equal(run[name].to_numpy(), run["ceiling.interface_1_temperature"].to_numpy())


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"outputs": ["room.air_temprature"]}, "Did you mean 'room.air_temperature'"),
        ({"scheme": "sdirk"}, "Did you mean 'sdirk2'?"),
        ({"start": "2001-01-02", "end": "2001-01-01"}, "expected the end after the start"),
        ({"start": "2001-03-01"}, "start: found 2001-03-01 00:00:00+"),
        ({"start": "2001-03-01"}, ", after all values of "),
        ({"end": "2000-12-01"}, "end: found 2000-12-01 00:00:00+"),
        ({"end": "2000-12-01"}, ", before all values of "),
        ({"end": "2001-02-01"}, "is outside the data"),
        ({"end": "2001-01-02 00:10"}, "not a whole number of steps"),
        ({"step": "soon"}, "expected a positive time"),
        ({"step": -60}, "expected a positive time"),
        ({"initial": "warm"}, "expected 'repeat', a temperature between -100 and 200 degC"),
        ({"initial": True}, "expected 'repeat', a temperature between -100 and 200 degC"),
        ({"initial": 500.0}, "expected 'repeat', a temperature between -100 and 200 degC"),
    ],
)
def test_impossible_options_are_refused(
    options: dict[str, Any], words: str, everything: Building, island: Climate
) -> None:
    with pytest.raises(InputError) as caught:
        Simulation(everything, island, **options)
    assert words in str(caught.value)


def test_a_measured_column_that_is_missing_is_named(linear: Building) -> None:
    columns = measured(3)
    del columns["yard"]
    with pytest.raises(InputError, match="'yard', which the building needs"):
        Simulation(linear, weather(3, **columns))


def test_measured_columns_may_be_in_a_separate_table(linear: Building, climate: Climate) -> None:
    index = pd.date_range("2001-01-01", periods=73, freq="1h", tz="UTC")
    beside = Measurements.from_table(pd.DataFrame(measured(3), index=index), timezone="UTC")
    together = simulate(linear, climate, step="1h", end="2001-01-03").records
    apart = simulate(linear, weather(3), measurements=beside, step="1h", end="2001-01-03").records
    assert np.array_equal(apart, together)


def test_a_file_of_results_names_the_measured_table(linear: Building, tmp_path: Path) -> None:
    index = pd.date_range("2001-01-01", periods=73, freq="1h", tz="UTC", name="time")
    table = tmp_path / "measured.csv"
    pd.DataFrame(measured(3), index=index).to_csv(table)
    beside = Measurements.from_table(table, timezone="UTC")
    run = simulate(linear, weather(3), measurements=beside, step="1h", end="2001-01-01 03:00")
    run.write(tmp_path / "run.csv")
    made_from = Results.open(tmp_path / "run.csv").provenance.measurements
    assert made_from is not None
    assert made_from["sha256"] == hashlib.sha256(table.read_bytes()).hexdigest()
    assert made_from["columns"] == list(measured(3))
    alone = simulate(linear, weather(3, **measured(3)), step="1h", end="2001-01-01 03:00")
    assert alone.provenance.measurements is None


# --- start ---


def test_a_number_is_the_temperature_everywhere(linear: Building, climate: Climate) -> None:
    outputs = ["sunny.air_temperature", "shady.air_temperature", "deep.temperature"]
    run = simulate(linear, climate, step="1h", initial=31.5, outputs=outputs)
    assert run.records[0] == pytest.approx(31.5, abs=1.5)  # the sensor lies between a volume and a surface
    assert run["sunny.air_temperature"][0] == 31.5
    assert run.provenance.start == "31.5 degC everywhere"


def test_a_repeated_period_starts_in_its_final_state(linear: Building, climate: Climate) -> None:
    run = simulate(
        linear, climate, step="1h", outputs=["sunny.air_temperature", "between.inside_temperature"]
    )
    # Converged to 0.01 K: after a day the state equals that at the start, but for slow changes of weather.
    assert run.records[24] == pytest.approx(run.records[0], abs=0.011)
    assert "first 24 h repeated" in run.provenance.start


def test_a_repeated_period_does_not_depend_on_the_first_guess(linear: Building, climate: Climate) -> None:
    outputs = ["shady.air_temperature"]
    repeated = simulate(linear, climate, step="1h", outputs=outputs).records[:24]
    twice = [
        simulate(
            linear, climate, step="1h", outputs=outputs, initial=start, start="2001-01-01", end="2001-01-03"
        )
        for start in (0.0, 40.0)
    ]
    # After two days the difference of 40 K has decayed below the tolerance of the repeated period.
    assert abs(float(twice[0].records[-1, 0] - twice[1].records[-1, 0])) < 0.05
    assert np.ptp(repeated) > 1.0


def test_a_first_period_longer_than_the_run_is_the_run(linear: Building, climate: Climate) -> None:
    outputs = ["sunny.air_temperature", "shady.air_temperature", "between.inside_temperature"]
    run = simulate(linear, climate, step="1h", end="2001-01-01 12:00", first_period="2d", outputs=outputs)
    assert "first 12 h" in run.provenance.start
    assert run.records[0] == pytest.approx(run.records[-1], abs=0.011)


# --- numbers ---


def test_a_vector_changes_one_number(linear: Building, climate: Climate) -> None:
    simulation = Simulation(linear, climate, step="1h", outputs=["sunny.air_temperature"])
    path = "zones.sunny.infiltration"
    vector = simulation.vector({path: 5.0})
    position = simulation.position(path)
    assert simulation.paths[position] == "zones.sunny.infiltration.constant"
    assert np.flatnonzero(vector != simulation.vector({})).tolist() == [position]
    drafty = simulation.run_vector(vector)
    assert drafty.provenance.changed == {"zones.sunny.infiltration.constant": 5.0}
    direct = simulate(linear.replace({path: 5.0}), climate, step="1h", outputs=["sunny.air_temperature"])
    assert np.array_equal(drafty.records, direct.records)


def test_an_unknown_or_structural_number_is_refused(linear: Building, climate: Climate) -> None:
    run = Simulation(linear, climate, step="1h")
    with pytest.raises(InputError, match=r"Did you mean 'zones\.sunny\.volume'"):
        run.vector({"zones.sunny.volum": 1.0})
    with pytest.raises(InputError, match="is structural"):
        run.vector({"site.latitude": 1.0})


def test_vectors_of_the_wrong_length_are_refused(linear: Building, climate: Climate) -> None:
    run = Simulation(linear, climate, step="1h")
    with pytest.raises(InputError, match="parameter"):
        run.run_vector(run.vector({})[:-1])
    for members in (3, len(run.paths)):
        with pytest.raises(InputError, match="one value for each parameter"):
            run.ensemble(np.tile(run.vector({})[:-1], (members, 1)))


def test_members_are_the_same_bits_alone_and_together(everything: Building, island: Climate) -> None:
    run = Simulation(everything, island, step="15min", end="2001-01-02", initial=23.0)
    samples = np.tile(run.vector({}), (9, 1))
    samples[:, run.position("materials.energain.latent_heat")] *= np.linspace(0.5, 1.5, 9)
    calls: list[tuple[int, int]] = []
    records, closure, failures = run.ensemble(samples, progress=lambda *done: calls.append(done))
    assert failures == []
    assert all(total == 9 for _, total in calls)
    for member in (0, 4, 8):
        alone = run.run_vector(samples[member])
        assert np.array_equal(alone.records, records[member])
        assert alone.energy.relative_residual == closure[member]


def test_lanes_of_all_kinds_give_the_same_bits(
    everything: Building, island: Climate, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = Simulation(everything, island, step="15min", end="2001-01-02", initial=23.0)
    samples = np.tile(run.values, (9, 1))
    samples[:, run.position("materials.energain.latent_heat")] *= np.linspace(0.5, 1.5, 9)
    widest, closure, _ = run.ensemble(samples)
    for lanes in ("array", "avx2", "avx512"):
        monkeypatch.setenv("MASCARIN_LANES", lanes)
        records, same, _ = run.ensemble(samples)
        assert records.tobytes() == widest.tobytes(), lanes
        assert same.tobytes() == closure.tobytes(), lanes
    monkeypatch.setenv("MASCARIN_LANES", "wide")
    with pytest.raises(
        InputError, match="MASCARIN_LANES: found 'wide', expected avx512, avx2, neon or array"
    ):
        run.ensemble(samples)


def test_only_some_rows_are_recorded(everything: Building, island: Climate) -> None:
    run = Simulation(everything, island, step="1h", end="2001-01-03", initial=23.0)
    every, _, _ = run.ensemble(run.vector({})[None])
    some, _, _ = run.ensemble(run.vector({})[None], record_from=24, record_every=6)
    assert np.array_equal(some[0], every[0, 24::6])


def test_a_member_that_fails_leaves_the_others(everything: Building, island: Climate) -> None:
    run = Simulation(everything, island, step="1h", end="2001-01-02", initial=23.0)
    samples = np.tile(run.vector({}), (3, 1))
    samples[1, run.position("zones.room.volume")] = np.nan
    records, closure, failures = run.ensemble(samples)
    assert [failure.member for failure in failures] == [1]
    assert np.isnan(records[1]).all()
    assert np.isnan(closure[1])
    assert np.array_equal(records[0], records[2])
    assert np.array_equal(records[0], run.run().records)
    with pytest.raises(SolverError):
        run.run_vector(samples[1])


# --- outputs calculated from records ---


def test_operative_temperature_is_the_mean_of_air_and_radiant(everything: Building, island: Climate) -> None:
    names = ["room.operative_temperature", "room.air_temperature", "room.mean_radiant_temperature"]
    run = simulate(everything, island, step="1h", end="2001-01-02", initial=23.0, outputs=names)
    operative, air, radiant = run.records.T
    assert operative == pytest.approx(0.5 * (air + radiant), abs=1e-12)
    # In any order, and without the outputs that it is calculated from.
    alone = simulate(everything, island, step="1h", end="2001-01-02", initial=23.0, outputs=names[:1])
    assert np.array_equal(alone.records[:, 0], operative)


def test_the_globe_temperature_balances_radiation_and_convection() -> None:
    air, radiant = np.array([20.0, 20.0, 30.0]), np.array([40.0, 20.0, 10.0])
    globe = globe_temperature(air, radiant)
    emitted = 0.95 * 5.670374419e-8 * ((radiant + 273.15) ** 4 - (globe + 273.15) ** 4)
    carried = 1.4 * (np.abs(globe - air) / 0.15) ** 0.25 * (globe - air)
    assert emitted == pytest.approx(carried, rel=1e-11, abs=1e-9)
    assert globe[1] == 20.0


def test_mean_radiant_temperature_is_weighted_by_area(tmp_path: Path) -> None:
    building = read(LINEAR, tmp_path)
    run = simulate(building, weather(1, **measured(1)), step="1h", outputs=["shady.mean_radiant_temperature",
        "between.inside_temperature", "south.inside_temperature", "floor.inside_temperature"])  # fmt: skip
    radiant, *surfaces = run.records[-1]
    assert radiant == pytest.approx(np.average(surfaces, weights=[10.0, 8.0, 10.0]), abs=1e-12)


def test_weather_as_the_engine_reads_it(linear: Building, climate: Climate) -> None:
    run = Simulation(linear, climate, step="1h", end="2001-01-02")
    expected = np.interp(hours(1), hours(3), climate.data["air_temperature"])
    assert run.weather("air_temperature")[1:] == pytest.approx(expected[1:], abs=1e-9)


# --- units between Python and engine ---


def test_heat_into_a_zone_is_in_joules(tmp_path: Path) -> None:
    """100 W/m2 on 2 m2 of absorptance 0.5 for an hour, almost without convection: 360 kJ are stored."""
    text = setup.SITE + (
        "materials: {slab: {conductivity: 1, density: 2000, specific_heat: 1000}}\n"
        "constructions: {slab: {layers: [{material: slab, thickness: 0.1}]}}\n"
        "surfaces:\n  slab: {construction: slab, area: 2, tilt: 90, inside: {adiabatic: true},\n"
        "    outside: {outdoors: true, convection: 1e-9, emissivity: 0.9, absorptance: 0.5, longwave: none,\n"
        "              irradiance: sun}}\n"
    )
    text = text.replace("1e-9", "0.001")
    run = simulate(
        read(text, tmp_path), setup.climate(3600.0, {"sun": np.full(2, 100.0)}), step=60, initial=20.0,
        end="2001-01-01 01:00", outputs=["slab.outside_flux"],
    )  # fmt: skip
    assert run.energy.into["solar"] == pytest.approx(360e3, rel=1e-12)
    assert run.energy.stored == pytest.approx(360e3, rel=1e-3)
    assert run.energy.relative_residual < 1e-10


def test_provenance_describes_the_run(linear: Building, climate: Climate) -> None:
    run = simulate(linear, climate, step="30min", end="2001-01-02", scheme="backward-euler")
    provenance = run.provenance.to_dict()
    assert provenance["mascarin_version"] == mc.__version__
    assert provenance["building"] == "linear"
    assert provenance["step_seconds"] == 1800.0
    assert provenance["scheme"] == "backward-euler"
    assert provenance["changed"] == {}
    assert provenance["newton_iterations"] >= 48
    assert provenance["climate"]["timezone"] == "UTC"
    other = simulate(linear.replace({"zones.sunny.volume": 31.0}), climate, step="30min", end="2001-01-02")
    assert other.provenance.building_hash != run.provenance.building_hash


def test_linearly_implicit_is_near_the_default_with_half_of_the_solves() -> None:
    there = {"site.latitude": -35.0, "site.longitude": 0.0, "site.timezone": "UTC"}
    cell, climate = mc.load(FOLDER / "lgi" / "building.yaml").replace(there), weather(4, slab_underside=22.0)
    room, roof = "room.air_temperature", "roof.inside_temperature"
    runs = {
        scheme: Simulation(cell, climate, outputs=[room, roof], initial=25.0, scheme=scheme)
        for scheme in ("sdirk2", "linearly-implicit")
    }
    whole, linear = (run.run() for run in runs.values())
    assert linear.provenance.scheme == "linearly-implicit"
    assert linear.provenance.newton_iterations < 0.65 * whole.provenance.newton_iterations
    apart = np.abs(linear.records - whole.records)[96:]
    assert 0.0 < apart[:, 0].max() < 0.01
    assert apart[:, 1].max() < 0.05
    assert linear.energy.relative_residual < 1e-10
    members = np.tile(runs["linearly-implicit"].values, (9, 1))
    records, *_ = runs["linearly-implicit"].ensemble(members)
    assert np.array_equal(records[8], linear.records)
    slopes = runs["linearly-implicit"].jacobian(["surfaces.roof.outside.absorptance"])
    expected = runs["sdirk2"].jacobian(["surfaces.roof.outside.absorptance"])
    assert np.array_equal(slopes[f"d {room}"], expected[f"d {room}"])


def test_identity_differs_between_runs(linear: Building, climate: Climate) -> None:
    def identity(**options: Any) -> str:
        given: dict[str, Any] = {"step": "1h", "end": "2001-01-02", **options}
        return Simulation(linear, climate, **given).identity

    same = identity()
    assert identity() == same
    others: list[dict[str, Any]] = [
        {"step": "30min"},
        {"end": "2001-01-03"},
        {"scheme": "backward-euler"},
        {"initial": 20.0},
        {"outputs": ["sunny.air_temperature"]},
        {"first_period": "12h"},
    ]
    assert len({same, *(identity(**options) for options in others)}) == len(others) + 1


# --- every parameter reaches the engine ---


def claimed(building: Building) -> dict[str, str]:
    """Parameters that the description itself calls inactive."""
    return {p.path: p.reason for p in building.parameters() if p.reason is not None and not p.structural}


def columns_for(building: Building) -> dict[str, np.ndarray[Any, np.dtype[np.float64]]]:
    """Varying values for every measured column of a building."""
    day = 2.0 * np.pi * hours(3) / 86400.0
    return {
        name: np.maximum(-500.0 * np.cos(day), 0.0) if name == "Pyr" else 22.0 + np.sin(day + k)
        for k, name in enumerate(building.to_engine().channels)
    }


@pytest.mark.parametrize("name", ["everything", "linear", "wall_bench", "lgi"])
def test_every_parameter_has_an_effect_or_a_reason_why_not(
    name: str, linear: Building, everything: Building
) -> None:
    if name in ("linear", "everything"):
        building = linear if name == "linear" else everything
    else:
        package = Path(mc.__file__).parent / "examples" / name / "building.yaml"
        building = mc.load(package)
    columns = columns_for(building)
    climate = weather(3, **columns) if name == "linear" else _anywhere(columns)
    found = inactive_parameters(building, climate, step="30min")
    assert found == claimed(building)
    assert len(found) < 0.5 * len(building.to_engine().paths)


def _anywhere(columns: dict[str, Any]) -> Climate:
    """Weather in which everything varies; in March the sun reaches north and south."""
    t = hours(3)
    air = zones.island_weather(3)
    index = pd.date_range("2001-03-05", periods=len(t), freq="1h", tz="UTC")
    return Climate.from_table(
        pd.DataFrame({**air, **columns}, index=index), timezone="UTC", columns={one: one for one in air},
        extra=list(columns), instant=list(air), check_sun=False,
    )  # fmt: skip


def test_a_parameter_that_is_inactive_only_in_this_period_is_found(linear: Building) -> None:
    """At night the absorptance of a wall does nothing."""
    found = inactive_parameters(linear, weather(1, **measured(1)), step="1h", end="2001-01-01 03:00")
    assert found["surfaces.north.outside.absorptance"] == "did not act in this period"
    assert "surfaces.north.area" not in found


def test_the_command_lists_parameters_without_effect(
    data_dir: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "everything.yaml"
    island = "latitude: -35, longitude: 0, altitude: 55, timezone: UTC,"
    denver = "latitude: 39.83, longitude: -104.65, altitude: 1650, timezone: UTC-7,"
    file.write_text(zones.EVERYTHING.replace(island, denver), encoding="utf-8")
    weather_file = str(data_dir / "bestest" / "725650TYCST.epw")
    assert cli.main(["parameters", str(file), "--reach", "--weather", weather_file, "--json"]) == 0
    out, err = capsys.readouterr()
    listed = {row["path"]: row["reason"] for row in json.loads(out)}
    assert listed["surfaces.floor.azimuth"] == "a horizontal surface has no direction"
    assert "surfaces.roof.area" not in listed
    assert err == f"95 parameters, {len(listed)} without effect\n"


def test_the_command_needs_weather_for_that(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "everything.yaml"
    file.write_text(zones.EVERYTHING, encoding="utf-8")
    assert cli.main(["parameters", str(file), "--reach"]) == 2
    assert "--weather" in capsys.readouterr().err

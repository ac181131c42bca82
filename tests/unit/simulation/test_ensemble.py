"""Ensembles: members in order, the same bits alone and together, failures that are named."""

from __future__ import annotations

import pickle
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from ensemble_support import Forgetful, always_deadly, coldest, deadly, warmest
from mascarin import cli
from mascarin._io import locks
from mascarin.building import Building, load
from mascarin.ensemble import Statistic, Store, latin_hypercube, sweep, sweep_into
from mascarin.ensemble import workers as sweep_workers
from mascarin.errors import InputError, SolverError
from mascarin.examples import box, box_climate
from mascarin.examples.small import BOX
from mascarin.simulation.preparation.run_results import Failure
from mascarin.simulation.run import simulate
from mascarin.simulation.simulation import Simulation
from mascarin.weather import Climate, Measurements
from study_support import BUILDING, drivers, open_climate

JOINT = "wall.interface_1_temperature"
K = "materials.insulation.conductivity"
COEFFICIENT = "surfaces.wall.inside.convection.coefficient"


@pytest.fixture(scope="module")
def building(tmp_path_factory: pytest.TempPathFactory) -> Building:
    path = tmp_path_factory.mktemp("building") / "building.yaml"
    path.write_text(BUILDING, encoding="utf-8")
    return load(path)


@pytest.fixture(scope="module")
def climate() -> Climate:
    return open_climate(drivers())


@pytest.fixture(scope="module")
def measured() -> Measurements:
    return Measurements.from_table(drivers(), timezone="UTC+1")


def test_members_come_in_order_with_their_samples(
    building: Building, climate: Climate, measured: Measurements
) -> None:
    samples = {K: [0.02, 0.04, 0.06], COEFFICIENT: [4.0, 8.0, 12.0]}
    found = sweep(
        building, climate, samples, outputs=[JOINT], step="1h", start="2023-03-01", end="2023-03-04",
        measurements=measured,
    )  # fmt: skip
    assert found[JOINT].dims == ("member", "time")
    assert found[JOINT].shape == (3, 73)
    assert found[JOINT].attrs["units"] == "degC"
    np.testing.assert_array_equal(found["samples"], np.column_stack([samples[K], samples[COEFFICIENT]]))
    assert found["parameter"].to_numpy().tolist() == [K, COEFFICIENT]
    assert (found["closure"] < 1e-10).all()
    assert found.attrs["failures"] == []
    assert found.attrs["timezone"] == "UTC+1"
    # Times are UTC without a zone: local midnight is 23:00 of the day before.
    assert pd.Timestamp(found["time"].to_numpy()[0]) == pd.Timestamp("2023-02-28 23:00")
    # A lower conductivity brings the joint closer to the temperature of the room.
    mean = found[JOINT].mean("time").to_numpy()
    assert mean[0] > mean[1] > mean[2]


def test_a_member_does_not_depend_on_the_others(
    building: Building, climate: Climate, measured: Measurements
) -> None:
    span = {"step": "1h", "start": "2023-03-01", "end": "2023-03-03", "measurements": measured}
    # The same mesh for all: the worst ends of the ranges are among each of the samples.
    values = np.array([0.02, 0.06, 0.031, 0.05, 0.045, 0.033, 0.027, 0.058, 0.041, 0.022])
    whole = sweep(building, climate, {K: values}, outputs=[JOINT], **span)  # type: ignore[arg-type]
    part = sweep(building, climate, {K: values[[0, 1, 7]]}, outputs=[JOINT], **span)  # type: ignore[arg-type]
    np.testing.assert_array_equal(part[JOINT].to_numpy(), whole[JOINT].to_numpy()[[0, 1, 7]])


def test_a_sweep_of_one_member_equals_a_run(
    building: Building, climate: Climate, measured: Measurements
) -> None:
    nominal = float(building.parameter(K).value)
    span = {"step": "1h", "start": "2023-03-01", "end": "2023-03-03", "measurements": measured}
    one = sweep(building, climate, {K: [nominal]}, outputs=[JOINT], **span)  # type: ignore[arg-type]
    run = simulate(building, climate, outputs=[JOINT], **span)  # type: ignore[arg-type]
    np.testing.assert_allclose(one[JOINT].to_numpy()[0], run.records[:, 0], atol=1e-9)


def test_samples_may_be_a_data_frame(building: Building, climate: Climate, measured: Measurements) -> None:
    frame = pd.DataFrame({K: [0.03, 0.05]})
    found = sweep(
        building, climate, frame, outputs=[JOINT], step="1h", end="2023-03-02", measurements=measured
    )
    assert found.sizes["member"] == 2


@pytest.mark.parametrize(
    ("samples", "says"),
    [
        ({}, "samples: no columns; give values by parameter path"),
        ({K: [0.03, 0.04], COEFFICIENT: [8.0]}, "expected the same number for every path"),
        ({K: []}, "expected one value for each member"),
        ({K: [0.03, -1.0]}, r"of member 1 is -1 W/\(m K\); expected a value above 0 and at most 5000 W/"),
        ({K: [0.03, 0.0]}, r"of member 1 is 0 W/\(m K\); expected a value above 0 and at most 5000 W/"),
        ({K: [0.03, float("nan")]}, "of member 1 is nan"),
        ({"materials.insulation.conductivty": [1.0]}, "Did you mean 'materials.insulation.conductivity'"),
        ({"site.latitude": [44.0, 95.0]}, "member 1.*latitude"),
        ({"surfaces.wall.inside.convection": [8.0, "tarpp"]}, "(?s)member 1.*tarpp"),
    ],
)
def test_impossible_samples_are_refused(
    samples: dict[str, list[float]], says: str, building: Building, climate: Climate, measured: Measurements
) -> None:
    with pytest.raises(InputError, match=says):
        sweep(building, climate, samples, outputs=[JOINT], step="1h", end="2023-03-02", measurements=measured)


def test_an_unknown_output_is_refused(
    building: Building, climate: Climate, measured: Measurements, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=r"wall.interface_1_temperature"):
        sweep(building, climate, {K: [0.03]}, outputs=["wall.interface_1_temprature"], measurements=measured)


SOME = {K: np.linspace(0.02, 0.06, 40), COEFFICIENT: np.linspace(4.0, 12.0, 40)}


class Setting:
    """Building, climate and options of all sweeps below."""

    def __init__(self, building: Building, climate: Climate, measured: Measurements) -> None:
        self.place = (building, climate)
        self.options: dict[str, Any] = {
            "outputs": [JOINT], "step": "1h", "start": "2023-03-01", "end": "2023-03-03",
            "measurements": measured,
        }  # fmt: skip

    def sweep(self, samples: Any, **more: Any) -> xr.Dataset:
        return sweep(*self.place, samples, **{**self.options, **more})

    def into(self, folder: Path, samples: Any, **more: Any) -> Store:
        return sweep_into(folder, *self.place, samples, **{**self.options, **more})


@pytest.fixture(scope="module")
def setting(building: Building, climate: Climate, measured: Measurements) -> Setting:
    return Setting(building, climate, measured)


def test_structural_parameters_and_whole_parts_are_grouped(setting: Setting) -> None:
    building, climate = setting.place
    windy = {"kind": "linear_wind", "constant": 2.0, "wind": 1.0}
    samples: dict[str, list[Any]] = {
        K: [0.02, 0.03, 0.04, 0.05],
        "site.latitude": [44.0, 46.0, 44.0, 46.0],
        "surfaces.wall.inside.convection": [8.0, windy, windy, 8.0],
    }
    found = setting.sweep(samples)
    for member in range(4):
        shape = {path: values[member] for path, values in samples.items() if path != K}
        # The mesh is the same: it is chosen for the whole range of the samples.
        alone = sweep(
            building.replace(shape), climate, {K: [samples[K][member], 0.02, 0.05]}, **setting.options
        )
        np.testing.assert_array_equal(found[JOINT][member], alone[JOINT][0])
    assert found["sample: site.latitude"].to_numpy().tolist() == samples["site.latitude"]
    assert len({float(mean) for mean in found[JOINT].mean("time")}) == 4


def test_a_structure_that_cannot_be_run_fails_alone(setting: Setting) -> None:
    """Members are run structure by structure; results and reasons stand at the place of the sample."""
    samples: dict[str, list[Any]] = {K: [0.02, 0.03, 0.04, 0.05], "site.latitude": [44.0, 60.0, 46.0, 44.0]}
    found = setting.sweep(samples)
    assert [text.split(":")[0] for text in found.attrs["failures"]] == ["member 1"]
    assert np.isfinite(found[JOINT].to_numpy()).all(axis=1).tolist() == [True, False, True, True]
    kept = [0, 2, 3]
    others = setting.sweep({path: [values[member] for member in kept] for path, values in samples.items()})
    np.testing.assert_array_equal(found[JOINT][kept], others[JOINT])


def test_objectives_equal_statistics_of_the_series(setting: Setting) -> None:
    series = setting.sweep(SOME)[JOINT]
    found = setting.sweep(SOME, objectives={"warmest": warmest, "coldest": coldest})
    np.testing.assert_array_equal(found["warmest"], series.max("time"))
    np.testing.assert_array_equal(found["coldest"], series.min("time"))
    assert JOINT not in found


def test_impossible_objectives_are_named(setting: Setting) -> None:
    with pytest.raises(InputError, match=r"objective 'none': found a result of shape \(16, 49\)"):
        setting.sweep(SOME, objectives={"none": lambda run: run[JOINT]})
    with pytest.raises(InputError, match="objective 'lost' failed: KeyError"):
        setting.sweep(SOME, objectives={"lost": lambda run: run["room"]})
    with pytest.raises(InputError, match="'closure' is a variable of every result"):
        setting.sweep(SOME, objectives={"closure": warmest})


def test_workers_and_threads_give_the_same_bits(setting: Setting) -> None:
    calls: list[tuple[int, int]] = []
    found = setting.sweep(SOME, workers=2, progress=lambda *done: calls.append(done))
    np.testing.assert_array_equal(found[JOINT], setting.sweep(SOME)[JOINT])
    assert calls[-1] == (40, 40)
    with pytest.raises(InputError, match="workers: found 0"):
        setting.sweep(SOME, workers=0)


def test_nothing_is_lost_when_a_worker_dies(
    setting: Setting, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MASCARIN_TEST_MARK", str(tmp_path / "died"))
    found = setting.sweep(SOME, objectives={"warmest": deadly}, workers=2)
    assert (tmp_path / "died").exists()
    np.testing.assert_array_equal(found["warmest"], setting.sweep(SOME)[JOINT].max("time"))


def test_a_chunk_whose_workers_always_die_is_named(setting: Setting) -> None:
    with pytest.raises(SolverError, match=r"members \d+ to \d+: their worker died 3 times"):
        setting.sweep(SOME, objectives={"warmest": always_deadly}, workers=1)


def test_any_executor_can_be_used_and_may_lose_work(setting: Setting) -> None:
    executor = Forgetful()
    found = setting.sweep(SOME, workers=executor)
    assert executor.given > 3
    np.testing.assert_array_equal(found[JOINT], setting.sweep(SOME)[JOINT])


def test_a_cluster_of_processes(setting: Setting) -> None:
    distributed = pytest.importorskip("distributed")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        cluster = distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        )
        with cluster, distributed.Client(cluster) as client:
            found = setting.sweep(SOME, objectives={"warmest": warmest}, workers=client.get_executor())
    np.testing.assert_array_equal(found["warmest"], setting.sweep(SOME)[JOINT].max("time"))


@pytest.mark.parametrize("objectives", [None, {"warmest": warmest}])
def test_a_store_continues_after_an_interruption(
    setting: Setting, tmp_path: Path, objectives: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = setting.into(tmp_path / "whole", SOME, objectives=objectives, seed=7)
    # Chunks of another size, interrupted in the second of them.
    monkeypatch.setattr(sweep_workers, "FIRST", 8)
    calls: list[int] = []

    def impatient(done: int, _: int) -> None:
        calls.append(done)
        if done > 8:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        setting.into(tmp_path / "cut", SOME, objectives=objectives, seed=7, progress=impatient)
    half = Store(tmp_path / "cut")
    assert (half.complete, half.done) == (False, 8)
    assert half.gaps() == [(8, 40)]
    assert len(half.to_dataframe()) == 8
    with pytest.raises(InputError, match="members 0 to 39 are not all there; 8 of 40"):
        half.to_xarray()
    (tmp_path / "cut" / "pieces" / "000000000008-000000000016.part").write_bytes(b"half written")
    calls.clear()
    setting.into(
        tmp_path / "cut", SOME, objectives=objectives, seed=7, progress=lambda done, _: calls.append(done)
    )
    assert calls[0] > 8
    for name in ("manifest.json", "members.parquet"):
        assert (tmp_path / "cut" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()
    shown = sorted(file.name for file in (tmp_path / "cut").iterdir() if file.name != locks.NAME)
    assert shown == ["manifest.json", "members.parquet"]
    name = "warmest" if objectives else JOINT
    straight = setting.sweep(SOME, objectives=objectives)
    np.testing.assert_array_equal(whole.to_xarray()[name], straight[name])
    np.testing.assert_array_equal(whole.to_xarray(3, 11)[name], straight[name][3:11])
    np.testing.assert_array_equal(whole.to_xarray()[f"sample: {K}"], SOME[K])
    assert whole.manifest["seed"] == 7
    assert whole.manifest["mascarin_version"]


def test_a_folder_with_something_else_is_refused(setting: Setting, tmp_path: Path) -> None:
    setting.into(tmp_path / "kept", SOME, objectives={"warmest": warmest})
    with pytest.raises(InputError, match="differs in identity, samples; expected the same one"):
        setting.into(tmp_path / "kept", {**SOME, K: SOME[K] + 0.01}, objectives={"warmest": warmest})
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "thesis.txt").write_text("years of work", encoding="utf-8")
    with pytest.raises(InputError, match="not empty and no ensemble"):
        setting.into(tmp_path / "other", SOME)
    with pytest.raises(InputError, match="no readable manifest"):
        Store(tmp_path / "nowhere")


def test_a_folder_in_use_is_refused(
    setting: Setting, tmp_path: Path, data_dir: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "used"
    folder.mkdir()
    with locks.FolderLock(folder):
        with pytest.raises(InputError, match="another process is writing to this folder"):
            setting.into(folder, SOME, objectives={"warmest": warmest})
        arguments = ["sweep", str(BOX), "--weather", str(data_dir / "bestest" / "725650TYCST.epw")]
        arguments += ["--start", "2001-01-02", "--end", "2001-01-03", "--draw", "2", "-o", str(folder)]
        assert cli.main([*arguments, "--objective", "max:room.air_temperature"]) == 2
        assert "another process is writing" in capsys.readouterr().err
    assert [file.name for file in folder.iterdir()] == [locks.NAME]


def test_values_common_to_all_members(setting: Setting) -> None:
    building, climate = setting.place
    found = setting.sweep({K: [0.02, 0.06]}, parameters={COEFFICIENT: 12.0})
    changed = building.replace({COEFFICIENT: 12.0})
    expected = sweep(changed, climate, {K: [0.02, 0.06]}, **setting.options)
    np.testing.assert_array_equal(found[JOINT], expected[JOINT])
    assert float(np.abs(found[JOINT] - setting.sweep({K: [0.02, 0.06]})[JOINT]).max()) > 0.1


def test_data_sets_have_units_and_both_times_and_can_be_written(setting: Setting, tmp_path: Path) -> None:
    found = setting.sweep({K: [0.02, 0.06]})
    kept = setting.into(tmp_path / "kept", {K: [0.02, 0.06]}).to_xarray()
    local = pd.DatetimeIndex(found["local_time"].to_numpy()) - pd.DatetimeIndex(found["time"].to_numpy())
    assert set(local) == {pd.Timedelta("1h")}
    assert found["parameter_unit"].to_numpy().tolist() == ["W/(m K)"]
    assert kept[f"sample: {K}"].attrs["units"] == "W/(m K)"
    for data in (found, kept):
        assert data[JOINT].attrs["units"] == "degC"
        assert data["closure"].attrs["long_name"] == "relative energy-balance residual"
        data.to_netcdf(tmp_path / "members.nc", engine="h5netcdf")
        with xr.open_dataset(tmp_path / "members.nc", engine="h5netcdf") as back:
            np.testing.assert_array_equal(back[JOINT], data[JOINT])
            np.testing.assert_array_equal(back["local_time"], found["local_time"])
            assert back.attrs["timezone"] == "UTC+1"


def test_a_store_is_described_in_a_few_lines(setting: Setting, tmp_path: Path) -> None:
    store = setting.into(tmp_path / "kept", {K: [0.02, 0.06]}, objectives={"warmest": warmest})
    assert "members     2 of 2 run" in repr(store)
    assert len(repr(store).splitlines()) <= 15
    assert "<table" in store._repr_html_()
    copied = pickle.loads(pickle.dumps(store))  # noqa: S301 (own data)
    assert copied.to_dataframe().equals(store.to_dataframe())


def test_failing_members_are_kept_with_their_reason(setting: Setting, tmp_path: Path) -> None:
    ensemble = Simulation.ensemble

    def failing(self: Simulation, vectors: Any, **options: Any) -> Any:
        run = ensemble(self, vectors, **options)
        return replace(run, failures=[Failure(2, "step 4: the wall did not converge")])

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Simulation, "ensemble", failing)
        found = setting.sweep({K: SOME[K][:8]})
        kept = setting.into(tmp_path / "kept", {K: SOME[K][:8]})
    assert found.attrs["failures"] == ["member 2: step 4: the wall did not converge"]
    assert np.isnan(found[JOINT][2]).all()
    assert not np.isnan(found[JOINT][3]).any()
    assert kept.to_dataframe()["failure"][2] == "step 4: the wall did not converge"
    assert kept.to_xarray().attrs["failures"] == found.attrs["failures"]


def test_statistics_from_text(setting: Setting) -> None:
    series = setting.sweep(SOME)[JOINT]
    words = [f"{kind}:{JOINT}" for kind in ("min", "mean", "max", "sd")]
    words += [f"above:12:{JOINT}", f"below:12:{JOINT}"]
    found = setting.sweep(SOME, objectives={text: Statistic.read(text) for text in words})
    np.testing.assert_allclose(found[words[1]], series.mean("time"), rtol=1e-14)
    np.testing.assert_allclose(found[words[3]], series.std("time"), rtol=1e-12)
    np.testing.assert_array_equal(found[words[4]], (series[:, 1:] > 12.0).sum("time"))
    np.testing.assert_array_equal(found[words[4]] + found[words[5]], 48.0)
    for text in ("mx:a", "max", "above:a", "max:1:a", "above::a"):
        with pytest.raises(InputError, match="objective: found"):
            Statistic.read(text)


def test_members_are_drawn_evenly_and_reproducibly(building: Building) -> None:
    drawn = latin_hypercube(building, 50, seed=3, vary=[K, COEFFICIENT])
    parameter = building.parameter(K)
    strata = (drawn[K].to_numpy() - parameter.low) / (parameter.high - parameter.low) * 50
    assert sorted(strata.astype(int).tolist()) == list(range(50))
    assert drawn.equals(latin_hypercube(building, 50, seed=3, vary=[K, COEFFICIENT]))
    assert not drawn.equals(latin_hypercube(building, 50, seed=4, vary=[K, COEFFICIENT]))
    assert "site.latitude" not in latin_hypercube(building, 2, seed=3)
    with pytest.raises(InputError, match="structural"):
        latin_hypercube(building, 2, seed=3, vary=["site.latitude"])


def test_members_whose_balance_does_not_close_are_named(tmp_path: Path) -> None:
    # Apparent capacities lose heat where a material melts.
    wax = {
        "kind": "pcm", "density": 900, "conductivity": 0.2, "specific_heat": 2000, "latent_heat": 100000,
        "melting_temperature": 22, "law": {"kind": "tanh", "width": 0.5},
    }  # fmt: skip
    building = box()
    name = next(iter(building.materials))
    melting = building.replace({f"materials.{name}": wax})
    samples = {"surfaces.facade.outside.absorptance": [0.3, 0.6, 0.9]}
    whole = sweep(melting, box_climate(), samples, step="1h", scheme="apparent-capacity", initial=22.0)
    residuals = whole["closure"].to_numpy()
    worst = int(residuals.argmax())
    count = int((residuals > 1e-10).sum())
    assert count > 0
    line, *of_building = whole.attrs["warnings"]
    assert line.startswith(f"the energy balance of {count} of 3 members does not close")
    assert f"most in member {worst} ({residuals[worst]:.1e})" in line
    store = sweep_into(
        tmp_path / "store",
        melting,
        box_climate(),
        samples,
        step="1h",
        scheme="apparent-capacity",
        initial=22.0,
    )
    assert store.to_xarray().attrs["warnings"] == [line, *of_building]
    assert store.warnings() == [line, *of_building]
    closed = sweep(building, box_climate(), samples, step="1h")
    assert not any("balance" in said for said in closed.attrs["warnings"])


def test_the_weather_that_all_members_share_counts_as_memory(
    building: Building, climate: Climate, measured: Measurements, monkeypatch: pytest.MonkeyPatch
) -> None:
    simulation = Simulation(building, climate, step="1h", outputs=[JOINT], measurements=measured)
    asked: list[float] = []
    monkeypatch.setattr(
        "mascarin.simulation.preparation.engine_run.memory.require", lambda size, *words: asked.append(size)
    )
    simulation.ensemble(simulation.vector({})[None, :])
    steps, stages, _ = simulation.compiled.forcing.shape
    rows = steps + 1
    kept = asked[-1] - 2.0 * 8.0 * rows
    # Sun, sky and wind of each stage: at least some twenty numbers.
    assert kept / (steps * stages) == simulation.compiled.plan.stage_bytes > 160

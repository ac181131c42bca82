"""Runs whose series go to a file while they go on."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
import tracemalloc
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from mascarin.errors import SolverError
from mascarin.examples import box, box_climate
from mascarin.simulation.checks.step_check import Bends
from mascarin.simulation.records import blocks, files
from mascarin.simulation.records.netcdf import NetcdfDraft
from mascarin.simulation.records.times import Times
from mascarin.simulation.results import Results
from mascarin.simulation.simulation import Simulation
from mascarin.tables.timezones import parse_timezone

OUTPUTS = ["room.air_temperature", "room.operative_temperature", "facade.outside_flux", "room.air_changes"]


@pytest.fixture
def simulation() -> Simulation:
    return Simulation(box(), box_climate(), step="15min", outputs=OUTPUTS)


@pytest.fixture
def small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Seven rows a block, so that the last one is shorter."""
    monkeypatch.setattr(blocks, "SIZE", 7 * 8 * len(OUTPUTS))


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize("ending", ["nc", "csv", "parquet"])
def test_a_file_written_in_blocks_has_the_bits_of_the_run(
    simulation: Simulation, ending: str, tmp_path: Path
) -> None:
    file = tmp_path / f"run.{ending}"
    stored = simulation.run_into(file)
    run = simulation.run()
    assert Results.open(file) == run
    assert stored.finished.energy == run.energy
    assert stored.finished.warnings == run.warnings
    run.write(tmp_path / f"whole.{ending}")
    if ending != "parquet":  # its creator notes nothing else, but the order of its metadata is not promised
        assert file.read_bytes() == (tmp_path / f"whole.{ending}").read_bytes()


@pytest.mark.usefixtures("small_blocks")
def test_records_in_memory_are_filled_block_by_block(simulation: Simulation) -> None:
    in_blocks = simulation.run()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(blocks, "SIZE", 2**25)
        whole = Simulation(box(), box_climate(), step="15min", outputs=OUTPUTS).run()
    assert in_blocks == whole
    members, _, _ = simulation.compiled.ensemble(simulation.vector({})[None])
    assert np.array_equal(whole.records, members[0])


def test_xarray_reads_what_it_would_have_written(simulation: Simulation, tmp_path: Path) -> None:
    run = simulation.run()
    run.to_netcdf(tmp_path / "ours.nc")
    run.to_xarray().to_netcdf(tmp_path / "theirs.nc", engine="h5netcdf")
    with (
        xr.open_dataset(tmp_path / "ours.nc", engine="h5netcdf") as ours,
        xr.open_dataset(tmp_path / "theirs.nc", engine="h5netcdf") as theirs,
    ):
        xr.testing.assert_identical(ours, theirs)
        for name in theirs.variables:
            a, b = (dict(data[name].encoding) for data in (ours, theirs))
            del a["source"], b["source"]
            assert str(a) == str(b)


@pytest.mark.parametrize("step", [900.0, 86400.0, 1.0, 0.25, 3600.0 / 7.0])
@pytest.mark.parametrize("zone", ["UTC-7", "Europe/Paris"])
def test_times_in_a_file(step: float, zone: str, tmp_path: Path) -> None:
    first = pd.Timestamp("2001-10-27 22:30", tz="UTC").timestamp()
    times = Times(first, first + 40 * step, step, parse_timezone(zone))
    with NetcdfDraft(tmp_path / "a.nc", [], times) as draft:
        draft.take(np.empty((41, 0)))
        draft.finish({})
    with xr.open_dataset(tmp_path / "a.nc", engine="h5netcdf") as data:
        found, local = (pd.DatetimeIndex(data[name].to_numpy()) for name in ("time", "local_time"))
    assert found.equals(times.index.tz_convert("UTC").tz_localize(None))
    assert local.equals(times.index.tz_localize(None))


def memory_of(work: Callable[[], object]) -> int:
    """Largest memory that Python and numpy take meanwhile [B]."""
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("ending", ["nc", "csv"])
def test_memory_does_not_grow_with_the_period(ending: str, tmp_path: Path) -> None:
    columns, rows = 40, 100
    simulation = Simulation(box(), box_climate(), step="1h", outputs=["room.air_temperature"])
    outputs = [replace(simulation.outputs[0], name=f"o{k}") for k in range(columns)]
    block = np.random.default_rng(1).random((rows, columns))

    def written(many: int) -> Callable[[], None]:
        times = Times(0.0, 900.0 * (many * rows - 1), 900.0, parse_timezone("UTC"))

        def work() -> None:
            with files.drafted(tmp_path / f"a.{ending}", outputs, times, f".{ending}") as draft:
                for _ in range(many):
                    draft.take(block)
                draft.finish({"outputs": "[]"})

        return work

    written(1)()  # what is imported and kept for later counts for nobody
    few, many = memory_of(written(2)), memory_of(written(42))
    # Beside the rows, the stamps of all times are held: 8 B for each, and copies of them.
    assert many - few < 40 * rows * 8 * 12
    assert 40 * rows * 8 * 12 < 40 * rows * columns * 8 / 3


def test_the_engine_waits_for_the_writer(simulation: Simulation) -> None:
    """It is ahead by one block at most, however slow the writer is."""
    compiled = simulation.compiled
    ahead = []
    done = 0

    def take(rows: np.ndarray[Any, Any]) -> None:
        nonlocal done
        time.sleep(0.02)
        done += len(rows)
        ahead.append(reached[-1] - done if reached else 0)

    reached: list[int] = []
    compiled.plan.simulate_into(
        simulation.values, compiled.forcing, compiled.options(), 5, take, reached.append
    )
    assert done == len(compiled.forcing) + 1
    assert max(ahead) <= 10


class Stop(Exception):
    """Raised by a test."""


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize("ending", ["nc", "csv", "parquet"])
@pytest.mark.parametrize("error", [Stop, KeyboardInterrupt])
def test_an_interrupted_run_leaves_the_older_file(
    simulation: Simulation, ending: str, error: type[BaseException], tmp_path: Path
) -> None:
    file = tmp_path / f"run.{ending}"
    file.write_text("older", encoding="utf-8")

    def stop(done: int, _total: int) -> None:
        if done > 0:
            raise error

    def fail(_self: object, _rows: object) -> None:
        raise error

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mascarin.simulation.records.blocks.Watch.add", fail)
        with pytest.raises(error):
            simulation.run_into(file)
    with pytest.raises(error):
        simulation.run_into(file, progress=stop)
    assert file.read_text(encoding="utf-8") == "older"
    assert [path.name for path in tmp_path.iterdir()] == [file.name]


def test_a_run_that_does_not_converge_leaves_no_file(
    simulation: Simulation, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    settings = {**simulation.compiled.settings, "warmup_steps": 96, "warmup_tolerance": 0.0}
    settings["warmup_max_cycles"] = 2
    monkeypatch.setitem(simulation.compiled.__dict__, "settings", settings)
    with pytest.raises(SolverError):
        simulation.run_into(tmp_path / "run.nc")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(sys.platform == "win32", reason="no such signals")
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_a_command_that_is_ended_leaves_no_file(how: signal.Signals, tmp_path: Path) -> None:
    code = (
        "import sys, time; from mascarin.simulation.records import blocks, netcdf; from mascarin import cli\n"
        "blocks.SIZE = 80\ntake = netcdf.NetcdfDraft.take\n"
        "def slow(self, rows):\n    take(self, rows); print('row', flush=True); time.sleep(0.05)\n"
        "netcdf.NetcdfDraft.take = slow\nsys.exit(cli.main())"
    )
    example = Path(sys.modules["mascarin"].__file__ or "").parent / "examples" / "box.yaml"
    words = ["run", str(example), "--weather", "shipped:golden", "-o", "run.nc"]
    with subprocess.Popen(
        [sys.executable, "-c", code, *words],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
    ) as process:
        assert process.stdout is not None
        process.stdout.readline()
        process.send_signal(how)
        process.wait(timeout=60)
    assert process.returncode != 0
    # A process that is killed cannot remove its draft, which has another name.
    left = [path.name for path in tmp_path.iterdir() if how != signal.SIGKILL or path.name == "run.nc"]
    assert left == []


def test_bends_do_not_depend_on_the_blocks() -> None:
    simulation = Simulation(box(), box_climate(), step="1h", outputs=["room.air_temperature"])
    rows = np.cumsum(np.random.default_rng(3).normal(size=(300, 1)), axis=0)
    found = []
    for cuts in ([], [1, 2, 3, 4, 5], [150], list(range(7, 300, 7))):
        bends = Bends(simulation.building, simulation.outputs)
        for part in np.split(rows, cuts):
            bends.add(part)
        found.append(bends.errors()[0])
    assert len(set(found)) == 1
    second = np.diff(rows[3:, 0], 2)
    assert found[0] == pytest.approx(0.1 * np.sqrt(np.mean(second**2)), rel=1e-12)

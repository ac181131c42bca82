"""The short part of the campaign of random and mutated inputs; ``make fuzz`` is the long one."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path

import pytest
from conftest import SEED

import fuzz_buildings
import fuzz_kills
import fuzz_own_files
import fuzz_processes
import fuzz_readers
import fuzz_states

#: Inputs of each reader: files of a year take longer to read.
INPUTS = {"EPW": 12, "TMY3": 8, "study": 30, "IDF": 15, "design": 15}
OWN = (
    "own NetCDF", "own CSV", "own Parquet", "own store", "own store resumed", "own pieces",
    "own pieces resumed", "own study", "own record", "own log", "own case", "own weather", "own settings",
    "own report",
)  # fmt: skip
Readers = dict[str, fuzz_readers.Reader | fuzz_own_files.OwnReader]
READERS = ("building", "room", "study", "EPW", "TMY3", "table", "DSC", "GenOpt")


@pytest.fixture(scope="module")
def readers(tmp_path_factory: pytest.TempPathFactory) -> Readers:
    """Every reader by its name; their samples are made once."""
    return {reader.name: reader for reader in fuzz_readers.readers(tmp_path_factory.mktemp("samples"))}


def seed() -> int:
    """The seed of this run of the tests, which the head of the report shows."""
    return int(os.environ[SEED])


@pytest.mark.parametrize("name", READERS)
def test_mutated_inputs_are_read_or_refused(name: str, readers: Readers, tmp_path: Path) -> None:
    reader = readers[name]
    for file, content in reader.files.items():
        (tmp_path / file).write_bytes(content)
    reader.read(tmp_path)  # what is mutated can be read
    counts = fuzz_readers.run(reader, tmp_path, INPUTS.get(name, 60), seed())
    assert counts.defects == []


@pytest.mark.parametrize("name", OWN)
def test_mutated_own_files_are_read_refused_or_computed_again(
    name: str, readers: Readers, tmp_path: Path
) -> None:
    assert sorted(own for own in readers if own.startswith("own ")) == sorted(OWN)
    reader, place = readers[name], tmp_path / "place"
    for file, content in reader.files.items():
        (place / file).parent.mkdir(parents=True, exist_ok=True)
        (place / file).write_bytes(content)
    if name not in ("own settings",):
        reader.read(place)  # what is mutated can be read
    counts = fuzz_readers.run(reader, place, 10 if name == "own NetCDF" else 25, seed())
    assert counts.defects == []


def test_random_buildings_keep_the_laws() -> None:
    found = fuzz_buildings.run(25, seed())
    assert found.faults == []
    assert found.buildings == 25
    assert found.refused + found.unsolved < 13


@pytest.mark.parametrize("machine", [fuzz_states.Buildings, fuzz_states.PassiveBuildings])
def test_buildings_made_step_by_step_keep_the_laws(machine: type[fuzz_states.Buildings]) -> None:
    fuzz_states.explore(machine, seed(), histories=5)


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX systems")
@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_workers_end_with_their_parent(how: signal.Signals, tmp_path: Path) -> None:
    assert fuzz_processes.orphans(fuzz_processes.inputs(tmp_path), how) == []


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX systems")
@pytest.mark.parametrize("name", ["sweep", "optimize"])
def test_killed_commands_end_with_the_same_bytes(name: str, tmp_path: Path) -> None:
    assert fuzz_kills.killed(name, tmp_path, 2, seed()) == []


def test_two_writers_leave_one_result(tmp_path: Path) -> None:
    assert fuzz_processes.two_writers(fuzz_processes.inputs(tmp_path), 1) == []


def test_a_full_disk_leaves_work_that_can_be_finished(tmp_path: Path) -> None:
    assert fuzz_processes.full_disks(fuzz_processes.inputs(tmp_path), 2) == []

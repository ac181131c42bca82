"""Outputs: one process at a time, and refused before the work where they cannot be written."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from building_samples import ROOM
from fuzz_readers import epw_text
from genopt_support import write_project
from mascarin._io.locks import writing, writing_into
from mascarin.cli import main
from mascarin.errors import InputError, InUse
from study_support import BUILDING, STUDY, drivers

HOLD = """
import sys
from pathlib import Path
from mascarin._io.locks import writing, writing_into, FolderLock
kind, path = sys.argv[1], Path(sys.argv[2])
with {"file": writing, "folder": writing_into}[kind](path):
    print("held", flush=True)
    sys.stdin.read()
"""


@contextmanager
def held(kind: str, path: Path) -> Iterator[None]:
    """Another process that holds an output."""
    with subprocess.Popen(
        [sys.executable, "-c", HOLD, kind, str(path)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == "held\n"
        try:
            yield
        finally:
            other.communicate()


def test_an_output_that_is_held_for_a_moment_is_waited_for(tmp_path: Path) -> None:
    # As by a program that a killed process was just starting.
    brief = HOLD.replace("sys.stdin.read()", "import time; time.sleep(0.1)")
    with subprocess.Popen(
        [sys.executable, "-c", brief, "folder", str(tmp_path)], stdout=subprocess.PIPE, text=True
    ) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == "held\n"
        with writing_into(tmp_path):
            pass


@pytest.fixture(scope="module")
def inputs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a building, a weather file and a study."""
    folder = tmp_path_factory.mktemp("inputs")
    (folder / "site.epw").write_text(epw_text(), encoding="utf-8")
    (folder / "building.yaml").write_text(BUILDING, encoding="utf-8")
    (folder / "study.yaml").write_text(STUDY, encoding="utf-8")
    table = drivers(9)
    table["joint"] = table["core"] = table["room"]
    table.to_csv(folder / "logger.csv", lineterminator="\n")
    return folder


def test_a_file_is_held_by_one_process(tmp_path: Path) -> None:
    file = tmp_path / "results.csv"
    said = r"results.csv: another process is writing .* another file"
    with held("file", file), pytest.raises(InUse, match=said), writing(file):
        pass
    with writing(file):
        pass
    assert list(tmp_path.iterdir()) == []


def test_a_folder_is_held_by_one_process_and_leaves_nothing(tmp_path: Path) -> None:
    folder = tmp_path / "a" / "results"
    with held("folder", folder), pytest.raises(InUse, match="another folder"), writing_into(folder):
        pass
    assert not folder.exists()
    with writing_into(folder):
        (folder / "x").write_text("")
    assert [file.name for file in folder.iterdir()] == ["x"]


def test_two_commands_with_one_output(
    tmp_path: Path, inputs: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "results.csv"
    words = ["run", str(inputs / "room.yaml"), "--weather", str(inputs / "site.epw"), "-o", str(out)]
    (inputs / "room.yaml").write_text(ROOM, encoding="utf-8")
    with held("file", out):
        assert main([*words, "--end", "1995-01-03"]) == 2
    assert "another process is writing to this file" in capsys.readouterr().err
    assert not out.exists()


COMMANDS = {
    "sweep": ["sweep", "{room}", "--weather", "{epw}", "-o", "{out}", "--draw", "8", "--end", "1995-01-03",
              "--vary", "zones.room.volume", "--objective", "max:room.air_temperature"],
    "genopt": ["genopt", "{study}", "-o", "{out}", "--program", "mascarin"],
    "init": ["init", "{out}"],
    "bestest": ["bestest", "600", "--weather", "{epw}", "-o", "{out}"],
}  # fmt: skip


@pytest.mark.parametrize("name", COMMANDS)
def test_the_second_process_in_a_folder_says_so(
    name: str, tmp_path: Path, inputs: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (inputs / "room.yaml").write_text(ROOM, encoding="utf-8")
    places = {
        "room": inputs / "room.yaml", "epw": inputs / "site.epw", "study": inputs / "study.yaml",
        "out": tmp_path / "out",
    }  # fmt: skip
    with held("folder", tmp_path / "out"):
        assert main([word.format(**places) for word in COMMANDS[name]]) == 2
    said = capsys.readouterr().err
    assert "another process is writing to this folder" in said or "is not empty" in said


def test_two_optimizations_of_one_project(tmp_path: Path) -> None:
    slow = "import time; time.sleep(30)"
    ini = write_project(tmp_path / "project", program=slow)
    words = [sys.executable, "-m", "mascarin.cli", "optimize", str(ini), "--quiet"]
    with subprocess.Popen(words, stderr=subprocess.PIPE) as first:
        lock = ini.parent / ".mascarin.lock"
        while not lock.exists() and first.poll() is None:
            time.sleep(0.01)
        while not (ini.parent / "tmp-genopt-run-1").exists() and first.poll() is None:
            time.sleep(0.01)
        second = subprocess.run(words, capture_output=True, text=True, check=False)
        first.terminate()
    assert second.returncode == 2
    assert "another process is writing to this folder" in second.stderr
    assert first.returncode == 143
    assert not lock.exists()


@pytest.mark.skipif(sys.platform == "win32", reason="pipes and devices of POSIX systems")
def test_what_is_no_file_is_refused_as_output(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe.csv"
    os.mkfifo(pipe)
    for path, found in ((pipe, "a named pipe"), (Path("/dev/null"), "a device"), (tmp_path, "a folder")):
        with pytest.raises(InputError, match=f"found {found}, expected a file to write"), writing(path):
            pass
    with pytest.raises(InputError, match="expected an existing folder"), writing(tmp_path / "no" / "a.csv"):
        pass


def test_an_output_is_refused_before_the_run(
    tmp_path: Path, inputs: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from mascarin.simulation.simulation import Simulation

    def never(self: Simulation) -> None:
        raise AssertionError("the run has begun")

    monkeypatch.setattr(Simulation, "run", never)
    (inputs / "room.yaml").write_text(ROOM, encoding="utf-8")
    words = ["run", str(inputs / "room.yaml"), "--weather", str(inputs / "site.epw"), "--end", "1995-01-02"]
    assert main([*words, "-o", str(tmp_path / "none" / "a.csv")]) == 2
    assert "expected an existing folder" in capsys.readouterr().err
    (tmp_path / "a.nc").mkdir()
    assert main([*words, "-o", str(tmp_path / "a.nc")]) == 2
    assert "found a folder" in capsys.readouterr().err

"""Atomic writes, folder locks and short descriptions."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from mascarin._io import atomic, display, locks
from mascarin._io.locks import FolderLock
from mascarin._io.tables import read_csv
from mascarin.errors import InputError


def test_a_file_is_replaced_whole(tmp_path: Path) -> None:
    target = tmp_path / "a.csv"
    atomic.write(target, "old")
    atomic.write(target, b"new\r\n")
    assert target.read_bytes() == b"new\r\n"
    assert [path.name for path in tmp_path.iterdir()] == ["a.csv"]


def test_a_failure_keeps_the_old_file(tmp_path: Path) -> None:
    target = tmp_path / "a.csv"
    atomic.write(target, "old")

    def fail() -> None:
        with atomic.replacing(target) as file:
            file.write(b"half")
            raise RuntimeError("disk")

    with pytest.raises(RuntimeError, match="disk"):
        fail()
    assert target.read_text() == "old"
    assert [path.name for path in tmp_path.iterdir()] == ["a.csv"]


def test_two_writers_do_not_mix(tmp_path: Path) -> None:
    target = tmp_path / "a.csv"
    with atomic.replacing(target) as first:
        first.write(b"first")
        with atomic.replacing(target) as second:
            second.write(b"2")
        assert target.read_bytes() == b"2"
    assert target.read_bytes() == b"first"


@pytest.mark.skipif(sys.platform == "win32", reason="permissions of POSIX systems")
def test_a_new_file_has_the_usual_permissions(tmp_path: Path) -> None:
    usual = tmp_path / "usual"
    usual.write_text("")
    atomic.write(tmp_path / "ours", "")
    assert (tmp_path / "ours").stat().st_mode == usual.stat().st_mode


def test_drafts_of_killed_processes_are_removed(tmp_path: Path) -> None:
    (tmp_path / ".a.csv.x1.part").write_text("half")
    (tmp_path / "b.csv").write_text("whole")
    atomic.remove_drafts(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["b.csv"]


def test_a_locked_folder_refuses_a_second_process(tmp_path: Path) -> None:
    code = (
        "import sys; from pathlib import Path; from mascarin._io.locks import FolderLock\n"
        "lock = FolderLock(Path(sys.argv[1])); print('held', flush=True); sys.stdin.read()"
    )
    with subprocess.Popen(
        [sys.executable, "-c", code, str(tmp_path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
        env=dict(os.environ), text=True,
    ) as other:  # fmt: skip
        assert other.stdout is not None
        assert other.stdout.readline() == "held\n"
        with pytest.raises(InputError, match=r"another process is writing .* choose another folder"):
            FolderLock(tmp_path)
        other.kill()
    with FolderLock(tmp_path):
        pass


def test_text_has_at_most_fifteen_lines() -> None:
    rows = [(f"name {k}", "x" * 200) for k in range(40)]
    lines = display.text("Title", rows).splitlines()
    assert len(lines) == 15
    assert lines[-1] == "  ... 27 more"
    assert max(map(len, lines)) <= 100


def test_html_is_escaped() -> None:
    table = pd.DataFrame({"<b>": ["<script>"]})
    found = display.page("<i>", [("<a>", "<u>")], tables={"<em>": table})
    for tag in ("<i>", "<a>", "<u>", "<em>", "<b>", "<script>"):
        assert tag not in found
    assert found.count("<details>") == 1


def test_a_library_that_writes_to_a_name_replaces_whole(tmp_path: Path) -> None:
    target = tmp_path / "a.csv"
    with atomic.drafted(target) as draft:
        draft.write_text("whole")
        assert not target.exists()
    assert target.read_text() == "whole"
    assert [path.name for path in tmp_path.iterdir()] == ["a.csv"]


@pytest.mark.parametrize("decimal", [".", ","])
def test_numbers_of_a_csv_file_are_read_to_the_last_digit(tmp_path: Path, decimal: str) -> None:
    rng = np.random.default_rng(7)
    written = rng.normal(size=5000) * 10.0 ** rng.integers(-12, 13, 5000)
    # The text that Python writes for a number is read by Python as the same number.
    lines = [repr(value).replace(".", decimal) for value in written.tolist()]
    (tmp_path / "a.csv").write_text("\n".join(["x", *lines]) + "\n", encoding="utf-8")
    found = read_csv(tmp_path / "a.csv", sep=";", decimal=decimal)
    np.testing.assert_array_equal(found["x"].to_numpy(), written)


def test_what_a_killed_process_left_is_removed_by_the_next_command(tmp_path: Path) -> None:
    target, foreign = tmp_path / "room.fmu", tmp_path / "film.part"
    foreign.write_text("a download")
    killed = (
        "import os, signal, sys\nfrom pathlib import Path\nfrom mascarin._io import atomic\n"
        "with getattr(atomic, sys.argv[2])(Path(sys.argv[1])):\n    os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    for how in ("replacing", "drafted"):
        subprocess.run([sys.executable, "-c", killed, str(target), how], check=False)
    assert len(list(tmp_path.glob(".room.fmu.*.part"))) == 2
    with locks.writing(target):
        assert [file.name for file in tmp_path.glob("*.part")] == ["film.part"]
    subprocess.run([sys.executable, "-c", killed, str(target), "drafted"], check=False)
    with locks.writing_into(tmp_path):
        assert [file.name for file in tmp_path.glob("*.part")] == ["film.part"]
    # Without a lock another process may still be writing: only what is older than a day is removed.
    for name in (".a.csv.abcdefgh.mascarin.part", ".b.csv.abcdefgh.mascarin.part", ".c.abcdefgh.part"):
        (tmp_path / name).write_text("half")
    old = time.time() - 2 * atomic.OLD
    os.utime(tmp_path / ".a.csv.abcdefgh.mascarin.part", (old, old))
    atomic._cleaned.clear()
    atomic.write(tmp_path / "c.csv", "whole")
    left = [".b.csv.abcdefgh.mascarin.part", ".c.abcdefgh.part", "film.part"]
    assert sorted(file.name for file in tmp_path.glob("*.part")) == left
    # What is written under a lock of another process stays; a file of another program, too.
    with locks.writing(tmp_path / "b.csv"):
        (tmp_path / left[0]).write_text("half")
        with locks.writing_into(tmp_path):
            assert sorted(file.name for file in tmp_path.glob("*.part")) == left

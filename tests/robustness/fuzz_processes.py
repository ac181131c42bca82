"""Processes that are killed, that find a full disk, or that share an output: what they leave behind."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import psutil

from building_samples import ROOM
from fuzz_readers import epw_text

#: As a command that is killed again and again: the same bytes in the end.
SWEEP = ("--draw", "24", "--seed", "3", "--step", "1h", "--end", "1995-01-09", "--objective",
         "max:room.air_temperature", "--vary", "zones.room.volume")  # fmt: skip


def inputs(folder: Path) -> Path:
    """Write a building and a weather file."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "site.epw").write_text(epw_text(), encoding="utf-8")
    (folder / "room.yaml").write_text(ROOM, encoding="utf-8")
    return folder


def mascarin(*words: str) -> list[str]:
    """The command line of a command."""
    return [sys.executable, "-m", "mascarin.cli", *words]


def sweep(folder: Path, out: Path, *more: str) -> list[str]:
    """A sweep of 24 members."""
    place = (str(folder / "room.yaml"), "--weather", str(folder / "site.epw"))
    return mascarin("sweep", *place, "-o", str(out), *SWEEP, *more)


def content(folder: Path) -> dict[str, bytes]:
    """Files of a folder by name, without the lock."""
    return {
        str(file.relative_to(folder)): file.read_bytes()
        for file in sorted(folder.rglob("*"))
        if file.is_file() and file.name != ".lock"
    }


def two_writers(folder: Path, count: int) -> list[str]:
    """Start two runs with one output at the same time; one is refused, or both run one after the other.

    Returns
    -------
    list of str
        What was wrong.
    """
    faults = []
    place = (str(folder / "room.yaml"), "--weather", str(folder / "site.epw"), "--end", "1995-01-03")
    steps, out = ("30min", "1h"), folder / "both.csv"
    each = []
    for step in steps:
        subprocess.run(
            mascarin("run", *place, "--step", step, "-o", str(out)), check=True, capture_output=True
        )
        each.append(out.read_bytes())
    for _ in range(count):
        out.unlink(missing_ok=True)
        both = [
            subprocess.Popen(
                mascarin("run", *place, "--step", step, "-o", str(out)), stderr=subprocess.PIPE, text=True
            )
            for step in steps
        ]
        said = [process.communicate()[1] for process in both]
        for process, text in zip(both, said, strict=True):
            refused = process.returncode == 2 and "another process is writing" in text
            if process.returncode != 0 and not refused:
                faults.append(f"one of two writers ended with {process.returncode}: {text}")
        if all(process.returncode for process in both) or out.read_bytes() not in each:
            faults.append("two writers of one file left neither of the two results")
        left = [file.name for file in folder.iterdir() if file.name.startswith(".")]
        if left:
            faults.append(f"two writers of one file left {left}")
    return faults


FULL = """
import errno, os, sys
from mascarin.cli import main
allowed = int(sys.argv.pop(1))
real = os.fsync
def fsync(handle):
    global allowed
    allowed -= 1
    if allowed < 0:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    real(handle)
os.fsync = fsync
sys.exit(main(sys.argv[1:]))
"""


def full_disks(folder: Path, count: int) -> list[str]:
    """Let the disk be full at the n-th file that is flushed; afterwards the same command finishes the work.

    Returns
    -------
    list of str
        What was wrong.
    """
    faults = []
    whole = folder / "whole"
    if not whole.exists():
        subprocess.run(sweep(folder, whole), check=True, capture_output=True)
    expected = content(whole)
    for n in range(count):
        out = folder / f"full{n}"
        words = [sys.executable, "-c", FULL, str(n), *sweep(folder, out)[3:]]
        ended = subprocess.run(words, capture_output=True, text=True, check=False)
        if ended.returncode not in (0, 2) or (ended.returncode == 2 and "Make room" not in ended.stderr):
            faults.append(f"a full disk at file {n} ended with {ended.returncode}: {ended.stderr}")
        subprocess.run(sweep(folder, out), check=True, capture_output=True)
        if content(out) != expected:
            faults.append(
                f"after a full disk at file {n} the results are not those of a sweep that ran through"
            )
    return faults


#: Time for workers to end; they take a fraction of a second on a machine that is not busy. [s]
WITHIN = 10.0


def _alive(process: psutil.Process) -> bool:
    """Whether a process runs; one that has ended and that nobody has asked for does not."""
    try:
        return process.is_running() and process.status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False


def orphans(folder: Path, how: int, workers: int = 2) -> list[str]:
    """End a sweep with workers, and look for workers that outlive it.

    Returns
    -------
    list of str
        What was wrong.
    """
    out = folder / f"orphans{how}"
    members = ("--workers", str(workers), "--draw", "100000", "--step", "5min", "--end", "1995-12-01")
    words = [
        word
        for word in sweep(folder, out)
        if word not in ("--draw", "24", "--step", "1h", "--end", "1995-01-09")
    ]
    with subprocess.Popen(
        [*words, *members], stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL
    ) as process:
        watched, until = psutil.Process(process.pid), time.monotonic() + 60.0
        children: list[psutil.Process] = []
        while len(children) < workers + 1 and time.monotonic() < until and process.poll() is None:
            children = watched.children(recursive=True)  # the workers and a tracker of resources
            time.sleep(0.05)
        time.sleep(1.0)
        children = watched.children(recursive=True)
        os.kill(process.pid, how)
        code = process.wait()
        until = time.monotonic() + WITHIN
        while (alive := [one for one in children if _alive(one)]) and time.monotonic() < until:
            time.sleep(0.05)
    shutil.rmtree(out, ignore_errors=True)
    faults = (
        [f"{len(alive)} of {len(children)} workers outlived signal {how} by {WITHIN:g} s"] if alive else []
    )
    if len(children) < workers:
        faults.append(f"found {len(children)} workers, expected {workers}")
    if code not in (-how, 130, 143):
        faults.append(f"signal {how} ended the sweep with {code}")
    for process_left in alive:
        process_left.kill()
    return faults

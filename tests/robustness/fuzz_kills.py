"""Commands that are killed at random times and started again: the same bytes in the end."""

from __future__ import annotations

import random
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import fuzz_processes
from design_support import written
from genopt_support import write_project
from study_support import BUILDING, STUDY, logger_table

#: Ends of a command that was killed, and 1: that of GenOpt for every error, interruptions included.
ENDS = {
    0,
    1,
    130,
    143,
    -signal.SIGTERM,
    -signal.SIGINT,
    *([-signal.SIGKILL] if sys.platform != "win32" else []),
}


@dataclass(frozen=True)
class Loop:
    """A command with its inputs, how it is continued, and what it must leave."""

    #: Writes the inputs into an empty folder.
    prepare: Callable[[Path], object]
    #: Words of the command that begins or continues the work.
    words: Callable[[Path], list[str]]
    #: Files that it must leave, by name.
    results: Callable[[Path], dict[str, bytes]]
    #: Kills come within this time. [s]
    longest: float


def loops() -> dict[str, Loop]:
    """The commands by name."""
    return {
        "sweep": Loop(
            fuzz_processes.inputs,
            lambda folder: fuzz_processes.sweep(folder, folder / "out"),
            lambda folder: fuzz_processes.content(folder / "out"),
            4.0,
        ),
        "optimize": Loop(write_project, _optimize, _listings, 4.0),
        "study": Loop(
            _study,
            lambda folder: fuzz_processes.mascarin(
                "study", str(folder / "study.yaml"), "-o", str(folder / "out")
            ),
            _tables,
            15.0,
        ),
        "design": Loop(
            _design,
            lambda folder: fuzz_processes.mascarin(
                "design", str(folder / "design.yaml"), "-o", str(folder / "out")
            ),
            _designs,
            8.0,
        ),
    }


def _optimize(folder: Path) -> list[str]:
    begun = (folder / "opt.evaluations.jsonl").exists()
    words = fuzz_processes.mascarin("optimize", str(folder / "opt.ini"), "--quiet")
    return [*words, "--resume"] if begun else words


def _listings(folder: Path) -> dict[str, bytes]:
    """Listings of GenOpt without the lines with the date, the folder and the time of the run."""
    found = {}
    for file in folder.glob("OutputListing*.txt"):
        lines = file.read_bytes().splitlines()
        found[file.name] = b"\n".join(line for line in lines if line[:1].isdigit())
    return found


def _study(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "building.yaml").write_text(BUILDING, encoding="utf-8")
    (folder / "study.yaml").write_text(STUDY, encoding="utf-8")
    logger_table(folder / "building.yaml").round(3).to_csv(folder / "logger.csv")


def _design(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    written(folder)


def _designs(folder: Path) -> dict[str, bytes]:
    return {file.name: file.read_bytes() for file in (folder / "out").glob("*.*") if file.is_file()}


def _tables(folder: Path) -> dict[str, bytes]:
    out = folder / "out"
    files = [out / "study.json", *sorted((out / "tables").glob("*"))]
    return {file.name: file.read_bytes() for file in files if file.is_file()}


def _other(found: dict[str, bytes], expected: dict[str, bytes]) -> str:
    """Where results differ first; empty where they do not."""
    for name in sorted(found.keys() | expected.keys()):
        here, there = found.get(name, b""), expected.get(name, b"")
        if here != there:
            at = next((k for k, (a, b) in enumerate(zip(here, there, strict=False)) if a != b), 0)
            low = max(0, at - 60)
            return f"{name}, byte {at}: {here[low : at + 60]!r} instead of {there[low : at + 60]!r}"
    return ""


def killed(name: str, folder: Path, count: int, seed: int) -> list[str]:
    """Kill a command at random times until `count` kills have hit; then it is finished and compared.

    Returns
    -------
    list of str
        What was wrong.
    """
    loop, draw, faults, kills = loops()[name], random.Random(f"{name} {seed}"), [], 0
    whole, place = folder / f"{name}-whole", folder / f"{name}-killed"
    loop.prepare(whole)
    subprocess.run(loop.words(whole), check=True, capture_output=True)
    expected = loop.results(whole)
    assert expected
    loop.prepare(place)
    while True:
        finish = kills >= count
        with subprocess.Popen(
            loop.words(place), stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True
        ) as process:
            if not finish:
                try:
                    process.wait(draw.uniform(0.3, loop.longest))
                except subprocess.TimeoutExpired:
                    process.send_signal(draw.choice((signal.SIGKILL, signal.SIGTERM, signal.SIGINT)))
                    kills += 1
            said = process.communicate()[1]
        if process.returncode not in ENDS:
            faults.append(f"a killed {name} ended with {process.returncode}: {said[-1000:]}")
        if process.returncode == 0 or finish:
            if other := _other(loop.results(place), expected):
                faults.append(f"after {kills} kills a {name} has other results: {other}; {said[-1000:]}")
            if finish:
                return faults
            shutil.rmtree(place)
            loop.prepare(place)

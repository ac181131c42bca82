"""Commands that are interrupted at random times: processor time from the signal to their end."""

from __future__ import annotations

import os
import random
import shutil
import signal
import subprocess
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import psutil

import fuzz_kills
import fuzz_processes

#: Processor time from the signal to the end of a command. [s]
WITHIN = 0.5
#: Exit codes after a signal: of a command that was done before (1: a missed criterion, and GenOpt), that was
#: interrupted, or whose interpreter had not begun.
ENDS = {
    signal.SIGINT: {0, 1, 130, -signal.SIGINT},
    signal.SIGTERM: {0, 1, 143, -signal.SIGTERM},
}


@dataclass(frozen=True)
class Command:
    """A command with its inputs."""

    #: Writes the inputs into an empty folder.
    prepare: Callable[[Path], object]
    #: Words of the command line.
    words: Callable[[Path], list[str]]


def commands() -> dict[str, Command]:
    """The commands by name."""
    room = fuzz_processes.inputs

    def run(*more: str) -> Callable[[Path], list[str]]:
        return lambda folder: fuzz_processes.mascarin(
            "run", str(folder / "room.yaml"), "--weather", str(folder / "site.epw"), "--step", "5min",
            *(word.replace("OUT", str(folder)) for word in more),
        )  # fmt: skip

    found = {
        "run, NetCDF": Command(room, run("-o", "OUT/out.nc")),
        "run, CSV": Command(room, run("-o", "OUT/out.csv")),
        "run, report": Command(room, run("--report", "OUT/out.html")),
    }
    return found | {name: Command(loop.prepare, loop.words) for name, loop in fuzz_kills.loops().items()}


def interrupted(name: str, folder: Path, count: int, seed: int) -> tuple[float, list[str]]:
    """Interrupt a command `count` times, at times spread over its whole length.

    Returns
    -------
    float
        Longest processor time from a signal to the end. [s]
    list of str
        What was wrong.
    """
    command, draw, faults, longest = commands()[name], random.Random(f"{name} {seed}"), [], 0.0
    place = folder / name.replace(", ", "-")
    command.prepare(place)
    began = time.monotonic()
    subprocess.run(command.words(place), check=True, capture_output=True)
    whole = time.monotonic() - began
    for k in range(count):
        shutil.rmtree(place)
        command.prepare(place)
        number = draw.choice(list(ENDS))
        spent, code, said = _ended(command.words(place), whole * (k + draw.random()) / count, number)
        longest = max(longest, spent)
        if code not in ENDS[number]:
            faults.append(f"{name} ended with {code} after {number.name}: {said[-1000:]}")
        elif spent > WITHIN:
            faults.append(f"{name} took {spent:.2f} s of processor time after {number.name}: {said[-300:]}")
        elif "Traceback" in said:
            faults.append(f"{name} showed a traceback after {number.name}: {said[-1000:]}")
    return longest, faults


def _ended(words: list[str], after: float, number: signal.Signals) -> tuple[float, int, str]:
    """Processor time from the signal to the end, exit code and what was said."""
    with subprocess.Popen(words, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True) as process:
        try:
            said = process.communicate(timeout=after)[1]
        except subprocess.TimeoutExpired:
            before = _spent(process.pid)
            process.send_signal(number)
            assert process.stderr is not None
            said = process.stderr.read()
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            return usage.ru_utime + usage.ru_stime - before, process.returncode, said
    return 0.0, process.returncode, said


def _spent(pid: int) -> float:
    """Processor time of a process and its children. [s]"""
    try:
        program = psutil.Process(pid)
        times = [one.cpu_times() for one in (program, *program.children(recursive=True))]
        own = program.cpu_times()
    except psutil.NoSuchProcess:
        return 0.0
    return sum(one.user + one.system for one in times) + own.children_user + own.children_system

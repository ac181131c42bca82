"""The campaign in parts: processes that try inputs, watched, with a journal from which it is continued."""

from __future__ import annotations

import contextlib
import json
import queue
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TextIO

import psutil

CHILD = Path(__file__).with_name("fuzz_child.py")
#: Processor time after which an input is ended, with its process. [s]
HANGS = 60.0
#: Inputs of a process: starting one takes as long as a hundred of them.
INPUTS = 500


@dataclass(frozen=True)
class Part:
    """Inputs `first` to `last` - 1 of a kind: the name of a reader, or ``buildings``."""

    kind: str
    seed: int
    first: int
    last: int


def parts(kind: str, seed: int, count: int) -> list[Part]:
    """The parts of `count` inputs."""
    return [Part(kind, seed, first, min(first + INPUTS, count)) for first in range(0, count, INPUTS)]


def attempt(part: Part) -> list[dict[str, Any]]:
    """Try the inputs of a part; one that ends or blocks the process is a defect, and another one goes on."""
    found: list[dict[str, Any]] = []
    first = part.first
    while first < part.last:
        begun, ended = None, ""
        for message in _watched(part, first):
            if "begun" in message:
                begun = message["begun"]
            elif "ended" in message:
                ended = message["ended"]
            else:
                found.append(message)
                first, begun = message["n"] + 1, None
        if first >= part.last:
            break
        lost = first if begun is None else begun
        found.append({"n": lost, "seconds": 0.0, "outcome": "defect", "text": f"the process {ended}"})
        first = lost + 1
    return found


def _watched(part: Part, first: int) -> Iterator[dict[str, Any]]:
    """Messages of a process, the last with how it ended."""
    words = [sys.executable, str(CHILD), part.kind, str(part.seed), str(first), str(part.last)]
    lines: queue.Queue[str | None] = queue.Queue()
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None
        assert child.stderr is not None
        errors: list[str] = []
        for stream, take in ((child.stdout, lines.put), (child.stderr, errors.append)):
            threading.Thread(target=_forward, args=(stream, take, lines), daemon=True).start()
        watched, used, why, open_streams = psutil.Process(child.pid), 0.0, "", 2
        while open_streams:
            try:
                line = lines.get(timeout=1.0)
            except queue.Empty:
                if _seconds(watched) - used > HANGS:
                    why = f"was ended after {HANGS:g} s of processor time on one input"
                    child.kill()
                continue
            if line is None:
                open_streams -= 1
            else:
                used = _seconds(watched)
                yield json.loads(line)
        code = child.wait()
        yield {"ended": why or f"ended with {code}: {''.join(errors)[-2000:]}"}


def _forward(stream: TextIO, take: Any, lines: queue.Queue[str | None]) -> None:
    for line in stream:
        take(line)
    lines.put(None)


def _seconds(process: psutil.Process) -> float:
    """Processor time of a process. [s]"""
    with contextlib.suppress(psutil.Error):
        times = process.cpu_times()
        return float(times.user + times.system)
    return 0.0


class Journal:
    """Parts that are done, one JSON text a line; without a file nothing is kept.

    Parameters
    ----------
    path : Path or None
        The file; what is in it is not done again.
    """

    def __init__(self, path: Path | None) -> None:
        self._path = path
        self._done: dict[Part, list[dict[str, Any]]] = {}
        if path is not None and path.exists():
            for line in path.read_text(encoding="utf-8").splitlines():
                kept = json.loads(line)
                self._done[Part(*kept["part"])] = kept["found"]

    def found(self, part: Part) -> list[dict[str, Any]] | None:
        """What became of the inputs of a part, if it is done."""
        return self._done.get(part)

    def add(self, part: Part, found: list[dict[str, Any]]) -> None:
        """Keep a part."""
        self._done[part] = found
        if self._path is not None:
            kept = {"part": [part.kind, part.seed, part.first, part.last], "found": found}
            with self._path.open("a", encoding="utf-8") as file:
                file.write(json.dumps(kept) + "\n")


def run(wanted: list[Part], processes: int, journal: Journal) -> Iterator[tuple[Part, list[dict[str, Any]]]]:
    """Do parts, `processes` at once; defects are printed as they come.

    Yields
    ------
    Part
        A part.
    list of dict
        The outcome of each of its inputs.
    """
    waiting: queue.SimpleQueue[Part] = queue.SimpleQueue()
    done: queue.SimpleQueue[tuple[Part, list[dict[str, Any]]]] = queue.SimpleQueue()
    for part in wanted:
        found = journal.found(part)
        if found is None:
            waiting.put(part)
        else:
            done.put((part, found))

    def work() -> None:
        with contextlib.suppress(queue.Empty):
            while True:
                part = waiting.get_nowait()
                done.put((part, attempt(part)))

    threads = [threading.Thread(target=work, daemon=True) for _ in range(processes)]
    for thread in threads:
        thread.start()
    began = time.monotonic()
    for count in range(len(wanted)):
        part, found = done.get()
        if journal.found(part) is None:
            journal.add(part, found)
            minutes = (time.monotonic() - began) / 60.0
            print(f"{count + 1} of {len(wanted)} parts, {minutes:.0f} min", file=sys.stderr, flush=True)
            for one in found:
                if one["outcome"] == "defect" or one["seconds"] > 5.0:
                    print(f"{part.kind}, seed {part.seed}, {one}", file=sys.stderr, flush=True)
        yield part, found

"""The long campaign of random and mutated inputs: ``make fuzz``, with the numbers on the command line.

Prints the counts as tables for docs/robustness.md and every defect with what repeats it. Exits with 1 if
there is one.
"""

from __future__ import annotations

import argparse
import os
import signal
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import _folders  # noqa: F401
import fuzz_buildings
import fuzz_interruptions
import fuzz_kills
import fuzz_parts
import fuzz_processes
import fuzz_readers


def main() -> int:
    """Run what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--inputs", type=int, default=8000, help="mutated inputs, of all readers together")
    parser.add_argument("--buildings", type=int, default=300, help="random buildings")
    parser.add_argument("--states", type=int, default=30, help="histories of buildings made step by step")
    parser.add_argument("--kills", type=int, default=20, help="kills, of sweep, optimize and study together")
    parser.add_argument("--interruptions", type=int, default=14, help="of all commands together")
    parser.add_argument("--writers", type=int, default=5, help="pairs of writers of one file")
    parser.add_argument("--disks", type=int, default=5, help="full disks")
    parser.add_argument("--seed", type=int, default=0, help="the same seed gives the same inputs")
    parser.add_argument("--only", default="", help="names of readers, with commas; default all")
    parser.add_argument("--processes", type=int, default=os.cpu_count() or 1, help="inputs tried at once")
    parser.add_argument("--journal", type=Path, help="file of what is done; the same command continues it")
    asked = parser.parse_args()
    began = time.monotonic()
    with tempfile.TemporaryDirectory() as name:
        defects = _inputs(Path(name), asked)
        defects += _processes(Path(name), asked)
    print(f"\n{len(defects)} defects; {time.monotonic() - began:.0f} s")
    for text in defects:
        print(f"\n{text}")
    return 1 if defects else 0


def _inputs(folder: Path, asked: argparse.Namespace) -> list[str]:
    """Mutated inputs and random buildings; what is wrong with them."""
    names = [reader.name for reader in fuzz_readers.readers(folder / "samples")]
    chosen = [name for name in names if not asked.only or name in asked.only.split(",")]
    each = {name: asked.inputs // len(chosen) for name in chosen} | {
        "buildings": asked.buildings,
        "states": asked.states,
    }
    wanted = [part for name, count in each.items() for part in fuzz_parts.parts(name, asked.seed, count)]
    # Parts of all kinds from the start, so that defects of each are seen early.
    wanted.sort(key=lambda part: part.first / max(each[part.kind], 1))
    counts = {name: fuzz_readers.Counts() for name in chosen}
    counts["states"] = fuzz_readers.Counts()
    buildings = fuzz_buildings.Found()
    for part, found in fuzz_parts.run(wanted, asked.processes, fuzz_parts.Journal(asked.journal)):
        for one in found:
            if part.kind == "buildings":
                buildings.add(_building(one, asked.seed))
            else:
                counts[part.kind].add(one["n"], one["outcome"], one["text"], one["seconds"])
    print(f"seed {asked.seed}\n\n| reader | inputs | read | refused | unsolved | defects | above 5 s |")
    print("|---|---:|---:|---:|---:|---:|---:|")
    for name in chosen:
        print(counts[name].row(name))
    print("\n| random buildings | runs | refused | unsolved | slow | largest residual | faults |")
    print("|---:|---:|---:|---:|---:|---:|---:|")
    numbers = (buildings.buildings, buildings.runs, buildings.refused, buildings.unsolved, buildings.slow)
    row = f"| {' | '.join(map(str, numbers))} | {buildings.largest_closure:.1e} | {len(buildings.faults)} |"
    print(row, flush=True)
    states = counts["states"]
    print(f"\n{states.inputs} histories of buildings made step by step, {len(states.defects)} faults")
    defects = [
        f"{name}, seed {asked.seed}, input {n}:\n{text}"
        for name in counts
        for n, text in [*counts[name].defects, *((n, "too slow") for n in _slow(name, counts))]
    ]
    return defects + buildings.faults


def _slow(name: str, counts: dict[str, fuzz_readers.Counts]) -> list[int]:
    """Inputs that took too long; a history of a building is many runs."""
    return [] if name == "states" else counts[name].slow


def _building(one: dict[str, Any], seed: int) -> fuzz_buildings.Found:
    """Counts of one random building; the process that checked it may have ended before it said them."""
    return fuzz_buildings.Found(
        buildings=1, runs=one.get("runs", 0), refused=one["outcome"] == "refused",
        unsolved=one["outcome"] == "unsolved", slow=one.get("slow", 0),
        largest_closure=one.get("residual", 0.0),
        faults=[f"building, seed {seed}, number {one['n']}: {one['text']}"] * (one["outcome"] == "defect"),
    )  # fmt: skip


def _processes(folder: Path, asked: argparse.Namespace) -> list[str]:
    place = fuzz_processes.inputs(folder / "processes")
    rows: list[tuple[str, int, list[str]]] = []
    if asked.kills:
        commands = list(fuzz_kills.loops())
        for k, name in enumerate(commands):
            count = (asked.kills + k) // len(commands)
            faults = fuzz_kills.killed(name, folder / "kills", count, asked.seed)
            rows.append((f"kills of {name}", count, faults))
        ends = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT)
        rows += [
            (f"sweeps with workers ended by {how.name}", 1, fuzz_processes.orphans(place, how))
            for how in ends
        ]
    if asked.interruptions:
        commands = list(fuzz_interruptions.commands())
        for k, name in enumerate(commands):
            count = (asked.interruptions + k) // len(commands)
            longest, faults = fuzz_interruptions.interrupted(
                name, folder / "interruptions", count, asked.seed
            )
            rows.append((f"interruptions of {name} (longest {longest:.2f} s)", count, faults))
    if asked.disks:
        rows.append(("full disks", asked.disks, fuzz_processes.full_disks(place, asked.disks)))
    if asked.writers:
        rows.append(("pairs of writers", asked.writers, fuzz_processes.two_writers(place, asked.writers)))
    print("\n| processes | count | faults |\n|---|---:|---:|")
    for name, count, faults in rows:
        print(f"| {name} | {count} | {len(faults)} |", flush=True)
    return [fault for _, _, faults in rows for fault in faults]


if __name__ == "__main__":
    sys.exit(main())

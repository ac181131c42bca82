"""The long campaign of random and mutated inputs: ``make fuzz``, with the numbers on the command line.

Prints the counts as tables for docs/robustness.md and every defect with what repeats it. Exits with 1 if
there is one.
"""

from __future__ import annotations

import argparse
import signal
import sys
import tempfile
import time
from pathlib import Path

import fuzz_buildings
import fuzz_processes
import fuzz_readers


def main() -> int:
    """Run what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--inputs", type=int, default=1000, help="mutated inputs of each reader")
    parser.add_argument("--buildings", type=int, default=300, help="random buildings")
    parser.add_argument("--kills", type=int, default=20, help="kills of a sweep")
    parser.add_argument("--writers", type=int, default=5, help="pairs of writers of one file")
    parser.add_argument("--disks", type=int, default=5, help="full disks")
    parser.add_argument("--seed", type=int, default=0, help="the same seed gives the same inputs")
    parser.add_argument("--only", default="", help="names of readers, with commas; default all")
    asked = parser.parse_args()
    began, defects = time.monotonic(), []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        print(f"seed {asked.seed}\n\n| reader | inputs | read | refused | defects | above 5 s |")
        print("|---|---:|---:|---:|---:|---:|", flush=True)
        for reader in fuzz_readers.readers(folder / "samples"):
            if asked.only and reader.name not in asked.only.split(","):
                continue
            place = folder / reader.name
            place.mkdir()
            counts = fuzz_readers.run(reader, place, asked.inputs, asked.seed)
            print(counts.row(reader.name), flush=True)
            defects += [f"{reader.name}, seed {asked.seed}, input {n}:\n{text}" for n, text in counts.defects]
        defects += _buildings(asked.buildings, asked.seed)
        defects += _processes(folder, asked)
    print(f"\n{len(defects)} defects; {time.monotonic() - began:.0f} s")
    for text in defects:
        print(f"\n{text}")
    return 1 if defects else 0


def _buildings(count: int, seed: int) -> list[str]:
    if not count:
        return []
    found = fuzz_buildings.run(count, seed)
    print("\n| random buildings | runs | refused | unsolved | slow | largest residual | faults |")
    print("|---:|---:|---:|---:|---:|---:|---:|")
    numbers = (found.buildings, found.runs, found.refused, found.unsolved, found.slow)
    print(
        f"| {' | '.join(map(str, numbers))} | {found.largest_closure:.1e} | {len(found.faults)} |", flush=True
    )
    return found.faults


def _processes(folder: Path, asked: argparse.Namespace) -> list[str]:
    place = fuzz_processes.inputs(folder / "processes")
    rows: list[tuple[str, int, list[str]]] = []
    if asked.kills:
        rows.append(
            ("kills of a sweep", asked.kills, fuzz_processes.killed_sweeps(place, asked.kills, asked.seed))
        )
        ends = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT)
        rows += [
            (f"sweeps with workers ended by {how.name}", 1, fuzz_processes.orphans(place, how))
            for how in ends
        ]
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

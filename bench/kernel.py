"""The engine beside a program written by hand for one cell: times in turns, instructions and allocations.

    python bench/kernel.py FOLDER [--rounds 5] [--write docs/speed.md]

FOLDER is that of the kernel, a crate with a program `fastb`: the same cell with 46 nodes, 92 days, SDIRK2 at
900 s, two iterations a stage, without ledger, warm-up, tolerance, windows, loads or openings, and with fused
multiply-add. It is a bound to come near to. Both are built for x86-64-v3. The kernel times itself by the
clock and the engine by the processor, one after the other in each round; the shortest time of each counts, so
that the machine has to be quiet. Instructions of a stage and allocations of a run are counted by valgrind.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import counting
import engine_alone
import engine_cases
import page
from engine_speed import LANES, apart

MODELS = {"constant-46": "constant films, 46 nodes", "table4-46": "table 4 after, 46 nodes"}
#: Steps over which instructions are counted, and stages in them.
COUNTED = 288
STAGES = 2 * COUNTED
_LINE = re.compile(r"^(scalar|V8) 46n +wide true dt 900 SDIRK its 2 tol 0e0: .*\(best ([0-9.]+)\)", re.M)
_HEAP = re.compile(r"total heap usage: ([0-9,]+) allocs, [0-9,]+ frees, ([0-9,]+) bytes")


def build(folder: Path) -> Path:
    """The program of the kernel, built beside the benches; its folder is not written to."""
    target = engine_alone.TARGET / "kernel"
    command = [str(shutil.which("cargo")), "build", "--release", "--bin", "fastb", "--locked"]
    command += ["--manifest-path", str(folder / "Cargo.toml"), "--target-dir", str(target)]
    environment = {**os.environ, "RUSTFLAGS": "-C target-cpu=x86-64-v3"}
    subprocess.run(command, env=environment, check=True, stdout=sys.stderr)  # noqa: S603
    return target / "release" / "fastb"


def kernel_times(program: Path) -> dict[str, float]:
    """Times of the kernel for a member: one at a time, and with eight lanes. [s]"""
    done = subprocess.run([program], check=True, capture_output=True, text=True)  # noqa: S603
    times = {kind: 1e-3 * float(best) for kind, best in _LINE.findall(done.stdout)}
    return {"run": times["scalar"], "member": times["V8"]}


def in_turns(program: Path, rounds: int, options: argparse.Namespace) -> dict[str, dict[str, float]]:
    """Shortest times of the kernel and of each model of the engine over some rounds. [s]"""
    rows: dict[str, list[dict[str, float]]] = {name: [] for name in ("kernel", *MODELS)}
    for _ in range(rounds):
        rows["kernel"].append(kernel_times(program))
        for name in MODELS:
            rows[name].append(apart(name, options, 1, "avx2"))
    return {
        name: {kind: min(row[kind] for row in measured) for kind in ("run", "member")}
        for name, measured in rows.items()
    }


def allocations(program: Path, case: Path) -> tuple[int, int]:
    """Allocations of a run and their bytes, without those for reading the case."""
    sums = []
    for kind in ("run", "nothing"):
        command = [str(shutil.which("valgrind")), str(program), str(case), kind, str(COUNTED)]
        environment = {**os.environ, "RAYON_NUM_THREADS": "1", LANES: "avx2"}
        done = subprocess.run(command, check=True, capture_output=True, text=True, env=environment)  # noqa: S603
        usage = _HEAP.search(done.stderr)
        assert usage is not None, "valgrind says how much memory was asked for"
        sums.append([int(number.replace(",", "")) for number in usage.groups()])
    return sums[0][0] - sums[1][0], sums[0][1] - sums[1][1]


def table(folder: Path, options: argparse.Namespace) -> str:
    """Everything measured, as a table."""
    kernel = build(folder.resolve())
    times = in_turns(kernel, options.rounds, options)
    bound = times.pop("kernel")
    rows = [["kernel", f"{1e3 * bound['run']:.1f} ms", "1", f"{1 / bound['member']:.0f}", "1", "", "", ""]]
    with tempfile.TemporaryDirectory() as place:
        files = {file.stem: file for file in engine_cases.write(Path(place), 3)}
        engine_alone.build(times=False, cases=Path(place))
        worth = counting.disassembled(engine_alone.PROGRAM)
        for name, title in MODELS.items():
            case, environment = str(files[name]), {LANES: "avx2", "RAYON_NUM_THREADS": "1"}
            taken = [
                counting.count(engine_alone.PROGRAM, [case, kind, str(COUNTED)], worth, environment)
                for kind in ("run", "nothing")
            ]
            stage = taken[0].less(taken[1], STAGES)
            number, size = allocations(engine_alone.PROGRAM, files[name])
            run, member = times[name]["run"], times[name]["member"]
            rows.append(
                [
                    title,
                    f"{1e3 * run:.1f} ms",
                    f"{run / bound['run']:.2f}",
                    f"{1 / member:.0f}",
                    f"{bound['member'] / member:.2f}",
                    f"{stage.instructions:,.0f}",
                    f"{stage.flops:,.0f}",
                    f"{number} with {1e-3 * size:.0f} kB",
                ]
            )
    head = ("program", "one run", "/ kernel", "members/s", "/ kernel")
    head += ("instructions a stage", "FLOP a stage", "allocations of a run")
    note = f"{page.conditions(options.days)}; one thread, {options.rounds} rounds. Asked: 2.5 and 0.5."
    return f"{page.table(head, rows)}\n\n{note}"


def main() -> None:
    """Measure, print, and write on demand."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--days", type=int, default=92)
    parser.add_argument("--members", type=int, default=16)
    parser.add_argument("--repeats", type=int, default=2)
    parser.add_argument("--write", type=Path, help="page whose table is replaced")
    options = parser.parse_args()
    if not counting.at_hand():
        raise SystemExit("counting takes valgrind, objdump and an x86_64 processor")
    page.publish("kernel", table(options.folder, options), options.write)


if __name__ == "__main__":
    main()

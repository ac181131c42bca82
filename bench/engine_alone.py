"""The engine without Python: time by criterion, instructions and operations by callgrind, peak of a core.

Time: `cargo bench` in bench/engine, a crate of its own; one run, and a pack of eight members on one thread.

Arithmetic: counting.py. The instructions for reading the case are subtracted. Valgrind does not support
AVX-512, so that packs are counted with AVX2; results have the same bits, by the same operations. The first
day is not repeated.

Peak: the shortest time of several matrix products with numpy on one thread. They multiply and add in one
instruction (FMA). The engine does not, because results would differ between machines. Code without FMA can
reach half of that peak at most.

    python bench/engine_alone.py [--days 92] [--counted 10] [--write docs/speed.md]
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # before numpy is loaded: the peak of one core

import argparse
import json
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path

import counting
import engine_cases
import numpy as np
import page
from counting import Count
from engine_speed import LANES, MODELS

ROOT = Path(__file__).resolve().parent.parent
TARGET = ROOT / "target" / "bench"
ESTIMATES = TARGET / "criterion"
PROGRAM = TARGET / "release" / "mascarin-bench"
STAGES_A_DAY = 192  # two in every step of 900 s


def build(*, times: bool, cases: Path) -> None:
    """Build the program that is counted; with times, run criterion on the cases. Output is passed on."""
    cargo = shutil.which("cargo")
    if cargo is None:
        raise SystemExit("cargo: not found; expected Rust 1.89 or later, see rustup.rs")
    command = [cargo, *(("bench", "--bench", "simulate") if times else ("build", "--release")), "--locked"]
    command += ["--target-dir", str(TARGET), "--manifest-path", str(ROOT / "bench/engine/Cargo.toml")]
    environment = {
        **os.environ,
        "MASCARIN_BENCH_CASES": str(cases),
        "CRITERION_HOME": str(ESTIMATES),
        "RAYON_NUM_THREADS": "1",
    }
    subprocess.run(command, env=environment, check=True, stdout=sys.stderr)  # noqa: S603


def criterion(kind: str, name: str) -> tuple[float, float]:
    """Mean time and half-width of its 95 % interval, from the files of criterion [s]."""
    file = ESTIMATES / kind / name / "new" / "estimates.json"
    mean = json.loads(file.read_text(encoding="utf-8"))["mean"]
    interval = mean["confidence_interval"]
    return 1e-9 * mean["point_estimate"], 0.5e-9 * (interval["upper_bound"] - interval["lower_bound"])


def counted(case: Path, days: int, worth: Mapping[int, int]) -> tuple[Count, Count]:
    """Counts per stage, of one run and of one member of a pack, over some days."""
    stages = STAGES_A_DAY * days

    def taken(what: str) -> Count:
        # Valgrind knows no AVX-512.
        environment = {LANES: "avx2", "RAYON_NUM_THREADS": "1"}
        return counting.count(PROGRAM, [str(case), what, str(stages // 2)], worth, environment)

    idle = taken("nothing")
    return taken("run").less(idle, stages), taken("pack").less(idle, stages * engine_cases.WIDTH)


def peak(size: int = 1500, repeats: int = 7) -> float:
    """Largest number of operations of double precision in a second on one core."""
    rng = np.random.default_rng(1)
    a, b = rng.normal(size=(2, size, size))
    times = []
    for _ in range(repeats):
        before = time.perf_counter()
        a @ b
        times.append(time.perf_counter() - before)
    return float(2.0 * size**3 / min(times))


# --- The table ----------------------------------------------------------------------------------------------


def row(
    name: str, case: Path, given: argparse.Namespace, best: float, worth: Mapping[int, int] | None
) -> list[str]:
    """One model."""
    (run, spread), (pack, _) = criterion("run", name), criterion("pack", name)
    cells = [
        MODELS[name].name,
        f"{1e3 * run:.1f} ± {1e3 * spread:.1f} ms",
        f"{engine_cases.WIDTH / pack:.0f}",
    ]
    if worth is None:
        return [*cells, *[""] * 5]
    single, member = counted(case, given.counted, worth)
    stages = STAGES_A_DAY * given.days
    cells += [f"{single.instructions:,.0f}", f"{single.flops:,.0f}", f"{member.flops:,.0f}"]
    for each, seconds in ((single, run), (member, pack / engine_cases.WIDTH)):
        rate = each.flops * stages / seconds
        cells.append(f"{1e-9 * rate:.2f} GFLOP/s, {100 * rate / best:.1f} %")
    return cells


def main() -> None:
    """Measure, count, print."""
    options = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument("--days", type=int, default=92)
    options.add_argument("--counted", type=int, default=10, help="days under callgrind")
    options.add_argument("--write", type=Path, help="page whose table is replaced")
    given = options.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        cases = engine_cases.write(Path(folder), given.days)
        build(times=True, cases=Path(folder))
        best = peak()
        worth = counting.disassembled(PROGRAM) if counting.at_hand() else None
        rows = [row(case.stem, case, given, best, worth) for case in cases]
    head = ("model", "one run", "members/s", "instructions a stage", "FLOP a stage", "the same in a pack")
    text = page.table([*head, "one run", "pack"], rows)
    note = f"{page.conditions(given.days)}; one thread. Peak of a core, measured: {1e-9 * best:.1f} GFLOP/s."
    if worth is None:
        note += " Nothing is counted: that takes valgrind, objdump and an x86_64 processor."
    page.publish("engine", f"{text}\n\n{note}", given.write)


if __name__ == "__main__":
    main()

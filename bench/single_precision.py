"""Ensembles in single precision beside double precision: members a second, and how far the results are apart.

    python bench/single_precision.py [--write docs/speed.md]

The buildings of linearly_implicit.py, 32 members each, drawn over the ranges of all parameters; their airs,
surfaces and loads are recorded at every step. Times are processor time of one thread, all in turn, the
shortest of some repetitions. Errors of the step and of the scheme: the first member beside a run of SDIRK2
in double precision with steps of one minute.
"""

from __future__ import annotations

import argparse
import os
import time
from dataclasses import replace
from pathlib import Path

os.environ["RAYON_NUM_THREADS"] = "1"  # before the engine is loaded

import numpy as np
import page
from linearly_implicit import AIRS, SETTLING, Case, cases, simulation

from mascarin.ensemble import latin_hypercube
from mascarin.simulation.preparation.options import Precision, Scheme
from mascarin.simulation.simulation import Simulation

MEMBERS = 32
REPEATS = 3
#: Days of the runs; a year takes too long with steps of a minute.
DAYS = 92
#: Step [s], scheme and precision of each column with members a second.
KINDS: tuple[tuple[float, Scheme, Precision], ...] = (
    (900.0, "sdirk2", "double"),
    (900.0, "linearly-implicit", "double"),
    (900.0, "linearly-implicit", "single"),
    (1800.0, "linearly-implicit", "single"),
)


def members(of: Simulation) -> np.ndarray:
    """Parameter vectors: the building itself, then draws over the ranges."""
    drawn = latin_hypercube(of.building, MEMBERS - 1, seed=1)
    paths = [path for path in drawn.columns if path in of.paths]
    return np.vstack([of.values[None, :], of.varied(paths, drawn[paths].to_numpy(dtype=float))])


def timed(of: Simulation, vectors: np.ndarray, precision: Precision) -> tuple[float, np.ndarray]:
    """Processor time of an ensemble [s], and its records of the airs without the first days."""
    before = time.process_time()
    records, _, failures = of.ensemble(vectors, precision=precision)
    taken = time.process_time() - before
    if failures:
        raise SystemExit(f"a member failed: {failures[0]}")
    airs = [k for k, output in enumerate(of.outputs) if output.kind in AIRS]
    return taken, records[:, round(86400 * SETTLING / of.step_seconds) :, airs]


def apart(one: np.ndarray, other: np.ndarray) -> str:
    """Largest rms of an air, and the largest difference [K]."""
    difference = one - other
    rms = np.sqrt(np.mean(difference**2, axis=(0, 1))).max()
    return f"{rms:.4f} ({np.abs(difference).max():.3f})"


def line(case: Case) -> list[str]:
    """The line of a building in the table."""
    case = replace(case, days=min(case.days, DAYS))
    runs = [(simulation(case, scheme, step), precision) for step, scheme, precision in KINDS]
    vectors = members(runs[0][0])
    times: list[list[float]] = [[] for _ in runs]
    airs: list[np.ndarray] = []
    for _ in range(REPEATS):
        airs = []
        for (of, precision), taken in zip(runs, times, strict=True):
            seconds, found = timed(of, vectors, precision)
            taken.append(seconds)
            airs.append(found)
    fine = simulation(case, "sdirk2", 60.0)
    _, exact = timed(fine, vectors[:1], "double")
    return [
        case.name,
        *(f"{MEMBERS / min(taken):.0f}" for taken in times),
        apart(airs[2], airs[1]),
        *(apart(found[:1], exact[:, :: len(exact[0]) // (len(found[0]) - 1)]) for found in airs[1:]),
    ]


def main() -> None:
    """Measure, print, and write on demand."""
    options = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument("--write", type=Path, help="page whose table is replaced")
    options.add_argument("--only", help="cases whose name contains this")
    given = options.parse_args()
    head = (
        "building",
        "double, SDIRK2 [members/s]",
        "double, linearly implicit",
        "single, linearly implicit",
        "the same, 30 min",
        "single from double [K]",
        "double from 1 min [K]",
        "single from 1 min",
        "single, 30 min, from 1 min",
    )
    lines = []
    for case in cases():
        if given.only is None or given.only in case.name:
            lines.append(line(case))
            print(" | ".join(lines[-1]), flush=True)
    note = (
        f"x86_64, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f} at the end; one thread, shortest of "
        f"{REPEATS}; {MEMBERS} members, {DAYS} days (reunion-house and the rooms 90)."
    )
    page.publish("single precision", f"{page.table(head, lines)}\n\n{note}", given.write)


if __name__ == "__main__":
    main()

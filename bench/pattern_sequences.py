"""1500 pattern searches on the LGI cell: how many minima does the cost of the paper have?

Each sequence is a Hooke-Jeeves search over seven parameters, the first from the values of the building and
the others from random starts, with the data of the identification of the shipped study and the cost of the
paper, the sum over the sensors of the standard deviation of the error.

``python bench/pattern_sequences.py [sequences] [folder]`` runs them, 1500 when absent, and prints the number
of minima and a histogram of their costs; the folder gets both as figures. From the lowest end of each of the
largest groups an evolution strategy continues with small steps: ends that are true minima remain apart, those
of searches that stopped in a flat valley come together. Every evaluation is kept in the folder: a run that
was stopped is continued, and so is one with a larger number of sequences.
"""

from __future__ import annotations

import hashlib
import resource
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from lgi_seven import VARIANT
from matplotlib.figure import Figure

from mascarin.calibration import Calibration, CalibrationProblem, SearchOptions, solve
from mascarin.calibration.base.result import PlotKind
from mascarin.examples import FOLDER
from mascarin.figures.files import save
from mascarin.progress import Progress
from mascarin.study import Study

TOGETHER = 64
KINDS: tuple[PlotKind, ...] = ("minima", "convergence")
#: The mesh ends at 0.1 / 2^6 of each range, 0.16 %.
REDUCTIONS = 6
#: Groups of ends from which the evolution strategy continues.
POLISHED = 6


def searched(
    problem: CalibrationProblem, sequences: int, folder: Path, reductions: int = REDUCTIONS
) -> Calibration:
    """Run all sequences; evaluations in the folder are read, not run again."""
    rules = SearchOptions(agree=sequences + 1, sequences=sequences, reductions=reductions, together=TOGETHER)
    with Progress("sequences") as progress:
        return solve(
            problem,
            method="hooke-jeeves",
            cost="sd",
            seed=1,
            options=rules,
            record=folder / "evaluations.jsonl",
            batch=TOGETHER,
            on_batch=lambda count, lowest: progress.update(count, 0, f"{count}, lowest {lowest:.6g}"),
        )


def polished(fit: Calibration, folder: Path) -> list[Calibration]:
    """Continue from the lowest ends by an evolution strategy with small steps."""
    groups = fit.distinct_minima()[:POLISHED]
    found = []
    for k, group in enumerate(groups):
        there = group[0].x
        started = tuple(
            replace(p, start=float(v)) for p, v in zip(fit.problem.parameters, there, strict=True)
        )
        # A record belongs to one end: with more sequences the ends are others.
        name = hashlib.sha256(there.tobytes()).hexdigest()[:12]
        found.append(
            solve(
                replace(fit.problem, parameters=started),
                method="cma-es",
                cost="sd",
                seed=k,
                options=SearchOptions(agree=1, sequences=1, step=0.02),
                record=folder / f"polished-{name}.jsonl",
                batch=TOGETHER,
            )
        )
    return found


def print_polished(found: list[Calibration]) -> None:
    """Print whether the ends reach the same minimum."""
    problem = found[0].problem
    z = np.array([problem.positions(fit.x) for fit in found])
    costs = np.array([fit.cost for fit in found])
    apart = 100.0 * np.abs(z - z[costs.argmin()]).max(axis=1)
    together = int(np.sum((apart <= 2.0) & (costs <= 1.001 * costs.min())))
    print_line(f"{len(found)} lowest ends continued: {together} are one minimum, cost {costs.min():.6g}")
    for cost, distance in zip(costs, apart, strict=True):
        print_line(f"| {cost:.6f} | {distance:.2f} % of a range from the lowest |")


def print_line(line: str = "") -> None:
    """Print one line."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def print_minima(fit: Calibration, seconds: float, processor: float) -> None:
    """Print how many minima there are, where they are, and the computing time."""
    made = fit.trace.cost.size - fit.trace.replayed
    asked = sum(minimum.evaluations for minimum in fit.minima)
    print_line(f"{len(fit.minima)} sequences, {asked} evaluations ({asked / len(fit.minima):.0f} each)")
    if made:
        print_line(
            f"{made} made now in {seconds:.0f} s ({processor:.0f} s of processors): "
            f"{1e3 * seconds / made:.2f} ms each, {1e3 * processor / made:.2f} ms of a processor"
        )
    for within in (1e-3, 1e-2):
        groups = fit.distinct_minima(within=within)
        sizes = [len(group) for group in groups]
        print_line(
            f"different minima (cost within {100 * within:g} %, parameters within 2 % of their range): "
            f"{len(groups)}; the largest hold {sorted(sizes, reverse=True)[:5]}"
        )
    costs = [minimum.cost for minimum in fit.minima]
    near = [m for m in fit.minima if m.cost <= 1.001 * min(costs)]
    print_line(
        f"lowest cost {min(costs):.6g}; within 0.1 % of it {len(near)} sequences, "
        f"all within {100 * (max(costs) / min(costs) - 1):.2f} %"
    )
    z = np.array([fit.problem.positions(minimum.x) for minimum in near])
    for path, low, high in zip(fit.problem.paths, z.min(axis=0), z.max(axis=0), strict=True):
        print_line(f"| {path} | {100 * (high - low):.1f} % of its range between them |")
    counts, edges = fit.histogram(20)
    for count, low, high in zip(counts, edges[:-1], edges[1:], strict=True):
        print_line(f"| {low:.4f} to {high:.4f} | {count} |")


def main() -> None:
    """Search, print and draw."""
    sequences = int(sys.argv[1]) if len(sys.argv) > 1 else 1500
    folder = Path(sys.argv[2] if len(sys.argv) > 2 else "pattern_sequences")
    folder.mkdir(parents=True, exist_ok=True)
    began = time.perf_counter()
    problem = Study(FOLDER / "lgi" / "study.yaml").context.problem(VARIANT)
    fit = searched(problem, sequences, folder)
    used = resource.getrusage(resource.RUSAGE_SELF)
    print_minima(fit, time.perf_counter() - began, used.ru_utime + used.ru_stime)
    print_polished(polished(fit, folder))
    for kind in KINDS:
        figure = Figure(figsize=(7.0, 3.2), layout="constrained")
        fit.plot(kind, ax=figure.subplots())
        save(figure, folder / f"{kind}.svg")


if __name__ == "__main__":
    main()

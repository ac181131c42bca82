"""1500 pattern searches on the LGI cell: how many different minima does the paper's cost have?

Each sequence is a Hooke-Jeeves search over seven parameters, the first from the building's values and the
others from random starts, on the data of the shipped study's identification and with the paper's cost, the
sum over the sensors of the standard deviation of the error.

``python bench/pattern_sequences.py [sequences] [folder]`` makes them, 1500 when absent, and prints how many
minima there are and a histogram of their costs; the folder gets both as figures. Every evaluation is kept in
the folder as it is made: a run that was stopped goes on, and so does a larger number of sequences.
"""

from __future__ import annotations

import resource
import sys
import time
from pathlib import Path

import numpy as np
from lgi_seven import VARIANT

from mascarin.calibration import CalibrationProblem, Fit, Rules, plots, solve
from mascarin.examples import FOLDER
from mascarin.progress import Progress
from mascarin.sensitivity.plots import save
from mascarin.study.pipeline import Study

TOGETHER = 64
#: The mesh ends at 0.1 / 2^6 of each range, 0.16 %.
REDUCTIONS = 6


def searched(problem: CalibrationProblem, sequences: int, folder: Path, reductions: int = REDUCTIONS) -> Fit:
    """All sequences; those in the folder are replayed, not run again."""
    rules = Rules(agree=sequences + 1, sequences=sequences, reductions=reductions, together=TOGETHER)
    with Progress("sequences") as progress:
        return solve(
            problem,
            method="hooke-jeeves",
            cost="sd",
            seed=1,
            rules=rules,
            record=folder / "evaluations.jsonl",
            batch=TOGETHER,
            progress=lambda count, lowest: progress.update(count, 0, f"{count}, lowest {lowest:.6g}"),
        )


def say(line: str = "") -> None:
    """One line, at once."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def tell(fit: Fit, seconds: float, processor: float) -> None:
    """How many minima, where they are, and how long it took."""
    made = fit.trace.cost.size - fit.trace.replayed
    asked = sum(minimum.evaluations for minimum in fit.minima)
    say(f"{len(fit.minima)} sequences, {asked} evaluations ({asked / len(fit.minima):.0f} each)")
    if made:
        say(
            f"{made} made now in {seconds:.0f} s ({processor:.0f} s of processors): "
            f"{1e3 * seconds / made:.2f} ms each, {1e3 * processor / made:.2f} ms of a processor"
        )
    for within in (1e-3, 1e-2):
        groups = fit.distinct_minima(within=within)
        sizes = [len(group) for group in groups]
        say(
            f"different minima (cost within {100 * within:g} %, parameters within 2 % of their range): "
            f"{len(groups)}; the largest hold {sorted(sizes, reverse=True)[:5]}"
        )
    best = fit.minima[int(np.argmin([minimum.cost for minimum in fit.minima]))]
    near = [m for m in fit.minima if m.cost <= 1.001 * best.cost]
    say(f"lowest cost {best.cost:.6g}; within 0.1 % of it {len(near)} sequences")
    z = np.array([fit.problem.positions(minimum.x) for minimum in near])
    for path, low, high in zip(fit.problem.paths, z.min(axis=0), z.max(axis=0), strict=True):
        say(f"| {path} | {100 * (high - low):.1f} % of its range between them |")
    counts, edges = fit.histogram(20)
    for count, low, high in zip(counts, edges[:-1], edges[1:], strict=True):
        say(f"| {low:.4f} to {high:.4f} | {count} |")


def main() -> None:
    """Search, tell and draw."""
    sequences = int(sys.argv[1]) if len(sys.argv) > 1 else 1500
    folder = Path(sys.argv[2] if len(sys.argv) > 2 else "pattern_sequences")
    folder.mkdir(parents=True, exist_ok=True)
    began = time.perf_counter()
    problem = Study(FOLDER / "lgi" / "study.yaml").problem(VARIANT)
    fit = searched(problem, sequences, folder)
    used = resource.getrusage(resource.RUSAGE_SELF)
    tell(fit, time.perf_counter() - began, used.ru_utime + used.ru_stime)
    save(plots.minima(fit), folder / "minima.svg")
    save(plots.course(fit), folder / "course.svg")


if __name__ == "__main__":
    main()

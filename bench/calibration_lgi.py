"""Seven parameters of the LGI cell estimated from simulated data: errors, and coverage of the intervals.

``python bench/calibration_lgi.py recover``: data without noise, five starts; prints the largest error.
``python bench/calibration_lgi.py cover KIND [repetitions]``: 95 % intervals for errors of 0.3 K, where KIND
is ``white`` or ``1h`` (correlation time). Each repetition draws new errors and fits the parameters. By
default the model is replaced by its first-order expansion about the true values: 1000 fits then take
minutes. ``cover KIND N full`` fits with the model itself, from the true values. Repetitions are stored in a
file; a run that was stopped is continued.
``python bench/calibration_lgi.py speed [starts]``: computing time of a start and of its parts, with both
kinds of derivatives, on data with white errors; 6 starts by default.
"""

from __future__ import annotations

import json
import math
import resource
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from lgi_seven import SENSOR_SD, Seven, seven
from numpy.typing import ArrayLike, NDArray
from scipy.signal import lfilter

from mascarin.calibration import CalibrationProblem, Cost, Evaluator, SearchOptions, solve
from mascarin.calibration.base.search_options import SLOPES
from mascarin.calibration.methods.least_squares import derivative, least_squares

Floats = NDArray[np.float64]

KINDS = {"white": 0.0, "1h": 1.0}
_STEP = 0.25  # h
KEPT = Path("calibration_lgi_kept")


def recover() -> None:
    """Print each parameter, its true value, its estimate and the error in percent."""
    case = seven()
    fit = solve(case.measured(), options=SearchOptions(starts=5), seed=1)
    error = 100.0 * np.abs(fit.x / case.truth - 1.0)
    for path, truth, found, e in zip(case.problem.paths, case.truth, fit.x, error, strict=True):
        print_line(f"| {path} | {truth:.6g} | {found:.6g} | {e:.2g} % |")
    print_line(
        f"largest error {error.max():.2g} %, {fit.trace.cost.size} evaluations, {len(fit.minima)} starts"
    )


def cover(kind: str, repetitions: int, full: bool) -> None:
    """Run the missing repetitions and print how often the intervals contain the true values."""
    case = seven()
    model = case.measured() if full else linear(case)
    KEPT.mkdir(exist_ok=True)
    path = KEPT / f"{kind}-{'full' if full else 'linear'}.jsonl"
    done = [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []
    seeds = {entry["seed"] for entry in done}
    with path.open("a") as file:
        for seed in range(repetitions):
            if seed in seeds:
                continue
            entry = {"seed": seed, **one(case, model, kind, seed)}
            file.write(json.dumps(entry) + "\n")
            file.flush()
            done.append(entry)
    done = [entry for entry in done if entry["seed"] < repetitions]
    inside = np.array([entry["inside"] for entry in done])
    width = np.array([entry["width"] for entry in done])
    print_line(f"{kind}, {'the model itself' if full else 'first-order expansion'}: {len(done)} repetitions")
    print_line(
        f"all parameters {100 * inside.mean():.1f} % "
        f"({100 * inside.mean(axis=0).min():.1f}-{100 * inside.mean(axis=0).max():.1f})"
    )
    for p, path_, held, w in zip(
        range(inside.shape[1]), case.problem.paths, inside.mean(axis=0), width.mean(axis=0), strict=True
    ):
        print_line(f"| {p + 1} | {path_} | {100 * held:.1f} % | {100 * w:.2f} % of its range |")


def linear(case: Seven) -> CalibrationProblem:
    """The same with the first-order expansion of the model about the true values."""
    problem = case.measured()
    z = problem.positions(case.truth)
    _, slope = derivative(problem, z, 1e-3)

    def model(x: Floats) -> Floats:
        moved = np.array([problem.positions(row) - z for row in x])
        return np.asarray(case.clean + np.einsum("tsp,mp->mts", slope, moved))

    return replace(problem, model=model, slopes=None)


def one(case: Seven, problem: CalibrationProblem, kind: str, seed: int) -> dict[str, list[float]]:
    """Whether each interval contains the true value, and its width in ranges."""
    noise = errors(np.random.default_rng([seed, 7]), case.clean.shape, KINDS[kind])
    drawn = case.measured(noise)
    starts = tuple(
        replace(p, start=float(value)) for p, value in zip(problem.parameters, case.truth, strict=True)
    )
    fit = solve(
        replace(problem, sensors=drawn.sensors, parameters=starts, model=problem.model),
        options=SearchOptions(starts=1),
    )
    span = np.array([p.upper - p.lower for p in problem.parameters])
    return {
        "inside": [float(v) for v in (fit.low <= case.truth) & (case.truth <= fit.high)],
        "width": [float(v) for v in (fit.high - fit.low) / span],
    }


def speed(starts: int) -> None:
    """Print the wall-clock and processor time of a start and of its parts."""
    case = seven()
    problem = case.measured(errors(np.random.default_rng(0), case.clean.shape, KINDS["white"]))
    first = np.array([p.first for p in problem.parameters])
    slopes = problem.require_slopes()
    parts = {
        "one run": lambda: problem.model(first[None]),
        "eight in one batch": lambda: problem.model(np.tile(first, (8, 1))),
        "exact slopes by seven": lambda: slopes(first),
    }
    for name, part in parts.items():
        part()
        clock, processor = timed(part, 10)
        print_line(f"| {name} | {1e3 * clock:.0f} ms | {1e3 * processor:.0f} ms of a processor |")
    for kind in SLOPES:
        search = Search(problem, SearchOptions(starts=starts, slopes=kind))
        clock, processor = timed(search)
        print_line(
            f"| a start, {kind} | {clock / starts:.2f} s | {processor / starts:.2f} s of a processor | "
            f"{search.runs / starts:.0f} runs, {search.jacobians / starts:.0f} times exact slopes |"
        )
    one = SearchOptions(starts=1)
    searched = timed(Search(problem, one))
    whole = timed(lambda: solve(problem, options=one))
    print_line(
        f"| intervals, once a fit | {whole[0] - searched[0]:.2f} s | "
        f"{whole[1] - searched[1]:.2f} s of a processor |"
    )


class Search:
    """Least squares alone, without the intervals."""

    def __init__(self, problem: CalibrationProblem, rules: SearchOptions) -> None:
        self.jacobians, self.runs = 0, 0
        self._problem, self._rules = replace(problem, slopes=self._slopes), rules
        self._of_problem = problem.require_slopes()

    def _slopes(self, x: Floats) -> ArrayLike:
        self.jacobians += 1
        return self._of_problem(x)

    def __call__(self) -> None:
        """Search from all starts."""
        with Evaluator(Cost(self._problem, "nll"), keep_residuals=True) as evaluator:
            least_squares(self._problem, evaluator, self._rules, 1)
            self.runs = evaluator.count


def timed(work: Callable[[], object], times: int = 1) -> tuple[float, float]:
    """Wall-clock and processor time of a piece of work. [s]"""
    clock, used = time.perf_counter(), _processor()
    for _ in range(times):
        work()
    return (time.perf_counter() - clock) / times, (_processor() - used) / times


def _processor() -> float:
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def errors(rng: np.random.Generator, shape: tuple[int, ...], hours: float) -> Floats:
    """Errors (T, S) with a correlation time. [K]"""
    lead = 400
    drawn = rng.normal(size=(shape[0] + lead, shape[1]))
    phi = math.exp(-_STEP / hours) if hours else 0.0
    return np.asarray(
        SENSOR_SD * lfilter([math.sqrt(1.0 - phi**2)], [1.0, -phi], drawn, axis=0)[lead:], dtype=np.float64
    )


def print_line(line: str) -> None:
    """Print one line."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def main() -> None:
    """Run the part that the command line names."""
    if sys.argv[1:2] == ["recover"]:
        recover()
    elif sys.argv[1:2] == ["cover"] and sys.argv[2:3] and sys.argv[2] in KINDS:
        cover(sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 1000, "full" in sys.argv)
    elif sys.argv[1:2] == ["speed"]:
        speed(int(sys.argv[2]) if len(sys.argv) > 2 else 6)
    else:
        print_line(__doc__ or "")


if __name__ == "__main__":
    main()

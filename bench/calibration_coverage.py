"""How often the 95 % intervals of a calibration contain the true values, for white and autocorrelated errors.

A linear model with slow responses, three sensors and four parameters over five days of quarter hours; errors
of 0.3 K, white or with a correlation time of 1 h and 5 h, independent or shared by the sensors, with gaps.
Run ``python bench/calibration_coverage.py [repetitions]``; a thousand take about a minute on one core.
"""

from __future__ import annotations

import math
import sys

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from mascarin.calibration import CalibrationProblem, FitParameter, FitSensor, SearchOptions, solve

Floats = NDArray[np.float64]

TIMES, SENSORS, TRUTH = 480, 3, np.array([0.3, 0.5, 0.6, 0.45])


def responses() -> Floats:
    """Derivative of the sensors by the parameters, (T, S, P): daily and half-daily waves and a drift."""
    rng = np.random.default_rng(5)
    shape = (SENSORS, TRUTH.size)
    angle = 2.0 * np.pi * np.arange(TIMES)[:, None, None] / 96
    day = rng.normal(size=shape) * np.cos(angle + rng.uniform(0.0, 6.3, shape))
    half = 0.5 * rng.normal(size=shape) * np.cos(2.0 * angle + rng.uniform(0.0, 6.3, shape))
    return np.asarray(day + half + np.cumsum(rng.normal(size=(TIMES, *shape)), axis=0) / 50.0)


def errors(rng: np.random.Generator, hours: float, shared: float) -> Floats:
    """Errors (T, S) with a correlation time and a part common to all sensors. [K]"""
    own = rng.normal(size=(TIMES + 300, SENSORS))
    source = math.sqrt(1.0 - shared) * own + math.sqrt(shared) * rng.normal(size=(TIMES + 300, 1))
    phi = math.exp(-0.25 / hours) if hours else 0.0
    return np.asarray(0.3 * lfilter([math.sqrt(1.0 - phi**2)], [1.0, -phi], source, axis=0)[300:])


def cover(repetitions: int, hours: float, shared: float, gaps: bool) -> tuple[float, float, float]:
    """Coverage, mean width relative to what white errors would give, mean number of effective samples."""
    j = responses()
    information = np.einsum("tsp,tsq->pq", j, j) / 0.3**2
    plain = 2.0 * 1.96 * np.sqrt(np.diag(np.linalg.inv(information)))
    inside = width = effective = 0.0
    for seed in range(repetitions):
        measured = 20.0 + j @ TRUTH + errors(np.random.default_rng(seed), hours, shared)
        if gaps:
            measured[100:160, 0] = np.nan
            measured[::7, 1] = np.nan
        problem = CalibrationProblem(
            tuple(FitParameter(f"p{k}", -2.0, 3.0) for k in range(TRUTH.size)),
            tuple(FitSensor(f"s{k}", measured[:, k], 0.3) for k in range(SENSORS)),
            lambda x: 20.0 + np.einsum("tsp,mp->mts", j, x),
        )
        fit = solve(problem, options=SearchOptions(starts=1))
        inside += float(np.mean((fit.low <= TRUTH) & (fit.high >= TRUTH)))
        width += float(np.mean((fit.high - fit.low) / plain))
        effective += sum(fit.uncertainty.effective_samples)
    return inside / repetitions, width / repetitions, effective / repetitions


def main() -> None:
    """Print the table."""
    repetitions = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    lines = [
        f"95 % intervals, {repetitions} repetitions, four parameters, {TIMES * SENSORS} residuals.",
        "",
        "| errors | coverage | width over that of white errors | effective samples |",
        "|---|---|---|---|",
    ]
    sys.stdout.write("\n".join(lines) + "\n")
    for text, hours, shared, gaps in (
        ("white", 0.0, 0.0, False),
        ("1 h", 1.0, 0.0, False),
        ("1 h, 60 % shared by the sensors", 1.0, 0.6, False),
        ("1 h, with gaps", 1.0, 0.0, True),
        ("5 h", 5.0, 0.0, False),
    ):
        coverage, width, effective = cover(repetitions, hours, shared, gaps)
        sys.stdout.write(f"| {text} | {100.0 * coverage:.1f} % | {width:.2f} | {effective:.0f} |\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()

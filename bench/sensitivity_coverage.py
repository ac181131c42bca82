"""How often the 95 % intervals of the spectral method contain the true first-order index.

The indices of every case are known analytically (in the first M harmonics, which the method estimates).
Run ``python bench/sensitivity_coverage.py [repetitions]``; a thousand take a few minutes on one core.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mascarin.sensitivity.base.factors import unit_factors
from mascarin.sensitivity.spectral import analyze, design

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Case:
    """A model on [0, 1]^P with known indices, at one or several times."""

    name: str
    parameters: int
    order: int
    model: Callable[[Floats], Floats]
    index: Floats


def retained(main: Callable[[Floats], Floats], order: int) -> float:
    """Variance of a function of one uniform parameter in the first harmonics of its search curve."""
    angle = 2.0 * np.pi * np.arange(8192) / 8192
    values = main(0.5 + np.arcsin(np.sin(angle)) / np.pi)
    lines = np.fft.rfft(values.reshape(8192, -1), axis=0)[1 : order + 1] / 8192
    return float(np.sum(2.0 * np.abs(lines) ** 2))


def ishigami(order: int) -> Case:
    """Ishigami and Homma, a = 7, b = 0.1."""
    b4 = 0.1 * math.pi**4 / 5.0
    variance = 49.0 / 8.0 + b4 + 0.01 * math.pi**8 / 18.0 + 0.5
    first = [
        retained(lambda u: (1.0 + b4) * np.sin(2.0 * np.pi * u - np.pi), order),
        retained(lambda u: 7.0 * np.sin(2.0 * np.pi * u - np.pi) ** 2, order),
        0.0,
    ]

    def model(u: Floats) -> Floats:
        x = 2.0 * np.pi * u - np.pi
        s = np.sin(x)
        return np.asarray(s[:, 0] + 7.0 * s[:, 1] ** 2 + 0.1 * x[:, 2] ** 4 * s[:, 0])

    return Case("Ishigami", 3, order, model, np.array(first) / variance)


def g_function(a: Floats, order: int) -> Case:
    """Sobol's g-function."""
    variance = float(np.prod(1.0 + 1.0 / 3.0 / (1.0 + a) ** 2) - 1.0)
    # Only the first part varies; a constant does not change the variance.
    slope = retained(lambda u: np.abs(4.0 * u - 2.0), order)
    first = slope / (1.0 + a) ** 2

    def model(u: Floats) -> Floats:
        return np.asarray(np.prod((np.abs(4.0 * u - 2.0) + a) / (1.0 + a), axis=1))

    return Case(f"g-function, {a.size} parameters", a.size, order, model, first / variance)


def day(parameters: int, order: int) -> Case:
    """A synthetic building: effects over 24 hours, a square and all products of two parameters."""
    rng = np.random.default_rng(7)
    hour = 2.0 * np.pi * np.arange(24) / 24
    size = rng.exponential(1.0, parameters) ** 3
    slope = size[:, None] * np.cos(hour + rng.uniform(0.0, 2.0 * np.pi, parameters)[:, None])
    cross = np.triu(rng.normal(0.0, 0.3, (parameters, parameters)) * np.sqrt(np.outer(size, size)), 1)
    wave = 1.0 + np.sin(hour)

    def model(u: Floats) -> Floats:
        x = u - 0.5
        line = x @ slope
        return np.asarray(line + np.outer(np.einsum("ni,ij,nj->n", x, cross, x), wave) + 0.1 * line**2)

    square = 0.01 * slope**4 * (1.0 / 80.0 - 1.0 / 144.0)
    product = cross[:, :, None] * wave + 0.2 * np.triu(np.ones_like(cross), 1)[:, :, None] * np.einsum(
        "it,jt->ijt", slope, slope
    )
    variance = float(np.sum(slope**2 / 12.0 + square) + np.sum(product**2) / 144.0)

    def alone(k: Floats) -> Callable[[Floats], Floats]:
        return lambda u: (u - 0.5)[:, None] * k + 0.1 * (u - 0.5)[:, None] ** 2 * k**2

    first = [retained(alone(k), order) for k in slope]
    return Case(
        f"synthetic day, {parameters} parameters", parameters, order, model, np.array(first) / variance
    )


def cover(case: Case, repetitions: int, replicates: int) -> str:
    """One row of the table."""
    inside = np.zeros(case.parameters)
    width = np.zeros(case.parameters)
    indices = np.zeros(case.parameters)
    factors = unit_factors(case.parameters)
    for seed in range(repetitions):
        plan = design(factors, order=case.order, replicates=replicates, seed=seed)
        y = case.model(plan.all_samples())
        result = analyze(plan, y.reshape(len(plan), -1, 1))
        low, high = result.low[:, 0], result.high[:, 0]
        inside += (low <= case.index + 1e-12) & (case.index <= high + 1e-12)
        width += high - low
        indices += result.index[:, 0]
    large = case.index > 0.01
    coverage = inside / repetitions
    bias = np.abs(indices / repetitions - case.index)[large].max()
    return (
        f"| {case.name} | {case.order} | {replicates} x {plan.runs} | {100 * coverage[large].mean():.1f} % "
        f"({100 * coverage[large].min():.1f}-{100 * coverage[large].max():.1f}) | "
        f"{100 * coverage[~large].mean():.1f} % | {width[large].mean() / repetitions:.4f} | {bias:.5f} |"
    )


def say(line: str) -> None:
    """Print one line of the table immediately."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def main() -> None:
    """Print the table."""
    repetitions = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    cases = [
        ishigami(8),
        g_function(np.array([0.0, 1.0, 4.5, 9.0, 99.0, 99.0, 99.0, 99.0]), 6),
        g_function(np.concatenate([[0.0, 0.5, 1.0, 2.0, 3.0, 4.5, 9.0, 20.0], np.full(52, 60.0)]), 2),
        day(60, 2),
    ]
    say(f"Coverage of 95 % intervals, {repetitions} repetitions. Parameters with an index above 1 %: mean")
    say("(smallest-largest); the others; mean width of the interval and largest bias above 1 %.")
    say("")
    say("| case | M | runs | above 1 % | below 1 % | width | bias |")
    say("|---|---|---|---|---|---|---|")
    for case in cases:
        for replicates in (8, 16):
            begin = time.perf_counter()
            say(cover(case, repetitions, replicates))
            sys.stderr.write(f"{time.perf_counter() - begin:.0f} s\n")


if __name__ == "__main__":
    main()

"""Optimization: algorithms that propose points and receive their costs.

An algorithm does not call a cost function. `Optimizer.ask` returns points that may be evaluated at the same
time, and `Optimizer.tell` takes their costs; `minimize` does both until the end.
"""

from __future__ import annotations

from mascarin.optimization.base import CONVERGED, EXHAUSTED, Observer, Optimizer, Steps, minimize
from mascarin.optimization.covariance import CovarianceSearch
from mascarin.optimization.gradient import ArmijoGradient, ArmijoRules
from mascarin.optimization.grid import Grid, OneAtATime
from mascarin.optimization.line import FibonacciSearch, GoldenSection
from mascarin.optimization.mesh import SufficientDecrease, uniform_starts
from mascarin.optimization.pattern import CoordinateSearch, HookeJeeves, PatternSearch
from mascarin.optimization.simplex import NelderMead
from mascarin.optimization.space import Continuous, Discrete, Evaluation, Point, Space, box
from mascarin.optimization.swarm import ParticleSwarm, SwarmRules, SwarmThenPattern

__all__ = [
    "CONVERGED",
    "EXHAUSTED",
    "ArmijoGradient",
    "ArmijoRules",
    "Continuous",
    "CoordinateSearch",
    "CovarianceSearch",
    "Discrete",
    "Evaluation",
    "FibonacciSearch",
    "GoldenSection",
    "Grid",
    "HookeJeeves",
    "NelderMead",
    "Observer",
    "OneAtATime",
    "Optimizer",
    "ParticleSwarm",
    "PatternSearch",
    "Point",
    "Space",
    "Steps",
    "SufficientDecrease",
    "SwarmRules",
    "SwarmThenPattern",
    "box",
    "minimize",
    "uniform_starts",
]


def __dir__() -> list[str]:
    return __all__

"""Optimisers that ask for points and are told their costs."""

from __future__ import annotations

from mascarin.optimization.base import Observer, Optimiser, minimise
from mascarin.optimization.evolution import CovarianceSearch, DifferentialEvolution
from mascarin.optimization.gradient import ArmijoGradient, ArmijoRules
from mascarin.optimization.grid import Grid, OneAtATime
from mascarin.optimization.line import FibonacciSearch, GoldenSection
from mascarin.optimization.pattern import (
    CoordinateSearch,
    HookeJeeves,
    PatternSearch,
    SufficientDecrease,
    uniform_starts,
)
from mascarin.optimization.simplex import NelderMead
from mascarin.optimization.space import Continuous, Discrete, Evaluation, Point, Space, box
from mascarin.optimization.swarm import ParticleSwarm, SwarmRules, SwarmThenPattern

__all__ = [
    "ArmijoGradient",
    "ArmijoRules",
    "Continuous",
    "CoordinateSearch",
    "CovarianceSearch",
    "DifferentialEvolution",
    "Discrete",
    "Evaluation",
    "FibonacciSearch",
    "GoldenSection",
    "Grid",
    "HookeJeeves",
    "NelderMead",
    "Observer",
    "OneAtATime",
    "Optimiser",
    "ParticleSwarm",
    "PatternSearch",
    "Point",
    "Space",
    "SufficientDecrease",
    "SwarmRules",
    "SwarmThenPattern",
    "box",
    "minimise",
    "uniform_starts",
]

"""Optimisers that ask for points and are told their costs."""

from __future__ import annotations

from mascarin.optimise.base import Observer, Optimiser, minimise
from mascarin.optimise.evolution import CovarianceSearch, DifferentialEvolution
from mascarin.optimise.gradient import ArmijoGradient, ArmijoRules
from mascarin.optimise.grid import Grid, OneAtATime
from mascarin.optimise.line import FibonacciSearch, GoldenSection
from mascarin.optimise.pattern import (
    CoordinateSearch,
    HookeJeeves,
    PatternSearch,
    SufficientDecrease,
    uniform_starts,
)
from mascarin.optimise.simplex import NelderMead
from mascarin.optimise.space import Continuous, Discrete, Evaluation, Point, Space, box
from mascarin.optimise.swarm import ParticleSwarm, SwarmRules, SwarmThenPattern

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

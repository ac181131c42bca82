"""Optimisers that ask for points and are told their costs."""

from __future__ import annotations

from mascarin.optimise.base import Observer, Optimiser, minimise
from mascarin.optimise.pattern import (
    CoordinateSearch,
    HookeJeeves,
    PatternSearch,
    SufficientDecrease,
    uniform_starts,
)
from mascarin.optimise.space import Continuous, Discrete, Evaluation, Point, Space, box

__all__ = [
    "Continuous",
    "CoordinateSearch",
    "Discrete",
    "Evaluation",
    "HookeJeeves",
    "Observer",
    "Optimiser",
    "PatternSearch",
    "Point",
    "Space",
    "SufficientDecrease",
    "box",
    "minimise",
    "uniform_starts",
]

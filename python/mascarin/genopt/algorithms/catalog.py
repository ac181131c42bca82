"""The algorithms by their names after ``Main =``, with the keys of each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from mascarin.genopt.algorithms import searches
from mascarin.genopt.algorithms.searches import Context
from mascarin.genopt.algorithms.settings import Keys
from mascarin.optimization import CoordinateSearch, FibonacciSearch, GoldenSection, HookeJeeves, Optimizer
from mascarin.optimization.line import fibonacci_points, golden_points


@dataclass(frozen=True)
class Algorithm:
    """One algorithm.

    Parameters
    ----------
    keys : tuple of str
        Its keys, in the order in which they must appear.
    build : callable
        Makes the search.
    optional : tuple of str
        Keys that may be missing.
    discrete : bool
        Whether it takes discrete parameters.
    mixed : bool
        Whether it takes discrete parameters with ``--lenient``.
    bounds : bool
        Whether all parameters need both bounds.
    start : bool
        Whether it starts from the initial values.
    extension : bool
        Whether GenOpt has no algorithm of this name.
    """

    keys: tuple[str, ...]
    build: Callable[[Context, Keys], Optimizer]
    optional: tuple[str, ...] = ()
    discrete: bool = False
    mixed: bool = False
    bounds: bool = False
    start: bool = True
    extension: bool = False


_MULTI = ["MultiStart", "Seed", "NumberOfInitialPoint"]
_DECREASE = ["Zeta", "Phi", "Alpha"]
_SWARM = [
    "NeighborhoodTopology",
    "NeighborhoodSize",
    "NumberOfParticle",
    "NumberOfGeneration",
    "Seed",
    "CognitiveAcceleration",
    "SocialAcceleration",
    "MaxVelocityGainContinuous",
    "MaxVelocityDiscrete",
]
_GPS_TAIL = (
    "MeshSizeDivider",
    "InitialMeshSizeExponent",
    "MeshSizeExponentIncrement",
    "NumberOfStepReduction",
)
_GPS_KEYS = (*_MULTI, *_DECREASE, *_GPS_TAIL)
_GPS_OPTIONAL = (*_MULTI, *_DECREASE)
_DAG_KEYS = ("Alpha", "Beta", "Gamma", "K0", "KStar", "LMax", "Kappa", "EpsilonM", "EpsilonX")
ALGORITHMS: Final[dict[str, Algorithm]] = {
    "GPSHookeJeeves": Algorithm(_GPS_KEYS, searches.pattern(HookeJeeves), _GPS_OPTIONAL, mixed=True),
    "GPSCoordinateSearch": Algorithm(
        _GPS_KEYS, searches.pattern(CoordinateSearch), _GPS_OPTIONAL, mixed=True
    ),
    "NelderMeadONeill": Algorithm(
        ("Accuracy", "StepSizeFactor", "BlockRestartCheck", "ModifyStoppingCriterion"), searches.simplex
    ),
    "DiscreteArmijoGradient": Algorithm(_DAG_KEYS, searches.gradient),
    "PSOCC": Algorithm((*_SWARM, "ConstrictionGain"), searches.swarm, discrete=True, bounds=True),
    "PSOIW": Algorithm(
        (*_SWARM, "InitialInertiaWeight", "FinalInertiaWeight"), searches.swarm, discrete=True, bounds=True
    ),
    "PSOCCMesh": Algorithm(
        (*_SWARM, "ConstrictionGain", "MeshSizeDivider", "InitialMeshSizeExponent"),
        searches.swarm,
        discrete=True,
        bounds=True,
    ),
    "GPSPSOCCHJ": Algorithm(
        (
            *_SWARM,
            "ConstrictionGain",
            "MeshSizeDivider",
            "InitialMeshSizeExponent",
            "MultiStart",
            "MultiStartSeed",
            "NumberOfInitialPoint",
            *_DECREASE,
            "MeshSizeExponentIncrement",
            "NumberOfStepReduction",
        ),
        searches.hybrid,
        ("MultiStart", "MultiStartSeed", "NumberOfInitialPoint", *_DECREASE),
        discrete=True,
        bounds=True,
    ),
    "GoldenSection": Algorithm(
        ("AbsDiffFunction", "IntervalReduction"),
        searches.interval(GoldenSection, golden_points),
        ("AbsDiffFunction", "IntervalReduction"),
        bounds=True,
        start=False,
    ),
    "Fibonacci": Algorithm(
        ("IntervalReduction",),
        searches.interval(FibonacciSearch, fibonacci_points),
        ("IntervalReduction",),
        bounds=True,
        start=False,
    ),
    "Mesh": Algorithm(("StopAtError",), searches.mesh, discrete=True, bounds=True, start=False),
    "Parametric": Algorithm(("StopAtError",), searches.parametric, discrete=True, bounds=True, start=False),
    "MascarinHookeJeeves": Algorithm(
        _GPS_KEYS, searches.pattern(HookeJeeves), _GPS_OPTIONAL, discrete=True, extension=True
    ),
    "MascarinCMAES": Algorithm(
        ("Seed", "Sigma", "PopulationSize"), searches.covariance, ("Sigma", "PopulationSize"), extension=True
    ),
}
"""All algorithms by name, GenOpt's own first."""

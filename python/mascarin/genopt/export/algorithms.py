"""The algorithms for exported projects, each as lines of the section ``Algorithm``."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from mascarin.errors import InputError, did_you_mean

PARTICLES: Final = 20
#: Evaluations of a swarm when the study sets no budget.
SWARM_BUDGET: Final = 1000
INTERVALS: Final = 4
"""Intervals of a parameter on an equidistant mesh."""


@dataclass(frozen=True)
class Plan:
    """Starts and limits of a search.

    Attributes
    ----------
    starts : int
        Number of starts. [-]
    seed : int
        Of the random numbers.
    reductions : int
        Number of times that the step is halved before a pattern search ends. [-]
    budget : int or None
        Largest number of evaluations. [-]
    """

    starts: int
    seed: int
    reductions: int
    budget: int | None


@dataclass(frozen=True)
class Algorithm:
    """One algorithm.

    Attributes
    ----------
    main : str
        GenOpt's name.
    lines : callable
        Lines below ``Main`` for a plan.
    single : bool
        Whether it searches along one parameter only.
    several_parameters : bool
        Whether it needs at least two parameters.
    intervals : bool
        Whether ``Step`` is a number of intervals.
    """

    main: str
    lines: Callable[[Plan], list[str]]
    single: bool = False
    several_parameters: bool = False
    intervals: bool = False


def _multi_start(plan: Plan) -> list[str]:
    if plan.starts == 1:
        return []
    return ["MultiStart = Uniform", f"Seed = {plan.seed}", f"NumberOfInitialPoint = {plan.starts}"]


def _mesh() -> list[str]:
    return ["MeshSizeDivider = 2", "InitialMeshSizeExponent = 0"]


def _refinement(plan: Plan) -> list[str]:
    return ["MeshSizeExponentIncrement = 1", f"NumberOfStepReduction = {plan.reductions}"]


def _pattern(plan: Plan) -> list[str]:
    return [*_multi_start(plan), *_mesh(), *_refinement(plan)]


def _swarm(plan: Plan) -> list[str]:
    generations = max(1, (plan.budget or SWARM_BUDGET) // PARTICLES)
    return [
        "NeighborhoodTopology = lbest",
        "NeighborhoodSize = 2",
        f"NumberOfParticle = {PARTICLES}",
        f"NumberOfGeneration = {generations}",
        f"Seed = {plan.seed}",
        "CognitiveAcceleration = 2.8",
        "SocialAcceleration = 1.3",
        "MaxVelocityGainContinuous = 0.5",
        "MaxVelocityDiscrete = 4",
    ]


_CONSTRICTION: Final = "ConstrictionGain = 0.5"


def _simplex(_: Plan) -> list[str]:
    return [
        "Accuracy = 0.0001",
        "StepSizeFactor = 0.1",
        "BlockRestartCheck = 5",
        "ModifyStoppingCriterion = true",
    ]


def _gradient(_: Plan) -> list[str]:
    return [
        "Alpha = 0.5",
        "Beta = 0.8",
        "Gamma = 0.1",
        "K0 = 10",
        "KStar = 0",
        "LMax = 50",
        "Kappa = 25",
        "EpsilonM = 0.05",
        "EpsilonX = 0.05",
    ]


def _line(_: Plan) -> list[str]:
    return ["IntervalReduction = 0.001"]


def _all(_: Plan) -> list[str]:
    return ["StopAtError = true"]


ALGORITHMS: Final[dict[str, Algorithm]] = {
    "hooke-jeeves": Algorithm("GPSHookeJeeves", _pattern),
    "coordinate-search": Algorithm("GPSCoordinateSearch", _pattern),
    "pso": Algorithm("PSOCC", lambda plan: [*_swarm(plan), _CONSTRICTION]),
    "pso-inertia": Algorithm(
        "PSOIW", lambda plan: [*_swarm(plan), "InitialInertiaWeight = 1.2", "FinalInertiaWeight = 0"]
    ),
    "pso-mesh": Algorithm("PSOCCMesh", lambda plan: [*_swarm(plan), _CONSTRICTION, *_mesh()]),
    "hybrid": Algorithm(
        "GPSPSOCCHJ", lambda plan: [*_swarm(plan), _CONSTRICTION, *_mesh(), *_refinement(plan)]
    ),
    "nelder-mead": Algorithm("NelderMeadONeill", _simplex, several_parameters=True),
    "gradient": Algorithm("DiscreteArmijoGradient", _gradient),
    "golden-section": Algorithm("GoldenSection", _line, single=True),
    "fibonacci": Algorithm("Fibonacci", _line, single=True),
    "mesh": Algorithm("Mesh", _all, intervals=True),
    "parametric": Algorithm("Parametric", _all, intervals=True),
}
"""All algorithms by the names of the option ``--algorithm``."""


def chosen(name: str, parameters: int) -> Algorithm:
    """Return the algorithm of a name.

    Parameters
    ----------
    name : str
        Key of `ALGORITHMS`, or GenOpt's name.
    parameters : int
        Number of parameters to vary. [-]

    Returns
    -------
    Algorithm
        The algorithm.

    Raises
    ------
    InputError
        It is not known, or needs another number of parameters.
    """
    by_name = {**ALGORITHMS, **{a.main: a for a in ALGORITHMS.values()}}
    if name not in by_name:
        raise InputError(
            f"--algorithm: found '{name}', expected one of {', '.join(ALGORITHMS)}, or GenOpt's own name. "
            f"{did_you_mean(name, by_name, known=False)}".rstrip()
        )
    algorithm = by_name[name]
    if algorithm.single and parameters != 1:
        raise InputError(
            f"--algorithm {name}: searches along one parameter, and the study identifies {parameters}; "
            "choose hooke-jeeves, or identify only one parameter"
        )
    if algorithm.several_parameters and parameters < 2:
        raise InputError(
            f"--algorithm {name}: needs two parameters or more, and the study identifies {parameters}; "
            "choose hooke-jeeves or golden-section"
        )
    return algorithm

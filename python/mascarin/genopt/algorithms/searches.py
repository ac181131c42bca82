"""Optimization algorithms of GenOpt, made from the settings of a project.

Each public function makes a search from the project with its parameters (`Context`) and the checked keys
of the section ``Algorithm``; `pattern` and `interval` make such a function for several kinds of search.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import cast

from mascarin.genopt.algorithms.settings import Keys
from mascarin.genopt.files import functions
from mascarin.genopt.files.numbers import double_text, single_rounding
from mascarin.genopt.files.project import Project
from mascarin.optimization import (
    ArmijoGradient,
    ArmijoRules,
    CoordinateSearch,
    CovarianceSearch,
    Evaluation,
    FibonacciSearch,
    GoldenSection,
    Grid,
    HookeJeeves,
    NelderMead,
    Observer,
    OneAtATime,
    Optimizer,
    ParticleSwarm,
    Space,
    SufficientDecrease,
    SwarmRules,
    SwarmThenPattern,
    uniform_starts,
)


@dataclass(frozen=True)
class Context:
    """What a search is made from besides its settings.

    Parameters
    ----------
    project : Project
        The project.
    space : Space
        Its parameters.
    observer : Observer
        Is informed about the search.
    workers : int
        Number of evaluations at a time [-].
    """

    project: Project
    space: Space
    observer: Observer
    workers: int


def pattern(
    kind: type[HookeJeeves] | type[CoordinateSearch],
) -> Callable[[Context, Keys], Optimizer]:
    """Make the builder of a search on a mesh.

    Parameters
    ----------
    kind : type
        `HookeJeeves` or `CoordinateSearch`.

    Returns
    -------
    callable
        Makes the search from context and keys.
    """

    def make(context: Context, keys: Keys) -> Optimizer:
        space, settings = context.space, context.project.settings
        starts = None
        if "MultiStart" in keys:
            starts = uniform_starts(
                space,
                keys["NumberOfInitialPoint"],
                keys["Seed"],
                divider=keys["MeshSizeDivider"],
                exponent=keys["InitialMeshSizeExponent"],
                rounding=single_rounding,
            )
        return kind(
            space,
            divider=keys["MeshSizeDivider"],
            exponent=keys["InitialMeshSizeExponent"],
            increment=keys["MeshSizeExponentIncrement"],
            reductions=keys["NumberOfStepReduction"],
            starts=starts,
            max_evaluations=settings.max_iterations,
            sufficient=_sufficient(context, keys),
            penalty=settings.write_step,
            discrete_moves=bool(space.discrete),
            rounding=single_rounding,
            text=double_text,
            observer=context.observer,
            remember=False,
        )

    return make


def _sufficient(context: Context, keys: Keys) -> SufficientDecrease | None:
    """The rule of sufficient decrease that Zeta, Phi and Alpha describe."""
    if "Zeta" not in keys:
        return None
    text = cast("str", keys["Phi"])
    project = context.project
    names = [o.name for o in project.objectives]
    entry = project.algorithm.get("Phi")
    location = entry.location if entry else project.algorithm.location
    variables = [n for n in ("Delta", "stepNumber", *names) if f"%{n}%" in text]
    trial = functions.evaluate(functions.substitute(text, dict.fromkeys(variables, "1")))
    if not variables and trial != 0.0:
        project.report.error(location, "Phi without variables must be 0; use %Delta%, %stepNumber% or a cost")
        project.report.raise_if_any()

    def phi(delta: float, step: int, e: Evaluation) -> float:
        values = {"Delta": double_text(delta), "stepNumber": str(step)}
        values.update(zip(names, map(double_text, (e.cost, *e.outputs)), strict=False))
        return functions.evaluate(functions.substitute(text, values))

    return SufficientDecrease(keys["Zeta"], phi, keys.get("Alpha"), "stepNumber" in variables)


def _swarm_rules(keys: Keys) -> SwarmRules:
    """How particles move."""
    return SwarmRules(
        topology=keys["NeighborhoodTopology"],
        neighbors=keys["NeighborhoodSize"],
        particles=keys["NumberOfParticle"],
        generations=keys["NumberOfGeneration"],
        seed=keys["Seed"],
        cognitive=keys["CognitiveAcceleration"],
        social=keys["SocialAcceleration"],
        speed=keys["MaxVelocityGainContinuous"],
        discrete_speed=keys["MaxVelocityDiscrete"],
        constriction=keys.get("ConstrictionGain"),
        inertia=(keys.get("InitialInertiaWeight", 1.0), keys.get("FinalInertiaWeight", 0.0)),
    )


def swarm(context: Context, keys: Keys) -> Optimizer:
    """Make a particle swarm, on a mesh when one is given."""
    mesh = (keys["MeshSizeDivider"], keys["InitialMeshSizeExponent"]) if "MeshSizeDivider" in keys else None
    return ParticleSwarm(
        context.space,
        _swarm_rules(keys),
        mesh=mesh,
        penalty=context.project.settings.write_step,
        fresh_step=0,
        rounding=single_rounding,
        observer=context.observer,
        remember=False,
    )


def hybrid(context: Context, keys: Keys) -> Optimizer:
    """Make a particle swarm followed by Hooke-Jeeves."""
    settings = context.project.settings
    return SwarmThenPattern(
        context.space,
        _swarm_rules(keys),
        mesh=(keys["MeshSizeDivider"], keys["InitialMeshSizeExponent"]),
        increment=keys["MeshSizeExponentIncrement"],
        reductions=keys["NumberOfStepReduction"],
        restarts=(keys["NumberOfInitialPoint"], keys["MultiStartSeed"]) if "MultiStart" in keys else None,
        sufficient=_sufficient(context, keys),
        max_evaluations=settings.max_iterations,
        text=double_text,
        penalty=settings.write_step,
        fresh_step=0,
        rounding=single_rounding,
        observer=context.observer,
        remember=False,
    )


def simplex(context: Context, keys: Keys) -> Optimizer:
    """Make the simplex search of Nelder and Mead."""
    settings = context.project.settings
    return NelderMead(
        context.space,
        accuracy=keys["Accuracy"],
        step_factor=keys["StepSizeFactor"],
        block=keys["BlockRestartCheck"],
        modified=keys["ModifyStoppingCriterion"],
        max_iterations=settings.max_iterations,
        penalty=settings.write_step,
        observer=context.observer,
        remember=False,
    )


def gradient(context: Context, keys: Keys) -> Optimizer:
    """Make the gradient descent with Armijo line search."""
    rules = ArmijoRules(
        alpha=keys["Alpha"],
        beta=keys["Beta"],
        gamma=keys["Gamma"],
        k0=keys["K0"],
        k_star=keys["KStar"],
        l_max=keys["LMax"],
        kappa=keys["Kappa"],
        epsilon_m=keys["EpsilonM"],
        epsilon_x=keys["EpsilonX"],
    )
    return ArmijoGradient(
        context.space,
        rules,
        max_evaluations=context.project.settings.max_iterations,
        text=double_text,
        observer=context.observer,
        remember=False,
    )


def interval(
    kind: type[GoldenSection] | type[FibonacciSearch], points_for: Callable[[float], int]
) -> Callable[[Context, Keys], Optimizer]:
    """Make the builder of a search that reduces an interval.

    Parameters
    ----------
    kind : type
        `GoldenSection` or `FibonacciSearch`.
    points_for : callable
        Number of points for a reduction of the interval.

    Returns
    -------
    callable
        Makes the search from context and keys.
    """

    def make(context: Context, keys: Keys) -> Optimizer:
        limit = context.project.settings.max_iterations
        return kind(
            context.space,
            points_for(keys["IntervalReduction"]) if "IntervalReduction" in keys else limit,
            difference=keys.get("AbsDiffFunction"),
            text=double_text,
            observer=context.observer,
            remember=False,
        )

    return make


def mesh(context: Context, keys: Keys) -> Optimizer:
    """Make the run of all combinations."""
    _check_logarithms(context)
    return Grid(
        context.space,
        batch=context.workers,
        rounding=single_rounding,
        fresh_step=0,
        observer=context.observer,
        remember=False,
    )


def parametric(context: Context, keys: Keys) -> Optimizer:
    """Make the run of one parameter at a time."""
    _check_logarithms(context)
    return OneAtATime(context.space, observer=context.observer, remember=False)


def _check_logarithms(context: Context) -> None:
    """Logarithmic spacing needs positive bounds."""
    report = context.project.report
    for p in context.project.continuous:
        if p.step < 0 and not (p.lower is not None and p.lower > 0 and p.upper is not None and p.upper > 0):
            report.error(p.location, f"'{p.name}': logarithmic spacing needs Min and Max above zero")
        if p.step != int(p.step):
            report.notes.append(
                f"{p.location}: Step of '{p.name}' is a number of intervals, cut to {int(p.step)}"
            )
    report.raise_if_any()


def covariance(context: Context, keys: Keys) -> Optimizer:
    """Make a CMA-ES search, which GenOpt does not have; MaxIte is the largest number of evaluations."""
    return CovarianceSearch(
        context.space,
        sigma=keys.get("Sigma", 0.25),
        population=keys.get("PopulationSize"),
        max_evaluations=context.project.settings.max_iterations,
        seed=keys["Seed"],
        observer=context.observer,
        remember=False,
    )

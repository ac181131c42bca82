"""Designs chosen by a search: the optimizers of this package for one objective, NSGA-II for several.

Every search asks for designs in generations and depends on nothing but their objectives and its seed. A
search that was
interrupted is made again from the beginning; its finished generations are read from their stores.

References
----------
Deb, Pratap, Agarwal & Meyarivan (2002), NSGA-II, doi:10.1109/4235.996017.
Blank & Deb (2020), pymoo, doi:10.1109/ACCESS.2020.2990567.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mascarin.errors import InputError
from mascarin.optimization import (
    Continuous,
    CovarianceSearch,
    Discrete,
    Evaluation,
    Optimizer,
    ParticleSwarm,
    Point,
    Space,
    SwarmRules,
)

if TYPE_CHECKING:
    from mascarin.design.variants.description import Search
    from mascarin.design.variants.variables import Choices, Design

    #: From designs to costs, shape (designs, objectives); all are minimized.
    Costs = Callable[[Sequence[Design]], Any]


def searched(choices: Choices, plan: Search, costs: Costs) -> list[Design]:
    """Run a search; all designs that it evaluated, in their order, each once.

    Parameters
    ----------
    choices : Choices
        The variables.
    plan : Search
        Method, seed and number of evaluations.
    costs : callable
        Costs of designs; a design that failed has infinite costs.

    Returns
    -------
    list of Design
        What was evaluated.

    Raises
    ------
    InputError
        A package that the search needs is not installed.
    """
    evaluated: dict[Design, None] = {}

    def evaluate(designs: Sequence[Design]) -> Any:
        evaluated.update(dict.fromkeys(designs))
        return costs(designs)

    if plan.method == "nsga2":
        _nsga2(choices, plan, evaluate)
    else:
        _minimized(choices, plan, evaluate)
    return list(evaluated)


def _minimized(choices: Choices, plan: Search, evaluate: Callable[[Sequence[Design]], Any]) -> None:
    """A search for one objective."""
    optimizer, slots = _optimizer(choices, plan)
    used = 0
    while used < plan.evaluations and (points := optimizer.ask()):
        designs = [_design(point, slots) for point in points]
        costs = np.asarray(evaluate(designs), dtype=np.float64)[:, 0]
        used += len(points)
        optimizer.tell([Evaluation(p, float(c)) for p, c in zip(points, costs, strict=True)])


def _optimizer(choices: Choices, plan: Search) -> tuple[Optimizer, list[tuple[str, int]]]:
    """The optimizer, and where it has each variable: among its continuous or its discrete ones."""
    continuous: list[Continuous] = []
    discrete: list[Discrete] = []
    slots: list[tuple[str, int]] = []
    for choice in choices.all:
        if choice.range is not None:
            low, high = choice.range
            slots.append(("x", len(continuous)))
            continuous.append(Continuous(choice.name, 0.5 * (low + high), 0.1 * (high - low), low, high))
        else:
            slots.append(("choices", len(discrete)))
            discrete.append(Discrete(choice.name, len(choice.options) // 2, len(choice.options)))
    space = Space(tuple(continuous), tuple(discrete))
    if plan.method == "cma":
        return CovarianceSearch(
            space, population=plan.population, max_evaluations=plan.evaluations, seed=plan.seed
        ), slots
    generations = max(plan.evaluations // plan.population, 1)
    rules = SwarmRules(topology="gbest", particles=plan.population, generations=generations, seed=plan.seed)
    return ParticleSwarm(space, rules), slots


def _design(point: Point, slots: Sequence[tuple[str, int]]) -> Design:
    return tuple(float(getattr(point, kind)[k]) for kind, k in slots)


def _nsga2(choices: Choices, plan: Search, evaluate: Callable[[Sequence[Design]], Any]) -> None:
    """NSGA-II over mixed variables, by pymoo."""
    try:
        from pymoo.algorithms.moo.nsga2 import RankAndCrowdingSurvival
        from pymoo.core.evaluator import Evaluator
        from pymoo.core.mixed import MixedVariableGA
        from pymoo.core.problem import Problem
        from pymoo.core.variable import Choice, Real
        from pymoo.problems.static import StaticProblem
    except ImportError as error:
        raise InputError(
            "search: method nsga2 needs pymoo, which is not installed: pip install 'mascarin[design]'"
        ) from error
    names = [f"x{k}" for k in range(len(choices.all))]
    variables = {
        name: Real(bounds=choice.range)
        if choice.range is not None
        else Choice(options=range(len(choice.options)))
        for name, choice in zip(names, choices.all, strict=True)
    }
    count = len(plan.objectives)
    problem = Problem(vars=variables, n_obj=count)
    algorithm = MixedVariableGA(pop_size=plan.population, survival=RankAndCrowdingSurvival())
    generations = max(plan.evaluations // plan.population, 1)
    algorithm.setup(problem, termination=("n_gen", generations), seed=plan.seed, verbose=False)
    while algorithm.has_next():
        population = algorithm.ask()
        designs = [tuple(float(individual[name]) for name in names) for individual in population.get("X")]
        costs = np.asarray(evaluate(designs), dtype=np.float64)
        # pymoo compares finite numbers only.
        costs = np.where(np.isfinite(costs), costs, 1e30)
        Evaluator().eval(StaticProblem(problem, F=costs), population)
        algorithm.tell(infills=population)

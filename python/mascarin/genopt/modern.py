"""Optimization algorithms that GenOpt does not have."""

from __future__ import annotations

from mascarin.genopt.searches import Context
from mascarin.genopt.settings import Keys
from mascarin.optimization import CovarianceSearch, DifferentialEvolution, Optimiser


def differential(context: Context, keys: Keys) -> Optimiser:
    """Make a differential evolution; MaxIte is the number of generations where none is given.

    Parameters
    ----------
    context : Context
        The project and its parameters.
    keys : Keys
        Settings of the section.

    Returns
    -------
    Optimiser
        The search.
    """
    return DifferentialEvolution(
        context.space,
        population=keys.get("PopulationSize", 10 * len(context.space.names)),
        generations=keys.get("NumberOfGeneration", context.project.settings.max_iterations),
        seed=keys["Seed"],
        weight=keys.get("Weight", 0.7),
        crossover=keys.get("Crossover", 0.9),
        tolerance=keys.get("Tolerance", 1e-6),
        observer=context.observer,
        remember=False,
    )


def covariance(context: Context, keys: Keys) -> Optimiser:
    """Make a CMA-ES search; MaxIte is the largest number of evaluations.

    Parameters
    ----------
    context : Context
        The project and its parameters.
    keys : Keys
        Settings of the section.

    Returns
    -------
    Optimiser
        The search.
    """
    return CovarianceSearch(
        context.space,
        sigma=keys.get("Sigma", 0.25),
        population=keys.get("PopulationSize"),
        max_evaluations=context.project.settings.max_iterations,
        seed=keys["Seed"],
        observer=context.observer,
        remember=False,
    )

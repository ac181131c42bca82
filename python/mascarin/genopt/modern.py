"""Optimisers beyond GenOpt's, under names of their own."""

from __future__ import annotations

from mascarin.genopt.algorithm import Algorithm, Context, Keys
from mascarin.optimization import CovarianceSearch, DifferentialEvolution, Optimiser


def _differential(context: Context, keys: Keys) -> Optimiser:
    """Differential evolution; MaxIte is the largest number of generations where none is given."""
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


def _covariance(context: Context, keys: Keys) -> Optimiser:
    """CMA-ES; MaxIte is the largest number of evaluations."""
    return CovarianceSearch(
        context.space,
        sigma=keys.get("Sigma", 0.25),
        population=keys.get("PopulationSize"),
        max_evaluations=context.project.settings.max_iterations,
        seed=keys["Seed"],
        observer=context.observer,
        remember=False,
    )


_DIFFERENTIAL = ("PopulationSize", "NumberOfGeneration", "Weight", "Crossover", "Tolerance")

ALGORITHMS: dict[str, Algorithm] = {
    "MascarinDE": Algorithm(
        ("Seed", *_DIFFERENTIAL), _differential, _DIFFERENTIAL, discrete=True, bounds=True, own=True
    ),
    "MascarinCMAES": Algorithm(
        ("Seed", "Sigma", "PopulationSize"), _covariance, ("Sigma", "PopulationSize"), own=True
    ),
}

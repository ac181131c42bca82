"""Optimizers beyond GenOpt's, under names of their own."""

from __future__ import annotations

from mascarin.genopt.algorithm import Algorithm, Context, Keys
from mascarin.optimization import CovarianceSearch, Optimizer


def _covariance(context: Context, keys: Keys) -> Optimizer:
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


ALGORITHMS: dict[str, Algorithm] = {
    "MascarinCMAES": Algorithm(
        ("Seed", "Sigma", "PopulationSize"), _covariance, ("Sigma", "PopulationSize"), own=True
    ),
}

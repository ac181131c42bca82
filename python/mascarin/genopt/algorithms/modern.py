"""Optimization algorithms that GenOpt does not have."""

from __future__ import annotations

from mascarin.genopt.algorithms.searches import Context
from mascarin.genopt.algorithms.settings import Keys
from mascarin.optimization import CovarianceSearch, Optimizer


def covariance(context: Context, keys: Keys) -> Optimizer:
    """Make a CMA-ES search; MaxIte is the largest number of evaluations."""
    return CovarianceSearch(
        context.space,
        sigma=keys.get("Sigma", 0.25),
        population=keys.get("PopulationSize"),
        max_evaluations=context.project.settings.max_iterations,
        seed=keys["Seed"],
        observer=context.observer,
        remember=False,
    )

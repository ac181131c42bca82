"""Ensembles: many members of one building in one climate, on threads, processes or a cluster."""

from mascarin.ensemble.draw import latin_hypercube
from mascarin.ensemble.objectives import Statistic
from mascarin.ensemble.run import sweep, sweep_into
from mascarin.ensemble.store import Store

__all__ = ["Statistic", "Store", "latin_hypercube", "sweep", "sweep_into"]

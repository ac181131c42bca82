"""Ensembles: many members of one building in one climate, on threads, processes or a cluster."""

from mascarin.sweep.draw import latin_hypercube
from mascarin.sweep.objectives import Statistic
from mascarin.sweep.run import sweep, sweep_into
from mascarin.sweep.store import Store

__all__ = ["Statistic", "Store", "latin_hypercube", "sweep", "sweep_into"]

"""Ensembles: many members of one building in one climate, on threads, processes or a cluster."""

from mascarin.sweep.run import sweep, sweep_into
from mascarin.sweep.store import Store

__all__ = ["Store", "sweep", "sweep_into"]

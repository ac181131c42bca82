"""Runs GenOpt projects: the same files, the same listings, any simulation program."""

from __future__ import annotations

from mascarin.genopt.project import Project, load
from mascarin.genopt.run import Options, Outcome, optimise

__all__ = ["Options", "Outcome", "Project", "load", "optimise"]

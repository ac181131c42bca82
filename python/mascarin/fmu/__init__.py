"""A building as a unit for co-simulation (FMU), with the engine inside and no Python."""

from __future__ import annotations

from mascarin.fmu.export import VERSIONS, Version, export
from mascarin.fmu.variables import gives

__all__ = ["VERSIONS", "Version", "export", "gives"]

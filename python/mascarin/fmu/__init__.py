"""A building as a unit for co-simulation (FMU), with the engine inside and no Python."""

from __future__ import annotations

from mascarin.fmu.export import VERSIONS, Version, export

__all__ = ["VERSIONS", "Version", "export"]

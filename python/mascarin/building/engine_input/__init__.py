"""The building as the engine reads it.

The layout is that of ``crates/engine/src/input/description``: references are indices, and every number is the
id of an entry of ``parameters``.
"""

from __future__ import annotations

from mascarin.building.engine_input.channels import measured_columns
from mascarin.building.engine_input.description import EngineDescription, describe
from mascarin.building.engine_input.windows import framed
from mascarin.building.engine_input.zones import view_weights

__all__ = ["EngineDescription", "describe", "framed", "measured_columns", "view_weights"]

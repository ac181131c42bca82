"""The description of a building: YAML in, parameters by path, the engine's description out."""

from __future__ import annotations

from mascarin.building.building import Building
from mascarin.building.checks import check
from mascarin.building.engine_input import EngineDescription
from mascarin.building.outputs import Output
from mascarin.building.parameters import Parameter
from mascarin.building.reading import load
from mascarin.building.tables import json_schema, parameter_table

__all__ = [
    "Building",
    "EngineDescription",
    "Output",
    "Parameter",
    "check",
    "json_schema",
    "load",
    "parameter_table",
]

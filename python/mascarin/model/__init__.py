"""The description of a building: YAML in, parameters by path, the engine's description out."""

from __future__ import annotations

from mascarin.model.border import EngineDescription
from mascarin.model.building import Building
from mascarin.model.checking import check
from mascarin.model.outputs import Output
from mascarin.model.parameters import Parameter
from mascarin.model.reading import load
from mascarin.model.tables import json_schema, parameter_table

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

"""Models of EnergyPlus as buildings of Mascarin.

Examples
--------
>>> from mascarin.energyplus import convert
>>> convert("office.idf").building  # doctest: +SKIP
"""

from __future__ import annotations

from mascarin.energyplus.conversion import Conversion, convert
from mascarin.energyplus.model.findings import Finding
from mascarin.energyplus.writing import report, run_options, terminal_lines, was_edited, yaml_text

__all__ = [
    "Conversion",
    "Finding",
    "convert",
    "report",
    "run_options",
    "terminal_lines",
    "was_edited",
    "yaml_text",
]

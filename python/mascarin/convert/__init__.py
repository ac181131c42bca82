"""Models of EnergyPlus as buildings of Mascarin.

Examples
--------
>>> from mascarin.convert import convert
>>> convert("office.idf").building  # doctest: +SKIP
"""

from __future__ import annotations

from mascarin.convert.conversion import Conversion, convert
from mascarin.convert.findings import Finding
from mascarin.convert.writing import report, run_options, terminal_lines, yaml_text

__all__ = ["Conversion", "Finding", "convert", "report", "run_options", "terminal_lines", "yaml_text"]

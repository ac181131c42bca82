"""Results of six programs for each quantity of each case."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Final

PROGRAMS: Final = ("BSIMAC", "CSE", "DeST", "EnergyPlus", "ESP-r", "TRNSYS")
"""The programs, in the order of the published tables."""


@dataclass(frozen=True)
class Range:
    """Results of the six programs for one quantity of one case.

    Attributes
    ----------
    case, quantity, unit : str
        Case, quantity and unit.
    programs : mapping of str to float
        Result of each program that gave one. [unit]
    whens : mapping of str to str
        Hour of a peak or an extreme: month, day, hour that ends.
    """

    case: str
    quantity: str
    unit: str
    programs: Mapping[str, float]
    whens: Mapping[str, str]

    @property
    def low(self) -> float:
        """Smallest result. [unit]"""
        return min(self.programs.values())

    @property
    def high(self) -> float:
        """Largest result. [unit]"""
        return max(self.programs.values())

    @property
    def mean(self) -> float:
        """Mean of the results. [unit]"""
        return sum(self.programs.values()) / len(self.programs)


@cache
def ranges() -> Mapping[tuple[str, str], Range]:
    """Read all ranges, by case and quantity.

    Returns
    -------
    mapping of (str, str) to Range

    Examples
    --------
    >>> found = ranges()["600", "peak_heating"]
    >>> found.low, found.high, found.unit
    (3.02023, 3.35889, 'kW')
    """
    text = files("mascarin.verification.bestest").joinpath("reference.csv").read_text(encoding="utf-8")
    rows = csv.DictReader(line for line in text.splitlines() if not line.startswith("#"))
    return {(found.case, found.quantity): found for found in map(_range, rows)}


_CELL: Final = re.compile(r"(?P<value>-?[\d.]+)(?: (?P<when>\w+ \d+ \d+))?")


def _range(row: Mapping[str, str]) -> Range:
    programs: dict[str, float] = {}
    whens: dict[str, str] = {}
    for program in PROGRAMS:
        if cell := _CELL.fullmatch(row[program]):
            programs[program] = float(cell["value"])
            if cell["when"]:
                whens[program] = cell["when"]
    return Range(row["case"], row["quantity"], row["unit"], programs, whens)

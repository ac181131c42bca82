"""Results of six programs for each quantity of each case."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Final

from mascarin._io.regular import require_regular
from mascarin._io.tables import csv_refused
from mascarin.errors import InputError

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
    return {(row.case, row.quantity): row for row in map(_range, rows)}


def read_ranges(path: Path) -> Mapping[tuple[str, str], Range]:
    """Read ranges of the user, by case and quantity.

    Parameters
    ----------
    path : Path
        CSV file with the columns case, quantity, unit, then min and max, or one column for each program. A
        case is the name of a building file, with or without its ending; lines that begin with # are left out.

    Returns
    -------
    mapping of (str, str) to Range

    Raises
    ------
    InputError
        The file cannot be read, or a row cannot be used; its line is named.
    """
    try:
        text = require_regular(path, "a CSV file").read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not UTF-8 text"
        raise InputError(f"--ranges: {path}: cannot be read ({reason}); expected a CSV file") from error
    lines = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    lines = [(number, line) for number, line in lines if not line.lstrip().startswith("#")]
    with csv_refused(str(path)):
        reader = csv.DictReader((line for _, line in lines), skipinitialspace=True)
        names, rows = [str(name).strip() for name in reader.fieldnames or ()], list(reader)
    programs = [name for name in names if name not in _REQUIRED_COLUMNS]
    missing = [name for name in _REQUIRED_COLUMNS if name not in names] or (
        [] if len(programs) > 1 else ["min", "max"]
    )
    if missing:
        raise InputError(
            f"{path}:{lines[0][0] if lines else 1}: found the columns {', '.join(names) or 'none'}; "
            "expected case, "
            f"quantity, unit, min and max (or a column for each program): add {', '.join(missing)}"
        )
    table = {}
    for (number, _), row in zip(lines[1:], rows, strict=False):
        where = f"{path}:{number}"
        cells = {
            str(key).strip(): (value or "").strip() for key, value in row.items() if isinstance(value, str)
        }
        case, quantity = cells.get("case", ""), cells.get("quantity", "")
        values = {name: _value(cells[name], f"{where}: {name}") for name in programs if cells.get(name)}
        if not case or not quantity or not values:
            raise InputError(f"{where}: found {row}; expected a case, a quantity and at least one number")
        if "min" in values and "max" in values and values["min"] > values["max"]:
            raise InputError(
                f"{where}: found min {values['min']:g} above max {values['max']:g}; exchange them"
            )
        if (case, quantity) in table:
            raise InputError(f"{where}: found {quantity} of {case} again; expected it once")
        table[case, quantity] = Range(case, quantity, cells.get("unit", ""), values, {})
    return table


def _value(text: str, where: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise InputError(f"{where}: found {text!r}; expected a number")
    return number


_REQUIRED_COLUMNS: Final = ("case", "quantity", "unit")
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

"""Exports of calorimeters: names with units, rows, and what the lines above say of sample and sign.

Told apart by their signatures: NETZSCH Proteus (``#EXPORTTYPE``), TA Universal Analysis (``StartOfData``), TA
TRIOS (``[step]``), Mettler STARe (``Curve Values:``); all else is a table with a line of names, and a line of
units below it if there is one.
"""

from __future__ import annotations

import contextlib
import csv
import io
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from mascarin._io.tables import csv_refused
from mascarin.errors import InputError
from mascarin.materials.units import SIGN, UNITS, plain_unit

_NUMBER: Final = re.compile(r'^\s*"?[-+]?[\d.,]*\d')
#: Columns from which on a line of as many words is no fact of the file.
_LEAST_COLUMNS: Final = 3
_MASS: Final = tuple(
    re.compile(pattern, re.IGNORECASE)
    for pattern in (
        r"^#?\s*sample (?:mass|weight)\s*/?\s*(?P<unit>mg|g)\s*[:;,\t]\s*(?P<mass>[\d.,]+)",
        r"^(?:size|sample (?:mass|weight))[\s,;:]+(?P<mass>[\d.]+)[\s,]*(?P<unit>mg|g)\b",
        r"^(?:sample )?(?:mass|weight)\s*[\[(/]\s*(?P<unit>mg|g)[\])]?\s*[:=;,\t]\s*(?P<mass>[\d.,]+)",
        r"^[^\d]*,\s*(?P<mass>[\d.]+)\s*(?P<unit>mg)\s*$",
    )
)
_EXOTHERMAL: Final = (
    (re.compile(r"^#EXO:\s*(-?1)"), {"1": True, "-1": False}),
    (re.compile(r"^Exotherm[\s,;:]+(Up|Down)", re.IGNORECASE), {"up": True, "down": False}),
)
_UNITS: Final = frozenset(
    {unit for factors in UNITS.values() for unit in factors} | {"1", "-", "", "%", "uv/mw"}
)


@dataclass(frozen=True)
class Export:
    """A file of a calorimeter, before its columns are understood.

    Attributes
    ----------
    names : list of str
        Names of the columns, with their units.
    rows : list of list of str
        Entries.
    line : int
        Line of the names.
    mass : float or None
        Mass of the sample, where the file states it [mg].
    exothermal_up : bool or None
        Direction of heat that is given off, where the file states it.
    """

    names: list[str]
    rows: list[list[str]]
    line: int
    mass: float | None = None
    exothermal_up: bool | None = None


def export_of(text: str, where: str) -> Export:
    """Names, rows and facts of a file.

    Parameters
    ----------
    text : str
        Content of the file.
    where : str
        File, for errors.

    Raises
    ------
    InputError
        There is no line of names above numbers.
    """
    numbered = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    lines = [line for _, line in numbered]
    if "StartOfData" in (line.strip() for line in lines):
        return _universal_analysis(lines, numbered, where)
    head = next((k for k, line in enumerate(lines) if _is_head(line, lines[k + 1 : k + 2])), None)
    if head is None:
        raise InputError(
            f"{where}: found no line of column names above numbers; expected a first line such as "
            "'temperature [degC],cp [J/(g K)]'"
        )
    facts = _facts(lines[: head + 1])
    separator = _separator(lines[head], lines[head + 1])
    names = [name.lstrip("#").strip() for name in _split(lines[head : head + 1], separator, where)[0]]
    unit_row = head
    if head > 0 and _are_units(names):
        above = [name.lstrip("#").strip() for name in _split(lines[head - 1 : head], separator, where)[0]]
        if len(above) == len(names):
            words = _in_two_lines(above, lines[: head - 1], separator, where)
            names = [_with_unit(name, unit) for name, unit in zip(words, names, strict=True)]
            unit_row = head - 1
    body = lines[head + 1 :]
    if any(line.strip().startswith(("Curve Values", "[step]")) for line in lines[: head + 1]):
        # Results, or further curves, follow the numbers.
        count = next((k for k, line in enumerate(body) if not _NUMBER.match(line)), len(body))
        body = body[:count]
    return Export(names, _split(body, separator, where), numbered[unit_row][0], *facts)


def _in_two_lines(names: list[str], above: Sequence[str], separator: str, where: str) -> list[str]:
    """Names whose first words are in the line above, as PerkinElmer writes them."""
    if not above or separator == " ":
        return names
    first = [name.lstrip("#").strip() for name in _split(above[-1:], separator, where)[0]]
    if (
        len(first) != len(names)
        or len(first) < _LEAST_COLUMNS
        or any(re.search(r"\d", name) for name in first)
    ):
        return names
    return [f"{before} {name}".strip() for before, name in zip(first, names, strict=True)]


def _universal_analysis(lines: list[str], numbered: list[tuple[int, str]], where: str) -> Export:
    """Signals are listed in the head; rows of equal negative numbers mark ends of segments."""
    start = next(k for k, line in enumerate(lines) if line.strip() == "StartOfData")
    names = [match[1].strip() for line in lines[:start] if (match := re.match(r"Sig\d+\s+(.*)", line))]
    rows = _split(lines[start + 1 :], "\t" if "\t" in lines[start + 1] else " ", where)
    rows = [row for row in rows if not (len(set(row)) == 1 and row[0].startswith("-"))]
    if not names or not rows:
        raise InputError(
            f"{where}:{numbered[start][0]}: found {len(names)} signals in the head (Sig1, Sig2, ...) and "
            f"{len(rows)} rows below StartOfData; expected both. Export the file again as text"
        )
    return Export(names, rows, numbered[start][0], *_facts(lines[:start]))


def _is_head(line: str, following: Sequence[str]) -> bool:
    return bool(following) and not _NUMBER.match(line) and _NUMBER.match(following[0]) is not None


def _separator(head: str, row: str) -> str:
    """Separator of the rows; a blank where they have columns of fixed width."""
    for mark in (";", "\t"):
        if mark in row:
            return mark
    words = row.split()
    if len(words) > 1 and all(_NUMBER.match(word) for word in words) and head.count(",") != row.count(","):
        return " "
    if len(words) > 1 and "," not in row:
        return " "
    return ","


def _split(lines: Sequence[str], separator: str, where: str) -> list[list[str]]:
    if separator == " ":
        return [line.split() for line in lines]
    with csv_refused(where):
        return [
            [cell.strip() for cell in row]
            for row in csv.reader(io.StringIO("\n".join(lines)), delimiter=separator)
        ]


def _are_units(names: Sequence[str]) -> bool:
    return len(names) > 1 and all(plain_unit(name) in _UNITS for name in names) and any(names)


def _with_unit(name: str, unit: str) -> str:
    bare = unit.strip("[]() ")
    # Mettler calls the time t, which is a temperature elsewhere.
    plain = "time" if name == "t" and plain_unit(unit) in UNITS["time"] else name
    plain = re.sub(r"\s*\(normalized\)", "", plain, flags=re.IGNORECASE)  # TRIOS; the unit says it, too
    return f"{plain} [{bare}]" if bare not in ("", "1", "-") else plain


def _facts(lines: Sequence[str]) -> tuple[float | None, bool | None]:
    """Mass of the sample [mg], and whether heat that is given off points up."""
    mass: float | None = None
    up: bool | None = None
    for line in lines:
        for pattern in _MASS:
            match = pattern.match(line.strip())
            if match is not None and mass is None:
                with contextlib.suppress(ValueError):  # no number: as if it were not stated
                    factor = 1000.0 if match["unit"].lower() == "g" else 1.0
                    mass = float(match["mass"].replace(",", ".")) * factor
        for exothermal, meanings in _EXOTHERMAL:
            match = exothermal.match(line.strip())
            if match is not None:
                up = meanings[match[1].lower()]
    signs = list(SIGN.finditer(lines[-1])) if lines else []
    if up is None and signs:
        up = (signs[0]["kind"].lower() == "exo") == (signs[0]["side"].lower() == "up")
    return mass if mass else None, up

"""What the lines above the names of the columns say: units of columns, and the clock."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from mascarin.tables.units import parse_unit

#: A line that is about the clock.
_ABOUT_CLOCK: Final = re.compile(r"zone|\btime|uhr|zeit|\btz\b|fuseau|heure|hora", re.IGNORECASE)
_CLOCK: Final = re.compile(r"\b(?:GMT|UTC)\b(?:\s*[-+\u2212]\s*\d{1,2}(?::?\d{2})?\b)?")
_SIGNS: Final = " \t\"'#;,:=[]()<>"


def clock_of_preamble(lines: Sequence[str]) -> tuple[str, int]:
    """The clock that lines above a table state.

    Parameters
    ----------
    lines : sequence of str
        Lines above that with the names.

    Returns
    -------
    (str, int)
        Its words, such as ``GMT-05:00``, and the number of the line from 0; empty where no line or more than
        one clock is stated.

    Examples
    --------
    >>> clock_of_preamble(["Logger: A7", "Time zone: GMT-05:00"]), clock_of_preamble(["Exported 2024-01-01"])
    (('GMT-05:00', 1), ('', 0))
    """
    stated = [
        (match[0], number)
        for number, line in enumerate(lines)
        if _ABOUT_CLOCK.search(line) and (match := _CLOCK.search(line)) is not None
    ]
    return stated[0] if len({words for words, _ in stated}) == 1 else ("", 0)


def units_of_preamble(lines: Sequence[str], names: Sequence[str]) -> dict[str, tuple[str, int]]:
    """Units that lines above a table state for its columns.

    Parameters
    ----------
    lines : sequence of str
        Lines above that with the names.
    names : sequence of str
        Names of the columns.

    Returns
    -------
    dict of str to (str, int)
        Text of the unit, and the number of its line from 0, by the name of the column.

    Examples
    --------
    >>> units_of_preamble(["# AirT: Deg F", "Wind [km/h]", "AirT is new"], ["time", "AirT", "Wind"])
    {'AirT': ('Deg F', 0), 'Wind': ('km/h', 1)}
    """
    units: dict[str, tuple[str, int]] = {}
    for number, line in enumerate(lines):
        for name in names:
            if not name or name in units:
                continue
            for part in re.findall(rf"(?:^|[\s\"'#;,]){re.escape(name)}\s*[:=;,\t\[(]+([^:=;,\t\])]+)", line):
                text = part.strip(_SIGNS)
                if parse_unit(text) is not None:
                    units[name] = (text, number)
    return units

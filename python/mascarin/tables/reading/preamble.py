"""What the lines above the names of the columns say: units of columns, and the clock."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from mascarin.tables.units import parse_unit

#: A line that is about the clock.
_ABOUT_CLOCK: Final = re.compile(r"zone|\btime|uhr|zeit|\btz\b|fuseau|heure|hora", re.IGNORECASE)
_CLOCK: Final = re.compile(r"\b(?:GMT|UTC)\b(?:\s*[-+\u2212]\s*\d{1,2}(?::?\d{2})?\b)?")
#: Names of cells with the offset of the clock, above a line with their values: NSRDB, Open-Meteo.
_OFFSET_CELLS: Final = {"time zone": 1.0, "timezone": 1.0, "utc_offset_seconds": 1.0 / 3600.0}
_OFFSET: Final = re.compile(r"[-+]?\d{1,5}(?:\.\d+)?")
#: A line that states the offset alone.
_OFFSET_LINE: Final = re.compile(
    r"\W*time ?zone\W*?[:=,;\t ]\W*?(?P<hours>[-+]?\d{1,2}(?:\.\d+)?)\s*(?:h|hours)?[\W]*$", re.IGNORECASE
)
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
    stated = stated or _offsets(lines)
    return stated[0] if len({words for words, _ in stated}) == 1 else ("", 0)


def _offsets(lines: Sequence[str]) -> list[tuple[str, int]]:
    """Offsets of the clock as numbers: behind their name, or in the line below it."""
    offsets = []
    for number, line in enumerate(lines):
        alone = _OFFSET_LINE.fullmatch(line)
        if alone is not None:
            offsets.append((_offset_text(float(alone["hours"])), number))
        below = lines[number + 1] if number + 1 < len(lines) else ""
        for mark in (",", ";", "\t"):
            names, values = ([cell.strip(" \"'") for cell in text.split(mark)] for text in (line, below))
            if len(names) < 2 or len(names) > len(values):
                continue
            for name, value in zip(names, values, strict=False):
                factor = _OFFSET_CELLS.get(name.lower())
                if factor is not None and _OFFSET.fullmatch(value) and abs(float(value) * factor) <= 14.0:
                    offsets.append((_offset_text(float(value) * factor), number + 1))
    return offsets


def _offset_text(hours: float) -> str:
    minutes = round(abs(hours) * 60.0)
    return f"UTC{'-' if hours < 0.0 else '+'}{minutes // 60:02d}:{minutes % 60:02d}"


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
    >>> units_of_preamble(["T in Fahrenheit, G in kW/m2", "# FH = wind (in 0.1 m/s)"], ["T", "G", "FH"])
    {'T': ('Fahrenheit', 0), 'G': ('kW/m2', 0), 'FH': ('0.1 m/s', 1)}
    """
    units: dict[str, tuple[str, int]] = {}
    for number, line in enumerate(lines):
        for name in names:
            if not name or name in units:
                continue
            name_pattern = rf"(?:^|[\s\"'#;,]){re.escape(name)}"
            parts = re.findall(rf"{name_pattern}\s*[:=;,\t\[(]+([^:=;,\t\])]+)", line)
            parts += re.findall(rf"{name_pattern} (?:is |are |measured )*in ([^:=;,\t\])]+)", line)
            parts += re.findall(rf"{name_pattern}\s*[:=][^:=\[(]*[\[(](?:in )?([^\])]+)[\])]", line)
            for part in parts:
                text = part.strip(_SIGNS)
                if parse_unit(text) is not None:
                    units[name] = (text, number)
    return units


def repeated_names(names: Sequence[str], where: str) -> tuple[str, ...]:
    """A note about names that stand above several columns: the reader of CSV numbers the later ones."""
    later = [name for name in names if name.endswith(".1") and name[:-2] in names]
    return tuple(
        f"{where}: {name[:-2]!r} stands above several columns: the second one is called {name!r}."
        for name in later
    )

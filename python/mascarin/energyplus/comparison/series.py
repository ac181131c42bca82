"""Series of a run of EnergyPlus, from ``eplusout.csv`` or ``eplusout.eso``, by run period."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from mascarin._io.regular import require_regular
from mascarin.errors import InputError

Array = npt.NDArray[np.float64]

#: Reporting frequencies that are read; longer ones say nothing of a day.
FREQUENCIES: Final = ("Hourly", "TimeStep")
_HEADER: Final = re.compile(
    r"^(?P<key>[^:\n]+):(?P<title>.+ \[[^\]]*\])\s?\((?P<often>[A-Za-z ]+)\)(?::.*)?$"
)
_STAMP: Final = re.compile(r"^\s*(\d{1,2})/(\d{1,2})\s+(\d{1,2}):(\d{2}):\d{2}\s*$")
_ENTRY: Final = re.compile(r"^(\d+),\d+,([^,]+),(.+ \[[^\]]*\]) !(Hourly|TimeStep|Zone TimeStep)\b")
_HOUR: Final = 60
#: Columns that ReadVarsESO writes beside the time unless it is called with ``unlimited``.
MOST_COLUMNS: Final = 255
#: Minutes before each month of a year of 365 days.
_BEFORE: Final = np.cumsum([0, 31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30]) * 1440


@dataclass
class RunPeriod:
    """Hourly results of one run period.

    Attributes
    ----------
    hours : ndarray of int
        End of each hour, from the beginning of the year. [min]
    series : dict of (str, str) to ndarray
        By title with unit, and by name in capitals; means of temperatures and rates, sums of energies.
    """

    hours: npt.NDArray[np.int64]
    series: dict[tuple[str, str], Array] = field(default_factory=dict)

    @property
    def days(self) -> tuple[str, str]:
        """First and last day, as ``MM-DD``."""
        first, last = (_day(int(minute)) for minute in (self.hours[0] - _HOUR, self.hours[-1] - _HOUR))
        return first, last


def _day(minute: int) -> str:
    month = int(np.searchsorted(_BEFORE, minute, side="right"))
    return f"{month:02d}-{(minute - int(_BEFORE[month - 1])) // 1440 + 1:02d}"


def read_series(folder: Path, titles: frozenset[str]) -> list[RunPeriod]:
    """Results of a run by run period.

    Parameters
    ----------
    folder : Path
        Where EnergyPlus has left its results.
    titles : frozenset of str
        Titles with units that are read, such as ``Zone Mean Air Temperature [C]``.

    Raises
    ------
    InputError
        There are no results that can be read.
    """
    if not folder.is_dir():
        raise InputError(
            f"--compare: found no folder {folder}; expected the folder where EnergyPlus left eplusout.csv. "
            "Run EnergyPlus with: energyplus -r -w EPW -d FOLDER MODEL"
        )
    table, record = folder / "eplusout.csv", folder / "eplusout.eso"
    full = table.is_file() and may_lack_columns(table)
    if table.is_file() and not full:
        return list(_of_table(require_regular(table), titles))
    if record.is_file():
        return list(_of_record(require_regular(record), titles))
    if full:
        raise InputError(
            f"{table}: found {MOST_COLUMNS} columns of results, as many as ReadVarsESO writes; expected all "
            "of them. Keep eplusout.eso beside it, which is read then, or run: ReadVarsESO NAME.rvi unlimited"
        )
    raise InputError(
        f"{folder}: found neither eplusout.csv nor eplusout.eso; expected results of EnergyPlus. Run it by: "
        "energyplus -r -w EPW -d FOLDER MODEL"
    )


# ------------------------------------------------------------------ eplusout.csv


def may_lack_columns(table: Path) -> bool:
    """Whether a table of ReadVarsESO is full, so that further columns may be left out without a word."""
    with require_regular(table).open(encoding="latin-1") as lines:
        return lines.readline().count(",") == MOST_COLUMNS


def _of_table(file: Path, titles: frozenset[str]) -> Iterator[RunPeriod]:
    import pandas as pd

    try:
        header = list(pd.read_csv(file, nrows=0, encoding="latin-1").columns)
        chosen = {name: match for name in header if (match := _chosen(name, titles))}
        table = pd.read_csv(file, usecols=[header[0], *chosen], encoding="latin-1", low_memory=False)
        ends = np.array([_minute(str(text)) for text in table[header[0]]], dtype=np.int64)
        series = {name: table[name].to_numpy(dtype=float) for name in chosen}
    except (ValueError, IndexError, pd.errors.ParserError) as error:
        raise InputError(
            f"{file}: {str(error).splitlines()[0]}; expected the table that ReadVarsESO makes of a run, with "
            "times such as '01/01  01:00:00'. Run EnergyPlus again with -r"
        ) from None
    for first, last in _stretches(ends):
        stretch = ends[first:last]
        period = RunPeriod(stretch[stretch % _HOUR == 0])
        for name, (key, title, often) in chosen.items():
            values = series[name][first:last]
            hourly = values[stretch % _HOUR == 0] if often == "Hourly" else _by_hour(stretch, values, title)
            if len(hourly) == len(period.hours) and np.isfinite(hourly).all():
                period.series[title, key] = hourly
        if len(period.hours):
            yield period


def _chosen(name: str, titles: frozenset[str]) -> tuple[str, str, str] | None:
    """Name in capitals, title with unit, and frequency of a column that is read."""
    match = _HEADER.match(name.strip())
    if match is None or match["title"] not in titles or match["often"] not in FREQUENCIES:
        return None
    return match["key"].strip().upper(), match["title"], match["often"]


def _minute(text: str) -> int:
    """Time of a stamp in the year; 24:00 ends a day. [min]"""
    match = _STAMP.match(text)
    if match is None:
        raise ValueError(f"found the time {text.strip()[:40]!r}")
    month, day, hour, minute = (int(group) for group in match.groups())
    if month == 2 and day == 29:
        raise ValueError("found 29 February, which a typical year does not have")
    return int(_BEFORE[month - 1]) + (day - 1) * 1440 + hour * _HOUR + minute


def _stretches(ends: npt.NDArray[np.int64]) -> Iterator[tuple[int, int]]:
    """Rows of each run period and design day: times rise by an hour at most."""
    if not len(ends):
        return
    steps = np.diff(ends)
    breaks = np.nonzero((steps <= 0) | (steps > _HOUR))[0] + 1
    yield from zip([0, *breaks.tolist()], [*breaks.tolist(), len(ends)], strict=True)


def _by_hour(ends: npt.NDArray[np.int64], values: Array, title: str) -> Array:
    """Values of time steps by hour."""
    hours = -(-ends // _HOUR)
    rows = hours - hours[0]
    sums = np.bincount(rows, values)
    return np.asarray(sums if title.endswith("[J]") else sums / np.bincount(rows), dtype=np.float64)


# ------------------------------------------------------------------ eplusout.eso


def _of_record(file: Path, titles: frozenset[str]) -> Iterator[RunPeriod]:
    entries: dict[str, tuple[str, str]] = {}
    stretches: list[dict[tuple[str, str], dict[int, list[float]]]] = []
    minute = 0
    with file.open(encoding="latin-1") as lines:
        for line in lines:
            if line.startswith("End of Data Dictionary"):
                break
            if (match := _ENTRY.match(line)) and match[3] in titles:
                entries[match[1]] = (match[3], match[2].strip().upper())
        for line in lines:
            number, _, record = line.partition(",")
            if number == "1":
                stretches.append({})
            elif number == "2":
                parts = record.split(",")
                minute = int(_BEFORE[int(parts[1]) - 1]) + (int(parts[2]) - 1) * 1440
                minute += int(parts[4]) * _HOUR
            elif number in entries and stretches:
                held = stretches[-1].setdefault(entries[number], {})
                held.setdefault(minute, []).append(float(record.split(",")[0]))
    for stretch in stretches:
        ends = sorted({end for values in stretch.values() for end in values})
        if not ends:
            continue
        period = RunPeriod(np.array(ends, dtype=np.int64))
        for (title, key), values in stretch.items():
            if list(values) == ends:
                merge = np.sum if title.endswith("[J]") else np.mean
                period.series[title, key] = np.array([float(merge(values[end])) for end in ends])
        yield period

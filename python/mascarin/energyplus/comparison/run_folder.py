"""A finished run of EnergyPlus, checked to be one of the converted model."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from datetime import date, timedelta
from pathlib import Path
from typing import Final

import numpy as np

from mascarin._io.regular import require_regular
from mascarin.energyplus.comparison.series import Array, RunPeriod, read_series
from mascarin.energyplus.conversion import Conversion
from mascarin.errors import InputError

#: Titles in EnergyPlus of each quantity; the first that is there counts. Energies in J, rates in W.
TITLES: Final[dict[str, tuple[str, ...]]] = {
    "air": ("Zone Mean Air Temperature [C]", "Zone Air Temperature [C]"),
    "heating": (
        "Zone Air System Sensible Heating Energy [J]",
        "Zone Air System Sensible Heating Rate [W]",
    ),
    "cooling": (
        "Zone Air System Sensible Cooling Energy [J]",
        "Zone Air System Sensible Cooling Rate [W]",
    ),
    "sun": (
        "Enclosure Windows Total Transmitted Solar Radiation Energy [J]",
        "Enclosure Windows Total Transmitted Solar Radiation Rate [W]",
        "Zone Windows Total Transmitted Solar Radiation Energy [J]",
        "Zone Windows Total Transmitted Solar Radiation Rate [W]",
    ),
}
#: Titles by the name of the ideal loads system: with its outdoor air.
SUPPLIED: Final[dict[str, tuple[str, ...]]] = {
    which: tuple(
        f"Zone Ideal Loads Supply Air Sensible {which.capitalize()} {unit}"
        for unit in ("Energy [J]", "Rate [W]")
    )
    for which in ("heating", "cooling")
}
OUTDOOR_AIR: Final = "Site Outdoor Air Drybulb Temperature [C]"
_ALL: Final = frozenset(
    title for table in (TITLES, SUPPLIED) for titles in table.values() for title in titles
) | {OUTDOOR_AIR}
#: Names of a list that an error shows.
_SHOWN: Final = 5


@dataclass(frozen=True)
class PeerRun:
    """Results of EnergyPlus for the model.

    Attributes
    ----------
    folder : Path
        Where they are.
    version : str
        Version of EnergyPlus; empty where nothing says it.
    hours : int
        Number of hours.
    series : dict of (str, str) to ndarray
        Hourly values by quantity and zone in capitals: temperature [degC], heat [Wh].
    outdoors : ndarray or None
        Temperature of the outdoor air. [degC]
    shadow_days : int
        Days between calculations of the sun and shadows; 0 where nothing says it.
    sizes : dict of str to float
        Volume of each zone in capitals, as far as it is said. [m3]
    """

    folder: Path
    version: str
    hours: int
    series: dict[tuple[str, str], Array]
    outdoors: Array | None = None
    shadow_days: int = 0
    sizes: dict[str, float] = field(default_factory=dict)


def read_run(folder: Path, conversion: Conversion) -> PeerRun:
    """Read a run, and check that it is one of the model.

    Raises
    ------
    InputError
        There are no results, the run has failed, or it is of another model, period or time step.
    """
    initial = _Initial(folder / "eplusout.eio")
    periods = read_series(folder, _ALL)
    _check_end(folder)
    _check_zones(folder, conversion, initial, periods)
    _check_steps(folder, conversion, initial)
    period = _period(folder, conversion, periods)
    series = {}
    for zone in conversion.names["zones"]:
        for quantity, titles in TITLES.items():
            held = _first(period, titles, zone.upper())
            if held is not None:
                series[quantity, zone.upper()] = held
    supplied = {finding.name for finding in conversion.findings if finding.what == "outdoor air"}
    for system, zone in conversion.systems.items():
        for which, titles in SUPPLIED.items():
            held = _first(period, titles, system.upper())
            if held is not None and (system in supplied or (which, zone.upper()) not in series):
                series[which, zone.upper()] = held
    outdoors = next((held for (title, _), held in period.series.items() if title == OUTDOOR_AIR), None)
    return PeerRun(
        folder, initial.version, len(period.hours), series, outdoors, initial.shadow_days, initial.sizes
    )


def _first(period: RunPeriod, titles: Iterable[str], key: str) -> Array | None:
    """The first series of these titles that is there: a temperature [degC], or heat by hour [Wh]."""
    for title in titles:
        held = period.series.get((title, key))
        if held is not None:
            return held / 3600.0 if title.endswith("[J]") else held
    return None


class _Initial:
    """What ``eplusout.eio`` says of the model; nothing where the file is not there."""

    def __init__(self, file: Path) -> None:
        text = require_regular(file).read_text(encoding="latin-1") if file.is_file() else ""
        self.version = _group(r"^ *Version, *([\d.]+)", text)
        self.steps = int(_group(r"^ *Timesteps per Hour, *(\d+)", text) or 0)
        self.shadow_days = int(_group(r"^Shadowing/Sun Position[^,]*,[^,]*, *Periodic, *(\d+)", text) or 0)
        self.sizes = {match[1].strip().upper(): float(match[2] or "nan") for match in self._zones(text)}

    @staticmethod
    def _zones(text: str) -> Iterable[re.Match[str]]:
        head = re.search(r"^! <Zone Information>,(.*)$", text, re.MULTILINE)
        names = [] if head is None else [name.partition("{")[0].strip() for name in head[1].split(",")]
        column = names.index("Volume") if "Volume" in names else 1
        between = rf"(?:[^,\n]*,){{{column - 1}}}"
        return re.finditer(rf"^ *Zone Information,([^,\n]+),{between} *([\d.]+)?", text, re.MULTILINE)


def _group(pattern: str, text: str) -> str:
    match = re.search(pattern, text, re.MULTILINE)
    return "" if match is None else match[1]


def _check_end(folder: Path) -> None:
    end = folder / "eplusout.end"
    line = require_regular(end).read_text(encoding="latin-1").strip() if end.is_file() else ""
    if "Fatal" in line:
        raise InputError(
            f"{end}: found '{line[:80]}'; expected a run that completed. eplusout.err says why; run "
            "EnergyPlus again"
        )


def _check_zones(folder: Path, conversion: Conversion, initial: _Initial, periods: list[RunPeriod]) -> None:
    """Refuse a run of another model: zones that this one does not have, or none of its own."""
    expected = {name.upper() for name in conversion.names["zones"]}
    without = {finding.name.upper() for finding in conversion.findings if finding.kind == "Zone"}
    reported = {key for period in periods for title, key in period.series if title in TITLES["air"]}
    if not reported:
        raise InputError(
            f"{folder}: found no hourly '{TITLES['air'][0]}'; expected it for each zone. Add "
            "'Output:Variable,*,Zone Mean Air Temperature,Hourly;' to the model, and run EnergyPlus again"
        )
    strange = (set(initial.sizes) or reported) - expected - without
    if strange or not reported & expected:
        raise InputError(
            f"{folder}: found a run of another model, with zones {_listed(strange or reported)}; expected "
            f"{_listed(expected)} as in {conversion.file}. Run EnergyPlus with it, or convert the other"
        )


def _listed(names: Iterable[str]) -> str:
    ordered = sorted(names)
    more = f" and {len(ordered) - _SHOWN} more" if len(ordered) > _SHOWN else ""
    return ", ".join(f"'{name}'" for name in ordered[:_SHOWN]) + more


def _check_steps(folder: Path, conversion: Conversion, initial: _Initial) -> None:
    if initial.steps not in (0, conversion.steps_per_hour):
        raise InputError(
            f"{folder}: found a run with {initial.steps} time steps in an hour; expected "
            f"{conversion.steps_per_hour}, as in {conversion.file}. Run EnergyPlus again with this model"
        )


def _period(folder: Path, conversion: Conversion, periods: list[RunPeriod]) -> RunPeriod:
    """The run period of the model among those of the run."""
    last = date.fromisoformat(conversion.end) - timedelta(days=1)
    days = (conversion.start[5:], f"{last:%m-%d}")
    for period in periods:
        if period.days == days and len(period.hours) == _hours_between(conversion):
            return period
    spans = list(dict.fromkeys(" to ".join(period.days) for period in periods))
    raise InputError(
        f"{folder}: found results of {', '.join(spans)}; expected {days[0]} to {days[1]}, the run period of "
        f"{conversion.file}. Run EnergyPlus again with this model, for its whole run period"
    )


def _hours_between(conversion: Conversion) -> int:
    start, end = (date.fromisoformat(text) for text in (conversion.start, conversion.end))
    return (end - start).days * 24


def rms(values: Array) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(values**2)))

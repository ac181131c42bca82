"""The inputs of a design study, read from its files, with everything checked before the first run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pandas as pd

from mascarin.building import Building, TextInfiltration, load
from mascarin.building.files import yaml_document
from mascarin.building.parameters.ties import expanded, spread
from mascarin.comfort import Surroundings
from mascarin.design.evaluation.checks import require_no_columns, require_same_basis
from mascarin.design.evaluation.objectives import Comfort
from mascarin.design.variants.description import FILE_KEYS, DesignFile
from mascarin.design.variants.variables import Choices, read_choices
from mascarin.errors import InputError
from mascarin.simulation.preparation.prepare import period
from mascarin.study.file.inputs import Beside, find
from mascarin.study.file.locations import Faults, Places
from mascarin.tables.reading.files import file_hash
from mascarin.weather import Climate
from mascarin.weather.reading.shipped import PREFIX, found

if TYPE_CHECKING:
    from mascarin.design.evaluation.objectives import AnyObjective
    from mascarin.design.variants.description import ClimateFile


#: Sections of a building with zones that are dried, and with the vertices that are seen from a seat.
_DEEP_SECTIONS: Final = ("humidity", "surfaces", "windows", "zones")


@dataclass(frozen=True)
class DesignSite:
    """A climate of the study: weather, period, and the building at that place.

    Attributes
    ----------
    name, words : str
        Name, and the place in words.
    climate : Climate
        The weather.
    start, end : pandas.Timestamp
        The period, local time.
    building : Building
        The building at this place.
    hash : str
        SHA-256 of the weather file.
    """

    name: str
    words: str
    climate: Climate
    start: pd.Timestamp
    end: pd.Timestamp
    building: Building
    hash: str

    @property
    def days(self) -> float:
        """Length of the period. [d]"""
        return float((self.end - self.start).total_seconds()) / 86400.0


@dataclass(frozen=True)
class DesignInputs:
    """A design study, read and checked.

    Attributes
    ----------
    file : DesignFile
        What is done.
    path : Path
        The design file.
    building : Building
        The building that all designs begin with.
    sites : tuple of DesignSite
        The climates.
    choices : Choices
        The variables.
    uncertain : tuple of str
        Paths of the uncertain parameters.
    """

    file: DesignFile
    path: Path
    building: Building
    sites: tuple[DesignSite, ...]
    choices: Choices
    uncertain: tuple[str, ...]

    def objective(self, name: str) -> AnyObjective:
        """An objective by its name."""
        return self.file.objectives[name]


def read_design(path: str | Path, *, allow_outside: bool = False) -> DesignInputs:
    """Read a design file and what it names, and check all of it.

    Parameters
    ----------
    path : str or Path
        The design file.
    allow_outside : bool
        Whether it may name files outside its folder and the data folder.

    Returns
    -------
    DesignInputs
        The study.

    Raises
    ------
    InputError
        A file, name or value cannot be used; all that were found are in the text, with file and line.

    Examples
    --------
    >>> read_design("nowhere.yaml")
    Traceback (most recent call last):
    mascarin.errors.InputError: nowhere.yaml: cannot be read ...
    """
    path = Path(path)
    file = yaml_document.read(path, DesignFile, "a design study", file_keys=FILE_KEYS)
    locations, faults, beside = Places(path), Faults(), Beside(path.parent, allow_outside)
    with locations.blame("building"):
        described = load(find(file.building, beside))
    with locations.blame("set"):
        building = described.replace(file.set) if file.set else described
    choices = read_choices(file, building, locations, faults)
    faults.raise_all(path)
    uncertain = _uncertain(file, building, choices, locations, faults)
    sites = []
    for name in file.climates:
        with faults.kept():
            sites.append(_site(name, file, building, beside, locations))
    if not any(option.parts for choice in choices.all for option in choice.options):
        # Parts that a design replaces may be those with columns.
        for site in sites:
            with locations.noting(faults, "building"):
                require_no_columns(site.building)
    _check_objectives(file, building, choices, uncertain, locations, faults)
    with locations.noting(faults, "reference"):
        building.replace(file.reference)
    _check_validity(file, sites, locations, faults)
    _check_search(file, choices, locations, faults)
    faults.raise_all(path)
    return DesignInputs(file, path, building, tuple(sites), choices, uncertain)


def in_mode(building: Building, objective: AnyObjective) -> Building:
    """The building as an objective needs it, such as with ideal cooling."""
    changes = objective.changes()
    return building.replace(changes) if changes else building


def _site(name: str, file: DesignFile, building: Building, beside: Beside, locations: Places) -> DesignSite:
    climate_file = file.climates[name]
    with locations.blame("climates", name, "epw" if climate_file.epw is not None else "tmy"):
        text = str(climate_file.epw or climate_file.tmy)
        weather = found(text) if text.startswith(PREFIX) else find(text, beside)
        read = Climate.from_epw if climate_file.epw is not None else Climate.from_tmy
        climate = read(weather, check_sun=climate_file.check_sun, shift=climate_file.shift)
    with locations.blame("climates", name, "set"):
        moved = building.replace({**_location_changes(climate), **climate_file.set})
    with locations.blame("climates", name):
        _require_wind(climate, moved)
        start, end = period(climate, *_dates(file, climate_file))
        first, last = period(climate, None, None)
        if start < first or end > last:
            raise InputError(
                f"found the period {start:%Y-%m-%d} to {end:%Y-%m-%d}, expected one inside of the weather "
                f"file, "
                f"{first:%Y-%m-%d} to {last:%Y-%m-%d}. A summer over the turn of the year is two periods: "
                f"take "
                "the part after it, such as start: 01-01"
            )
    site = climate.site
    words = f"{site.name or name} ({site.latitude:.2f}, {site.longitude:.2f})" if site is not None else name
    return DesignSite(name, words, climate, start, end, moved, file_hash(weather))


def _dates(file: DesignFile, climate_file: ClimateFile) -> Iterator[str | None]:
    for key in ("start", "end"):
        yield getattr(climate_file, key) or (getattr(file.period, key) if file.period is not None else None)


def _location_changes(climate: Climate) -> dict[str, Any]:
    """The place of the weather, to which the building is moved."""
    site = climate.site
    if site is None:
        return {}
    return {
        "site.latitude": site.latitude,
        "site.longitude": site.longitude,
        "site.altitude": site.altitude,
        "site.timezone": climate.timezone,
    }


def _require_wind(climate: Climate, building: Building) -> None:
    """Refuse weather without wind where wind drives a flow of air."""
    driven = [
        f"openings.{name}"
        for name, opening in building.openings.items()
        if float(opening.wind_coefficient) > 0.0
    ]
    driven += [f"vents.{name}" for name, vent in building.vents.items() if vent.windy]
    driven += [f"zones.{name}.infiltration" for name, zone in building.zones.items() if _by_wind(zone)]
    columns = climate.record.columns
    wind = columns["wind_speed"] if "wind_speed" in columns else np.zeros(1)
    if driven and not np.nanmax(wind, initial=0.0) > 0.0:
        raise InputError(
            f"found no wind in the weather file, expected wind speeds, by which air flows through "
            f"{driven[0]}. "
            "Choose another file, or set the wind coefficient of these openings to 0 and 'pressure' of vents "
            "to none, so that only buoyancy acts"
        )


def _by_wind(zone: Any) -> bool:
    leaks = zone.infiltration
    if isinstance(leaks, TextInfiltration) and "V" in leaks.names:
        return True
    return float(leaks.wind) > 0.0 or getattr(leaks.blower_door, "kind", "") == "stack_wind"


def _uncertain(
    file: DesignFile, building: Building, choices: Choices, locations: Places, faults: Faults
) -> tuple[str, ...]:
    if file.uncertainty is None:
        return ()
    chosen = [path for choice in choices.all for o in choice.options for path in (*o.numbers, *o.parts)]
    paths: list[str] = []
    for number, pattern in enumerate(file.uncertainty.parameters):
        with locations.noting(faults, "uncertainty", "parameters", number):
            for path in expanded(building, [pattern]):
                parameter = building.parameter(path)
                if parameter.structural:
                    raise InputError(
                        f"{path} changes the shape of the building; expected a number that may vary"
                    )
                if any(_overlap(path, changed) for changed in chosen):
                    raise InputError(
                        f"{path} is one of the variables, or in a part that they replace; remove it"
                    )
                if not parameter.low < parameter.high:
                    raise InputError(
                        f"{path} has no range; expected one in the building, such as "
                        f"{{value: {parameter.value:g}, "
                        "range: [low, high]}"
                    )
                paths.append(parameter.path)
    return tuple(dict.fromkeys(paths))


def _overlap(path: str, chosen: str) -> bool:
    # A product replaces all numbers of its material.
    part = chosen.removesuffix(".product")
    return path == part or path.startswith(f"{part}.")


def _check_objectives(
    file: DesignFile,
    building: Building,
    choices: Choices,
    uncertain: Sequence[str],
    locations: Places,
    faults: Faults,
) -> None:
    deep = [*_deep(choices), *_uncertain_emissivities(building, uncertain)]
    variants = list(choices.structures())
    for name, objective in file.objectives.items():
        with locations.noting(faults, "objectives", name):
            changed = in_mode(building, objective)
            objective.check(changed)
            # A variant may leave out what an objective needs; one of each structure is compiled later.
            for parts in variants if len(variants) <= 12 else ():
                objective.check(in_mode(building.replace(parts), objective))
            for parts in deep:
                other = in_mode(building.replace(parts), objective)
                require_same_basis(objective.basis(changed), objective.basis(other))
            _require_whole(spread(building, objective.changes()), choices)
        prices: Mapping[str, Mapping[str, float]] = getattr(objective, "choices", {})
        for variable, labels in prices.items():
            with locations.noting(faults, "objectives", name, "choices", variable):
                options = {choice.name: [o.label for o in choice.options] for choice in choices.all}
                if variable not in options:
                    raise InputError(
                        f"found '{variable}', expected one of the variables {', '.join(options)}"
                    )
                wrong = [label for label in labels if label not in options[variable]]
                if wrong:
                    raise InputError(f"found '{wrong[0]}', expected one of {', '.join(options[variable])}")


def _require_whole(changes: Mapping[str, Any], choices: Choices) -> None:
    """Refuse an objective that changes a part of what a variable chooses, or the other way round."""
    for path in changes:
        for choice in choices.all:
            for chosen in dict.fromkeys(p for o in choice.options for p in (*o.numbers, *o.parts)):
                if chosen.startswith(f"{path}.") or path.startswith(f"{chosen}."):
                    raise InputError(
                        f"found a change of {path}, and variable '{choice.name}' chooses {chosen}; expected "
                        "changes of the same path, which then hold for every design, or of different parts. "
                        "Write one of them with the path of the other"
                    )


def _deep(choices: Choices) -> Iterator[dict[str, Any]]:
    """Changes by single options that may change what an objective reads: humidity, geometry, emissivity."""
    for choice in choices.all:
        for option in choice.options:
            if any(path.split(".")[0] in _DEEP_SECTIONS for path in option.parts):
                yield dict(option.parts)
            elif any(path.endswith("emissivity") for path in option.numbers):
                yield dict(option.numbers)


def _uncertain_emissivities(building: Building, uncertain: Sequence[str]) -> Iterator[dict[str, Any]]:
    """Emissivities that vary over the samples, each at the middle between its value and an end."""
    for path in uncertain:
        if path.endswith("emissivity"):
            parameter = building.parameter(path)
            end = parameter.low if parameter.low < parameter.value else parameter.high
            yield {path: 0.5 * (parameter.value + end)}


def _check_validity(file: DesignFile, sites: Sequence[DesignSite], locations: Places, faults: Faults) -> None:
    """Refuse a comfort index that has no value in most of the period, even in a room of 26 degC."""
    for name, objective in file.objectives.items():
        if not isinstance(objective, Comfort):
            continue
        for site in sites:
            with locations.noting(faults, "objectives", name, "comfort"):
                times = pd.date_range(site.start, site.end, freq="1h")
                hours = objective.comfort.occupied(times)
                room = np.full(len(times), 26.0)
                around = Surroundings.of(site.climate, times)
                settings = objective.comfort
                if settings.humidity == "simulated":
                    # Not known before the run: that of the outdoor air.
                    settings = settings.model_copy(update={"humidity": "outdoor"})
                tried = settings.discomfort(room, room, hours, around)
                reasons = "; ".join(why for why, time in tried.reasons.items() if float(time) > 0.0)
                if float(tried.undefined_hours) > 0.5 * float(hours.sum()):
                    raise InputError(
                        f"found no value of {objective.comfort.index} in "
                        f"{float(tried.undefined_hours):.0f} of {float(hours.sum()):.0f} h in climate "
                        f"'{site.name}', even in a room of 26 degC "
                        f"({reasons}); expected conditions inside its validity. Choose another index, or "
                        "kind: degree_hours with a limit"
                    )


def _check_search(file: DesignFile, choices: Choices, locations: Places, faults: Faults) -> None:
    with locations.noting(faults, "search"):
        if file.search.method == "grid":
            choices.grid()
        fixed = [choice.name for choice in choices.all if choice.range is None]
        if file.search.method == "cma" and (fixed or len(choices.all) < 2):
            raise InputError(
                f"found method: cma with {', '.join(fixed) or 'one variable'}; expected two or more "
                f"variables with "
                "range:, as it chooses numbers only. Take method: swarm"
            )
        if file.search.method == "nsga2" and len(file.search.objectives or file.objectives) < 2:
            raise InputError("found one objective, expected two or more for nsga2. Take method: swarm")

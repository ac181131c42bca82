"""Reads the files of a study: weather and measurements."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mascarin._io.sealed.cache import cache_folder
from mascarin.building.engine_input import measured_columns
from mascarin.errors import InputError, did_you_mean
from mascarin.study.file.locations import Faults, Places
from mascarin.tables.reading.table import read_table
from mascarin.weather import Climate, Measurements
from mascarin.weather.reading.data import FOLDER, data_file
from mascarin.weather.reading.shipped import FOLDER as CLIMATES
from mascarin.weather.reading.shipped import PREFIX

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.building.parts.site import Site
    from mascarin.study.file.data_sources import ClimateSource, MeasuredTable, MeasuredWeather
    from mascarin.study.file.description import StudyFile

#: Prefix of a known data set.
KNOWN = "data:"


@dataclass(frozen=True)
class Beside:
    """The folder of a study, and whether the study may name files elsewhere.

    A study from somewhere else must not read what it likes: what it names could end in an error, a table or a
    report that is passed on.

    Attributes
    ----------
    folder : Path
        Folder of the study; paths start there.
    allow_outside : bool
        Whether files outside of it may be read. Those of the data folder (MASCARIN_DATA) always may.
    """

    folder: Path
    allow_outside: bool = False

    def require_inside(self, path: Path) -> None:
        """Refuse a file elsewhere, links followed; whether it exists is not said."""
        if self.allow_outside:
            return
        data = os.environ.get(FOLDER)
        # Known data sets are downloaded to a cache; the shipped climates are files of Mascarin.
        allowed = [self.folder, *([Path(data)] if data else []), cache_folder(), CLIMATES]
        target = path.resolve()
        if not any(target.is_relative_to(folder.resolve()) for folder in allowed):
            raise InputError(
                f"found the file {path}, which is outside the folder of the study; expected a file in "
                f"{self.folder.resolve()}. If you trust the study, allow it with --allow-outside (in Python "
                "allow_outside=True), or copy the file there"
            )


def find(name: str, beside: Beside) -> Path:
    """A file beside the study, or a known data set.

    Parameters
    ----------
    name : str
        Relative path, or ``data:NAME``.
    beside : Beside
        Folder of the study.

    Raises
    ------
    InputError
        There is no such file, or it is outside the folder.
    """
    if name.startswith(KNOWN):
        return data_file(name.removeprefix(KNOWN))
    path = beside.folder / name
    try:
        beside.require_inside(path)
        there = path.is_file()
    except (OSError, ValueError) as error:  # longer than the system allows; a zero in the name
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(f"found the name {name[:60]!r} ({reason}), expected that of a file") from None
    if not there:
        raise InputError(
            f"found no file {path}; expected a file, its path counted from the folder of the study. "
            + _neighbours(path)
        )
    return path


def _neighbours(path: Path) -> str:
    """Hint at a similar file name."""
    if not path.parent.is_dir():
        return f"There is no folder {path.parent} either: correct the path."
    same = [other.name for other in path.parent.iterdir() if other.suffix == path.suffix]
    return did_you_mean(path.name, same) or "Correct the path."


def open_climate(source: ClimateSource, beside: Beside, building: Building, places: Places) -> Climate:
    """The weather of a study.

    Raises
    ------
    InputError
        A file, column or time zone is missing, or a value cannot be used.
    """
    if source.epw is not None:
        with places.blame("climate", "epw"):
            shipped = source.epw.startswith(PREFIX)
            path = source.epw if shipped else find(source.epw, beside)
            return Climate.from_epw(path, check_sun=source.check_sun, shift=source.shift)
    if source.tmy is not None:
        with places.blame("climate", "tmy"):
            path = find(source.tmy, beside)
            return Climate.from_tmy(path, check_sun=source.check_sun, shift=source.shift)
    if source.measured is not None:
        return _measured_climate(source.measured, beside, building.site, places, source.check_sun)
    raise InputError("climate: nothing given; expected one of epw, tmy, measured")


def _measured_climate(
    table: MeasuredWeather, beside: Beside, site: Site, places: Places, check_sun: bool
) -> Climate:
    with places.blame("climate", "measured", "table"):
        path = find(table.table, beside)
    with places.blame("climate", "measured", "columns"):
        columns = {channel: _column(given) for channel, given in table.columns.items()}
    with places.blame("climate", "measured"):
        climate = Climate.from_table(
            path,
            columns=columns,
            absent=table.absent,
            latitude=float(site.latitude),
            longitude=float(site.longitude),
            altitude=float(site.altitude),
            check_sun=check_sun,
            **table.options,
        )
    return climate if table.fill_gaps is None else climate.fill_gaps(table.fill_gaps)


def require_one_clock(study: StudyFile, places: Places) -> None:
    """Refuse one table that is read with two time zones or two meanings of its stamps.

    Raises
    ------
    InputError
        Climate and measurements name the same table with another time zone or other stamps.
    """
    weather, measured = study.climate.measured, study.measurements
    if weather is None or weather.table != measured.table:
        return
    for key in ("timezone", "stamps"):
        mine, theirs = getattr(weather, key), getattr(measured, key)
        if mine != theirs:
            with places.blame("measurements", key):
                raise InputError(
                    f"found {theirs}, but the climate reads the same table with {key} {mine} "
                    f"({places.at('climate', 'measured', key)}); expected the same in both: change one of "
                    "them"
                )


def _column(given: object) -> str | dict[str, object]:
    if isinstance(given, str):
        return given
    if isinstance(given, dict):
        return {str(key): value for key, value in given.items()}
    raise InputError(f"found {given!r}, expected a column's name or a mapping with 'column'")


def open_measurements(
    study: StudyFile, beside: Beside, building: Building, places: Places, of_building: Places
) -> Measurements:
    """The measured columns that sensors and boundaries need.

    Parameters
    ----------
    study : StudyFile
        Names table and sensors.
    beside : Beside
        Folder of the study.
    building : Building
        Names the columns of its measured boundaries.
    places, of_building : Places
        Lines of the study and of the building, for errors.

    Raises
    ------
    InputError
        A file, column or time zone is missing, or a value cannot be used.
    """
    table: MeasuredTable = study.measurements
    with places.blame("measurements", "table"):
        path = find(table.table, beside)
    boundaries = measured_columns(building)
    # Entry that needs each column, for errors.
    needed = {name: places.at("measurements", "inspect") for name in table.inspect}
    for name in boundaries:
        keys = ("measured", "irradiance", "column")
        line = next((at for key in keys if (at := of_building.find(key, name))), None)
        needed[name] = f"{line or of_building.file}: measured column"
    for sensor, entry in study.sensors.items():
        needed |= dict.fromkeys(entry.columns, places.at("sensors", sensor, "column"))
    chosen = {name: table.column_of(name) for name in needed}
    taken = {column if isinstance(column, str) else str(column["column"]) for column in chosen.values()}
    if not table.inspect:
        chosen |= {name: name for name in _other_columns(path, table, taken) if name not in chosen}
    try:
        return Measurements.from_table(path, columns=chosen, **table.options)
    except InputError as error:
        _explain(path, table, needed, places)
        raise InputError(f"{places.at('measurements', 'mean')}: {error}") from None


def _other_columns(path: Path, table: MeasuredTable, needed: Collection[str]) -> list[str]:
    """Further columns of numbers; their quality is checked too."""
    options = {key: value for key, value in table.options.items() if key not in ("stamps", "mean")}
    try:
        read = read_table(path, **options)
    except InputError:
        # The error is raised where the needed columns are read.
        return []
    others = []
    for column in map(str, read.frame.columns):
        with contextlib.suppress(InputError):
            if column not in needed and np.isfinite(read.numbers(column, column)).any():
                others.append(column)
    return others


def _explain(path: Path, table: MeasuredTable, needed: Mapping[str, str], places: Places) -> None:
    """Raise the error of the whole table, else of every column with the entry that needs it."""
    plain, faults = {**table.options, "mean": ()}, Faults()
    with places.blame("measurements"):
        Measurements.from_table(path, columns=(), **plain)
    for column, place in needed.items():
        with faults.kept():
            try:
                Measurements.from_table(path, columns={column: table.column_of(column)}, **plain)
            except InputError as error:
                raise InputError(f"{place}: {error}") from None
    faults.raise_all(places.file)


def filled(read: Measurements, building: Building, longest: str) -> Measurements:
    """Fill short gaps in the columns of measured boundaries.

    Parameters
    ----------
    read : Measurements
        As they were read.
    building : Building
        Names the columns.
    longest : str
        Longest gap to fill, such as ``2h``.
    """
    return read.fill_gaps(longest, measured_columns(building))

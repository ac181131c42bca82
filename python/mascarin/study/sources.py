"""The inputs of a study: files found, read, and remembered with their hashes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from mascarin.climate import Climate, Measurements
from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.model import Building
    from mascarin.model.site import Site
    from mascarin.study.description import ClimateSource, MeasuredWeather, StudyFile, Table

#: A file that the data module knows, by name.
KNOWN = "data:"


def find(name: str, beside: Path) -> Path:
    """A file beside the study, or a known data set.

    Parameters
    ----------
    name : str
        Relative path, or ``data:NAME``.
    beside : Path
        Folder of the study.

    Raises
    ------
    InputError
        There is no such file.
    """
    if name.startswith(KNOWN):
        from mascarin.climate.data import data_file

        return data_file(name.removeprefix(KNOWN))
    path = beside / name
    if not path.is_file():
        raise InputError(
            f"{path}: no such file, though the study names it; paths are relative to the study file"
        )
    return path


def open_climate(source: ClimateSource, beside: Path, building: Building) -> Climate:
    """The weather of a study.

    Raises
    ------
    InputError
        A file, column or time zone is missing, or a value cannot be used.
    """
    if source.epw is not None:
        return Climate.from_epw(find(source.epw, beside))
    if source.tmy is not None:
        return Climate.from_tmy(find(source.tmy, beside))
    if source.measured is not None:
        return _measured_climate(source.measured, beside, building.site)
    raise InputError("climate: nothing given; expected one of epw, tmy, measured")


def _measured_climate(table: MeasuredWeather, beside: Path, site: Site) -> Climate:
    return Climate.from_table(
        find(table.table, beside),
        columns={channel: _column(given) for channel, given in table.columns.items()},
        absent=table.absent,
        latitude=float(site.latitude),
        longitude=float(site.longitude),
        altitude=float(site.altitude),
        **table.options,
    )


def _column(given: object) -> str | dict[str, object]:
    if isinstance(given, str):
        return given
    if isinstance(given, dict):
        return {str(key): value for key, value in given.items()}
    raise InputError(f"climate.columns: found {given!r}, expected a column's name or a mapping with 'column'")


def open_measurements(study: StudyFile, beside: Path, building: Building) -> Measurements:
    """The measured columns that sensors and boundaries need.

    Raises
    ------
    InputError
        A file, column or time zone is missing, or a value cannot be used.
    """
    table: Table = study.measurements
    from mascarin.model.border import channels

    wanted = [column for sensor in study.sensors.values() for column in sensor.columns]
    wanted += [*channels(building), *table.inspect]
    return Measurements.from_table(
        find(table.table, beside), columns=list(dict.fromkeys(wanted)), **table.options
    )

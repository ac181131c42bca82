"""A weather file of a year as a record: a typical year, or one calendar year."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from datetime import date
from typing import cast

import numpy as np

from mascarin._io.durations import shift_of
from mascarin.errors import InputError
from mascarin.tables.arrays import Array, Lines
from mascarin.tables.grid import Grid
from mascarin.tables.record import Kind
from mascarin.weather.reading.readers import WeatherYear, kind_of
from mascarin.weather.records.channels import RADIATION
from mascarin.weather.records.record import WeatherRecord
from mascarin.weather.records.site import Place

_FREE = ("infrared", "pressure", "cloud_cover")


def record_of_year(
    read: WeatherYear, typical: bool | None, year: int | None, elsewhere: bool
) -> WeatherRecord:
    """Record of a weather file of a year.

    Parameters
    ----------
    read : WeatherYear
        As read, hour-ending.
    typical, year, elsewhere
        As in `Climate.from_epw`.

    Returns
    -------
    WeatherRecord
        Spot values at their stamps, means at the start of their hour.

    Raises
    ------
    InputError
        The number of hours does not fit the calendar.
    """
    periodic = read.mixed if typical is None else typical
    label = read.year if not periodic else (2001 if year is None else year)
    notes = list(read.notes)
    values, lines = _with_global_alone(dict(read.values), read.where, notes), read.lines
    count = len(lines)
    day = 24 * read.records
    month, number = (1, 1) if periodic else read.start
    if periodic:
        if read.start != (1, 1):
            # In the order of the calendar: a typical year begins in January.
            leap = count != 365 * day
            first = (
                date(2000 if leap else 2001, *read.start) - date(2000 if leap else 2001, 1, 1)
            ).days * day
            values, lines = {k: np.roll(v, first) for k, v in values.items()}, np.roll(lines, first)
        if count != 365 * day:
            keep = np.r_[0 : 59 * day, 60 * day : count]
            values, lines, count = {k: v[keep] for k, v in values.items()}, lines[keep], 365 * day
            notes.append(f"{read.where}: 29 February left out of the typical year.")
        notes.append(
            f"{read.where}: one typical year of 365 days, labeled {label}; it represents any year, is "
            "repeated at its end, and 29 February takes the values of 28 February."
        )
    else:
        _check_length(count // read.records, label, read.start, read.where)
        notes.append(
            f"{read.where}: the calendar year {label}; its first hour starts from the first spot value."
        )
    start = (date(label, month, number) - date(1970, 1, 1)).total_seconds()
    offset = read.zone.utcoffset(None)
    grid = Grid(
        start - (offset.total_seconds() if offset else 0.0), 3600.0 / read.records, count, read.zone, periodic
    )
    return _of_year(read, grid, values, lines, notes, elsewhere)


def shifted(record: WeatherRecord, shift: str | float | None) -> WeatherRecord:
    """A record of a year all of whose times are later.

    Parameters
    ----------
    record : WeatherRecord
        As read.
    shift : str or float or None
        Added to the times; None: nothing. [s]

    Raises
    ------
    InputError
        No time can be read.
    """
    seconds = 0.0 if shift is None else shift_of(shift, f"{record.file}: shift")
    if not seconds:
        return record
    note = f"{record.file}: {seconds / 60.0:+g} min were added to all times, as stated (shift)."
    grid = replace(record.grid, start=record.grid.start + seconds)
    return replace(record, grid=grid, provenance=(*record.provenance, note))


def _with_global_alone(values: dict[str, Array], where: str, notes: list[str]) -> dict[str, Array]:
    """Without irradiances that the file does not have: they are derived from the others and the sun."""
    empty = {name for name in RADIATION if name in values and np.isnan(values[name]).all()}
    present = set(RADIATION) - empty
    if empty and ("global_horizontal" in present or len(present) == 2):
        notes.append(
            f"{where}: {' and '.join(sorted(empty))} have no value in any hour: derived from the others."
        )
        values = {name: column for name, column in values.items() if name not in empty}
    return values


def _check_length(count: int, year: int, start: tuple[int, int], where: str) -> None:
    first = (3, 1) if start == (2, 29) else start
    days = (date(year + 1, *first) - date(year, *start)).days
    if count not in (days * 24, 8760):
        raise InputError(f"{where}: found {count} hours for the year {year}, expected {days * 24}.")
    if count != days * 24:
        raise InputError(
            f"{where}: the year {year} has a 29 February and the file has none; add that day, or write "
            "a year without one, such as 2023, in every row (in Python: typical=True, if it is a "
            "typical year)."
        )


def _of_year(
    read: WeatherYear,
    grid: Grid,
    values: Mapping[str, Array],
    lines: Lines,
    notes: list[str],
    elsewhere: bool,
) -> WeatherRecord:
    columns, kinds, closing = {}, {}, {}
    for name, column in values.items():
        if np.isnan(column).all() and name in _FREE:
            continue
        kinds[name] = cast("Kind", kind_of(name))
        if kinds[name] == "mean":
            columns[name] = column
            continue
        # The spot value of the hour that ends at 24:00 on 31 December is the first of a typical year.
        opening = column[-1] if grid.periodic else column[0]
        columns[name] = np.concatenate([[opening], column[:-1]])
        closing[name] = float(column[-1])
    return WeatherRecord(
        columns=columns, kinds=kinds, grid=grid, closing=closing, site=Place(*read.place),
        file=read.where, sha256=read.sha256, provenance=tuple(notes), lines=lines,
        knots=np.concatenate([lines[-1:] if grid.periodic else lines[:1], lines]), of_year=True,
        elsewhere=elsewhere,
    )  # fmt: skip

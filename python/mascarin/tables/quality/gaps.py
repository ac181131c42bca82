"""Short gaps, filled on request."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TypeVar

import numpy as np

from mascarin._io.durations import seconds_of
from mascarin.errors import InputError, did_you_mean
from mascarin.tables.arrays import Array
from mascarin.tables.quality import runs
from mascarin.tables.record import Record

R = TypeVar("R", bound=Record)


def filled(record: R, longest: str | float, columns: Iterable[str] | None, *, hold_end: bool) -> R:
    """A record with its short gaps filled linearly.

    Parameters
    ----------
    record : Record
        With gaps.
    longest : str or float
        Longest gap to fill, such as `2h`, or seconds. [s]
    columns : iterable of str or None
        None: all.
    hold_end : bool
        Whether a missing instant at the end of the record takes the last value.

    Returns
    -------
    Record
        Another record, whose provenance lists what was filled.

    Raises
    ------
    InputError
        There is no such column, or no length can be read.
    """
    limit = seconds_of(longest, "fill_gaps") / record.grid.interval
    column_names = list(record.columns)
    names = column_names if columns is None else list(columns)
    values_of, closing, notes = dict(record.columns), dict(record.closing), list(record.provenance)
    for name in names:
        if name not in column_names:
            raise InputError(
                f"{record.file}: no column {name!r} to fill. {did_you_mean(name, column_names)}".rstrip()
            )
        values = values_of[name].copy()
        count = fill_linearly(values, limit, circular=name == "wind_direction")
        if count:
            values_of[name] = values
            notes.append(f"{record.file}: {count} missing values of {name} filled linearly on request.")
        if hold_end and name in closing and np.isnan(closing[name]):
            closing[name] = float(values[-1])
    return replace(record, columns=values_of, closing=closing, provenance=tuple(notes))


def fill_linearly(values: Array, limit: float, *, circular: bool = False) -> int:
    """Fill gaps in place by straight lines; those at either end of the record stay.

    Parameters
    ----------
    values : ndarray, shape (n,)
        NaN where missing.
    limit : float
        Longest gap to fill, in rows.
    circular : bool
        Whether the values are directions, which turn the shorter way. [deg]

    Returns
    -------
    int
        How many values were filled.
    """
    count = 0
    for first, last in runs(np.isnan(values)):
        if last - first > limit + 1e-9 or first == 0 or last == len(values):
            continue
        ends = np.array([values[first - 1], values[last]])
        if circular:
            ends = np.unwrap(ends, period=360.0)
        line = np.interp(np.arange(first, last), [first - 1, last], ends)
        values[first:last] = line % 360.0 if circular else line
        count += last - first
    return count

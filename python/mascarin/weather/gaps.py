"""Short gaps, filled on request."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from mascarin.errors import InputError, did_you_mean
from mascarin.weather.arrays import Array
from mascarin.weather.quality import runs
from mascarin.weather.table import seconds_of

if TYPE_CHECKING:
    from mascarin.weather.climate import Climate


def filled(climate: Climate, longest: str | float, columns: Iterable[str] | None = None) -> Climate:
    """A climate with its short gaps filled linearly; see `Climate.fill_gaps`."""
    limit = seconds_of(longest, "fill_gaps") / climate.grid.interval
    known = [str(name) for name in climate.data.columns]
    names = known if columns is None else list(columns)
    data, closing, notes = climate.data.copy(), dict(climate.closing), list(climate.provenance)
    for name in names:
        if name not in known:
            raise InputError(
                f"{climate.file}: no column {name!r} to fill. {did_you_mean(name, known)}".rstrip()
            )
        values = data[name].to_numpy(dtype=np.float64).copy()
        count = fill_linearly(values, limit, circular=name == "wind_direction")
        if count:
            data[name] = values
            notes.append(f"{climate.file}: {count} missing values of {name} filled linearly on request.")
        if name in closing and np.isnan(closing[name]):
            closing[name] = float(values[-1])
    return replace(climate, data=data, closing=closing, provenance=tuple(notes), _ready={})


def fill_linearly(values: Array, limit: float, *, circular: bool = False) -> int:
    """Fill gaps in place by straight lines; those at either end stay.

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

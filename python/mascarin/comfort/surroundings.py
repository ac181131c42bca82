"""What is outdoors while a room is assessed: running means of the temperature, moisture and pressure."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import tzinfo
from typing import TYPE_CHECKING

import numpy as np

from mascarin.comfort.adaptive import ASHRAE_WEIGHTS, EN_WEIGHTS, weighted_mean
from mascarin.comfort.evaluation import Floats
from mascarin.physics import STANDARD_PRESSURE, humidity_of_dew_point, humidity_ratio
from mascarin.tables.arrays import Array
from mascarin.tables.grid import values_in
from mascarin.tables.times import epoch_seconds, stamps_of
from mascarin.weather.records.window import window

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.weather import Climate

_DAY = 86400.0
_BEFORE = len(EN_WEIGHTS)  # days


@dataclass(frozen=True, eq=False)
class Surroundings:
    """The outdoors at the times of a run.

    Attributes
    ----------
    air_temperature : ndarray, shape (times,)
        Outdoor temperature. [degC]
    running_mean, prevailing_mean : ndarray, shape (times,)
        Means of the days before, by EN 16798-1 and ASHRAE 55; NaN where they are not all known. [degC]
    humidity_ratio : ndarray, shape (times,), or None
        Vapour in the outdoor air; None where the climate has no dew point. [kg/kg]
    pressure : ndarray, shape (times,)
        Pressure of the air. [Pa]

    Examples
    --------
    >>> from mascarin.examples import box_climate
    >>> import pandas as pd
    >>> times = pd.date_range("2001-07-01", periods=3, freq="12h", tz="UTC")
    >>> Surroundings.of(box_climate(), times).air_temperature.shape
    (3,)
    """

    air_temperature: Floats
    running_mean: Floats
    prevailing_mean: Floats
    humidity_ratio: Floats | None
    pressure: Floats

    @classmethod
    def of(cls, climate: Climate, times: pd.DatetimeIndex) -> Surroundings:
        """The outdoors of a climate.

        Parameters
        ----------
        climate : Climate
            The weather of the run.
        times : pandas.DatetimeIndex, shape (times,)
            Times with their zone, inside the climate.

        Returns
        -------
        Surroundings
            Interpolated to the times.
        """
        record, seconds = climate.record, epoch_seconds(times)
        names = set(climate.data.columns)
        outdoors = _sampled(climate, "air_temperature", seconds)
        pressure = np.full(len(times), STANDARD_PRESSURE)
        if "pressure" in names:
            pressure = _sampled(climate, "pressure", seconds)
        ratio = None
        if "dew_point" in names:
            dew = _sampled(climate, "dew_point", seconds)
            ratio = humidity_ratio(outdoors, humidity_of_dew_point(outdoors, dew), pressure)
        days, daily = _daily(climate, seconds[0] - (_BEFORE + 1) * _DAY, seconds[-1] + _DAY)
        local_days = _local_days(seconds, record.grid.zone)
        index = np.clip(np.searchsorted(days, local_days), 0, len(days) - 1)
        is_covered = days[index] == local_days
        means = (weighted_mean(daily, weights)[index] for weights in (EN_WEIGHTS, ASHRAE_WEIGHTS))
        running, prevailing = (np.where(is_covered, mean, np.nan) for mean in means)
        return cls(outdoors, running, prevailing, ratio, pressure)


def _sampled(climate: Climate, name: str, seconds: Array) -> Floats:
    """A channel at some times, linear between its values. [its unit]"""
    start, values, kind = window(climate.record, name, float(seconds[0]), float(seconds[-1]))
    middle = 0.5 if kind == "mean" else 0.0
    return np.interp(seconds, start + (np.arange(len(values)) + middle) * climate.grid.interval, values)


def _daily(climate: Climate, first: float, last: float) -> tuple[Floats, Floats]:
    """Local days, counted from 1970, and their mean outdoor temperature; NaN where a day is not whole."""
    grid, name = climate.grid, "air_temperature"
    # Gaps before the run are no error: the days with one are not known.
    start, rows = grid.rows(first, last)
    column = climate.data[name].to_numpy(dtype=np.float64)
    values = np.asarray(values_in(column, np.nan, rows, "mean"), dtype=np.float64)
    day = _local_days(start + (np.arange(len(values)) + 0.5) * grid.interval, grid.zone)
    days = np.arange(day[0], day[-1] + 1.0)
    day_number = (day - day[0]).astype(np.int64)
    count = np.bincount(day_number, minlength=len(days))
    total = np.bincount(day_number, weights=values, minlength=len(days))
    is_complete = count * grid.interval >= _DAY - 3601.0  # a day of 23 h where the clock is put forward
    return days, np.where(is_complete, total / np.maximum(count, 1), np.nan)


def _local_days(seconds: Array, zone: tzinfo) -> Floats:
    stamps = stamps_of(seconds, zone).tz_localize(None)
    return np.asarray(stamps.to_numpy().astype("datetime64[D]").astype(np.int64), dtype=np.float64)

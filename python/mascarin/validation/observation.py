"""Model and measurement at the same instants: the comparison that everything else rests on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Protocol

import numpy as np

from mascarin.errors import InputError
from mascarin.weather.times import epoch_seconds

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

    from mascarin.simulation.simulation import Simulation
    from mascarin.weather import Measurements

    Array = npt.NDArray[np.float64]
    Flags = npt.NDArray[np.bool_]


class SensorLike(Protocol):
    """What is compared: columns of a table whose mean one model output stands for."""

    @property
    def columns(self) -> tuple[str, ...]:
        """Columns of the measured table."""
        ...


PERIODS: Final = ("identification", "corroboration", "blind")


@dataclass(frozen=True, eq=False)
class Observation:
    """Measured series on the instants of the comparison.

    Attributes
    ----------
    times : pandas.DatetimeIndex
        Instants, or starts of the intervals of means, shape (n,).
    interval : float
        Spacing of the instants. [s]
    measured : ndarray, shape (n, S)
        NaN where missing or masked. [unit of each sensor]
    kinds : tuple of str
        `instant` or `mean` for each sensor.
    names : tuple of str
        Sensors.
    """

    times: pd.DatetimeIndex
    interval: float
    measured: Array
    kinds: tuple[str, ...]
    names: tuple[str, ...]

    def simulated(self, index: pd.DatetimeIndex, records: Array) -> Array:
        """Records of a run at the instants of the comparison.

        Parameters
        ----------
        index : pandas.DatetimeIndex
            Times of the records, shape (rows,), regular.
        records : ndarray, shape (..., rows, S)
            Outputs in the order of the sensors.

        Returns
        -------
        ndarray, shape (..., n, S)
            Instants interpolated linearly, means integrated; NaN outside the run.
        """
        seconds, at = epoch_seconds(index), epoch_seconds(self.times)
        place = (at - seconds[0]) / (seconds[1] - seconds[0])
        reach = self.interval / (seconds[1] - seconds[0])
        columns = [
            _instants(records[..., s], place) if kind == "instant" else _means(records[..., s], place, reach)
            for s, kind in enumerate(self.kinds)
        ]
        return np.stack(columns, axis=-1)

    def sampled(self, index: pd.DatetimeIndex, values: Array) -> Array:
        """A series of a run at the instants of the comparison, shape (rows,) -> (n,)."""
        seconds, at = epoch_seconds(index), epoch_seconds(self.times)
        return _instants(values, (at - seconds[0]) / (seconds[1] - seconds[0]))

    def during(self, start: pd.Timestamp, end: pd.Timestamp) -> Flags:
        """Instants from start up to but not including end, shape (n,)."""
        return np.asarray((self.times >= start) & (self.times < end))


def observe(
    simulation: Simulation, measurements: Measurements, sensors: Mapping[str, SensorLike], start: pd.Timestamp
) -> Observation:
    """Measured series where model and measurement can be compared.

    Parameters
    ----------
    simulation : Simulation
        Gives step and end.
    measurements : Measurements
        The table, masked as wished.
    sensors : mapping of str to SensorLike
        What to compare.
    start : pandas.Timestamp
        First instant.

    Returns
    -------
    Observation
        On the coarser of the two grids.

    Raises
    ------
    InputError
        A column is missing.
    """
    import pandas as pd

    interval = max(simulation.step_seconds, measurements.step_seconds)
    times = pd.date_range(start, simulation.end, freq=pd.Timedelta(seconds=interval), inclusive="left")
    columns = [_measured(measurements, sensor, times, interval) for sensor in sensors.values()]
    kinds = tuple(measurements.kinds[sensor.columns[0]] for sensor in sensors.values())
    return Observation(times, interval, np.stack(columns, axis=-1), kinds, tuple(sensors))


def _measured(
    measurements: Measurements, sensor: SensorLike, times: pd.DatetimeIndex, interval: float
) -> Array:
    """Mean of a sensor's columns; where one is missing the others stand for it."""
    parts = np.stack([measurements.at(column, times, interval) for column in sensor.columns])
    known = np.isfinite(parts)
    count = known.sum(axis=0)
    total = np.where(known, parts, 0.0).sum(axis=0)
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)


def _instants(records: Array, place: Array) -> Array:
    rows = records.shape[-1]
    near = np.round(place)
    place = np.where(np.abs(place - near) < 1e-6, near, place)
    inside = (place >= 0.0) & (place <= rows - 1)
    left = np.clip(np.floor(place).astype(np.int64), 0, rows - 1)
    right = np.minimum(left + 1, rows - 1)
    weight = place - left
    mixed = records[..., left] * (1.0 - weight) + records[..., right] * weight
    return np.where(inside, mixed, np.nan)


def _means(records: Array, place: Array, reach: float) -> Array:
    """Mean of the piecewise linear record over [place, place + reach]."""
    rows = records.shape[-1]
    steps = 0.5 * (records[..., 1:] + records[..., :-1])
    zero = np.zeros((*records.shape[:-1], 1))
    integral = np.concatenate([zero, np.cumsum(steps, axis=-1)], axis=-1)
    high, low = (_integral(records, integral, p) for p in (place + reach, place))
    inside = (place >= -1e-6) & (place + reach <= rows - 1 + 1e-6)
    return np.where(inside, (high - low) / reach, np.nan)


def _integral(records: Array, integral: Array, place: Array) -> Array:
    """Integral from the first row up to a place."""
    rows = records.shape[-1]
    left = np.clip(np.floor(place + 1e-9).astype(np.int64), 0, rows - 2)
    weight = place - left
    value, following = records[..., left], records[..., left + 1]
    return np.asarray(integral[..., left] + weight * value + 0.5 * weight**2 * (following - value))


def require_comparable(observation: Observation, use: Flags, what: str, sensors: Sequence[str]) -> None:
    """Refuse a period in which a sensor has no values.

    Raises
    ------
    InputError
        Nothing to compare.
    """
    for s, name in enumerate(observation.names):
        if name in sensors and not np.isfinite(observation.measured[use, s]).any():
            raise InputError(
                f"sensors.{name}: has no values during the {what} (missing or masked); choose another "
                "period, sensor or mask"
            )

"""Simulated and measured series at the same instants or over the same intervals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.errors import InputError
from mascarin.tables.times import epoch_seconds

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

    from mascarin.measurements.sensor import Sensor
    from mascarin.simulation.simulation import Simulation
    from mascarin.weather import Measurements

    Array = npt.NDArray[np.float64]
    Flags = npt.NDArray[np.bool_]


PERIODS: Final = ("identification", "corroboration", "blind")
"""Names of the periods of a study."""


@dataclass(frozen=True, eq=False)
class Observation:
    """Measured series at the instants of a comparison with a simulation.

    Attributes
    ----------
    times : pandas.DatetimeIndex
        Instants, or starts of the intervals of means, shape (n,), in the time zone of the climate.
    interval : float
        Time between the instants. [s]
    measured : ndarray, shape (n, S)
        NaN where missing or masked. [unit of each sensor]
    kinds : tuple of str
        ``instant`` or ``mean`` for each sensor.
    names : tuple of str
        Names of the sensors, S of them.

    Examples
    --------
    >>> import numpy as np
    >>> import pandas as pd
    >>> times = pd.date_range("2024-01-01", periods=2, freq="30min", tz="UTC")
    >>> observed = Observation(times, 1800.0, np.array([[20.0], [20.5]]), ("instant",), ("room",))
    >>> run = pd.date_range("2024-01-01", periods=2, freq="1h", tz="UTC")
    >>> observed.simulated(run, np.array([[20.0], [21.0]])).ravel()
    array([20. , 20.5])
    """

    times: pd.DatetimeIndex
    interval: float
    measured: Array
    kinds: tuple[str, ...]
    names: tuple[str, ...]

    def simulated(self, index: pd.DatetimeIndex, records: Array) -> Array:
        """Interpolate the records of a run to the instants of the comparison.

        Parameters
        ----------
        index : pandas.DatetimeIndex
            Times of the records, shape (rows,), regular.
        records : ndarray, shape (..., rows, S)
            Outputs in the order of the sensors.

        Returns
        -------
        ndarray, shape (..., n, S)
            Instants by linear interpolation, means by integration; NaN outside the run. [unit of each]
        """
        seconds, instants_of_comparison = epoch_seconds(index), epoch_seconds(self.times)
        position = (instants_of_comparison - seconds[0]) / (seconds[1] - seconds[0])
        length = self.interval / (seconds[1] - seconds[0])
        columns = [
            instants(records[..., s], position)
            if kind == "instant"
            else means(records[..., s], position, length)
            for s, kind in enumerate(self.kinds)
        ]
        return np.stack(columns, axis=-1)

    def sampled(self, index: pd.DatetimeIndex, values: Array) -> Array:
        """Interpolate one series of a run to the instants of the comparison.

        Parameters
        ----------
        index : pandas.DatetimeIndex
            Times of the values, shape (rows,), regular.
        values : ndarray, shape (rows,)
            The series. [unit]

        Returns
        -------
        ndarray, shape (n,)
            NaN outside the run. [unit]
        """
        seconds, instants_of_comparison = epoch_seconds(index), epoch_seconds(self.times)
        return instants(values, (instants_of_comparison - seconds[0]) / (seconds[1] - seconds[0]))

    def during(self, start: pd.Timestamp, end: pd.Timestamp) -> Flags:
        """Mark the instants of a period, shape (n,); the start belongs to it and the end does not."""
        return np.asarray((self.times >= start) & (self.times < end))


def observe(
    simulation: Simulation, measurements: Measurements, sensors: Mapping[str, Sensor], start: pd.Timestamp
) -> Observation:
    r"""Collect the measured series that a simulation is compared with.

    Parameters
    ----------
    simulation : Simulation
        Gives time step and end.
    measurements : Measurements
        The table; values that are masked in it are left out.
    sensors : mapping of str to Sensor
        Sensors by name.
    start : pandas.Timestamp
        First instant.

    Returns
    -------
    Observation
        At the longer of both time steps.

    Raises
    ------
    InputError
        A column is missing.

    Examples
    --------
    >>> import numpy as np
    >>> import pandas as pd
    >>> import mascarin as mc
    >>> from mascarin.measurements import Sensor
    >>> from mascarin.verification.analytical import setup
    >>> simulation = setup.simulation(
    ...     setup.building(
    ...         "materials: {panel: {kind: resistance, resistance: 1}}\n"
    ...         "constructions: {panel: {layers: [{material: panel}]}}\n"
    ...         "surfaces: {w: {construction: panel, area: 1, tilt: 90, outside: {measured: air}, "
    ...         "inside: {measured: air}}}"
    ...     ),
    ...     setup.climate(3600.0, {"air": np.full(25, 20.0)}),
    ...     step=3600.0,
    ...     outputs=["w.inside_flux"],
    ...     initial=20.0,
    ... )
    >>> table = pd.DataFrame({"q": np.zeros(24)}, index=simulation.index[:24])
    >>> logger = mc.Measurements.from_table(table, timezone="UTC")
    >>> sensors = {"flux": Sensor("q", expanded_uncertainty=1.0)}
    >>> observe(simulation, logger, sensors, simulation.start).measured.shape
    (24, 1)
    """
    import pandas as pd

    interval = max(simulation.step_seconds, measurements.step_seconds)
    times = pd.date_range(start, simulation.end, freq=pd.Timedelta(seconds=interval), inclusive="left")
    columns = [_measured(measurements, sensor, times, interval) for sensor in sensors.values()]
    kinds = tuple(measurements.kinds[sensor.columns[0]] for sensor in sensors.values())
    return Observation(times, interval, np.stack(columns, axis=-1), kinds, tuple(sensors))


def _measured(measurements: Measurements, sensor: Sensor, times: pd.DatetimeIndex, interval: float) -> Array:
    """Sum of the columns of a sensor, or their mean over those that have a value."""
    parts = np.stack([measurements.at(column, times, interval) for column in sensor.columns])
    if sensor.adds:
        return np.asarray(parts.sum(axis=0))
    finite = np.isfinite(parts)
    count = finite.sum(axis=0)
    total = np.where(finite, parts, 0.0).sum(axis=0)
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)


def instants(records: Array, position: Array) -> Array:
    """Interpolate records linearly.

    Parameters
    ----------
    records : ndarray, shape (..., rows)
        Values at regular times. [unit]
    position : ndarray, shape (n,)
        Where to interpolate, counted in rows from the first. [-]

    Returns
    -------
    ndarray, shape (..., n)
        NaN outside the records. [unit]

    Examples
    --------
    >>> import numpy as np
    >>> instants(np.array([0.0, 6.0]), np.array([0.5, 1.0, 2.0]))
    array([ 3.,  6., nan])
    """
    rows = records.shape[-1]
    nearest = np.round(position)
    position = np.where(np.abs(position - nearest) < 1e-6, nearest, position)
    inside = (position >= 0.0) & (position <= rows - 1)
    lower = np.clip(np.floor(position).astype(np.int64), 0, rows - 1)
    weight = position - lower
    if inside.all() and not weight.any():  # records of these instants: nothing to interpolate
        return np.asarray(records[..., lower])
    upper = np.minimum(lower + 1, rows - 1)
    mixed = records[..., lower] * (1.0 - weight) + records[..., upper] * weight
    return np.where(inside, mixed, np.nan)


def means(records: Array, position: Array, length: float) -> Array:
    """Average piecewise linear records over intervals of one length.

    Parameters
    ----------
    records : ndarray, shape (..., rows)
        Values at regular times. [unit]
    position : ndarray, shape (n,)
        Where the intervals start, counted in rows from the first. [-]
    length : float
        Length of the intervals. [rows]

    Returns
    -------
    ndarray, shape (..., n)
        NaN for intervals that are not inside the records. [unit]

    Examples
    --------
    >>> import numpy as np
    >>> means(np.array([0.0, 6.0, 12.0]), np.array([0.0, 1.0]), 1.0)
    array([3., 9.])
    """
    rows = records.shape[-1]
    steps = 0.5 * (records[..., 1:] + records[..., :-1])
    zero = np.zeros((*records.shape[:-1], 1))
    integral = np.concatenate([zero, np.cumsum(steps, axis=-1)], axis=-1)
    high, low = (_integral(records, integral, p) for p in (position + length, position))
    inside = (position >= -1e-6) & (position + length <= rows - 1 + 1e-6)
    return np.where(inside, (high - low) / length, np.nan)


def _integral(records: Array, integral: Array, position: Array) -> Array:
    """Integral from the first row up to a place."""
    rows = records.shape[-1]
    lower = np.clip(np.floor(position + 1e-9).astype(np.int64), 0, rows - 2)
    weight = position - lower
    value, following = records[..., lower], records[..., lower + 1]
    return np.asarray(integral[..., lower] + weight * value + 0.5 * weight**2 * (following - value))


def require_comparable(observation: Observation, use: Flags, what: str, sensors: Sequence[str]) -> None:
    """Refuse a period in which a sensor has no values.

    Parameters
    ----------
    observation : Observation
        The measured series.
    use : ndarray of bool, shape (n,)
        Instants of the period.
    what : str
        Name of the period in the error.
    sensors : sequence of str
        Names of the sensors that are needed.

    Raises
    ------
    InputError
        A sensor has no values in the period.
    """
    for s, name in enumerate(observation.names):
        if name in sensors and not np.isfinite(observation.measured[use, s]).any():
            raise InputError(
                f"sensors.{name}: has no values during the {what} (missing or masked); choose another "
                "period, sensor or mask"
            )

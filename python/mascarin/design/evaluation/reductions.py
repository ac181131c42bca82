"""Numbers that are kept of each run instead of its series: functions that can be sent to worker processes.

Each is called with a Dataset of outputs over (member, time) and gives one number for each member. Records
are states or means at the end of a step; the first record is the state at the start and represents no time.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin._io.limits import TOLERANCE, at_least, excess, shortfall
from mascarin.comfort import Surroundings

if TYPE_CHECKING:
    import numpy.typing as npt
    import xarray as xr

    from mascarin.comfort import ComfortSettings, SeatView
    from mascarin.comfort.evaluation import Discomfort
    from mascarin.weather import Climate

    Array = npt.NDArray[np.float64]
    Mask = npt.NDArray[np.bool_]

#: Bins of the daily change of the liquid fraction, from 0 to 1.
BINS: Final = 10

Hours = tuple[float, float]


@dataclass(frozen=True)
class Beyond:
    """Degree-hours or hours beyond a limit, as the mean over some zones.

    Parameters
    ----------
    outputs : tuple of str
        Temperatures, one for each zone. [degC]
    limit : float
        The limit. [degC]
    above : bool
        Whether what is above counts, or what is below.
    hours : tuple of float, optional
        First and last hour of the part of the day that counts; over midnight where the first is later. [h]
    weighted : bool
        Degree-hours [K h], or hours [h].

    Examples
    --------
    >>> import xarray as xr
    >>> import pandas as pd
    >>> time = pd.date_range("2024-01-01", periods=4, freq="1h")
    >>> run = xr.Dataset(
    ...     {"a": (("member", "time"), [[30.0, 29.0, 30.0, 20.0]])},
    ...     coords={"time": time, "local_time": ("time", time)},
    ... )
    >>> Beyond(("a",), 28.0)(run)
    array([3.])
    """

    outputs: tuple[str, ...]
    limit: float
    above: bool = True
    hours: Hours | None = None
    weighted: bool = True

    def __call__(self, run: xr.Dataset) -> Array:
        """Value for each member. [K h] or [h]"""
        seconds, counted = _clock(run, self.hours)
        total = 0.0
        for name in self.outputs:
            values = run[name].to_numpy()[:, 1:]
            beyond = (excess if self.above else shortfall)(values, self.limit)
            weights = beyond if self.weighted else (beyond > 0.0).astype(np.float64)
            total = total + (weights * counted).sum(axis=1)
        return np.asarray(total * seconds / 3600.0 / len(self.outputs), dtype=np.float64)


@dataclass(frozen=True)
class Highest:
    """Highest value of some outputs at any time of the counted hours. [unit of the outputs]"""

    outputs: tuple[str, ...]
    hours: Hours | None = None

    def __call__(self, run: xr.Dataset) -> Array:
        """Value for each member."""
        _, counted = _clock(run, self.hours)
        tops = [run[name].to_numpy()[:, 1:][:, counted].max(axis=1) for name in self.outputs]
        return np.asarray(np.max(tops, axis=0), dtype=np.float64)


@dataclass(frozen=True)
class Heat:
    """Heat of the loads of some zones over the run. [kWh]"""

    outputs: tuple[str, ...]

    def __call__(self, run: xr.Dataset) -> Array:
        """Value for each member. [kWh]"""
        seconds, _ = _clock(run, None)
        total = sum(run[name].to_numpy()[:, 1:].sum(axis=1) for name in self.outputs)
        return np.asarray(total * seconds / 3.6e6, dtype=np.float64)


@dataclass(frozen=True)
class PeakLoad:
    """Largest sum of the loads of some zones, as a mean over an hour. [W]"""

    outputs: tuple[str, ...]

    def __call__(self, run: xr.Dataset) -> Array:
        """Value for each member. [W]"""
        seconds, _ = _clock(run, None)
        load = np.sum([run[name].to_numpy()[:, 1:] for name in self.outputs], axis=0)
        width = max(min(round(3600.0 / seconds), load.shape[1]), 1)
        sums = np.cumsum(np.concatenate([np.zeros((len(load), 1)), load], axis=1), axis=1)
        return np.asarray((sums[:, width:] - sums[:, :-width]).max(axis=1) / width, dtype=np.float64)


@dataclass(frozen=True)
class Melted:
    """Fraction of a layer that melts in a day, as the mean over the days: all rises are added up. [-]"""

    output: str

    def __call__(self, run: xr.Dataset) -> Array:
        """Value for each member. [1/d]"""
        fraction = run[self.output].to_numpy()
        seconds, _ = _clock(run, None)
        rises = np.maximum(np.diff(fraction, axis=1), 0.0).sum(axis=1)
        return np.asarray(rises / (seconds * (fraction.shape[1] - 1) / 86400.0), dtype=np.float64)


@dataclass(frozen=True)
class CycleDays:
    """Number of days on which the liquid fraction changes by at least so much. [d]"""

    output: str
    least: float

    def __call__(self, run: xr.Dataset) -> Array:
        """Value for each member. [d]"""
        return np.asarray(at_least(daily_change(run, self.output), self.least).sum(axis=1), dtype=np.float64)


@dataclass(frozen=True)
class DaysInBin:
    """Number of days on which the change of the liquid fraction is in a bin of 1/`BINS`. [d]"""

    output: str
    number: int

    def __call__(self, run: xr.Dataset) -> Array:
        """Value for each member. [d]"""
        bins = np.minimum(((daily_change(run, self.output) + TOLERANCE) * BINS).astype(np.int64), BINS - 1)
        return np.asarray((bins == self.number).sum(axis=1), dtype=np.float64)


@dataclass(frozen=True)
class Assessed:
    """Degree-hours of discomfort by an index, or the hours in which it has no value; mean over some zones.

    Parameters
    ----------
    zones : tuple of str
        The zones.
    key : str
        ``degrees`` or ``undefined``.
    side : str
        ``hot``, ``cold`` or ``both``.
    settings : ComfortSettings
        Index, limits and person.
    climate : Climate
        The weather.
    views : tuple of SeatView or None
        What is seen from the seat in each zone; None: surfaces are weighted by area.
    """

    zones: tuple[str, ...]
    key: str
    side: str
    settings: ComfortSettings
    climate: Climate = field(repr=False, compare=False)
    views: tuple[SeatView | None, ...]

    def __call__(self, run: xr.Dataset) -> Array:
        """Value for each member. [unit of the index x h] or [h]"""
        import pandas as pd

        times = pd.DatetimeIndex(run["time"].to_numpy(), tz="UTC").tz_convert(self.climate.grid.zone)
        around = Surroundings.of(self.climate, times)
        hours = self.settings.occupied(times)
        total = np.zeros(run.sizes["member"])
        for zone, view in zip(self.zones, self.views, strict=True):
            air = run[f"{zone}.air_temperature"].to_numpy()
            if view is None:
                radiant = run[f"{zone}.mean_radiant_temperature"].to_numpy()
            else:
                radiant = view.radiant(np.stack([run[name].to_numpy() for name in view.outputs], axis=-1))
            simulated = self.settings.humidity == "simulated"
            humidity = 100.0 * run[f"{zone}.relative_humidity"].to_numpy() if simulated else None
            discomfort = self.settings.discomfort(air, radiant, hours, around, humidity)
            total += discomfort.undefined_hours if self.key == "undefined" else self._degrees(discomfort)
        return np.asarray(total / len(self.zones), dtype=np.float64)

    def _degrees(self, discomfort: Discomfort) -> Array:
        if self.side == "both":
            return discomfort.degree_hours
        return discomfort.hot_degree_hours if self.side == "hot" else discomfort.cold_degree_hours


def daily_change(run: xr.Dataset, output: str) -> Array:
    """Largest less smallest value of an output on each local day, shape (members, days). [unit of the output]

    The state at the beginning of a day belongs to it. A day of which less than half was simulated is left
    out, if there is another one.
    """
    values = run[output].to_numpy()
    starts, sizes = _days(run)
    tops = np.maximum.reduceat(values[:, 1:], starts, axis=1)
    lows = np.minimum.reduceat(values[:, 1:], starts, axis=1)
    before = values[:, starts]
    change = np.maximum(tops, before) - np.minimum(lows, before)
    full_days = sizes >= 0.5 * sizes.max()
    return np.asarray(change[:, full_days], dtype=np.float64)


def _days(run: xr.Dataset) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """First step of each local day, and number of its steps."""
    times = run["local_time"].to_numpy()
    middles = times[1:] - (run["time"].to_numpy()[1] - run["time"].to_numpy()[0]) / 2
    days = middles.astype("datetime64[D]")
    starts = np.flatnonzero(np.concatenate([[True], days[1:] != days[:-1]]))
    return starts, np.diff(np.append(starts, len(days)))


def _clock(run: xr.Dataset, hours: Hours | None) -> tuple[float, Mask]:
    """Length of a step [s], and whether each step counts, by the middle of the step on the local clock."""
    times = run["time"].to_numpy()
    step = times[1] - times[0]
    seconds = float(step / np.timedelta64(1, "s"))
    if hours is None:
        return seconds, np.ones(len(times) - 1, dtype=bool)
    middles = run["local_time"].to_numpy()[1:] - step / 2
    hour = (middles - middles.astype("datetime64[D]")) / np.timedelta64(1, "h")
    first, last = hours
    inside = (hour >= first) & (hour < last) if first < last else (hour >= first) | (hour < last)
    return seconds, inside

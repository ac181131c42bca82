"""A regular grid of intervals: which rows cover a span of time, and what follows after the ends."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime, tzinfo
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from mascarin.errors import InputError
from mascarin.tables.arrays import Array, Lines
from mascarin.tables.times import local_time, stamps_of
from mascarin.tables.timezones import zone_name

Rows = Lines

if TYPE_CHECKING:
    import pandas as pd

_MARGIN = 3
_DAY = 86400.0


@dataclass(frozen=True)
class Grid:
    """Intervals of equal length.

    Attributes
    ----------
    start : float
        Start of the first interval, seconds since 1970-01-01 UTC [s].
    interval : float
        Length of one [s].
    count : int
        Number of intervals.
    zone : datetime.tzinfo
        Time zone; a fixed offset where the grid is periodic.
    periodic : bool
        A typical year of 365 days, which represents any year.
    """

    start: float
    interval: float
    count: int
    zone: tzinfo
    periodic: bool = False

    @property
    def end(self) -> float:
        """End of the last interval [s]."""
        return self.start + self.interval * self.count

    def span(self) -> str:
        """The range covered, as text."""
        return _span(self.start, self.end, self.zone)

    def require(self, start: float, end: float, where: str, hint: str = "") -> None:
        """Refuse a span that the grid does not cover.

        Raises
        ------
        InputError
            The span starts too early or ends too late.
        """
        if self.periodic or (start >= self.start - 1e-6 and end <= self.end + 1e-6):
            return
        first, last = (local_time(seconds, self.zone) for seconds in (start, end))
        raise InputError(
            f"{where}: the period {first:%Y-%m-%d %H:%M} .. {last:%Y-%m-%d %H:%M} is outside the data, "
            f"which cover {self.span()}; choose a period inside{hint}."
        )

    def rows(self, start: float, end: float) -> tuple[float, Rows]:
        """Rows whose intervals cover a span, with a margin where there is one.

        Parameters
        ----------
        start, end : float
            Span, seconds since 1970-01-01 UTC [s].

        Returns
        -------
        first : float
            Start of the first interval [s].
        rows : ndarray, shape (k + 1,)
            Row of each interval, then that in which the last one ends (`count` past the record's end).
        """
        low = self._low(start)
        high = int(np.ceil((end - self.start) / self.interval - 1e-9)) + _MARGIN
        if not self.periodic:
            high = min(high, self.count)
            return self.start + low * self.interval, np.arange(low, high + 1)
        steps = np.arange(low, high + 1)
        return self.start + low * self.interval, self._in_any_year(self.start + steps * self.interval)

    def begin(self, start: float) -> float:
        """Start of the first interval that `rows` gives for a span [s].

        Parameters
        ----------
        start : float
            Start of the span, seconds since 1970-01-01 UTC [s].
        """
        return self.start + self._low(start) * self.interval

    def _low(self, start: float) -> int:
        low = int(np.floor((start - self.start) / self.interval + 1e-9)) - _MARGIN
        return low if self.periodic else max(low, 0)

    def _in_any_year(self, seconds: Array) -> Rows:
        """Row of the same local time in the stored year; 29 February takes the values of 28 February."""
        offset = self.zone.utcoffset(datetime(2001, 1, 1))
        early = offset.total_seconds() if offset is not None else 0.0
        # The first row begins at midnight, unless all times were shifted.
        midnight = round((self.start + early) / _DAY) * _DAY
        local = seconds + early - (self.start + early - midnight)
        days = np.floor(local / _DAY + 1e-9)
        date = days.astype(np.int64).astype("datetime64[D]")
        year = date.astype("datetime64[Y]")
        number = (date - year.astype("datetime64[D]")).astype(np.int64)
        leap = ((year + 1).astype("datetime64[D]") - year.astype("datetime64[D]")).astype(np.int64) == 366
        number = number - (leap & (number >= 59))
        per_day = round(_DAY / self.interval)
        return np.asarray(number * per_day + np.round((local - days * _DAY) / self.interval).astype(np.int64))


def values_in(values: Array, closing: float, rows: Rows, kind: str) -> Array:
    """Values of a window of rows.

    Parameters
    ----------
    values : ndarray, shape (count,)
        One value for each interval: at its start (instant) or its mean.
    closing : float
        Instantaneous value at the end of the record; not read for a mean.
    rows : ndarray, shape (k + 1,)
        From `Grid.rows`.
    kind : str
        `instant` or `mean`.

    Returns
    -------
    ndarray, shape (k + 1,) or (k,)
        Instants at both ends of every interval, or the means.
    """
    if kind == "mean":
        return values[rows[:-1]]
    return np.append(values, closing)[rows]


def frame_of(columns: Mapping[str, Array], grid: Grid) -> pd.DataFrame:
    """Columns on a grid, labelled by the start of each interval in the grid's zone."""
    import pandas as pd

    index = stamps_of(grid.start + grid.interval * np.arange(grid.count), grid.zone)
    frame = pd.DataFrame(dict(columns), index=index)
    frame.index.name = "time"
    return frame


@lru_cache(maxsize=64)  # every run of a study names the period of its climate
def _span(start: float, end: float, zone: tzinfo) -> str:
    first, last = (local_time(seconds, zone) for seconds in (start, end))
    return f"{first:%Y-%m-%d %H:%M} .. {last:%Y-%m-%d %H:%M} ({zone_name(zone)})"

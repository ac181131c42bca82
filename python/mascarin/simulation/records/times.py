"""The times of records: as numbers, and as an index of pandas when that is asked for."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime, tzinfo
from functools import cached_property
from typing import TYPE_CHECKING, Self

import numpy as np

from mascarin.tables.times import epoch_seconds, local_time, stamps_of

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd


@dataclass(frozen=True, eq=False)
class Times:
    """Times at equal distances. A run needs the numbers alone; pandas takes a quarter of a second to import.

    Attributes
    ----------
    first, last : float
        First and last time, seconds since 1970-01-01 UTC. [s]
    step : float
        Distance. [s]
    zone : datetime.tzinfo
        Zone of the local clock.
    """

    first: float
    last: float
    step: float
    zone: tzinfo

    @classmethod
    def of(cls, index: pd.DatetimeIndex) -> Self:
        """The times of an index with a zone, which is kept."""
        seconds = epoch_seconds(index[[0, min(1, len(index) - 1), -1]])
        zone = index.tz
        assert zone is not None, "times of records have a zone"  # noqa: S101 (a defect, not an input)
        times = cls(float(seconds[0]), float(seconds[2]), float(seconds[1] - seconds[0]), zone)
        times.__dict__["index"] = index
        return times

    @property
    def start(self) -> datetime:
        """First time, in the local clock."""
        return local_time(self.first, self.zone)

    @property
    def end(self) -> datetime:
        """Last time, in the local clock."""
        return local_time(self.last, self.zone)

    @cached_property
    def index(self) -> pd.DatetimeIndex:
        """The times in the local clock, shape (rows,)."""
        import pandas as pd

        start, end = stamps_of(np.array([self.first, self.last]), self.zone)
        step = pd.Timedelta(seconds=self.step)
        return pd.date_range(start, periods=round((end - start) / step) + 1, freq=step)

    @property
    def timezone(self) -> str:
        """Name of the zone of the local clock."""
        index = self.__dict__.get("index")
        return str(self.zone if index is None else index.tz)

    @property
    def rows(self) -> int:
        """Number of times."""
        index = self.__dict__.get("index")
        return len(index) if index is not None else round((self.last - self.first) / self.step) + 1

    def part(self, first: int, last: int) -> pd.DatetimeIndex:
        """The times of rows from one to before another one in the local clock, without those of all rows."""
        import pandas as pd

        if "index" in self.__dict__:
            return self.index[first:last]
        start, step = stamps_of(np.array([self.first]), self.zone)[0], pd.Timedelta(seconds=self.step)
        return pd.date_range(start + first * step, periods=min(last, self.rows) - first, freq=step)

    def nanoseconds(self, first: int = 0, last: int | None = None) -> npt.NDArray[np.int64]:
        """Times since 1970-01-01 UTC, shape (rows,), of all rows or from one to before another one. [ns]"""
        last = self.rows if last is None else min(last, self.rows)
        if self._whole_microseconds:
            begin, step = round(self.first * 1e6), round(self.step * 1e6)
            return (begin + step * np.arange(first, last, dtype=np.int64)) * 1000
        return _nanoseconds(self.part(first, last).tz_convert("UTC"))

    def clock_nanoseconds(self, first: int = 0, last: int | None = None) -> npt.NDArray[np.int64]:
        """Readings of the local clock since its 1970-01-01, shape (rows,), of rows as above. [ns]"""
        last = self.rows if last is None else min(last, self.rows)
        offset = self.zone.utcoffset(None)
        if offset is None or not self._whole_microseconds:  # a zone whose clocks change
            return _nanoseconds(self.part(first, last))
        return self.nanoseconds(first, last) + round(offset.total_seconds() * 1e6) * 1000

    @property
    def _whole_microseconds(self) -> bool:
        """Whether the times are known without their index: at equal distances of whole microseconds."""
        micro = (self.first * 1e6, self.step * 1e6)
        return "index" not in self.__dict__ and all(moment == round(moment) for moment in micro)

    @property
    def since_start(self) -> npt.NDArray[np.float64]:
        """Times since the first one, shape (rows,). [s]"""
        return np.asarray((self.index - self.index[0]).total_seconds(), dtype=np.float64)


def _nanoseconds(index: pd.DatetimeIndex) -> npt.NDArray[np.int64]:
    """Readings of the clock of an index since 1970-01-01, shape (rows,). [ns]"""
    return index.tz_localize(None).to_numpy().astype("datetime64[ns]").astype(np.int64)

"""Measured time series: compared with a simulation, or used as its boundary conditions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mascarin.errors import InputError, did_you_mean
from mascarin.tables.arrays import Array
from mascarin.tables.grid import Grid
from mascarin.tables.quality import Stretch, find
from mascarin.tables.quality.gaps import filled
from mascarin.tables.reading import records
from mascarin.tables.reading.records import Columns, record_of_columns
from mascarin.tables.reading.table import Stamps, read_table
from mascarin.tables.reading.table_cache import cached_record
from mascarin.tables.record import Record
from mascarin.tables.times import epoch_seconds
from mascarin.weather.records.view import RecordView

if TYPE_CHECKING:
    import pandas as pd


class Measurements(RecordView[Record]):
    """Measured columns on a regular grid of times.

    Made by `from_table`; never changed afterwards. Times follow the rule in `mascarin.weather`.

    Parameters
    ----------
    record : Record
        The columns with their origin; use `from_table`.

    Examples
    --------
    >>> import pandas as pd
    >>> index = pd.date_range("2024-06-01", periods=4, freq="1h", tz="Europe/Paris")
    >>> table = pd.DataFrame({"T_wall": [20.0, 20.5, 21.0, 20.8]}, index=index)
    >>> measured = Measurements.from_table(table)
    >>> float(measured.series("T_wall").max())
    21.0
    >>> print(measured)
    Measurements of 'table'
      period          2024-06-01 00:00 .. 2024-06-01 04:00 (Europe/Paris)
      step            3600 s, 4 rows
      time zone       Europe/Paris
      T_wall          20 .. 21, instant
      missing values  0
    """

    @classmethod
    def from_table(
        cls,
        source: str | Path | pd.DataFrame,
        *,
        timezone: str | None = None,
        columns: Iterable[str] | Columns | None = None,
        mean: Iterable[str] = (),
        stamps: Stamps = "start",
        step: str | float | None = None,
        time: str | Sequence[str] | None = None,
        time_format: str | None = None,
        separator: str | None = None,
        decimal: str | None = None,
        skip_lines: int | None = None,
        missing: Sequence[str | float] = (),
        tolerance: str | float | None = None,
        shift: str | float | None = None,
    ) -> Measurements:
        """Read a table of measurements.

        Parameters
        ----------
        source : path or pandas.DataFrame
            CSV or Parquet file, or a frame with a time index or column.
        timezone : str, optional
            IANA name (`Europe/Paris`) or fixed offset (`UTC+4`) of the stamps. Required, except for a
            frame whose stamps have a time zone.
        columns : iterable or mapping, optional
            Columns to read, or name -> column or `{column, unit, scale, offset, kind, overrule}`. Default:
            all.
        mean : iterable of str
            Columns that are means over their interval; the others are values at the stamp.
        stamps : str
            `start` or `end`: which end of its interval a stamp marks.
        step, time, time_format, separator, decimal, skip_lines, missing, tolerance, shift
            As in `read_table`.

        Returns
        -------
        Measurements
            The series.

        Raises
        ------
        InputError
            A column or the time zone is missing, an entry or a time cannot be used.

        Examples
        --------
        >>> import pandas as pd
        >>> table = pd.DataFrame(
        ...     {"time": ["2024-06-01 00:15", "2024-06-01 00:30"], "irradiance": [0.0, 12.0]}
        ... )
        >>> Measurements.from_table(
        ...     table, timezone="UTC+4", mean=["irradiance"], stamps="end"
        ... ).index[0].isoformat()
        '2024-06-01T00:00:00+04:00'
        """
        reading: dict[str, Any] = {
            "time": time, "time_format": time_format, "separator": separator, "decimal": decimal,
            "skip_lines": skip_lines, "step": step, "missing": missing, "tolerance": tolerance,
            "shift": shift,
        }  # fmt: skip
        selection = columns if columns is None or isinstance(columns, Mapping) else tuple(columns)
        choice = (selection, tuple(mean), stamps)

        def record() -> Record:
            return record_of_columns(read_table(source, timezone=timezone, **reading), *choice)

        return cls(cached_record(Record, source, timezone, (reading, *choice), [records], record))

    def quality(self, limits: Mapping[str, tuple[float, float]] | None = None) -> list[Stretch]:
        """Suspicious parts of every column: missing, stuck, out of range, spikes.

        Parameters
        ----------
        limits : mapping of str to (float, float), optional
            Lowest and highest possible value of a column. [unit of the column]

        Returns
        -------
        list of Stretch
            In order of column, then start; see `mascarin.tables.quality.find`.

        Examples
        --------
        >>> import pandas as pd
        >>> index = pd.date_range("2024-06-01", periods=4, freq="1h", tz="UTC")
        >>> table = pd.DataFrame({"T": [20.0, None, 21.0, 20.8]}, index=index)
        >>> [(part.kind, part.count) for part in Measurements.from_table(table).quality()]
        [('missing', 1)]
        """
        return find(self.data, limits=limits)

    def series(self, name: str) -> pd.Series[float]:
        """One column.

        Parameters
        ----------
        name : str
            Column.

        Returns
        -------
        pandas.Series
            Its values; the index is in local time with its offset.

        Raises
        ------
        InputError
            There is no such column.
        """
        if name not in self.data.columns:
            hint = did_you_mean(name, [str(column) for column in self.data.columns])
            raise InputError(f"{self.file}: no measured column {name!r}. {hint}".rstrip())
        return self.data[name]

    def at(self, name: str, times: pd.DatetimeIndex, step_seconds: float = 0.0) -> Array:
        """A column at given times, for comparison with results.

        Parameters
        ----------
        name : str
            Column.
        times : pandas.DatetimeIndex
            With a time zone, shape (n,).
        step_seconds : float
            For a `mean` column: length of the intervals that start at `times`; default the table's own [s].

        Returns
        -------
        ndarray, shape (n,)
            Instants: the value at the time, linear between two stamps that both have one. Means: the mean
            over the interval, from the table's intervals in proportion. NaN where missing or outside the
            record.

        Raises
        ------
        InputError
            There is no such column.

        Examples
        --------
        >>> import pandas as pd
        >>> index = pd.date_range("2024-06-01", periods=3, freq="1h", tz="UTC")
        >>> measured = Measurements.from_table(pd.DataFrame({"T": [20.0, 21.0, 23.0]}, index=index))
        >>> measured.at("T", index[:2] + pd.Timedelta("30min")).tolist()
        [20.5, 22.0]
        """
        values = self.series(name).to_numpy(dtype=np.float64)
        seconds = epoch_seconds(times)
        if self.kinds[name] == "instant":
            return _instants(self.grid, values, self.record.closing[name], seconds)
        return _means(self.grid, values, seconds, step_seconds or self.grid.interval)

    def fill_gaps(self, longest: str | float, columns: Iterable[str] | None = None) -> Measurements:
        """Fill short gaps linearly.

        Parameters
        ----------
        longest : str or float
            Longest gap to fill, such as `2h`, or seconds. [s]
        columns : iterable of str, optional
            Default: all.

        Returns
        -------
        Measurements
            New series, whose provenance lists what was filled.

        Raises
        ------
        InputError
            There is no such column, or no length can be read.
        """
        return Measurements(filled(self.record, longest, columns, hold_end=False))

    def masked(self, mask: pd.DataFrame) -> Measurements:
        """The same series with NaN where a mask is True.

        Parameters
        ----------
        mask : pandas.DataFrame
            True for values to leave out, such as from `mascarin.tables.quality.mask`; rows and columns that
            it does not have are kept.

        Returns
        -------
        Measurements
            New series, whose provenance states how many values were masked.
        """
        aligned = mask.reindex(index=self.data.index, columns=self.data.columns, fill_value=False).astype(
            bool
        )
        columns = {
            name: np.where(aligned[name].to_numpy(), np.nan, values)
            for name, values in self.record.columns.items()
        }
        counts = aligned.sum()
        parts = [f"{name} {int(count)}" for name, count in counts.items() if count]
        note = f"{self.file}: values masked on request: {', '.join(parts) if parts else 'none'}."
        return Measurements(replace(self.record, columns=columns, provenance=(*self.provenance, note)))


def _instants(grid: Grid, values: Array, closing: float, seconds: Array) -> Array:
    knots = np.append(values, closing)
    position = (seconds - grid.start) / grid.interval
    nearest = np.round(position)
    position = np.where(np.abs(position - nearest) < 1e-6, nearest, position)
    inside = (position >= 0.0) & (position <= grid.count)
    before = np.clip(np.floor(position).astype(np.int64), 0, grid.count)
    after = np.minimum(before + 1, grid.count)
    weight = position - before
    # At a stamp the next value has no weight; it may be missing.
    mixed = (1.0 - weight) * knots[before] + np.where(weight > 0.0, weight * knots[after], 0.0)
    return np.asarray(np.where(inside, mixed, np.nan))


def _means(grid: Grid, values: Array, seconds: Array, length: float) -> Array:
    """Means over [t, t + length] of a function that is constant in each interval."""
    missing = np.isnan(values)
    integral = np.concatenate([[0.0], np.cumsum(np.where(missing, 0.0, values))])
    absent = np.concatenate([[0.0], np.cumsum(missing.astype(np.float64))])
    knots = np.arange(grid.count + 1.0)
    low, high = ((seconds + shift - grid.start) / grid.interval for shift in (0.0, length))
    inside = (low >= -1e-6) & (high <= grid.count + 1e-6)
    total = np.interp(high, knots, integral) - np.interp(low, knots, integral)
    gone = np.interp(high, knots, absent) - np.interp(low, knots, absent)
    return np.asarray(np.where(inside & (gone < 1e-6), total * grid.interval / length, np.nan))

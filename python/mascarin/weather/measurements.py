"""Measured series: what a model is compared with, and what drives its measured boundaries."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, cast

import numpy as np

from mascarin.errors import InputError, did_you_mean
from mascarin.weather.arrays import Array, Lines
from mascarin.weather.channels import Kind
from mascarin.weather.grid import Grid, frame_of
from mascarin.weather.table import Column, Stamps, epoch_seconds, read_table
from mascarin.weather.timezones import zone_name

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.weather.quality import Stretch


@dataclass(frozen=True, eq=False)
class Measurements:
    """Measured columns on a regular grid.

    Attributes
    ----------
    data : pandas.DataFrame
        One row for each interval, labelled by its start in the table's time zone; NaN where missing. An
        `instant` column holds the value at the label, a `mean` column the mean over the interval.
    kinds : mapping of str to str
        `instant` or `mean` for each column.
    grid : Grid
        The intervals.
    closing : mapping of str to float
        Values of the instant columns at the end of the record.
    file : str
        File name, or `table`.
    sha256 : str or None
        Hash of the file.
    provenance : tuple of str
        What was read and converted, as sentences.
    lines : ndarray
        Line of each row in the file; 0 where the row was missing.
    knots : ndarray, optional
        Line of the instants at the start of each interval and at the end of the last; without it that of
        the row, shape (n + 1,).
    """

    data: pd.DataFrame
    kinds: Mapping[str, Kind]
    grid: Grid
    closing: Mapping[str, float]
    file: str
    sha256: str | None
    provenance: tuple[str, ...]
    lines: Lines
    knots: Lines | None = None

    @property
    def of_year(self) -> bool:
        """Never a weather file of a year; a climate may be one."""
        return False

    @classmethod
    def from_table(
        cls,
        source: str | Path | pd.DataFrame,
        *,
        timezone: str | None = None,
        columns: Iterable[str] | Mapping[str, str | Column | Mapping[str, object]] | None = None,
        mean: Iterable[str] = (),
        stamps: Stamps = "start",
        step: str | float | None = None,
        time: str | Sequence[str] | None = None,
        time_format: str | None = None,
        separator: str | None = None,
        decimal: str = ".",
        skip_lines: int = 0,
        missing: Sequence[str | float] = (),
    ) -> Measurements:
        """Read a table of measurements.

        Parameters
        ----------
        source : path or pandas.DataFrame
            CSV or Parquet file, or a frame with a time index or column.
        timezone : str
            IANA name or fixed offset (`UTC+4`) of the stamps. Required.
        columns : iterable or mapping, optional
            Columns to read, or name -> column or `{column, unit, scale, offset, kind}`. Default: all.
        mean : iterable of str
            Columns that are means over their interval; the others are values at the stamp.
        stamps : str
            `start` or `end`: which end of its interval a stamp marks.
        step, time, time_format, separator, decimal, skip_lines, missing
            As in `read_table`.

        Returns
        -------
        Measurements
            The series.

        Raises
        ------
        InputError
            A column or the time zone is missing, an entry or a time cannot be used.
        """
        from mascarin.weather.measured import knot_lines, to_starts

        table = read_table(
            source, timezone=timezone, time=time, time_format=time_format, separator=separator,
            decimal=decimal, skip_lines=skip_lines, step=step, missing=missing,
        )  # fmt: skip
        wanted: Iterable[str] | Mapping[str, str | Column | Mapping[str, object]]
        wanted = [str(name) for name in table.frame.columns] if columns is None else columns
        pairs = wanted.items() if isinstance(wanted, Mapping) else [(name, name) for name in wanted]
        chosen = {name: Column.of(given, f"{table.where}: columns.{name}") for name, given in pairs}
        kinds: dict[str, Kind] = {name: column.kind or "instant" for name, column in chosen.items()}
        for name in mean:
            if name not in kinds:
                raise InputError(
                    f"{table.where}: mean: {name!r} is not read. {did_you_mean(name, kinds)}".rstrip()
                )
            kinds[name] = "mean"
        values, notes = {}, []
        for name, column in chosen.items():
            raw = table.numbers(column.column, name)
            values[name] = column.convert(raw, "", table.interval, f"{table.where}: {name}")
            notes.append(column.sentence(name, ""))
        data, closing, grid, note = to_starts(table, values, kinds, stamps)
        said = (*table.notes, note, *(f"{table.where}: {text}" for text in notes if text))
        return cls(
            frame_of(data, grid), kinds, grid, closing, table.where, table.sha256, said, table.lines,
            knot_lines(table.lines, stamps),
        )  # fmt: skip

    @property
    def index(self) -> pd.DatetimeIndex:
        """Starts of the intervals, with the time zone."""
        return cast("pd.DatetimeIndex", self.data.index)

    @property
    def timezone(self) -> str:
        """Time zone of the labels."""
        return zone_name(self.grid.zone)

    @property
    def step_seconds(self) -> float:
        """Length of an interval [s]."""
        return self.grid.interval

    def quality(self, limits: Mapping[str, tuple[float, float]] | None = None) -> list[Stretch]:
        """Suspicious stretches of every column; see `quality.find`."""
        from mascarin.weather.quality import find

        return find(self.data, self.kinds, limits=limits)

    def series(self, name: str) -> pd.Series[float]:
        """One column.

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
        """
        values = self.series(name).to_numpy(dtype=np.float64)
        seconds = epoch_seconds(times)
        if self.kinds[name] == "instant":
            return _instants(self.grid, values, self.closing[name], seconds)
        return _means(self.grid, values, seconds, step_seconds or self.grid.interval)

    def masked(self, mask: pd.DataFrame) -> Measurements:
        """The same series with NaN where the mask is True; the provenance says how many values were masked.

        Parameters
        ----------
        mask : pandas.DataFrame
            From `quality.mask`.
        """
        from dataclasses import replace

        aligned = mask.reindex(index=self.data.index, columns=self.data.columns, fill_value=False).astype(
            bool
        )
        counts = aligned.sum()
        parts = [f"{name} {int(count)}" for name, count in counts.items() if count]
        note = f"{self.file}: values masked on request: {', '.join(parts) if parts else 'none'}."
        return replace(self, data=self.data.mask(aligned), provenance=(*self.provenance, note))


def _instants(grid: Grid, values: Array, closing: float, seconds: Array) -> Array:
    knots = np.append(values, closing)
    place = (seconds - grid.start) / grid.interval
    near = np.round(place)
    place = np.where(np.abs(place - near) < 1e-6, near, place)
    inside = (place >= 0.0) & (place <= grid.count)
    left = np.clip(np.floor(place).astype(np.int64), 0, grid.count)
    right = np.minimum(left + 1, grid.count)
    weight = place - left
    # At a stamp the neighbour does not count, not even where it is missing.
    mixed = (1.0 - weight) * knots[left] + np.where(weight > 0.0, weight * knots[right], 0.0)
    return np.asarray(np.where(inside, mixed, np.nan))


def _means(grid: Grid, values: Array, seconds: Array, length: float) -> Array:
    """Means over [t, t + length] of a function that is constant in each interval."""
    missing = np.isnan(values)
    integral = np.concatenate([[0.0], np.cumsum(np.where(missing, 0.0, values))])
    absent = np.concatenate([[0.0], np.cumsum(missing.astype(np.float64))])
    place = np.arange(grid.count + 1.0)
    low, high = ((seconds + shift - grid.start) / grid.interval for shift in (0.0, length))
    inside = (low >= -1e-6) & (high <= grid.count + 1e-6)
    total = np.interp(high, place, integral) - np.interp(low, place, integral)
    lost = np.interp(high, place, absent) - np.interp(low, place, absent)
    return np.asarray(np.where(inside & (lost < 1e-6), total * grid.interval / length, np.nan))

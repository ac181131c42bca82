"""Columns on a regular grid of times, with what is known about their origin."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from mascarin.weather.arrays import Array, Lines
from mascarin.weather.channels import RADIATION, Basis, Kind
from mascarin.weather.grid import Grid, frame_of
from mascarin.weather.site import Place

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, eq=False)
class Record:
    """Columns on a regular grid of times; never changed after it was made.

    Attributes
    ----------
    columns : mapping of str to ndarray, shape (n,)
        A value for each interval; NaN where missing. An `instant` column holds the value at its start, a
        `mean` column the mean over it.
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
        What was read, converted, derived and assumed, as sentences.
    lines : ndarray, shape (n,)
        Line of each row in the file; 0 where the row was missing.
    knots : ndarray, shape (n + 1,), optional
        Line of the instants at the start of each interval and at the end of the last; without it, the line
        of the row.
    of_year : bool
        Read from a weather file of a year, whose clock is the one of its place.
    """

    columns: Mapping[str, Array]
    kinds: Mapping[str, Kind]
    grid: Grid
    closing: Mapping[str, float]
    file: str
    sha256: str | None
    provenance: tuple[str, ...]
    lines: Lines
    knots: Lines | None = None
    of_year: bool = False

    @cached_property
    def data(self) -> pd.DataFrame:
        """The columns as a frame, labelled by the start of each interval in the time zone of the grid.

        It is made when it is first asked for: a run needs the columns alone, and no pandas.
        """
        return frame_of(self.columns, self.grid)

    def __getstate__(self) -> dict[str, Any]:
        """What is sent to another process: the frame is made again there."""
        return {name: value for name, value in vars(self).items() if name != "data"}

    def line(self, name: str, row: int) -> int:
        """Line of the file that holds a value; 0 where the row was missing.

        Parameters
        ----------
        name : str
            Column.
        row : int
            Interval; for an instant column, the number of intervals means the end of the record.
        """
        lines = self.lines if self.kinds[name] == "mean" or self.knots is None else self.knots
        return int(lines[row]) if row < len(lines) else 0


@dataclass(frozen=True, eq=False)
class WeatherRecord(Record):
    """A record of the weather.

    Attributes
    ----------
    site : Place or None
        Where the weather was measured, if known.
    check_sun : bool
        Refuse radiation that does not follow the sun.
    elsewhere : bool
        May be used for a building at another place than where it was measured.
    basis : str or None
        The two irradiances from which a third was derived; None before anything was derived.
    assumed : frozenset of str
        Channels that were not measured, for which a value is assumed or was stated.
    """

    site: Place | None = None
    check_sun: bool = True
    elsewhere: bool = False
    basis: Basis | None = None
    assumed: frozenset[str] = frozenset()

    def measured(self, name: str) -> bool:
        """Whether a channel of a measured table was measured; a weather file of a year fills it somehow."""
        return name in self.columns and name not in self.assumed and not self.of_year

    @property
    def radiation_basis(self) -> Basis:
        """The irradiances whose means are kept; one that is not given follows from two and the sun."""
        if self.basis is not None:
            return self.basis
        if all(name in self.columns for name in RADIATION):
            return "all"
        return "direct+diffuse" if "direct_normal" in self.columns else "global+diffuse"

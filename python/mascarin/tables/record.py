"""Columns on a regular grid of times, with what is known about their origin."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from mascarin.tables.arrays import Array, Lines
from mascarin.tables.grid import Grid, frame_of

if TYPE_CHECKING:
    import pandas as pd


Kind = Literal["instant", "mean"]
"""`instant`: the value at the stamp; `mean`: the mean over the interval that the stamp starts."""


@dataclass(frozen=True)
class Origin:
    """Where the values of a column come from.

    Attributes
    ----------
    unit : str
        Unit that the file states and into which the values were not converted; empty where there is none.
    stated : bool
        Whether the file or the user states the unit.
    line : str
        Name, unit in the file, conversion, range and missing values.
    of_interval : bool
        Whether the file has sums over intervals, which became means.
    """

    unit: str
    stated: bool
    line: str
    of_interval: bool = False


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
    origins : mapping of str to Origin
        Where columns of a table come from.
    """

    name_sets: ClassVar[tuple[str, ...]] = ()
    """Further attributes, sets of names, that the cache keeps with a record."""

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
    origins: Mapping[str, Origin] = field(default_factory=dict)

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

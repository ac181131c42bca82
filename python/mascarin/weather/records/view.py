"""Base of climates and measurements: columns on a regular grid of times."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final, Generic, TypeVar, cast

import numpy as np

from mascarin._io import display
from mascarin._io.arguments import require_type
from mascarin._io.units import bracketed, shown
from mascarin.errors import InputError, did_you_mean
from mascarin.tables.grid import Grid
from mascarin.tables.record import Kind, Record
from mascarin.tables.timezones import zone_name
from mascarin.weather.records.channels import UNITS

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SMALL: Final = (6.0, 1.8)  # inches
_MOST_FIGURES: Final = 4
_MOST_CURVES: Final = 6

R = TypeVar("R", bound=Record)


class RecordView(Generic[R]):
    """Base of `Climate` and `Measurements`: a record with its columns, times and origin.

    Parameters
    ----------
    record : Record
        The columns with their origin.
    """

    def __init__(self, record: R) -> None:
        self._record = record

    @property
    def record(self) -> R:
        """How the columns are stored, for the other packages of Mascarin."""
        return self._record

    @property
    def data(self) -> pd.DataFrame:
        """The columns; not to be changed (`to_dataframe` gives a copy)."""
        return self._record.data

    @property
    def kinds(self) -> Mapping[str, Kind]:
        """Kind of each column: `instant` (value at the stamp) or `mean` (of the interval after it)."""
        return self._record.kinds

    @property
    def grid(self) -> Grid:
        """The intervals: start, length, number and time zone."""
        return self._record.grid

    @property
    def index(self) -> pd.DatetimeIndex:
        """Starts of the intervals, in local time with its offset."""
        return cast("pd.DatetimeIndex", self._record.data.index)

    @property
    def timezone(self) -> str:
        """Name of the time zone, such as ``Europe/Paris`` or ``UTC+4``."""
        return zone_name(self._record.grid.zone)

    @property
    def step_seconds(self) -> float:
        """Length of an interval. [s]"""
        return self._record.grid.interval

    @property
    def file(self) -> str:
        """Name of the file, or `table`."""
        return self._record.file

    @property
    def sha256(self) -> str | None:
        """SHA-256 of the file, in hexadecimal; None for data that do not come from a file."""
        return self._record.sha256

    @property
    def provenance(self) -> tuple[str, ...]:
        """What was read, converted, derived and assumed, as sentences."""
        return self._record.provenance

    def to_dataframe(self) -> pd.DataFrame:
        """Copy of the columns as a pandas frame.

        Returns
        -------
        pandas.DataFrame
            One row for each interval, labeled by its start in local time with its offset. A `mean` column
            holds the mean over the interval, an `instant` column the value at its start (see `kinds`).
        """
        return self._record.data.copy()

    def plot(self, names: str | Sequence[str] | None = None, ax: Axes | None = None) -> Axes:
        """Plot columns over local time.

        Parameters
        ----------
        names : str or sequence of str, optional
            Columns of one unit. Default: those with the unit of the first column.
        ax : matplotlib.axes.Axes, optional
            Where to draw; default a new figure.

        Returns
        -------
        matplotlib.axes.Axes
            Where it was drawn.

        Raises
        ------
        InputError
            A column is unknown, or the columns have different units.
        """
        if names is None:
            columns = [str(name) for name in self.data.columns]
            unit = UNITS.get(columns[0], "")
            names = [name for name in columns if UNITS.get(name, "") == unit]
        chosen = [names] if isinstance(names, str) else list(names)
        unit = self._common_unit(chosen)
        import matplotlib.pyplot as plt
        from matplotlib.axes import Axes

        if ax is not None:
            require_type("ax", ax, Axes, "axes of matplotlib")
        ax = plt.subplots(layout="constrained")[1] if ax is None else ax
        self._draw(ax, chosen, unit)
        return ax

    def _common_unit(self, names: Sequence[str]) -> str:
        """The unit of columns; raises if one is unknown or their units differ."""
        columns = [str(name) for name in self.data.columns]
        for name in names:
            if name not in columns:
                raise InputError(
                    f"{self.file}: no column {name!r} to plot. {did_you_mean(name, columns)}".rstrip()
                )
        units = {UNITS.get(name, "") for name in names}
        if len(units) > 1:
            listing = ", ".join(f"{name} [{UNITS.get(name, '')}]" for name in names)
            raise InputError(
                f"{self.file}: found columns of several units to plot ({listing}), expected one unit; call "
                "plot once for each unit, with an ax for each."
            )
        return next(iter(units), "")

    def _draw(self, ax: Axes, names: Sequence[str], unit: str) -> None:
        """Draw columns of one unit; a mean holds until the end of its interval."""
        from mascarin.figures.series import SeriesCurve, columns  # matplotlib

        record = self._record
        curves = []
        for name in names:
            values = record.columns[name]
            mean = record.kinds[name] == "mean"
            last = values[-1:] if mean else [record.closing.get(name, np.nan)]
            curves.append(SeriesCurve(name, np.append(values, last), mean))
        grid = record.grid
        edges = (grid.start + grid.interval * np.arange(grid.count + 1)).astype("datetime64[s]")
        columns(ax, edges, curves, unit, grid.zone, zone_name(grid.zone))

    def _small_figures(self) -> dict[str, Figure]:
        """Small figures for a notebook, by heading: one for each unit, at most four."""
        from matplotlib.figure import Figure

        groups: dict[str, list[str]] = {}
        for name in self.data.columns:
            groups.setdefault(UNITS.get(str(name), ""), []).append(str(name))
        figures = {}
        for unit, names in list(groups.items())[:_MOST_FIGURES]:
            figure = Figure(figsize=_SMALL, layout="constrained")
            self._draw(figure.add_subplot(), names[:_MOST_CURVES], unit)
            figures[bracketed(", ".join(names[:_MOST_CURVES]), shown(unit))] = figure
        return figures

    def __repr__(self) -> str:
        return display.text(self._title(), self._rows())

    def _repr_html_(self) -> str:
        return display.page(
            self._title(),
            self._rows(),
            tables={"Columns": self._summary(), "First rows": self.data.head(5)},
            figures=self._small_figures(),
        )

    def _title(self) -> str:
        return f"{type(self).__name__} of {self.file!r}"

    def _rows(self) -> list[tuple[str, str]]:
        """Content of the short description."""
        grid = self._record.grid
        missing = int(self.data.isna().to_numpy().sum())
        return [
            ("period", "any year" if grid.periodic else grid.span()),
            ("step", f"{grid.interval:g} s, {grid.count} rows"),
            ("time zone", self.timezone),
            *((str(name), self._column(str(name))) for name in list(self.data.columns)[:8]),
            *([("more columns", str(len(self.data.columns) - 8))] if len(self.data.columns) > 8 else []),
            ("missing values", str(missing)),
        ]

    def _column(self, name: str) -> str:
        low, high = self.data[name].min(), self.data[name].max()
        unit = UNITS.get(name, "")
        return f"{low:.4g} .. {high:.4g}{' ' if unit else ''}{unit}, {self.kinds[name]}"

    def _summary(self) -> pd.DataFrame:
        """Unit, kind and statistics of every column."""
        import pandas as pd

        data = self.data
        return pd.DataFrame(
            {
                "unit": [UNITS.get(str(name), "") for name in data.columns],
                "kind": [self.kinds[str(name)] for name in data.columns],
                "min": data.min(),
                "mean": data.mean(),
                "max": data.max(),
                "missing": data.isna().sum(),
            }
        )

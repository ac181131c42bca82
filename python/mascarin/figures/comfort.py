"""Figures of comfort: carpet of days and hours, daily profiles, and an index with its limits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
from matplotlib import dates
from matplotlib.colors import Normalize, TwoSlopeNorm

from mascarin._io.units import bracketed, shown
from mascarin.figures import colors

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ComfortSeries:
    """Values over local time.

    Attributes
    ----------
    times : pandas.DatetimeIndex, shape (n,)
        Local times.
    numbers : ndarray, shape (n,)
        Values; NaN is left white or out. [unit]
    label, unit : str
        Name and plain unit of the values.

    Examples
    --------
    >>> import pandas as pd
    >>> ComfortSeries(pd.date_range("2001-07-01", periods=1, tz="UTC"), np.array([20.0]), "room", "degC").unit
    'degC'
    """

    times: pd.DatetimeIndex
    numbers: Array
    label: str
    unit: str


def carpet(ax: Axes, series: ComfortSeries, *, centre: float | None = None) -> None:
    """Draw values as colors: days across, hours of the day upwards. Times without a value stay gray.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where to draw.
    series : ComfortSeries
        Values; several in one cell are averaged.
    centre : float, optional
        Value between the blue and the red colors; default: colors from the lowest to the highest value.

    Examples
    --------
    >>> import pandas as pd
    >>> from matplotlib.figure import Figure
    >>> index = pd.date_range("2001-07-01", periods=48, freq="1h", tz="UTC")
    >>> ax = Figure().subplots()
    >>> carpet(ax, ComfortSeries(index, np.arange(48.0), "air", "degC"))
    >>> ax.get_ylabel()
    'hour of the day'
    """
    cells, first, rows = grid(series)
    days = dates.date2num(first)  # type: ignore[no-untyped-call]
    finite = cells[np.isfinite(cells)]
    norm: Normalize | None = None
    if centre is not None and len(finite):
        reach = max(float(np.max(np.abs(finite - centre))), 1e-9)
        norm = TwoSlopeNorm(vmin=centre - reach, vcenter=centre, vmax=centre + reach)
    ax.set_facecolor(colors.REMAINDER)
    edges = days + np.arange(cells.shape[1] + 1)
    hours = np.linspace(0.0, 24.0, rows + 1)
    colored = "viridis" if centre is None else "RdBu_r"
    mesh = ax.pcolormesh(edges, hours, cells, cmap=colored, norm=norm, rasterized=True)
    ax.set_yticks([0, 6, 12, 18, 24])
    ax.set_ylabel("hour of the day")
    _dates(ax)
    figure = ax.get_figure(root=True)
    if figure is not None:
        figure.colorbar(mesh, ax=ax, label=bracketed(series.label, shown(series.unit)))


def grid(series: ComfortSeries) -> tuple[Array, np.datetime64, int]:
    """Values in cells of days and hours.

    Parameters
    ----------
    series : ComfortSeries
        Values.

    Returns
    -------
    cells : ndarray, shape (rows, days)
        Mean of the values of each cell; NaN where there is none. [unit]
    first : datetime64
        First day.
    rows : int
        Cells of a day, at most 96.

    Examples
    --------
    >>> import pandas as pd
    >>> index = pd.date_range("2001-07-01", periods=48, freq="1h", tz="UTC")
    >>> cells, first, rows = grid(ComfortSeries(index, np.arange(48.0), "air", "degC"))
    >>> cells.shape, float(cells[3, 1])
    ((24, 2), 27.0)
    """
    local = series.times.tz_localize(None).to_numpy()
    day = local.astype("datetime64[D]")
    minutes = (local - day) / np.timedelta64(1, "m")
    step = np.median(np.diff(local) / np.timedelta64(1, "m")) if len(local) > 1 else 60.0
    rows = int(np.clip(round(1440.0 / step), 1, 96))
    column = (day - day[0]).astype(np.int64)
    cell = column * rows + (minutes * rows / 1440.0).astype(np.int64)
    finite = np.isfinite(series.numbers)
    size = rows * (int(column[-1]) + 1)
    total = np.bincount(cell[finite], weights=series.numbers[finite], minlength=size)
    count = np.bincount(cell[finite], minlength=size)
    with np.errstate(invalid="ignore"):
        cells = np.where(count > 0, total / np.maximum(count, 1), np.nan)
    return cells.reshape(-1, rows).T, day[0], rows


def with_limits(
    ax: Axes, series: ComfortSeries, low: Array | float | None, high: Array | float | None
) -> None:
    """Draw an index over time between its limits of comfort.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where to draw.
    series : ComfortSeries
        The index.
    low, high : ndarray or float or None
        Limits; one that is infinite or None is left out. [unit]

    Examples
    --------
    >>> import pandas as pd
    >>> from matplotlib.figure import Figure
    >>> index = pd.date_range("2001-07-01", periods=48, freq="1h", tz="UTC")
    >>> ax = Figure().subplots()
    >>> with_limits(ax, ComfortSeries(index, np.arange(48.0), "operative temperature", "degC"), 20.0, 26.0)
    >>> ax.get_ylabel()
    'operative temperature [°C]'
    """
    days = _numbers(series.times)
    ax.plot(days, series.numbers, color=colors.PALETTE[0], lw=1.0, label=series.label)
    for limit, label, color in ((high, "upper limit", 1), (low, "lower limit", 2)):
        line = np.broadcast_to(np.asarray(np.nan if limit is None else limit, dtype=np.float64), days.shape)
        if np.isfinite(line).any() and np.nanmin(line) > -200.0:
            ax.plot(days, line, color=colors.PALETTE[color], lw=1.0, ls="--", label=label)
    ax.set_ylabel(bracketed(series.label, shown(series.unit)))
    ax.grid(alpha=0.3)
    ax.legend(fontsize="small")
    _dates(ax)


def daily_profile(ax: Axes, series: ComfortSeries, months: Sequence[int] = ()) -> None:
    """Draw the mean of each hour of the day, and the range of nine days in ten, for each month.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where to draw.
    series : ComfortSeries
        Values.
    months : sequence of int
        Months to draw, 1 to 12; default: the month of the lowest and that of the highest mean.

    Examples
    --------
    >>> import pandas as pd
    >>> from matplotlib.figure import Figure
    >>> index = pd.date_range("2001-07-01", periods=48, freq="1h", tz="UTC")
    >>> ax = Figure().subplots()
    >>> daily_profile(ax, ComfortSeries(index, np.arange(48.0), "air", "degC"))
    >>> len(ax.lines)
    1
    """
    import pandas as pd

    finite = np.isfinite(series.numbers)
    month_of = np.asarray(series.times.month)[finite]
    hours, numbers = np.asarray(series.times.hour)[finite], series.numbers[finite]
    means = {int(month): float(numbers[month_of == month].mean()) for month in np.unique(month_of)}
    chosen = list(months)
    if means and not chosen:
        chosen = sorted({min(means, key=means.__getitem__), max(means, key=means.__getitem__)})
    for number, month in enumerate(chosen_month for chosen_month in chosen if chosen_month in means):
        by_hour = pd.Series(numbers[month_of == month]).groupby(hours[month_of == month])
        color = colors.PALETTE[number % len(colors.PALETTE)]
        middle, low, high = by_hour.mean(), by_hour.quantile(0.05), by_hour.quantile(0.95)
        middle_hours = middle.index.to_numpy(dtype=np.float64) + 0.5
        ax.plot(middle_hours, middle, color=color, label=_MONTHS[month - 1])
        ax.fill_between(middle_hours, low, high, color=color, alpha=0.18, lw=0)
    ax.set_xlim(0, 24)
    ax.set_xticks([0, 6, 12, 18, 24])
    ax.set_xlabel("hour of the day")
    ax.set_ylabel(bracketed(series.label, shown(series.unit)))
    ax.grid(alpha=0.3)
    if ax.lines:
        ax.legend(fontsize="small", title="mean, and 9 days in 10")


_MONTHS = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")


def _numbers(index: pd.DatetimeIndex) -> Array:
    local = index.tz_localize(None).to_numpy()
    return np.asarray(dates.date2num(local), dtype=np.float64)  # type: ignore[no-untyped-call]


def _dates(ax: Axes) -> None:
    locator = dates.AutoDateLocator()  # type: ignore[no-untyped-call]
    ax.xaxis.set_major_locator(locator)
    ax.xaxis.set_major_formatter(dates.ConciseDateFormatter(locator))  # type: ignore[no-untyped-call]

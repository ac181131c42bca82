"""Figures of series over local time, on axes for each unit."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import tzinfo
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt
from matplotlib import dates
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mascarin._io.arguments import require_type
from mascarin._io.units import bracketed, shown
from mascarin.errors import InputError
from mascarin.figures import colors
from mascarin.figures.shown import new_figure

if TYPE_CHECKING:
    import pandas as pd

Array = npt.NDArray[np.float64]


class SeriesCurve(NamedTuple):
    """A column of a table.

    Parameters
    ----------
    name : str
        Name in the legend.
    values : ndarray, shape (rows + 1,)
        At the starts of the intervals and at the end of the last one. [unit]
    mean : bool
        Whether they are means of the intervals, drawn as steps.

    Examples
    --------
    >>> import numpy as np
    >>> SeriesCurve("wind", np.array([3.0, 4.0]), mean=True).name
    'wind'
    """

    name: str
    values: Array
    mean: bool


def draw(
    series: Sequence[tuple[str, str, Array]], index: pd.DatetimeIndex, ax: Axes | Sequence[Axes] | None
) -> Figure:
    """Draw series over local time.

    Parameters
    ----------
    series : sequence of (str, str, ndarray)
        Name, unit and values of each series, shape (rows,). [its unit]
    index : pandas.DatetimeIndex, shape (rows,)
        Local times with their zone.
    ax : matplotlib.axes.Axes or sequence of them, or None
        One for each unit, or one for all; None makes a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The figure of the axes.

    Raises
    ------
    InputError
        Another number of axes.

    Examples
    --------
    >>> import numpy as np
    >>> import pandas as pd
    >>> index = pd.date_range("2001-07-01", periods=3, freq="1h", tz="UTC")
    >>> draw([("room", "degC", np.array([20.0, 21.0, 20.5]))], index, None).axes[0].get_xlabel()
    'local time (UTC)'
    """
    if not series:
        raise InputError("names: found none, expected at least one series to draw")
    units = list(dict.fromkeys(unit for _, unit, _ in series))
    axes = axes_for(ax, units)
    # Times in UTC with local labels: a line does not go back where daylight saving time ends.
    days = dates.date2num(index.tz_convert("UTC").tz_localize(None).to_numpy())  # type: ignore[no-untyped-call]
    for name, unit, values in series:
        axis = axes[units.index(unit)]
        look = colors.look(len(axis.lines))
        axis.plot(days, values, label=name, lw=1.1, color=look.color, linestyle=look.dash)
    for axis in dict.fromkeys(axes):
        axis_units = [unit for unit, other in zip(units, axes, strict=True) if other is axis]
        axis.set_ylabel(", ".join(bracketed("", shown(unit) or "-") for unit in axis_units))
        axis.legend(fontsize="small")
        axis.grid(alpha=0.3)
        _mark_dates(axis, index.tz)
    if axes:
        axes[-1].set_xlabel(f"local time ({index.tz})")
    return (axes[0].get_figure(root=True) if axes else None) or Figure()


def columns(
    ax: Axes,
    edges: npt.NDArray[np.datetime64],
    curves: Sequence[SeriesCurve],
    unit: str,
    zone: tzinfo,
    label: str,
) -> None:
    """Draw columns of a table over local time.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where to draw.
    edges : ndarray of datetime64, shape (rows + 1,)
        Starts of the intervals and the end of the last one, in UTC.
    curves : sequence of SeriesCurve
        The columns, all in one unit.
    unit : str
        Their unit.
    zone : datetime.tzinfo
        Zone of the clock.
    label : str
        Its name.

    Examples
    --------
    >>> import numpy as np
    >>> from datetime import UTC
    >>> edges = np.array(["2001-07-01T00:00", "2001-07-01T01:00"], dtype="datetime64[s]")
    >>> ax = Figure().subplots()
    >>> columns(ax, edges, [SeriesCurve("air", np.array([20.0, 21.0]), mean=False)], "degC", UTC, "UTC")
    >>> ax.get_xlabel(), ax.get_ylabel()
    ('local time (UTC)', '[°C]')
    """
    days = dates.date2num(edges)  # type: ignore[no-untyped-call]
    for number, curve in enumerate(curves):
        look = colors.look(number)
        style: dict[str, Any] = {"label": curve.name, "color": look.color, "linestyle": look.dash}
        if curve.mean:
            ax.step(days, curve.values, where="post", **style)
        else:
            ax.plot(days, curve.values, **style)
    _mark_dates(ax, zone)
    ax.set_xlabel(f"local time ({label})")
    ax.set_ylabel(bracketed("", shown(unit)))
    if len(curves) > 1:
        ax.legend()
    else:
        ax.set_title("".join(curve.name for curve in curves))


def _mark_dates(ax: Axes, zone: tzinfo | None) -> None:
    locator = dates.AutoDateLocator(tz=zone)  # type: ignore[no-untyped-call]
    ax.xaxis.set_major_locator(locator)
    ax.xaxis.set_major_formatter(dates.ConciseDateFormatter(locator, tz=zone))  # type: ignore[no-untyped-call]


def axes_for(ax: Axes | Sequence[Axes] | None, units: Sequence[str]) -> list[Axes]:
    """One axes for each unit; the same axes may be used for several units.

    Parameters
    ----------
    ax : matplotlib.axes.Axes or sequence of them, or None
        One for each unit, or one for all; None makes a new figure of pyplot.
    units : sequence of str
        The units.

    Returns
    -------
    list of matplotlib.axes.Axes
        As many as units.

    Raises
    ------
    InputError
        Another number of axes, or something else.

    Examples
    --------
    >>> from matplotlib import pyplot
    >>> len(axes_for(None, ["degC", "W"]))
    2
    >>> pyplot.close("all")
    """
    if ax is None:
        if not units:
            return []
        figure = new_figure(9.0, 2.8 * len(units) + 0.6)
        return list(figure.subplots(len(units), 1, sharex=True, squeeze=False)[:, 0])
    all_axes = [ax] if isinstance(ax, Axes) else list(np.ravel(np.array(ax, dtype=object)))
    for entry in all_axes:
        require_type("ax", entry, Axes, "axes of matplotlib, one or a list")
    if len(all_axes) == 1:
        return all_axes * len(units)
    if len(all_axes) != len(units):
        raise InputError(
            f"ax: found {len(all_axes)} axes, expected one, or one for each unit ({', '.join(units)})"
        )
    return all_axes

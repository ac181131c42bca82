"""The psychrometric chart: temperature across, vapour upwards, with lines of relative humidity and zones."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from mascarin import _engine
from mascarin.figures import colors

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = npt.NDArray[np.float64]

_LINES: Final = (20, 40, 60, 80, 100)  # %


def chart(
    ax: Axes,
    temperature: Array,
    ratio: Array,
    saturated: Array,
    *,
    zones: Mapping[str, Array] | None = None,
    top: float = 30.0,
    label: str = "hours",
) -> None:
    """Draw hours on a psychrometric chart, darker where there are more of them.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where to draw.
    temperature : ndarray, shape (n,)
        Temperature of the air; each value counts as one. [degC]
    ratio : ndarray, shape (n,)
        Humidity ratio. [kg/kg]
    saturated : ndarray, shape (m, 2)
        Temperature [degC] and humidity ratio [kg/kg] of saturated air, from the coldest to the warmest
        temperature of the chart.
    zones : mapping of str to ndarray, shape (corners, 2)
        Name -> corners of a zone: temperature [degC] and humidity ratio [kg/kg].
    top : float
        Upper end of the chart. [g/kg]
    label : str
        What the colors count.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> ax = Figure().subplots()
    >>> saturated = np.array([[0.0, 0.004], [30.0, 0.027]])
    >>> chart(ax, np.array([25.0]), np.array([0.01]), saturated)
    >>> ax.get_xlabel()
    'temperature of the air [°C]'
    """
    from matplotlib.colors import LogNorm
    from matplotlib.patches import Polygon

    known = np.isfinite(temperature) & np.isfinite(ratio)
    grams = 1000.0 * ratio[known]
    if len(grams):
        bins = (np.arange(saturated[0, 0], saturated[-1, 0] + 0.5, 0.5), np.arange(0.0, top + 0.5, 0.5))
        counts, x, y = np.histogram2d(temperature[known], grams, bins=bins)
        shown = np.where(counts > 0, counts, np.nan).T
        mesh = ax.pcolormesh(x, y, shown, cmap="YlGnBu", norm=LogNorm(vmin=0.7), rasterized=True)
        figure = ax.get_figure(root=True)
        if figure is not None:
            figure.colorbar(mesh, ax=ax, label=label)
    for percent in _LINES:
        # The vapour pressure, over that of the air, is a share of the saturated one.
        ones = np.ones(len(saturated))
        vapour = _engine.vapour_pressure(np.ascontiguousarray(saturated[:, 1]), ones)
        line = 1000.0 * _engine.humidity_ratio(percent / 100.0 * vapour, ones)
        ax.plot(saturated[:, 0], line, color=colors.INK, lw=1.0 if percent == 100 else 0.5, alpha=0.7)
        at = int(np.flatnonzero(line <= 0.94 * top)[-1])
        at = min(at, int(0.97 * len(line)))
        ax.annotate(f"{percent} %", (saturated[at, 0], line[at]), fontsize="x-small", ha="right", va="bottom")
    for number, (name, corners) in enumerate((zones or {}).items()):
        color = colors.PALETTE[(number + 1) % len(colors.PALETTE)]
        points = np.column_stack([corners[:, 0], 1000.0 * corners[:, 1]])
        ax.add_patch(Polygon(points.tolist(), closed=True, fill=False, ec=color, lw=1.6, label=name))
    if zones:
        ax.legend(loc="upper left", fontsize="small")
    ax.set_xlim(float(saturated[0, 0]), float(saturated[-1, 0]))
    ax.set_ylim(0.0, top)
    ax.set_xlabel("temperature of the air [°C]")
    ax.set_ylabel("humidity ratio [g/kg]")

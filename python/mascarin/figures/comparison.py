"""Figures of a comparison: measured and simulated series, and their difference."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]

MEASURED: Final = "#2b2f35"
FITTED: Final = "#0067a8"
NOMINAL: Final = "#b85400"
GRAY: Final = "#5a6069"
COLORS: Final[Mapping[str, str]] = {"nominal": NOMINAL, "fitted": FITTED}
"""Color of each model; others are gray."""


def series(
    ax: Axes,
    x: Any,
    measured: Floats,
    models: Mapping[str, Floats],
    *,
    uncertainty: float = 0.0,
    interval: Floats | None = None,
    middle: Floats | None = None,
    label: str = "measured",
) -> None:
    """Draw a measured series and the series of models.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where to draw.
    x : array_like, shape (n,)
        Times, such as a pandas.DatetimeIndex without time zone.
    measured : ndarray, shape (n,)
        Measured values; NaN where missing. [unit]
    models : mapping of str to ndarray, shape (n,)
        Simulated values by model. [unit]
    uncertainty : float
        Expanded uncertainty of the sensor, drawn as a band around the measured values. [unit]
    interval : ndarray, shape (n,), optional
        Half-width of the prediction interval. [unit]
    middle : ndarray, shape (n,), optional
        Its middle; the last model when absent. [unit]
    label : str
        Name of the measured series.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> ax = Figure().subplots()
    >>> series(ax, np.arange(3), np.ones(3), {"fitted": np.zeros(3)}, uncertainty=0.5)
    >>> [line.get_label() for line in ax.lines]
    ['measured', 'fitted']
    """
    if uncertainty > 0.0:
        ax.fill_between(
            x, measured - uncertainty, measured + uncertainty, color=GRAY, alpha=0.18, lw=0, label="sensor"
        )
    if interval is not None and models:
        last = list(models.values())[-1] if middle is None else middle
        ax.fill_between(x, last - interval, last + interval, color=FITTED, alpha=0.14, lw=0)
    ax.plot(x, measured, linewidth=1.0, color=MEASURED, label=label)
    for name, values in models.items():
        style = "--" if name == "nominal" else "-"
        ax.plot(x, values, linestyle=style, linewidth=1.2, color=COLORS.get(name, GRAY), label=name)
    _grid(ax)


def errors(ax: Axes, x: Any, found: Mapping[str, Floats], *, uncertainty: float = 0.0) -> None:
    """Draw simulated minus measured values of models.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where to draw.
    x : array_like, shape (n,)
        Times.
    found : mapping of str to ndarray, shape (n,)
        Errors by model. [unit]
    uncertainty : float
        Expanded uncertainty of the sensor, drawn as a band around zero. [unit]

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> ax = Figure().subplots()
    >>> errors(ax, np.arange(3), {"fitted": np.array([0.1, -0.1, 0.0])})
    >>> len(ax.lines)
    2
    """
    if uncertainty > 0.0:
        ax.axhspan(-uncertainty, uncertainty, color=GRAY, alpha=0.18, lw=0)
    ax.axhline(0.0, color=GRAY, linewidth=0.8)
    for name, values in found.items():
        ax.plot(x, values, linewidth=1.0, color=COLORS.get(name, GRAY), label=name)
    _grid(ax)


def _grid(ax: Axes) -> None:
    ax.spines[["top", "right", "left"]].set_visible(False)
    ax.spines["bottom"].set_color(GRAY)
    ax.grid(axis="y", color=GRAY, alpha=0.25, linewidth=0.7)
    ax.set_axisbelow(True)
    ax.tick_params(colors=GRAY, length=3)
    ax.tick_params(axis="y", length=0)

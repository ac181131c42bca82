"""Figures of a comparison: observations as points, models as lines, prediction intervals as bands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from mascarin.figures import colors

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

Floats = NDArray[np.float64]

_MAX_CIRCLES: Final = 200
"""Of more observations every k-th is drawn, so that one can see the points."""
_MAX_POINTS: Final = 3000
"""Observations from which all are drawn, as pixels: vectors would make a large file."""
_BAND_OPACITY: Final = 0.2
_MARKER_SIZE: Final = 3.2


@dataclass(frozen=True, eq=False)
class Compared:
    """One sensor over a period, with the series of models.

    Attributes
    ----------
    label : str
        Name of the sensor.
    measured : ndarray, shape (n,)
        NaN where missing. [unit]
    models : dict of str to ndarray, shape (n,)
        Simulated values by model. [unit]
    main : str
        The model whose predictions the band shows.
    half, center : ndarray, shape (n,), optional
        Half-width of the prediction interval, and its middle minus the series of the main model. [unit]
    uncertainty : float
        Expanded uncertainty of the sensor. [unit]

    Examples
    --------
    >>> one = Compared("room", np.array([20.0]), {"fitted": np.array([20.5])}, "fitted")
    >>> float(one.error("fitted")[0])
    0.5
    """

    label: str
    measured: Floats
    models: Mapping[str, Floats]
    main: str
    half: Floats | None = None
    center: Floats | None = None
    uncertainty: float = 0.0

    def error(self, model: str) -> Floats:
        """Simulated minus measured. [unit]

        Parameters
        ----------
        model : str
            Which model.

        Returns
        -------
        ndarray, shape (n,)
            NaN where nothing was measured.
        """
        return np.asarray(self.models[model] - self.measured)

    @property
    def band(self) -> tuple[Floats, Floats] | None:
        """Ends of the interval in which measured values are expected, shape (n,) each. [unit]"""
        if self.half is None:
            return None
        middle = self.models[self.main] + (0.0 if self.center is None else self.center)
        return middle - self.half, middle + self.half

    @property
    def error_band(self) -> tuple[Floats, Floats] | None:
        """Ends of the interval in which the error of the main model is expected. [unit]

        A measured value is inside its interval exactly where the error is inside of this one.
        """
        if self.band is None:
            return None
        low, high = self.band
        return self.models[self.main] - high, self.models[self.main] - low


def series(
    ax: Axes, x: Any, compared: Compared, *, looks: Mapping[str, str] | None = None, label: str = "measured"
) -> None:
    """Draw a measured series as points, the series of models as lines, and the prediction interval.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where to draw.
    x : array_like, shape (n,)
        Times, such as a pandas.DatetimeIndex without time zone.
    compared : Compared
        The sensor.
    looks : mapping of str to str, optional
        Color of each model; default those of `colors.models`.
    label : str
        Name of the measured series.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> ax = Figure().subplots()
    >>> one = Compared("room", np.ones(3), {"fitted": np.zeros(3)}, "fitted", half=np.full(3, 0.5))
    >>> series(ax, np.arange(3), one)
    >>> [line.get_label() for line in ax.lines], len(ax.collections)
    (['measured', 'fitted'], 1)
    """
    color_of = colors.models(compared.models) if looks is None else looks
    if compared.band is not None:
        _band(ax, x, compared.band, color_of[compared.main])
    _points(ax, x, compared.measured, colors.MEASURED, label)
    for name, values in compared.models.items():
        ax.plot(x, values, color=color_of[name], label=name, **_line(name))
    bare(ax)


def errors(ax: Axes, x: Any, compared: Compared, *, looks: Mapping[str, str] | None = None) -> None:
    """Draw simulated minus measured values of models, with the prediction interval.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where to draw.
    x : array_like, shape (n,)
        Times.
    compared : Compared
        The sensor.
    looks : mapping of str to str, optional
        Color of each model; default those of `colors.models`.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> ax = Figure().subplots()
    >>> errors(ax, np.arange(3), Compared("room", np.ones(3), {"fitted": np.zeros(3)}, "fitted"))
    >>> len(ax.lines)
    2
    """
    color_of = colors.models(compared.models) if looks is None else looks
    if compared.error_band is not None:
        _band(ax, x, compared.error_band, color_of[compared.main])
    if compared.uncertainty > 0.0:
        for end in (-compared.uncertainty, compared.uncertainty):
            ax.axhline(end, color=colors.MEASURED, linewidth=0.7, linestyle=(0, (1, 2)))
    ax.axhline(0.0, color=colors.INK, linewidth=0.7)
    for name in compared.models:
        ax.plot(x, compared.error(name), color=color_of[name], label=name, **_line(name))
    bare(ax)


def together(ax: Axes, x: Any, sensors: Sequence[tuple[Compared, colors.Look]]) -> None:
    """Draw several sensors of one unit: measured values as points, those of the main model as lines.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where to draw.
    x : array_like, shape (n,)
        Times.
    sensors : sequence of (Compared, Look)
        The sensors and how each is drawn.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> ax = Figure().subplots()
    >>> one = Compared("room", np.ones(3), {"fitted": np.zeros(3)}, "fitted")
    >>> together(ax, np.arange(3), [(one, colors.look(0))])
    >>> len(ax.lines)
    2
    """
    for compared, look in sensors:
        _points(ax, x, compared.measured, look.color, "_measured")
    for compared, look in sensors:
        line: dict[str, Any] = {"color": look.color, "linestyle": look.dash, "linewidth": 1.2}
        ax.plot(x, compared.models[compared.main], label=compared.label, **line)
    bare(ax)


def errors_together(ax: Axes, x: Any, sensors: Sequence[tuple[Compared, colors.Look]]) -> None:
    """Draw the errors of the main model for several sensors of one unit; parameters as for `together`.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where to draw.
    x : array_like, shape (n,)
        Times.
    sensors : sequence of (Compared, Look)
        The sensors and how each is drawn.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> ax = Figure().subplots()
    >>> one = Compared("room", np.ones(3), {"fitted": np.zeros(3)}, "fitted")
    >>> errors_together(ax, np.arange(3), [(one, colors.look(0))])
    >>> [line.get_label() for line in ax.lines][-1]
    'room'
    """
    for compared, look in sensors:
        if compared.error_band is not None:
            _band(ax, x, compared.error_band, look.color, 0.5 * _BAND_OPACITY)
    ax.axhline(0.0, color=colors.INK, linewidth=0.7)
    for compared, look in sensors:
        line: dict[str, Any] = {"color": look.color, "linestyle": look.dash, "linewidth": 1.1}
        ax.plot(x, compared.error(compared.main), label=compared.label, **line)
    bare(ax)


def bare(ax: Axes) -> None:
    """Show a light grid and only the horizontal axis.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        The axes.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> ax = Figure().subplots()
    >>> bare(ax)
    >>> ax.spines["left"].get_visible()
    False
    """
    ax.spines[["top", "right", "left"]].set_visible(False)
    ax.spines["bottom"].set_color(colors.INK)
    ax.grid(axis="y", color=colors.INK, alpha=0.18, linewidth=0.7)
    ax.set_axisbelow(True)
    ax.tick_params(colors=colors.INK, length=3)
    ax.tick_params(axis="y", length=0)


def _line(model: str) -> dict[str, Any]:
    """Style of the line of a model."""
    nominal = model == "nominal"
    return {"linestyle": (0, (4, 2)) if nominal else "-", "linewidth": 1.0 if nominal else 1.2}


def _points(ax: Axes, x: Any, values: Floats, color: str, label: str) -> Line2D:
    dense = values.size > _MAX_POINTS
    stride = 1 if dense else max(1, -(-values.size // _MAX_CIRCLES))
    (markers,) = ax.plot(
        x[::stride], values[::stride], "o", color=color, markerfacecolor=color if dense else "none",
        markersize=1.0 if dense else _MARKER_SIZE, markeredgewidth=0.0 if dense else 0.8, label=label,
        zorder=3.0,
    )  # fmt: skip
    markers.set_rasterized(dense)
    return markers


def _band(ax: Axes, x: Any, ends: tuple[Floats, Floats], color: str, alpha: float = _BAND_OPACITY) -> None:
    ax.fill_between(x, *ends, color=color, alpha=alpha, lw=0)

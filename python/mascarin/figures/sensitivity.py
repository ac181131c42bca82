"""Figures of a sensitivity analysis: indices, effects, indices over time, spectrum.

Each function draws plain arrays on axes that the caller gives.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from mascarin.figures import colors

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]

_KINDS: Final = {
    "fundamental": colors.PALETTE[0],
    "harmonic": colors.PALETTE[1],
    "interaction": colors.PALETTE[2],
    "unnamed": colors.REMAINDER,
}

Legend = tuple[list["Artist"], list[str]]
"""Handles and labels of a legend, for the caller to place."""


@dataclass(frozen=True, slots=True)
class SpectrumLine:
    """A line of a spectrum above the threshold.

    Attributes
    ----------
    number : int
        Its number. [1/circle]
    power : float
        Its part of the variance. [-]
    kind : str
        ``fundamental``, ``harmonic``, ``interaction`` or ``unnamed``.
    label : str
        Its name; empty when unnamed.
    """

    number: int
    power: float
    kind: str
    label: str


def indices(
    ax: Axes,
    names: Sequence[str],
    index: Floats,
    low: Floats,
    high: Floats,
    *,
    significant: NDArray[np.bool_],
    title: str,
    labeled: bool = True,
    total: tuple[Floats, Floats, Floats] | None = None,
) -> None:
    """Draw indices with their intervals, the first one at the top.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where to draw.
    names : sequence of str, length G
        Parameters.
    index, low, high : ndarray, shape (G,)
        Index and ends of its interval. [-]
    significant : ndarray of bool, shape (G,)
        Filled markers; the others are open.
    title : str
        What the index is, for the axis.
    labeled : bool
        Whether the axis has the names.
    total : tuple of three ndarray, shape (G,), optional
        Total index with its interval, drawn below the first one. [-]

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> ax = Figure().subplots()
    >>> half = np.array([0.7, 0.3])
    >>> indices(ax, ["a", "b"], half, half - 0.1, half + 0.1, significant=half > 0.5, title="S1 [-]")
    >>> ax.get_xlabel()
    'S1 [-]'
    """
    y = np.arange(len(names))[::-1].astype(np.float64)
    shift = 0.0 if total is None else 0.14
    for mask, fill in ((significant, colors.INK), (~significant, "white")):
        _points(ax, index[mask], low[mask], high[mask], y[mask] + shift, colors.INK, fill)
    if total is not None:
        _points(ax, *total, y - shift, colors.NOMINAL, colors.NOMINAL)
    ax.set_yticks(y, list(names), fontsize=8)
    ax.tick_params(labelleft=labeled)
    ax.set_xlim(left=0.0)
    ax.set_xlabel(title, fontsize=9)
    ax.set_title("open: not significant", loc="right", fontsize=8)
    _bare(ax)
    ax.tick_params(axis="y", length=0)


def effects(ax: Axes, names: Sequence[str], effect: Floats, unit: str, *, rms: Floats | None = None) -> None:
    """Draw signed effects as bars, the first one at the top.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where to draw.
    names : sequence of str, length G
        Parameters.
    effect : ndarray, shape (G,)
        Change of the output from the low to the high end of each range; no bar where NaN. [unit]
    unit : str
        Unit of the output.
    rms : ndarray, shape (G,), optional
        Root mean square of the effect over time, drawn as a line: a mean effect of zero may hide one that is
        positive by day and negative by night. [unit]

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> ax = Figure().subplots()
    >>> effects(ax, ["a", "b"], np.array([1.0, -0.5]), "K")
    >>> [float(bar.get_width()) for bar in ax.patches]
    [1.0, -0.5]
    """
    y = np.arange(len(names))[::-1]
    ax.barh(
        y,
        np.nan_to_num(effect),
        color=[colors.PALETTE[1] if e > 0 else colors.PALETTE[0] for e in effect],
        height=0.65,
    )
    if rms is not None:
        line = np.nan_to_num(rms)
        ax.hlines(y, -line, line, color=colors.INK, linewidth=0.8)
        ax.set_title("bar: mean, line: rms over time", loc="right", fontsize=8)
    ax.axvline(0.0, color=colors.INK, linewidth=0.8)
    ax.set_yticks(y, list(names), fontsize=8)
    ax.set_xlabel(f"low to high end of the range [{unit or '-'}]", fontsize=9)
    _bare(ax)
    ax.tick_params(axis="y", length=0)


def indices_over_time(
    ax: Axes, x: Floats, index: Floats, named: Sequence[tuple[str, colors.Look]], *, remainder: str
) -> Legend:
    """Draw first-order indices over time as stacked areas.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where to draw.
    x : ndarray, shape (T,)
        Times.
    index : ndarray, shape (G, T)
        Indices. [-]
    named : sequence of (str, Look), length G
        Parameters and how each is drawn; see `colors.parameters`.
    remainder : str
        Name of what the indices leave of 1.

    Returns
    -------
    tuple of list
        Handles and labels of the legend, from the top.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> ax = Figure().subplots()
    >>> index, named = np.full((1, 3), 0.8), [("a", colors.look(0))]
    >>> handles, labels = indices_over_time(ax, np.arange(3.0), index, named, remainder="others")
    >>> labels
    ['others', 'a']
    """
    percent = 100.0 * index
    # Estimates scatter a little: the rest is never negative.
    remaining = np.maximum(0.0, 100.0 - percent.sum(axis=0))
    shades = (*(look.color for _, look in named), colors.REMAINDER)
    hatches = [*(look.hatch for _, look in named), ""]
    areas = ax.stackplot(x, *percent, remaining, colors=shades, hatch=hatches, linewidth=0.0)
    ax.set_ylim(0.0, 100.0)
    ax.set_xlim(float(x[0]), float(x[-1]))
    ax.set_ylabel("first-order index S1 [%]")
    _bare(ax)
    return [*areas[::-1]], [*(name for name, _ in named), remainder][::-1]


def standard_deviation(ax: Axes, x: Floats, deviation: Floats, unit: str) -> None:
    """Draw the standard deviation of an output over time.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where to draw.
    x : ndarray, shape (T,)
        Times.
    deviation : ndarray, shape (T,)
        Standard deviation over the runs. [unit]
    unit : str
        Unit of the output.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> ax = Figure().subplots()
    >>> standard_deviation(ax, np.arange(3.0), np.ones(3), "K")
    >>> ax.get_ylabel()
    'sd [K]'
    """
    ax.plot(x, deviation, color=colors.INK, linewidth=1.2)
    ax.set_ylim(bottom=0.0)
    ax.set_ylabel(f"sd [{unit or '-'}]")
    _bare(ax)


def time_axis(ax: Axes, *, hours: bool) -> None:
    """Label the time axis.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        The axes.
    hours : bool
        Whether times are hours of the day; else they are numbers of steps.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> ax = Figure().subplots()
    >>> time_axis(ax, hours=True)
    >>> ax.get_xlabel()
    'hour of the day, local time [h]'
    """
    ax.set_xlabel("hour of the day, local time [h]" if hours else "time [steps]")
    if hours:
        ax.set_xticks(range(0, 25, 3))


def spectrum(
    ax: Axes, power: Floats, threshold: float, lines: Sequence[SpectrumLine], *, title: str, listed: int = 12
) -> Legend:
    """Draw power over frequency, with the threshold and the lines above it.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where to draw.
    power : ndarray, shape (K,)
        Part of the variance on the lines 1 ... K. [-]
    threshold : float
        Noise stays below. [-]
    lines : sequence of SpectrumLine
        Lines above the threshold.
    title : str
        Title of the axes.
    listed : int
        Largest number of lines in the legend, the strongest ones. [-]

    Returns
    -------
    tuple of list
        Handles and labels of the legend.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> ax = Figure().subplots()
    >>> line = SpectrumLine(3, 0.9, "fundamental", "a")
    >>> handles, labels = spectrum(ax, np.array([0.0, 0.1, 0.9]), 0.5, [line], title="y")
    >>> labels
    ['3  90.0 %  a', 'noise stays below 50 % (95 %)']
    """
    from matplotlib.lines import Line2D

    numbers = np.arange(1, power.size + 1)
    ax.vlines(numbers, 0.0, 100.0 * power, color=colors.INK, linewidth=0.6)
    ax.axhline(100.0 * threshold, color=colors.INK, linewidth=0.8, linestyle="--")
    for line in lines:
        ax.vlines(line.number, 0.0, 100.0 * line.power, color=_KINDS[line.kind], linewidth=1.8)
    strongest = sorted(lines, key=lambda line: -line.power)[:listed]
    for line in strongest:
        peak = (line.number, 100.0 * line.power)
        ax.annotate(
            str(line.number),
            peak,
            (0, 2),
            textcoords="offset points",
            ha="center",
            fontsize=7,
            color=colors.INK,
        )
    _bare(ax)
    ax.set_xlim(0, float(numbers[-1] + 1))
    ax.set_ylim(bottom=0.0, top=1.12 * 100.0 * max(float(power.max()), threshold))
    ax.set_xlabel("line [oscillations per replicate]")
    ax.set_ylabel("part of the variance [%]")
    ax.set_title(title, loc="left", fontsize=10)
    handles: list[Artist] = []
    labels: list[str] = []
    for line in sorted(strongest, key=lambda line: line.number):
        handles.append(Line2D([], [], color=_KINDS[line.kind], linewidth=2.0))
        name = line.label if line.kind != "unnamed" else "in this replicate only"
        labels.append(f"{line.number}  {100.0 * line.power:.1f} %  {name}")
    handles.append(Line2D([], [], color=colors.INK, linewidth=0.8, linestyle="--"))
    labels.append(f"noise stays below {100.0 * threshold:.2g} % (95 %)")
    return handles, labels


def _points(ax: Axes, x: Floats, low: Floats, high: Floats, y: Floats, color: str, fill: str) -> None:
    """Markers with intervals, in percent."""
    around = 100.0 * np.stack([np.maximum(x - low, 0.0), np.maximum(high - x, 0.0)])
    ax.errorbar(
        100.0 * x,
        y,
        xerr=around,
        fmt="o",
        markersize=4,
        markerfacecolor=fill,
        color=color,
        linewidth=1.0,
        capsize=2,
    )


def _bare(ax: Axes) -> None:
    """Show only the axes with numbers."""
    ax.spines[["top", "right"]].set_visible(False)
    ax.tick_params(labelsize=8)

"""Figures of a calibration, for print: profiles, the course of the search, where the sequences ended.

Each function returns a matplotlib figure that belongs to nobody; `mascarin.sensitivity.plots.save` writes it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.calibration.fit import Fit
from mascarin.calibration.profile import Profile
from mascarin.errors import InputError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_INK: Final = "#333333"
_BLUE: Final = "#0072b2"
_RED: Final = "#d55e00"
#: Evaluations beyond which their dots are drawn as a picture.
MOST_DOTS: Final = 20_000


def profiles(found: Sequence[Profile], *, columns: int = 3) -> Figure:
    """Profile of each parameter: the loss of likelihood where it is held, the limit and the interval.

    Parameters
    ----------
    found : sequence of Profile
        From `mascarin.calibration.profiles`.
    columns : int
        Panels side by side. [-]

    Raises
    ------
    InputError
        There is none.
    """
    if not found:
        raise InputError("found no profile to draw, expected one at least")
    columns = min(columns, len(found))
    rows = math.ceil(len(found) / columns)
    figure = _figure(3.2 * columns, 2.4 * rows)
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes, profile in zip(panels, found, strict=False):
        axes.plot(profile.values, profile.rise, color=_BLUE, marker="o", markersize=3, linewidth=1.2)
        axes.axhline(profile.limit, color=_INK, linewidth=0.8, linestyle="--")
        axes.axvspan(profile.low, profile.high, color=_BLUE, alpha=0.12, linewidth=0)
        axes.axvline(profile.estimate, color=_INK, linewidth=0.8)
        axes.set_ylim(0.0, 2.6 * profile.limit)
        axes.set_title(profile.path, fontsize=8, loc="left")
        axes.set_xlabel(f"[{profile.unit or '-'}]", fontsize=8)
        _bare(axes)
    for axes in panels[len(found) :]:
        axes.set_visible(False)
    for k in range(0, len(found), columns):
        panels[k].set_ylabel("loss of likelihood", fontsize=8)
    return figure


def course(fit: Fit) -> Figure:
    """Cost of every evaluation in its order, and the lowest so far, above the cost at the estimates.

    Parameters
    ----------
    fit : Fit
        The calibration.
    """
    cost = fit.trace.cost
    above = np.where(np.isfinite(cost), cost - fit.cost, np.nan)
    floor = max(float(np.nanmax(above, initial=0.0)), 1e-300) * 1e-9
    number = np.arange(1, cost.size + 1)
    figure = _figure(7.0, 3.2)
    axes = figure.subplots()
    # A million dots as dots would be a drawing of 100 MB; as a picture they are a few hundred kB.
    dots = axes.plot(number, np.maximum(above, floor), ".", color=_BLUE, markersize=2, alpha=0.5)
    dots[0].set_rasterized(cost.size > MOST_DOTS)
    lowest = np.fmin.accumulate(np.where(np.isnan(above), np.inf, above))
    steps = np.append(np.flatnonzero(lowest < np.append(np.inf, lowest[:-1])), cost.size - 1)
    axes.plot(
        number[steps], np.maximum(lowest[steps], floor), color=_RED, linewidth=1.2, drawstyle="steps-post"
    )
    axes.set_yscale("log")
    axes.set_xlabel("evaluation", fontsize=9)
    axes.set_ylabel("cost above the lowest", fontsize=9)
    axes.set_title(f"{fit.method}: {fit.reason}", fontsize=9, loc="left")
    _bare(axes)
    return figure


def minima(fit: Fit, *, bins: int = 30) -> Figure:
    """How many sequences ended at which cost, and how many different minima that are.

    Parameters
    ----------
    fit : Fit
        A calibration of several sequences or starts.
    bins : int
        Number of bars. [-]
    """
    counts, edges = fit.histogram(bins)
    groups = fit.distinct_minima()
    figure = _figure(7.0, 3.2)
    axes = figure.subplots()
    axes.bar(edges[:-1], counts, width=np.diff(edges), align="edge", color=_BLUE, linewidth=0)
    axes.set_xlabel("cost at the end of a sequence", fontsize=9)
    axes.set_ylabel("sequences", fontsize=9)
    axes.set_title(
        f"{len(fit.minima)} sequences, {len(groups)} different minima, {len(groups[0])} in the lowest",
        fontsize=9,
        loc="left",
    )
    _bare(axes)
    return figure


def _figure(width: float, height: float) -> Figure:
    """An empty figure. [inch]"""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def _bare(axes: Axes) -> None:
    """Only the axes that carry numbers."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(labelsize=8)

"""Figures of a calibration: estimates, correlations, profiles, convergence, minima and residuals.

Every function draws plain arrays on the axes that it gets.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from mascarin._io.units import bracketed, difference
from mascarin.figures import colors

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]

MAX_DOTS: Final = 20_000
"""Evaluations from which their dots are drawn as pixels: vectors would make a file of 100 MB."""


def estimates(
    axes: Axes, names: Sequence[str], estimate: Floats, low: Floats, high: Floats, nominal: Floats
) -> None:
    """Draw estimates with their intervals, and the nominal values, within the ranges of the parameters.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Where to draw.
    names : sequence of str, length P
        Names of the parameters.
    estimate, low, high, nominal : ndarray, shape (P,)
        Positions between 0 (lower end of the range) and 1 (upper end); NaN for what is not known. [-]
    """
    y = np.arange(len(names))[::-1]
    around = np.stack([np.maximum(estimate - low, 0.0), np.maximum(high - estimate, 0.0)])
    axes.errorbar(
        estimate,
        y,
        xerr=np.nan_to_num(around),
        fmt="o",
        color=colors.FITTED,
        markersize=4,
        capsize=2,
        label="fitted",
    )
    axes.plot(nominal, y, "|", color=colors.NOMINAL, markersize=9, markeredgewidth=1.6, label="nominal")
    axes.set_yticks(y, list(names), fontsize=8)
    axes.set_xlim(-0.02, 1.02)
    axes.set_xlabel("position in the range [-]", fontsize=9)
    axes.legend(fontsize=8, frameon=False, loc="best")
    _only_axes_with_numbers(axes)


def correlation(axes: Axes, names: Sequence[str], matrix: Floats) -> None:
    """Draw the correlations between estimates as a matrix.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Where to draw.
    names : sequence of str, length P
        Names of the parameters.
    matrix : ndarray, shape (P, P)
        Correlations. [-]
    """
    axes.imshow(matrix, cmap="RdBu_r", vmin=-1.0, vmax=1.0)
    positions = np.arange(len(names))
    axes.set_xticks(positions, [str(k + 1) for k in positions], fontsize=8)
    axes.set_yticks(positions, [f"{k + 1}  {name}" for k, name in enumerate(names)], fontsize=8)
    for i, row in enumerate(matrix):
        for k, value in enumerate(row):
            color = "white" if abs(value) > 0.6 else colors.INK
            axes.text(k, i, f"{value:.2f}", ha="center", va="center", fontsize=7, color=color)


def profile(
    axes: Axes, values: Floats, rise: Floats, *, limit: float, low: float, high: float, estimate: float
) -> None:
    """Draw the profile likelihood of one parameter, with its limit and interval.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Where to draw.
    values : ndarray, shape (K,)
        Fixed values of the parameter. [unit]
    rise : ndarray, shape (K,)
        Increase of the deviance there. [-]
    limit : float
        Of the increase within the interval. [-]
    low, high, estimate : float
        Interval and estimate. [unit]
    """
    axes.plot(values, rise, color=colors.FITTED, marker="o", markersize=3, linewidth=1.2)
    axes.axhline(limit, color=colors.INK, linewidth=0.8, linestyle="--")
    axes.axvspan(low, high, color=colors.FITTED, alpha=0.12, linewidth=0)
    axes.axvline(estimate, color=colors.INK, linewidth=0.8)
    axes.set_ylim(0.0, 2.6 * limit)
    _only_axes_with_numbers(axes)


def convergence(axes: Axes, cost: Floats, final: float) -> None:
    """Draw the cost of every evaluation, and the lowest so far, above the final cost.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Where to draw.
    cost : ndarray, shape (n,)
        In the order of the evaluations; infinite where the model could not be run.
    final : float
        Cost at the estimates.
    """
    above = np.where(np.isfinite(cost), cost - final, np.nan)
    floor = max(float(np.nanmax(above, initial=0.0)), 1e-300) * 1e-9
    number = np.arange(1, cost.size + 1)
    dots = axes.plot(number, np.maximum(above, floor), ".", color=colors.FITTED, markersize=2, alpha=0.5)
    dots[0].set_rasterized(cost.size > MAX_DOTS)
    lowest = np.fmin.accumulate(np.where(np.isnan(above), np.inf, above))
    steps = np.append(np.flatnonzero(lowest < np.append(np.inf, lowest[:-1])), cost.size - 1)
    axes.plot(
        number[steps],
        np.maximum(lowest[steps], floor),
        color=colors.NOMINAL,
        linewidth=1.2,
        drawstyle="steps-post",
    )
    axes.set_yscale("log")
    axes.set_xlabel("evaluation", fontsize=9)
    axes.set_ylabel("cost above the lowest", fontsize=9)
    _only_axes_with_numbers(axes)


def minima(axes: Axes, counts: NDArray[np.int64], edges: Floats) -> None:
    """Draw how many searches ended at which cost.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Where to draw.
    counts : ndarray, shape (bins,)
        Number of searches. [-]
    edges : ndarray, shape (bins + 1,)
        Edges of the bins of the cost.
    """
    axes.bar(edges[:-1], counts, width=np.diff(edges), align="edge", color=colors.FITTED, linewidth=0)
    axes.set_xlabel("cost at the end of a search", fontsize=9)
    axes.set_ylabel("searches", fontsize=9)
    _only_axes_with_numbers(axes)


def residuals(
    axes: Axes, times: pd.DatetimeIndex | Floats, series: Floats, names: Sequence[str], units: Sequence[str]
) -> None:
    """Draw the residuals of all sensors over time.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Where to draw.
    times : pandas.DatetimeIndex or ndarray, shape (T,)
        Times with a time zone, or numbers of the samples.
    series : ndarray, shape (T, S)
        Simulated minus measured, NaN for gaps. [unit of each sensor]
    names, units : sequence of str, length S
        Names and units of the sensors.
    """
    zone = getattr(times, "tz", None)
    # Axes have no time zones: the local clock is drawn, and the label names its zone.
    clock = times if zone is None else times.tz_localize(None)  # type: ignore[union-attr]
    for k, name in enumerate(names):
        look, label = colors.look(k), bracketed(name, difference(units[k]) or "-")
        axes.plot(clock, series[:, k], linewidth=0.9, color=look.color, linestyle=look.dash, label=label)
    axes.axhline(0.0, color=colors.INK, linewidth=0.8)
    axes.set_xlabel("sample" if isinstance(times, np.ndarray) else f"local time, {zone}", fontsize=9)
    axes.set_ylabel("simulated minus measured", fontsize=9)
    axes.legend(fontsize=8, frameon=False)
    _only_axes_with_numbers(axes)


def _only_axes_with_numbers(axes: Axes) -> None:
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(labelsize=8)

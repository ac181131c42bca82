"""Figure of the choice of days: leverage of each day, and the information that it would add."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from mascarin.figures import colors

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_USED, _OTHER, _PROPOSED = colors.PALETTE[2], colors.REMAINDER, colors.PALETTE[1]


def leverage(
    axes: Axes, dates: ArrayLike, ratio: ArrayLike, used: ArrayLike, proposed: Sequence[int], far: float
) -> None:
    """Draw the leverage of each day relative to the days of the calibration.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Where to draw.
    dates : array_like, shape (D,)
        Days.
    ratio : array_like, shape (D,)
        Leverage over its mean on the days of the calibration. [-]
    used : array_like of bool, shape (D,)
        Days of the calibration.
    proposed : sequence of int
        Days to use next.
    far : float
        Days above it are extrapolations. [-]

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().subplots()
    >>> leverage(axes, [0, 1], [1.0, 4.0], [True, False], [1], 3.0)
    >>> axes.get_ylabel()
    'leverage, relative to the identification'
    """
    _bars(axes, dates, ratio, used, proposed)
    axes.axhline(far, color=colors.INK, lw=0.8, ls="--", label="extrapolation above")
    axes.set_ylabel("leverage, relative to the identification")


def information(
    axes: Axes, dates: ArrayLike, gain: ArrayLike, used: ArrayLike, proposed: Sequence[int]
) -> None:
    """Draw the information that each day would add; parameters as those of `leverage`.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Where to draw.
    dates : array_like, shape (D,)
        Days.
    gain : array_like, shape (D,)
        Fall of the logarithm of the volume of the confidence region. [-]
    used : array_like of bool, shape (D,)
        Days of the calibration.
    proposed : sequence of int
        Days to use next.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().subplots()
    >>> information(axes, [0, 1], [0.1, 0.4], [True, False], [1])
    >>> axes.get_ylabel()
    'gain of information'
    """
    _bars(axes, dates, gain, used, proposed)
    axes.set_ylabel("gain of information")


def _bars(axes: Axes, dates: ArrayLike, values: ArrayLike, used: ArrayLike, proposed: Sequence[int]) -> None:
    days, heights = np.asarray(dates), np.asarray(values, dtype=np.float64)
    of_fit = np.asarray(used, dtype=bool)
    chosen = np.zeros(of_fit.size, dtype=bool)
    chosen[list(proposed)] = True
    for which, color, label in (
        (~of_fit & ~chosen, _OTHER, "other days"),
        (of_fit, _USED, "identification"),
        (chosen, _PROPOSED, "to use next"),
    ):
        if which.any():
            axes.bar(days[which], heights[which], color=color, width=0.8, label=label)

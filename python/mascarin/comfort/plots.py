"""Comfort of a room as figures."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from mascarin.comfort.evaluation import Evaluation, Floats
from mascarin.comfort.givoni import zone as givoni_zone
from mascarin.errors import InputError, did_you_mean
from mascarin.physics import STANDARD_PRESSURE, humidity_ratio

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from mascarin.comfort.indices import Index

KINDS: Final = ("series", "carpet", "profile", "psychrometric")
"""Kinds of figures of the comfort of a room."""

#: Air speeds of the zones that a chart shows. [m/s]
_SPEEDS: Final = (0.2, 1.0, 2.0)


def psychrometric(
    ax: Axes,
    temperature: Floats,
    humidity: npt.ArrayLike,
    pressure: npt.ArrayLike = STANDARD_PRESSURE,
) -> None:
    """Hours on the psychrometric chart, with Givoni's zones for three air speeds.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Where to draw.
    temperature : ndarray, shape (n,)
        Temperature of the air. [degC]
    humidity : array_like
        Relative humidity. [%]
    pressure : array_like
        Pressure of the air. [Pa]

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> ax = Figure().subplots()
    >>> psychrometric(ax, np.array([25.0, 31.0]), 60.0)
    >>> len(ax.patches)
    3
    """
    from mascarin.figures.psychrometric import chart

    t = np.asarray(temperature, dtype=np.float64)
    ratio = humidity_ratio(t, humidity, pressure)
    low = min(5.0, 5.0 * np.floor(np.nanmin(t) / 5.0))
    high = max(35.0, 5.0 * np.ceil(np.nanmax(t) / 5.0))
    along = np.linspace(low, high, 120)
    saturated = np.column_stack(
        [along, humidity_ratio(along, 100.0, float(np.mean(np.asarray(pressure, dtype=np.float64))))]
    )
    zones = {f"Givoni, {speed:g} m/s": givoni_zone(speed) for speed in _SPEEDS}
    chart(ax, t, ratio, saturated, zones=zones, top=max(26.0, 1000.0 * float(np.nanmax(ratio)) + 2.0))


def draw(
    kind: str,
    index: Index,
    times: pd.DatetimeIndex,
    evaluation: Evaluation,
    room: Mapping[str, Floats | float | None],
    ax: Axes | None = None,
) -> Figure:
    """One figure of the comfort of a room.

    Parameters
    ----------
    kind : str
        One of `KINDS`.
    index : Index
        What was evaluated.
    times : pandas.DatetimeIndex, shape (times,)
        Local times.
    evaluation : Evaluation
        Values and limits.
    room : mapping
        air_temperature [degC], relative_humidity [%] or None, and pressure [Pa] of the room.
    ax : matplotlib.axes.Axes, optional
        Where to draw; default a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The figure.

    Raises
    ------
    InputError
        There is no such kind, or the chart needs a humidity that is not known.
    """
    from mascarin.figures import comfort as figures
    from mascarin.figures.series import axes_for

    if kind not in KINDS:
        raise InputError(f"kind: found {kind!r}; expected a kind of figure. {did_you_mean(kind, KINDS)}")
    if kind == "psychrometric" and room["relative_humidity"] is None:
        raise InputError(
            "kind: found 'psychrometric'; expected another one, or a relative humidity: choose an index "
            "that uses it, such as givoni, with humidity: outdoor or a number in percent"
        )
    axes = axes_for(ax, [index.unit])[0]
    name = "PMV" if index.name == "pmv" else index.title.removeprefix("the ")
    if index.unit == "degC" and index.name in ("adaptive-en", "adaptive-ashrae", "givoni"):
        name = "operative temperature"
    series = figures.ComfortSeries(times, evaluation.values, name, index.unit)
    if kind == "series":
        figures.with_limits(axes, series, evaluation.low, evaluation.high)
        axes.set_xlabel(f"local time ({times.tz})")
    elif kind == "profile":
        figures.daily_profile(axes, series)
    elif kind == "carpet":
        excess = np.where(np.isnan(evaluation.values), np.nan, evaluation.excess)
        unit = "K" if index.unit == "degC" else index.unit
        figures.carpet(axes, figures.ComfortSeries(times, excess, "outside the limits by", unit), centre=0.0)
    else:
        psychrometric(
            axes, np.asarray(room["air_temperature"]), np.asarray(room["relative_humidity"]),
            np.asarray(room["pressure"]),
        )  # fmt: skip
    figure = axes.get_figure(root=True)
    assert figure is not None  # noqa: S101 (axes belong to a figure)
    return figure

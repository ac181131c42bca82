"""Figures of a sensitivity analysis for print, as SVG files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import ArrayLike

from mascarin.figures import sensitivity as figures
from mascarin.figures.files import save
from mascarin.sensitivity.base.result import Sensitivity, local_hours
from mascarin.sensitivity.spectral import SpectralSensitivity
from mascarin.sensitivity.spectral.result import lines

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LEGEND: Final = (0.56, 0.93)


def save_all(
    result: Sensitivity, output: str, folder: Path, stem: str, hour: ArrayLike | None = None
) -> list[Path]:
    """Write every figure that a method can give of one output.

    Parameters
    ----------
    result : Sensitivity
        The analysis, of any method; the spectral one adds spectrum and indices over the day.
    output : str
        Which output.
    folder : Path
        Where to.
    stem : str
        File names begin with it.
    hour : array_like, shape (T,), optional
        Hour of the day of each time; default: of the times of the analysis. [h]

    Returns
    -------
    list of Path
        What was written.
    """
    drawings = {"tornado": tornado(result, output)}
    if isinstance(result, SpectralSensitivity):
        drawings["spectrum"] = spectrum(result, output)
        if result.variance_t[:, result.output_index(output)].any():
            drawings["day"] = day(result, output, hour=hour)
    return [save(figure, folder / f"{stem}-{kind}.svg") for kind, figure in drawings.items()]


def spectrum(result: SpectralSensitivity, output: str, *, replicate: int = 0) -> Figure:
    """Draw power over frequency with the threshold, and list the peaks by name.

    Parameters
    ----------
    result : SpectralSensitivity
        The analysis.
    output : str
        Which output.
    replicate : int
        Which replicate; frequencies differ between replicates.

    Returns
    -------
    matplotlib.figure.Figure
        The figure.
    """
    power_spectrum = result.spectrum(output, replicate)
    figure = _figure(9.0, 4.2)
    ax = figure.add_axes((0.07, 0.14, 0.48, 0.74))
    title = f"{output}, replicate {replicate + 1} of {result.design.replicates}"
    legend = figures.spectrum(
        ax, power_spectrum.power, power_spectrum.threshold, lines(power_spectrum), title=title
    )
    figure.legend(*legend, loc="upper left", bbox_to_anchor=_LEGEND, fontsize=7.5, frameon=False)
    return figure


def day(result: SpectralSensitivity, output: str, *, hour: ArrayLike | None = None, top: int = 8) -> Figure:
    """Draw first-order indices over the day, stacked, above the standard deviation of the output.

    Parameters
    ----------
    result : SpectralSensitivity
        The analysis.
    output : str
        Which output.
    hour : array_like, shape (T,), optional
        Hour of the day of each time; the days are averaged, weighted with their variance. Default: of the
        times of the analysis; without those the times are numbered. [h]
    top : int
        Number of parameters shown by name, those with the largest indices. [-]

    Returns
    -------
    matplotlib.figure.Figure
        The figure.
    """
    s = result.output_index(output)
    hours = local_hours(result.times) if hour is None else hour
    x, index, variance = result.indices_by_hour(output, hours)
    order = result.strongest(output, top)
    figure = _figure(9.0, 5.0)
    upper = figure.add_axes((0.07, 0.36, 0.48, 0.56))
    lower = figure.add_axes((0.07, 0.10, 0.48, 0.20), sharex=upper)
    looks = result.looks(top)
    named = [
        (f"{result.names[i]}  {100.0 * result.index[i, s]:.1f} %", looks[result.names[i]]) for i in order
    ]
    remainder = 100.0 * (1.0 - result.index[order, s].sum())
    remainder_label = f"others and interactions  {remainder:.1f} %"
    legend = figures.indices_over_time(upper, x, index[order], named, remainder=remainder_label)
    figure.legend(*legend, loc="upper left", bbox_to_anchor=_LEGEND, fontsize=8, frameon=False)
    upper.set_title(output, loc="left", fontsize=10)
    upper.tick_params(labelbottom=False)
    figures.standard_deviation(lower, x, np.sqrt(variance), result.units[s])
    figures.time_axis(lower, hours=hours is not None)
    return figure


def tornado(result: Sensitivity, output: str, *, top: int = 15) -> Figure:
    """Draw the effects of the most influential parameters, and their indices with intervals to the right.

    Parameters
    ----------
    result : Sensitivity
        The analysis, of any method.
    output : str
        Which output.
    top : int
        Number of parameters, those with the largest indices. [-]

    Returns
    -------
    matplotlib.figure.Figure
        The figure.
    """
    s = result.output_index(output)
    order = result.strongest(output, top)
    names = [result.names[i] for i in order]
    figure = _figure(9.0, 1.2 + 0.28 * order.size)
    bottom, height = 0.55 / figure.get_figheight(), 1.0 - 1.0 / figure.get_figheight()
    effect_axes = figure.add_axes((0.38, bottom, 0.31, height))
    index_axes = figure.add_axes((0.72, bottom, 0.25, height), sharey=effect_axes)
    rms = result.effect_rms[order, s] if isinstance(result, SpectralSensitivity) else None
    figures.effects(effect_axes, names, result.effect[order, s], result.units[s], rms=rms)
    figure.text(0.02, 1.0 - 0.28 / figure.get_figheight(), output, fontsize=10)
    figures.indices(
        index_axes, names, result.index[order, s], result.low[order, s], result.high[order, s],
        significant=result.significant[order, s], title=result.axis_title, labeled=False,
    )  # fmt: skip
    return figure


def _figure(width: float, height: float) -> Figure:
    """An empty figure. [inch]"""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height))

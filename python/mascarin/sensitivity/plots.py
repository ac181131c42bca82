"""Figures of a sensitivity analysis, for print: spectrum, shares over the day, tornado.

Each function returns a matplotlib figure that belongs to nobody (no window, no global state); `save` writes
it as SVG, the same bytes for the same figure.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mascarin.errors import InputError
from mascarin.sensitivity.result import Sensitivity
from mascarin.sensitivity.spectral import SpectralSensitivity
from mascarin.sensitivity.spectrum import Peak

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

# Told apart in the common kinds of colour blindness (Okabe and Ito), and by lightness.
COLOURS: Final = (
    "#0072b2",
    "#e69f00",
    "#009e73",
    "#cc79a7",
    "#56b4e9",
    "#d55e00",
    "#f0e442",
    "#7a5195",
    "#3d3d3d",
)
_REST: Final = "#d9d9d9"
_INK: Final = "#333333"
_KINDS: Final = {
    "fundamental": COLOURS[0],
    "harmonic": COLOURS[1],
    "interaction": COLOURS[2],
    "unnamed": "#999999",
}


def spectrum(result: SpectralSensitivity, output: str, *, replicate: int = 0, listed: int = 12) -> Figure:
    """Power over frequency with the threshold, and the peaks by name.

    Parameters
    ----------
    result : SpectralSensitivity
        The analysis.
    output : str
        Which output.
    replicate : int
        Which replicate; frequencies are dealt out anew in each.
    listed : int
        Largest number of peaks in the legend, the strongest ones. [-]
    """
    found = result.spectrum(output, replicate)
    figure = _figure(9.0, 4.2)
    axes = figure.add_axes((0.07, 0.14, 0.48, 0.74))
    lines = np.arange(1, found.power.size + 1)
    axes.vlines(lines, 0.0, 100.0 * found.power, color=_INK, linewidth=0.6)
    axes.axhline(100.0 * found.threshold, color=_INK, linewidth=0.8, linestyle="--")
    strongest = sorted(found.peaks, key=lambda peak: -peak.power)[:listed]
    for peak in found.peaks:
        axes.vlines(peak.line, 0.0, 100.0 * peak.power, color=_KINDS[peak.kind], linewidth=1.8)
    for peak in strongest:
        place = (peak.line, 100.0 * peak.power)
        axes.annotate(
            str(peak.line), place, (0, 2), textcoords="offset points", ha="center", fontsize=7, color=_INK
        )
    _bare(axes)
    axes.set_xlim(0, lines[-1] + 1)
    axes.set_ylim(bottom=0.0, top=1.12 * 100.0 * max(float(found.power.max()), found.threshold))
    axes.set_xlabel("line [oscillations per replicate]")
    axes.set_ylabel("share of the variance [%]")
    axes.set_title(
        f"{output}, replicate {replicate + 1} of {result.design.replicates}", loc="left", fontsize=10
    )
    _list_peaks(figure, sorted(strongest, key=lambda peak: peak.line), found.threshold)
    return figure


def shares_over_time(
    result: SpectralSensitivity,
    output: str,
    *,
    hour: ArrayLike | None = None,
    top: int = 8,
) -> Figure:
    """Shares over the day, stacked, above the standard deviation they are shares of.

    Parameters
    ----------
    result : SpectralSensitivity
        The analysis.
    output : str
        Which output.
    hour : array_like, shape (T,), optional
        Hour of the day of each time, fractions included; the days are then laid on top of each other, each
        time weighted with its variance. Without it the times are numbered. [h]
    top : int
        Number of parameters shown by name, those with the largest shares. [-]
    """
    s = result.output_index(output)
    power = np.nan_to_num(result.share_t[:, :, s]) * result.variance_t[:, s]
    x, power, variance = _folded(power, result.variance_t[:, s], hour)
    with np.errstate(invalid="ignore", divide="ignore"):
        share = 100.0 * np.clip(power / variance, 0.0, 1.0)
    order = np.argsort(-result.share[:, s], kind="stable")[: min(top, len(COLOURS))]
    figure = _figure(9.0, 5.0)
    upper = figure.add_axes((0.07, 0.36, 0.48, 0.56))
    lower = figure.add_axes((0.07, 0.10, 0.48, 0.20), sharex=upper)
    # Estimates scatter a little: what is left for the rest is never negative.
    rest = np.maximum(0.0, 100.0 - share[order].sum(axis=0))
    areas = upper.stackplot(x, *share[order], rest, colors=(*COLOURS[: order.size], _REST), linewidth=0.0)
    named = [f"{result.names[i]}  {100.0 * result.share[i, s]:.1f} %" for i in order]
    remainder = 100.0 * (1.0 - result.share[order, s].sum())
    labels = [*named, f"others and interactions  {remainder:.1f} %"]
    figure.legend(
        areas[::-1], labels[::-1], loc="upper left", bbox_to_anchor=(0.56, 0.93), fontsize=8, frameon=False
    )
    upper.set_ylim(0.0, 100.0)
    upper.set_xlim(float(x[0]), float(x[-1]))
    upper.set_ylabel("share of the variance [%]")
    upper.set_title(output, loc="left", fontsize=10)
    upper.tick_params(labelbottom=False)
    lower.plot(x, np.sqrt(variance), color=_INK, linewidth=1.2)
    lower.set_ylim(bottom=0.0)
    lower.set_ylabel(f"sd [{result.units[s] or '-'}]")
    lower.set_xlabel("time [steps]" if hour is None else "hour of the day [h]")
    if hour is not None:
        lower.set_xticks(range(0, 25, 3))
    for axes in (upper, lower):
        _bare(axes)
    return figure


def tornado(result: Sensitivity, output: str, *, top: int = 15) -> Figure:
    """Effect of the most influential parameters over their range, and their shares with intervals.

    Parameters
    ----------
    result : Sensitivity
        The analysis, of any method.
    output : str
        Which output.
    top : int
        Number of parameters, those with the largest shares. [-]
    """
    s = result.output_index(output)
    order = np.argsort(-result.share[:, s], kind="stable")[:top]
    y = np.arange(order.size)[::-1]
    figure = _figure(9.0, 1.2 + 0.28 * order.size)
    bottom, height = 0.55 / figure.get_figheight(), 1.0 - 1.0 / figure.get_figheight()
    left = figure.add_axes((0.38, bottom, 0.31, height))
    right = figure.add_axes((0.72, bottom, 0.25, height), sharey=left)
    effect = result.effect[order, s]
    left.barh(
        y, np.nan_to_num(effect), color=[COLOURS[5] if e > 0 else COLOURS[0] for e in effect], height=0.65
    )
    if isinstance(result, SpectralSensitivity):
        # A mean effect of zero may hide one that is positive by day and negative by night.
        rms = np.nan_to_num(result.effect_rms[order, s])
        left.hlines(y, -rms, rms, color=_INK, linewidth=0.8)
    left.axvline(0.0, color=_INK, linewidth=0.8)
    left.set_yticks(y, [result.names[i] for i in order], fontsize=8)
    left.set_xlabel(f"low to high end of the range [{result.units[s] or '-'}]", fontsize=9)
    figure.text(0.02, 1.0 - 0.28 / figure.get_figheight(), output, fontsize=10)
    if isinstance(result, SpectralSensitivity):
        left.set_title("bar: mean, line: rms over time", loc="right", fontsize=8)
    share = 100.0 * result.share[order, s]
    low, high = 100.0 * result.low[order, s], 100.0 * result.high[order, s]
    around = np.stack([np.maximum(share - low, 0.0), np.maximum(high - share, 0.0)])
    sure = result.significant[order, s]
    for mask, face in ((sure, _INK), (~sure, "white")):
        right.errorbar(
            share[mask],
            y[mask],
            xerr=around[:, mask],
            fmt="o",
            markersize=4,
            markerfacecolor=face,
            color=_INK,
            linewidth=1.0,
            capsize=2,
        )
    right.set_xlim(left=0.0)
    right.set_xlabel(f"share, {100.0 * result.confidence:g} % interval [%]", fontsize=9)
    right.tick_params(labelleft=False)
    right.set_title("open: not significant", loc="right", fontsize=8)
    for axes in (left, right):
        _bare(axes)
        axes.tick_params(axis="y", length=0)
    return figure


def save_all(
    result: Sensitivity, output: str, folder: Path, stem: str, hour: ArrayLike | None = None
) -> list[Path]:
    """Write every figure that a method can give of one output.

    Parameters
    ----------
    result : Sensitivity
        The analysis, of any method; spectra and shares over the day are those of the spectral one.
    output : str
        Which output.
    folder : Path
        Where to.
    stem : str
        File names begin with it.
    hour : array_like, shape (T,), optional
        Hour of the day of each time, see `shares_over_time`. [h]

    Returns
    -------
    list of Path
        What was written.
    """
    figures = {"tornado": tornado(result, output)}
    if isinstance(result, SpectralSensitivity):
        figures["spectrum"] = spectrum(result, output)
        if result.variance_t[:, result.output_index(output)].any():
            figures["day"] = shares_over_time(result, output, hour=hour)
    return [save(figure, folder / f"{stem}-{kind}.svg") for kind, figure in figures.items()]


def save(figure: Figure, path: Path) -> Path:
    """Write a figure as SVG; the file appears only when it is complete.

    Parameters
    ----------
    figure : Figure
        What to write.
    path : Path
        Where to.
    """
    import io

    import matplotlib as mpl

    text = io.StringIO()
    with mpl.rc_context({"svg.hashsalt": "mascarin", "svg.fonttype": "none"}):
        figure.savefig(text, format="svg", metadata={"Date": None})
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(path.name + ".part")
    partial.write_text(text.getvalue(), encoding="utf-8", newline="\n")
    partial.replace(path)
    return path


def _folded(power: Floats, variance: Floats, hour: ArrayLike | None) -> tuple[Floats, Floats, Floats]:
    """Power (G, T) and variance (T,) over the times, or summed up at each time of the day."""
    if hour is None:
        return np.arange(variance.size, dtype=np.float64), power, variance
    hours = np.asarray(hour, dtype=np.float64)
    if hours.shape != variance.shape:
        msg = f"hour: {hours.size} values for {variance.size} times; give the hour of the day of each time"
        raise InputError(msg)
    # To the second, so that hours computed in different ways fall together.
    x, where, count = np.unique(
        np.round(np.mod(hours, 24.0) * 3600.0), return_inverse=True, return_counts=True
    )
    if x.size < 2:
        msg = "hour: every time is at the same hour of the day; leave it out to plot over time"
        raise InputError(msg)
    summed = np.stack([np.bincount(where, weights=row, minlength=x.size) for row in power]) / count
    mean = np.bincount(where, weights=variance, minlength=x.size) / count
    return x / 3600.0, summed, mean


def _figure(width: float, height: float) -> Figure:
    """An empty figure. [inch]"""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height))


def _bare(axes: Axes) -> None:
    """Only the axes that carry numbers."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(labelsize=8)


def _list_peaks(figure: Figure, peaks: Sequence[Peak], threshold: float) -> None:
    """Legend of the peaks by their line, and of the threshold."""
    from matplotlib.lines import Line2D

    entries = [
        (Line2D([], [], color=_KINDS[peak.kind], linewidth=2.0), f"{peak.line}  {_title(peak)}")
        for peak in peaks
    ]
    dashed = Line2D([], [], color=_INK, linewidth=0.8, linestyle="--")
    entries.append((dashed, f"noise stays below {100.0 * threshold:.2g} % (95 %)"))
    figure.legend(
        [handle for handle, _ in entries],
        [label for _, label in entries],
        loc="upper left",
        bbox_to_anchor=(0.56, 0.93),
        fontsize=7.5,
        frameon=False,
    )


def _title(peak: Peak) -> str:
    if peak.kind == "unnamed":
        return f"{100.0 * peak.power:.1f} %  in this replicate only"
    return f"{100.0 * peak.power:.1f} %  {peak.label}"

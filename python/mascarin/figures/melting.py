"""Figures of phase-change materials: enthalpy and apparent specific heat over temperature."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from mascarin._io.units import bracketed, shown
from mascarin.figures import colors
from mascarin.figures.series import axes_for

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


#: Panels beside each other.
_MAX_COLUMNS: Final = 6


class CapacityCurve(NamedTuple):
    """Enthalpy and apparent specific heat of a material on one path.

    Parameters
    ----------
    label : str
        Name in the legend.
    family : int
        Curves of one family have one color.
    style : str
        Style of the line.
    temperature, enthalpy : array_like, shape (n,)
        Points of the enthalpy. [degC, J/kg]
    middle, specific_heat : array_like, shape (m,)
        Points of the apparent specific heat. [degC, J/(kg K)]

    Examples
    --------
    >>> CapacityCurve("wax, heating", 0, "-", [20, 30], [0, 2e5], [25], [2e4]).label
    'wax, heating'
    """

    label: str
    family: int
    style: str
    temperature: Any
    enthalpy: Any
    middle: Any
    specific_heat: Any


def draw(curves: Sequence[CapacityCurve], ax: Axes | Sequence[Axes] | None = None) -> Figure:
    """Draw the enthalpy above, the apparent specific heat below.

    Parameters
    ----------
    curves : sequence of CapacityCurve
        The curves.
    ax : sequence of two matplotlib.axes.Axes, optional
        Where to draw; a new figure when absent.

    Returns
    -------
    matplotlib.figure.Figure
        The figure of the axes.

    Raises
    ------
    InputError
        Another number of axes.

    Examples
    --------
    >>> figure = draw([CapacityCurve("wax, heating", 0, "-", [20, 30], [0, 2e5], [25], [2e4])])
    >>> [axes.get_ylabel() for axes in figure.axes]
    ['enthalpy [kJ/kg]', 'apparent specific heat [kJ/(kg K)]']
    """
    import numpy as np

    above, below = axes_for(ax, ["kJ/kg", "kJ/(kg K)"])
    for curve in curves:
        look: dict[str, Any] = {
            "linestyle": curve.style,
            "color": colors.look(curve.family).color,
            "label": curve.label,
        }
        above.plot(curve.temperature, np.asarray(curve.enthalpy) / 1000.0, **look)
        below.plot(curve.middle, np.asarray(curve.specific_heat) / 1000.0, **look)
    above.set_ylabel("enthalpy [kJ/kg]")
    below.set_ylabel("apparent specific heat [kJ/(kg K)]")
    below.set_xlabel(bracketed("temperature", shown("degC")))
    for axes in (above, below):
        axes.grid(visible=True, alpha=0.3)
        axes.legend(frameon=False, fontsize="small")
    figure = above.get_figure(root=True)
    assert figure is not None  # noqa: S101 (axes always have a figure)
    return figure


class Analysis(NamedTuple):
    """What was done to the signal of a run.

    Attributes
    ----------
    family : int
        Number of the color.
    temperature, baseline : array-like, shape (n,)
        Sensible heat below the peak. [degC, J/(kg K)]
    marks : sequence of float
        Onset and end. [degC]
    """

    family: int
    temperature: Any
    baseline: Any
    marks: Sequence[float]


def draw_analysis(axes: Axes, runs: Sequence[Analysis]) -> None:
    """Draw baseline, onset and end into the specific heat.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        With the apparent specific heat.
    runs : sequence of Analysis
        The runs.
    """
    import numpy as np

    for run in runs:
        color = colors.look(run.family).color
        axes.plot(
            run.temperature, np.asarray(run.baseline) / 1000.0, color=color, linewidth=0.8, linestyle="-.",
            label="baseline; onset, end" if run is runs[0] else None,
        )  # fmt: skip
        for mark in run.marks:
            axes.axvline(mark, color=color, linewidth=0.6, linestyle=":")
    axes.legend(frameon=False, fontsize="small")


def panels(groups: Mapping[str, Sequence[CapacityCurve]]) -> Figure:
    """Draw the enthalpy of many materials, each in a panel of its own, with the same scale upwards.

    Parameters
    ----------
    groups : mapping of str to sequence of CapacityCurve
        Title of the panel -> curves of the material.

    Returns
    -------
    matplotlib.figure.Figure
        A new figure.

    Examples
    --------
    >>> wax = CapacityCurve("wax, heating", 0, "-", [20, 30], [0, 2e5], [25], [2e4])
    >>> [axes.get_title() for axes in panels({"wax": [wax]}).axes if axes.get_visible()]
    ['wax']
    """
    import numpy as np
    from matplotlib.figure import Figure

    across = min(_MAX_COLUMNS, len(groups))
    rows = -(-len(groups) // across)
    figure = Figure(figsize=(2.2 * across, 1.9 * rows + 0.5), layout="constrained")
    cells = figure.subplots(rows, across, squeeze=False, sharey=True).ravel()
    for cell in cells[len(groups) :]:
        cell.set_visible(False)
    for cell, (title, curves) in zip(cells, groups.items(), strict=False):
        for number, curve in enumerate(curves):
            color = colors.look(number).color
            cell.plot(
                curve.temperature, np.asarray(curve.enthalpy) / 1000.0, color=color, ls=curve.style, lw=1.1
            )
        cell.set_title(title, fontsize="small")
        cell.tick_params(labelsize="x-small")
        cell.grid(alpha=0.3)
    figure.supxlabel("temperature [°C]", fontsize="small")
    figure.supylabel("enthalpy [kJ/kg]: heating (line), cooling (dashed)", fontsize="small")
    return figure

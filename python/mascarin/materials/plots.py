"""Plots of phase-change products: enthalpy and apparent specific heat over temperature."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from mascarin.errors import InputError
from mascarin.materials.library import Product, capacities, enthalpy_curves

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST: Final = 8
"""Largest number of products in one plot."""

FORMATS: Final = (".svg", ".png", ".pdf")
_STYLES: Final = {"heating": "-", "cooling": "--"}


def plot(chosen: Sequence[Product], file: Path) -> None:
    """Draw the curves of some products: enthalpy above, apparent specific heat below.

    Parameters
    ----------
    chosen : sequence of Product
        At most `MOST`.
    file : Path
        File to write: SVG, PNG or PDF.

    Raises
    ------
    InputError
        The file has another ending, there are too many products, or none of them has a curve.
    """
    drawn = [one for one in chosen if any(enthalpy_curves(one))]
    if not drawn or len(drawn) > MOST:
        names = ", ".join(one.name for one in chosen[:MOST]) or "nothing"
        found = f"{len(drawn)} products with curves" if drawn else f"no curve of {names}"
        raise InputError(
            f"--plot: found {found}; expected 1 to {MOST} products with curves; narrow the search"
        )
    with_figure(file, lambda above, below: _draw(drawn, above, below))


def with_figure(file: Path, draw: Callable[[Axes, Axes], None]) -> None:
    """Write two plots, one above the other, that `draw(above, below)` fills.

    Parameters
    ----------
    file : Path
        File to write: SVG, PNG or PDF.
    draw : callable
        Takes the two axes.

    Raises
    ------
    InputError
        The file has another ending.
    """
    if file.suffix.lower() not in FORMATS:
        raise InputError(f"--plot: found '{file}'; expected a file ending in {', '.join(FORMATS)}")
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.0, 7.0), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    draw(above, below)
    above.set_ylabel("enthalpy [kJ/kg]")
    below.set_ylabel("apparent specific heat [kJ/(kg K)]")
    below.set_xlabel("temperature [degC]")
    for axes in (above, below):
        axes.grid(visible=True, alpha=0.3)
        axes.legend(frameon=False, fontsize="small")
    figure.savefig(file)


def _draw(chosen: Sequence[Product], above: Axes, below: Axes) -> None:
    for number, one in enumerate(chosen):
        for what, temperatures, enthalpies in enthalpy_curves(one):
            color, style, label = f"C{number}", _STYLES.get(what, "-"), f"{one.name}, {what}"
            above.plot(temperatures, [h / 1000.0 for h in enthalpies], style, color=color, label=label)
            middles, heats = zip(*capacities(temperatures, enthalpies), strict=True)
            below.plot(middles, [c / 1000.0 for c in heats], style, color=color, label=label)

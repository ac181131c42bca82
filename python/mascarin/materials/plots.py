"""Plots of phase-change products: enthalpy and apparent specific heat over temperature."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

from mascarin.errors import InputError
from mascarin.figures import melting
from mascarin.materials.library import Product, capacities, enthalpy_curves

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST: Final = 8
"""Largest number of products on the same axes; more have a panel each."""

_STYLES: Final = {"heating": "-", "cooling": "--"}


def plot(chosen: Sequence[Product], ax: Sequence[Axes] | None = None) -> Figure:
    """Draw the curves of some products: enthalpy above, apparent specific heat below.

    More than `MOST` products have a panel each, with the enthalpy alone.

    Parameters
    ----------
    chosen : sequence of Product
        Any number; at most `MOST` where axes are given.
    ax : sequence of two matplotlib.axes.Axes, optional
        Where to draw; a new figure when absent.

    Returns
    -------
    matplotlib.figure.Figure
        The figure of the axes.

    Raises
    ------
    InputError
        There are too many products for the given axes, or none of them has a curve.
    """
    shown = [item for item in chosen if any(enthalpy_curves(item))]
    if len(shown) > MOST and ax is None:
        return melting.panels({item.name: list(_curves([item])) for item in shown})
    if not shown or len(shown) > MOST:
        names = ", ".join(item.name for item in chosen[:MOST]) or "nothing"
        text = f"{len(shown)} products with curves" if shown else f"no curve of {names}"
        raise InputError(f"plot: found {text}; expected 1 to {MOST} products with curves; narrow the search")
    return melting.draw(list(_curves(shown)), ax)


def _curves(chosen: Sequence[Product]) -> Iterator[melting.CapacityCurve]:
    for number, item in enumerate(chosen):
        for what, temperatures, enthalpies in enthalpy_curves(item):
            middles, heats = zip(*capacities(temperatures, enthalpies), strict=True)
            label, style = f"{item.name}, {what}", _STYLES.get(what, "-")
            yield melting.CapacityCurve(label, number, style, temperatures, enthalpies, middles, heats)

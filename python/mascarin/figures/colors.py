"""Colors of all figures, in files and on pages.

A series, a model or a parameter has one color everywhere, the same on light and on dark paper: every color
has a contrast of at least 3 on both (WCAG 2.2, criterion 1.4.11). Any two colors of `PALETTE`, and the gray
of the measurements, differ by at least 9 (CIEDE2000) for readers with normal color vision, protanopia,
deuteranopia and tritanopia (Machado, Oliveira & Fernandes 2009, doi:10.1109/TVCG.2009.113).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

PALETTE: Final = (
    "#0078b4", "#d25a00", "#00a55a", "#a578ff", "#a53c87", "#00784b", "#e16996", "#b43c0f",
)  # fmt: skip
MEASURED: Final = "#787878"
"""Observations, drawn as points."""
FITTED: Final = PALETTE[0]
NOMINAL: Final = PALETTE[1]
INK: Final = "#333333"
"""Axes, texts and lines of reference; on a page the color of its text."""
REMAINDER: Final = "#9aa0a8"
"""What is left of a whole."""
_MODELS: Final = {"fitted": FITTED, "nominal": NOMINAL}
_DASHES: Final[tuple[object, ...]] = ("-", (0, (5, 2)), (0, (1, 1.5)), (0, (5, 1.5, 1, 1.5)))
_HATCHES: Final = ("", "//", "..", "xx")


@dataclass(frozen=True)
class Look:
    """How one of several series is drawn.

    Attributes
    ----------
    color : str
        One of `PALETTE`.
    round : int
        0 for the first series of a color, 1 for the second, ...

    Examples
    --------
    >>> look(9).color == look(1).color, look(9).dash == look(1).dash
    (True, False)
    """

    color: str
    round: int = 0

    @property
    def dash(self) -> object:
        """Style of its line, as matplotlib takes it."""
        return _DASHES[self.round % len(_DASHES)]

    @property
    def hatch(self) -> str:
        """Pattern of its area, as matplotlib takes it."""
        return _HATCHES[self.round % len(_HATCHES)]


def look(number: int) -> Look:
    """How the series of a number is drawn.

    Parameters
    ----------
    number : int
        Place of the series among all series of its kind, from 0.

    Returns
    -------
    Look
        After the last color the first one comes again with another line and another pattern.

    Examples
    --------
    >>> look(0)
    Look(color='#0078b4', round=0)
    """
    return Look(PALETTE[number % len(PALETTE)], number // len(PALETTE))


def models(names: Iterable[str]) -> dict[str, str]:
    """Color of each model: fixed for ``fitted`` and ``nominal``, then one after the other.

    Parameters
    ----------
    names : iterable of str
        All models of a study, in their order.

    Examples
    --------
    >>> models(["nominal", "fitted", "other"])
    {'nominal': '#d25a00', 'fitted': '#0078b4', 'other': '#00a55a'}
    """
    further = [name for name in names if name not in _MODELS]
    free = PALETTE[len(_MODELS) :]
    return {
        name: _MODELS[name] if name in _MODELS else free[further.index(name) % len(free)]
        for name in [*(n for n in names if n in _MODELS), *further]
    }


def parameters(shares: Mapping[str, Mapping[str, float]], most: int) -> dict[str, Look]:
    """Look of the parameters that figures of a sensitivity analysis name.

    Parameters
    ----------
    shares : mapping of str to mapping of str to float
        Output -> parameter -> index.
    most : int
        Parameters that are named for each output, those with the largest indices.

    Returns
    -------
    dict of str to Look
        The parameter with the largest index of all outputs comes first.

    Examples
    --------
    >>> list(parameters({"room": {"a": 0.2, "b": 0.7}, "gap": {"a": 0.9, "c": 0.1}}, 1))
    ['a', 'b']
    """
    largest: dict[str, float] = {}
    for share_of in shares.values():
        for name in strongest(share_of, most):
            largest[name] = max(largest.get(name, 0.0), share_of[name])
    return {name: look(number) for number, name in enumerate(strongest(largest, len(largest)))}


def strongest(shares: Mapping[str, float], most: int) -> Sequence[str]:
    """Parameters with the largest indices, the largest first.

    Parameters
    ----------
    shares : mapping of str to float
        Parameter -> index.
    most : int
        How many.

    Examples
    --------
    >>> strongest({"a": 0.2, "b": 0.7}, 1)
    ['b']
    """
    # NaN, which is not equal to itself, comes last.
    return sorted(shares, key=lambda name: -shares[name] if shares[name] == shares[name] else 1.0)[:most]

"""Energy balance of the building."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

from markupsafe import Markup

from mascarin.figures import text
from mascarin.figures.svg.chart import Svg
from mascarin.pages.study.data.labels import model_label
from mascarin.pages.study.data.series import Series
from mascarin.study_document.comparison import LedgerEntry
from mascarin.study_document.document import StudyDocument

TITLE = "Energy balance"
_MJ_PER_KWH: Final = 3.6


def content(study: StudyDocument, _series: Series) -> dict[str, Any] | None:
    """Values of the template."""
    ledger = study.ledger
    if ledger.closure is None and not ledger.terms:
        return None
    return {
        "closure": text.significant(ledger.closure, 2),
        "drawing": ledger_bars(ledger),
        "model": model_label(study, ledger.model),
    }


@dataclass(frozen=True)
class _Shape:
    """Sizes of the bars of an energy balance [px]: in the narrow one, names are above their bars."""

    width: float
    row: float
    middle: float
    half: float
    drop: float


_WIDE: Final = _Shape(680.0, 26.0, 480.0, 100.0, 0.0)
_NARROW: Final = _Shape(520.0, 38.0, 260.0, 170.0, 15.0)


def ledger_bars(ledger: LedgerEntry, *, narrow: bool = False) -> Markup | None:
    """Terms of the energy balance as bars about zero.

    Parameters
    ----------
    ledger : LedgerEntry
        The energy balance.
    narrow : bool
        Names above the bars, for half a page.
    """
    terms = [(term.label, float(term.value)) for term in ledger.terms if term.value is not None]
    if not terms:
        return None
    shape = _NARROW if narrow else _WIDE
    largest = max(abs(value) for _, value in terms) or 1.0
    # All with the digits of the largest one.
    decimals = max(0, 3 - math.floor(math.log10(largest / _MJ_PER_KWH)))
    height = 8.0 + shape.row * len(terms)
    svg = Svg(shape.width, height)
    for row, (label, value) in enumerate(terms):
        y = 4.0 + shape.row * row
        end = shape.middle + shape.half * value / largest
        svg.label(0.0, y + (11.0 if narrow else 16.0), label, "layer-name")
        svg.add(
            "rect",
            x=min(shape.middle, end),
            y=y + 4.0 + shape.drop,
            width=max(abs(end - shape.middle), 0.5),
            height=16.0 if not narrow else 13.0,
            class_="gain" if value >= 0 else "loss",
        )
        words = f"{text.fixed(value / _MJ_PER_KWH, decimals)}\u00a0kWh"
        side, anchor = (6.0, "start") if value >= 0 else (-6.0, "end")
        svg.label(end + side, y + 15.0 + shape.drop, words, "layer-name", anchor)
    if not narrow:
        svg.line(shape.middle, 0.0, shape.middle, height, "axis")
    return svg.markup("Heat flows of the energy balance")

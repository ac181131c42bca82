"""Energy balance of the building."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from markupsafe import Markup

from mascarin.figures import text
from mascarin.figures.svg.chart import Svg
from mascarin.pages.study.data.labels import model_label
from mascarin.pages.study.data.series import Series

TITLE = "Energy balance"


def content(study: Mapping[str, Any], _series: Series) -> dict[str, Any] | None:
    """Values of the template."""
    ledger = study.get("ledger")
    if not ledger:
        return None
    return {
        "closure": text.significant(ledger.get("closure"), 2),
        "drawing": ledger_bars(ledger),
        "rows": [
            {"label": str(t.get("label", "")), "value": text.significant(t.get("value"), 4)}
            for t in ledger.get("terms", [])
        ],
        "model": model_label(study, ledger.get("model")),
    }


def ledger_bars(ledger: Mapping[str, Any]) -> Markup | None:
    """Terms of the energy balance as bars about zero.

    Parameters
    ----------
    ledger : mapping
        As in :class:`~mascarin.pages.study.data.schema.Ledger`.
    """
    terms = [t for t in ledger.get("terms", []) if t.get("value") is not None]
    if not terms:
        return None
    largest = max(abs(float(t["value"])) for t in terms) or 1.0
    svg = Svg(680.0, 8.0 + 26.0 * len(terms))
    middle, half = 480.0, 100.0
    for row, term in enumerate(terms):
        value = float(term["value"])
        y = 4.0 + 26.0 * row
        length = half * value / largest
        svg.label(0.0, y + 16.0, str(term.get("label", "")), "layer-name")
        kind = "gain" if value >= 0 else "loss"
        svg.add(
            "rect",
            x=min(middle, middle + length),
            y=y + 4.0,
            width=max(abs(length), 0.5),
            height=16.0,
            class_=kind,
        )
        x = middle + length + (6.0 if value >= 0 else -6.0)
        shown = f"{text.significant(value, 4)}\u00a0MJ"
        svg.label(x, y + 16.0, shown, "layer-name", "start" if value >= 0 else "end")
    svg.line(middle, 0.0, middle, 8.0 + 26.0 * len(terms), "axis")
    return svg.markup("Heat flows of the energy balance")

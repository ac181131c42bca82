"""A small writer of SVG and a small chart on top of it.

Elements have classes instead of colors; the style sheet of the page gives them their color in light and dark
mode and in print. All text is escaped. Figures that exist outside of the report are in `mascarin.figures`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np
import numpy.typing as npt
from markupsafe import Markup, escape

from mascarin.figures import text

#: Width of a letter of the name of a mark. [px]
_LETTER: Final = 6.2

Array = npt.NDArray[np.float64]
Attribute = str | float | int


class Svg:
    """A drawing of fixed logical size.

    Parameters
    ----------
    width, height : float
        Size of the view box. [px]
    """

    def __init__(self, width: float, height: float) -> None:
        self.width, self.height = width, height
        self._parts: list[Markup] = []

    def add(self, tag: str, content: str | None = None, **attributes: Attribute) -> None:
        """Append an element; underscores in attribute names stand for hyphens (``class_`` for ``class``)."""
        written = Markup("").join(
            Markup(' {}="{}"').format(escape(name.rstrip("_").replace("_", "-")), _shown(value))
            for name, value in attributes.items()
        )
        name = escape(tag)
        if content is None:
            self._parts.append(Markup("<{}{}/>").format(name, written))
        else:
            self._parts.append(Markup("<{}{}>{}</{}>").format(name, written, content, name))

    def label(self, x: float, y: float, content: str, class_: str = "", anchor: str = "start") -> None:
        """Append a text."""
        self.add("text", content, x=x, y=y, class_=f"t {class_}".strip(), text_anchor=anchor)

    def line(self, x1: float, y1: float, x2: float, y2: float, class_: str) -> None:
        """Append a straight line."""
        self.add("line", x1=x1, y1=y1, x2=x2, y2=y2, class_=class_)

    def polyline(self, points: Array, class_: str) -> None:
        """Append a curve through points, shape (n, 2), broken where a coordinate is not finite. [px]"""
        commands = []
        pen_down = False
        for x, y in points:
            if not (math.isfinite(x) and math.isfinite(y)):
                pen_down = False
                continue
            commands.append(f"{'L' if pen_down else 'M'}{_short(x)} {_short(y)}")
            pen_down = True
        if commands:
            self.add("path", d="".join(commands), class_=class_)

    def polygon(self, points: Array, class_: str) -> None:
        """Append a filled outline, shape (n, 2). [px]"""
        self.add("polygon", points=" ".join(f"{_short(x)},{_short(y)}" for x, y in points), class_=class_)

    def markup(self, title: str, class_: str = "") -> Markup:
        """Finish the drawing.

        Parameters
        ----------
        title : str
            Description for readers who do not see the drawing.
        class_ : str
            Further classes of the element.
        """
        view = f"0 0 {_short(self.width)} {_short(self.height)}"
        return Markup('<svg class="{}" viewBox="{}" role="img" aria-label="{}">{}</svg>').format(
            f"figure-svg {class_}".strip(), view, title, Markup("").join(self._parts)
        )


@dataclass(frozen=True)
class Axis:
    """Range and marks of one direction of a chart."""

    low: float
    high: float
    ticks: Sequence[float] = ()
    names: Sequence[str] = ()

    @classmethod
    def over(cls, *values: Array | Sequence[float], count: int = 5, around: float | None = None) -> Axis:
        """Axis with round marks that holds all finite values.

        Parameters
        ----------
        values : arrays
            What is to be shown.
        count : int
            About how many marks. [-]
        around : float, optional
            A value that the axis must hold too.
        """
        parts = [np.asarray(v, dtype=np.float64).ravel() for v in values]
        joined = np.concatenate(parts) if parts else np.empty(0)
        joined = joined[np.isfinite(joined)]
        if around is not None:
            joined = np.append(joined, around)
        if not joined.size:
            return cls(0.0, 1.0, (0.0, 1.0), ("0", "1"))
        ticks = round_marks(float(joined.min()), float(joined.max()), count)
        return cls(ticks[0], ticks[-1], ticks, tick_names(ticks))


def round_marks(low: float, high: float, count: int = 5) -> list[float]:
    """Round numbers at equal distances that enclose an interval."""
    if high - low < 1e-12 * max(1.0, abs(low), abs(high)):
        half = max(abs(low), 1.0) * 0.5
        low, high = low - half, high + half
    raw = (high - low) / max(1, count - 1)
    size = 10.0 ** math.floor(math.log10(raw))
    step = next(m * size for m in (1.0, 2.0, 2.5, 5.0, 10.0) if m * size >= raw * (1.0 - 1e-9))
    first, last = math.floor(low / step + 1e-9), math.ceil(high / step - 1e-9)
    return [i * step for i in range(first, last + 1)]


def tick_names(ticks: Sequence[float]) -> list[str]:
    """Marks as text with as many decimals as they need."""
    step = ticks[1] - ticks[0] if len(ticks) > 1 else 1.0
    decimals = 0
    while decimals < 6 and abs(step * 10**decimals - round(step * 10**decimals)) > 1e-6:
        decimals += 1
    return [text.fixed(t, decimals) for t in ticks]


@dataclass
class Chart:
    """A chart: axes drawn at once, then curves, bars and bands in data coordinates.

    Parameters
    ----------
    x, y : Axis
        Axes.
    width, height : float
        Size. [px]
    x_label, y_label : str
        Names of the axes with their units.
    """

    x: Axis
    y: Axis
    width: float = 340.0
    height: float = 200.0
    x_label: str = ""
    y_label: str = ""
    margin_left: float = 40.0
    margin_right: float = 8.0
    margin_top: float = 20.0
    margin_bottom: float = 34.0
    svg: Svg = field(init=False)

    def __post_init__(self) -> None:
        """Draw the frame."""
        self.svg = Svg(self.width, self.height)
        self._frame()

    def _frame(self) -> None:
        bottom = self.height - self.margin_bottom
        for value, name in zip(self.y.ticks, self.y.names, strict=True):
            y = self.py(value)
            self.svg.line(
                self.margin_left,
                y,
                self.width - self.margin_right,
                y,
                "grid zero" if value == 0.0 else "grid",
            )
            self.svg.label(self.margin_left - 5, y + 3.5, name, "tick", "end")
        for value, name in zip(self.x.ticks, self.x.names, strict=True):
            x = self.px(value)
            self.svg.line(x, bottom, x, bottom + 4, "tickmark")
            # A name that would leave the drawing ends with it.
            beyond = x + 0.5 * _LETTER * len(name) > self.width
            self.svg.label(
                self.width if beyond else x, bottom + 15, name, "tick", "end" if beyond else "middle"
            )
        self.svg.line(self.margin_left, bottom, self.width - self.margin_right, bottom, "axis")
        if self.y_label:
            self.svg.label(0, 11, self.y_label, "axis-label")
        if self.x_label:
            self.svg.label(self.width - self.margin_right, self.height - 3, self.x_label, "axis-label", "end")

    def px(self, value: float) -> float:
        """Horizontal place of a value. [px]"""
        span = (self.x.high - self.x.low) or 1.0
        return self.margin_left + (value - self.x.low) / span * (
            self.width - self.margin_left - self.margin_right
        )

    def py(self, value: float) -> float:
        """Vertical place of a value. [px]"""
        span = (self.y.high - self.y.low) or 1.0
        return (
            self.height
            - self.margin_bottom
            - (value - self.y.low) / span * (self.height - self.margin_top - self.margin_bottom)
        )

    def _points(self, xs: Array, ys: Array) -> Array:
        span_x = (self.x.high - self.x.low) or 1.0
        span_y = (self.y.high - self.y.low) or 1.0
        inner_x, inner_y = (
            self.width - self.margin_left - self.margin_right,
            self.height - self.margin_top - self.margin_bottom,
        )
        px = self.margin_left + (np.asarray(xs) - self.x.low) / span_x * inner_x
        py = self.height - self.margin_bottom - (np.asarray(ys) - self.y.low) / span_y * inner_y
        return np.column_stack([px, py])

    def curve(self, xs: Array, ys: Array, class_: str) -> None:
        """Draw a curve."""
        self.svg.polyline(self._points(xs, ys), f"line {class_}")

    def band(self, xs: Array, low: Array, high: Array, class_: str) -> None:
        """Draw the area between two curves."""
        xs, low, high = (np.asarray(v, dtype=np.float64) for v in (xs, low, high))
        good = np.isfinite(low) & np.isfinite(high)
        if good.any():
            up, down = self._points(xs[good], high[good]), self._points(xs[good], low[good])
            self.svg.polygon(np.vstack([up, down[::-1]]), class_)

    def bar(self, x_low: float, x_high: float, low: float, high: float, class_: str) -> None:
        """Draw a filled rectangle."""
        x0, x1 = sorted((self.px(x_low), self.px(x_high)))
        y0, y1 = sorted((self.py(low), self.py(high)))
        self.svg.add("rect", x=x0, y=y0, width=max(x1 - x0, 0.3), height=max(y1 - y0, 0.3), class_=class_)

    def level(self, value: float, class_: str, name: str = "") -> None:
        """Draw a horizontal line over the whole width."""
        y = self.py(value)
        self.svg.line(self.margin_left, y, self.width - self.margin_right, y, class_)
        if name:
            self.svg.label(self.width - self.margin_right, y - 3, name, "note", "end")

    def markup(self, title: str, class_: str = "") -> Markup:
        """Finish the chart."""
        return self.svg.markup(title, class_)


def _shown(value: Attribute) -> str | Markup:
    return _short(value) if isinstance(value, float) else escape(str(value))


def _short(value: float) -> str:
    return f"{value:.1f}".rstrip("0").rstrip(".") if abs(value) < 1e6 else f"{value:g}"

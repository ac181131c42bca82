"""Figures of `mascarin.figures` on the page, with the colors of its style sheet."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from typing import TYPE_CHECKING, Any, Final

from markupsafe import Markup

from mascarin.figures import colors
from mascarin.figures.page import embedded
from mascarin.figures.svg.axes import short_day

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# All other colors are the same on light and on dark paper.
_COLORS: Final = {colors.INK: "--soft"}
_FONT_SIZE: Final = 9.0  # points, as large as the other texts of figures


def axes(width: float, height: float, *, bottom: float = 20.0) -> Axes:
    """Axes of a small figure. [px]"""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width / 72.0, height / 72.0))
    left_margin, right_margin, top_margin = 34.0, 8.0, 16.0
    return figure.add_axes(
        (
            left_margin / width,
            bottom / height,
            (width - left_margin - right_margin) / width,
            (height - bottom - top_margin) / height,
        )
    )


def titled(ax: Axes, name: str) -> None:
    """Write the name of the vertical axis above it, and the numbers in the size of the page."""
    ax.set_ylabel("")
    box = ax.get_position()
    ax.set_title(name, loc="left", x=-box.x0 / box.width, fontsize=_FONT_SIZE, color=colors.INK, pad=5.0)
    ax.tick_params(labelsize=_FONT_SIZE, colors=colors.INK)
    ax.xaxis.label.set(fontsize=_FONT_SIZE, color=colors.INK)
    ax.locator_params(axis="y", nbins=5)


def days(ax: Axes, times: Sequence[datetime]) -> None:
    """Mark midnights with their dates."""
    from matplotlib import dates, ticker

    ax.set_xlim(times[0], times[-1])  # type: ignore[arg-type]
    length = (times[-1] - times[0]).total_seconds() / 86400.0
    ax.xaxis.set_major_locator(dates.DayLocator(interval=max(1, round(length / 6.0))))  # type: ignore[no-untyped-call]

    def date(value: float, _position: Any = None) -> str:
        return short_day(dates.num2date(value))  # type: ignore[no-untyped-call]

    ax.xaxis.set_major_formatter(ticker.FuncFormatter(date))


def markup_of(ax: Axes, description: str, key: str = "") -> Markup:
    """The figure of some axes as an element of the page; see `embedded`."""
    figure: Figure = ax.get_figure(root=True)  # type: ignore[assignment]
    return Markup(embedded(figure, description, _COLORS, key=key))  # noqa: S704 (texts are escaped by matplotlib)

"""Short descriptions of objects: text of at most fifteen lines, and HTML for notebooks."""

from __future__ import annotations

import html
import io
import re
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

MOST_LINES: Final = 15
_WIDTH: Final = 100  # characters


def text(title: str, rows: Iterable[tuple[str, str]]) -> str:
    """Describe an object in at most fifteen lines.

    Parameters
    ----------
    title : str
        First line, such as ``Building 'cell'``.
    rows : iterable of (str, str)
        Names and values; rows that do not fit are counted in the last line.

    Returns
    -------
    str
        Lines without a line end at the end.

    Examples
    --------
    >>> print(text("Building 'box'", [("zones", "room"), ("surfaces", "6")]))
    Building 'box'
      zones     room
      surfaces  6
    """
    pairs = list(rows)
    most = MOST_LINES - 1
    shown = pairs if len(pairs) <= most else pairs[: most - 1]
    width = max((len(name) for name, _ in shown), default=0)
    lines = [title, *(_cut(f"  {name:<{width}}  {value}".rstrip()) for name, value in shown)]
    if len(shown) < len(pairs):
        lines.append(f"  ... {len(pairs) - len(shown)} more")
    return "\n".join(lines)


def page(
    title: str,
    rows: Iterable[tuple[str, str]],
    *,
    tables: Mapping[str, pd.DataFrame] | None = None,
    figures: Mapping[str, Figure] | None = None,
) -> str:
    """Describe an object in HTML: rows, then tables and figures that open at a click.

    Parameters
    ----------
    title : str
        Heading.
    rows : iterable of (str, str)
        Names and values, always shown.
    tables : mapping of str to pandas.DataFrame, optional
        Tables by heading.
    figures : mapping of str to matplotlib.figure.Figure, optional
        Figures by heading, drawn as SVG.

    Returns
    -------
    str
        HTML in which everything from outside is escaped.
    """
    cells = "".join(map(_row, rows))
    parts = [f"<div><strong>{html.escape(title)}</strong><table>{cells}</table>"]
    for heading, table in (tables or {}).items():
        parts.append(_folded(heading, table.to_html(max_rows=30, border=0)))
    for heading, figure in (figures or {}).items():
        parts.append(_folded(heading, svg(figure)))
    return "".join([*parts, "</div>"])


def _row(row: tuple[str, str]) -> str:
    """A name and a value; without a name, as for further values of the name above, there is no empty head."""
    name, value = map(html.escape, row)
    head = "th" if name else "td"
    style = "style='text-align:left'"
    return f"<tr><{head} {style}>{name}</{head}><td {style}>{value}</td></tr>"


def svg(figure: Figure) -> str:
    """Draw a figure as an SVG element for use inside HTML."""
    buffer = io.StringIO()
    figure.savefig(buffer, format="svg")
    return re.sub(r"^.*?(?=<svg)", "", buffer.getvalue(), count=1, flags=re.DOTALL)


def _folded(heading: str, content: str) -> str:
    return f"<details><summary>{html.escape(heading)}</summary>{content}</details>"


def _cut(line: str) -> str:
    return line if len(line) <= _WIDTH else line[: _WIDTH - 3] + "..."

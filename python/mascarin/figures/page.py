"""Figures inside an HTML page, with colors that the style sheet of the page decides."""

from __future__ import annotations

import hashlib
import html
import io
import re
from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def embedded(figure: Figure, description: str, colors: Mapping[str, str], *, key: str = "") -> str:
    """Draw a figure as an SVG element for an HTML page.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure; its backgrounds become transparent.
    description : str
        Text for readers who do not see the figure.
    colors : mapping of str to str
        Color of the figure, such as ``#0072b2`` -> CSS variable, such as ``--c0``.
    key : str
        Name of the place on the page, for a figure that is shown at several.

    Returns
    -------
    str
        The element. Its identifiers differ from those of other figures and places.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> figure = Figure()
    >>> line = figure.subplots().plot([1, 2], color="#0072b2")
    >>> element = embedded(figure, "A line", {"#0072b2": "--c0"})
    >>> "stroke: var(--c0)" in element, "#0072b2" in element
    (True, False)
    """
    import matplotlib as mpl

    figure.patch.set_visible(False)
    for ax in figure.axes:
        ax.patch.set_visible(False)
    file = io.StringIO()
    with mpl.rc_context({"svg.hashsalt": "mascarin", "svg.fonttype": "none"}):
        figure.savefig(file, format="svg", metadata={"Date": None})
    drawing = re.sub(r"<metadata>.*?</metadata>|<defs>\s*<style.*?</defs>", "", file.getvalue(), flags=re.S)
    view = re.search(r'viewBox="([^"]+)"', drawing)
    inner = re.search(r"<svg[^>]*>(.*)</svg>", drawing, flags=re.S)
    if view is None or inner is None:
        raise ValueError("no SVG")
    content = inner.group(1).replace("xlink:href", "href")
    content = re.sub(r"#[0-9a-f]{6}\b", lambda match: _color(match.group(), colors), content)
    content = re.sub(r"'DejaVu Sans'[^;\"]*", "var(--sans)", content)
    content = re.sub(r"\n\s*", " ", content)
    return (
        f'<svg class="figure-svg" viewBox="{view.group(1)}" role="img" '
        f'aria-label="{html.escape(description)}">{_unique(content, key + description)}</svg>'
    )


def _color(color: str, colors: Mapping[str, str]) -> str:
    return f"var({colors[color]})" if color in colors else color


def _unique(content: str, mark: str) -> str:
    """Remove identifiers without references, and make the others different from those of other figures."""
    used = set(re.findall(r'(?:href="|url\()#([^")]+)', content))
    mark = "f" + hashlib.sha256((mark + content).encode()).hexdigest()[:8]
    content = re.sub(
        r' id="([^"]+)"', lambda match: f' id="{mark}{match[1]}"' if match[1] in used else "", content
    )
    return re.sub(r'(href="|url\()#', rf"\1#{mark}", content)

"""Figures as files."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING, Final

from mascarin._io import atomic
from mascarin.errors import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FORMATS: Final = (".svg", ".png", ".pdf")


def require_format(path: Path, option: str) -> None:
    """Refuse a file that is no picture, before anything is calculated for it.

    Parameters
    ----------
    path : Path
        Where a figure is to be written.
    option : str
        Option of the command, for the message.

    Raises
    ------
    InputError
        The file has another ending than `FORMATS`.

    Examples
    --------
    >>> require_format(Path("a.svg"), "--plot")
    """
    if path.suffix.lower() not in FORMATS:
        raise InputError(f"{option}: found '{path}'; expected a file ending in {', '.join(FORMATS)}")


def save(figure: Figure, path: Path) -> Path:
    """Write a figure as SVG; the same figure gives the same bytes.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        What to write.
    path : Path
        Where to; missing folders are made.

    Returns
    -------
    Path
        The file.

    Examples
    --------
    >>> import tempfile
    >>> from matplotlib.figure import Figure
    >>> file = save(Figure(), Path(tempfile.mkdtemp()) / "figures" / "empty.svg")
    >>> file.read_text().startswith("<?xml")
    True
    """
    import matplotlib as mpl

    text = io.StringIO()
    with mpl.rc_context({"svg.hashsalt": "mascarin", "svg.fonttype": "none"}):
        figure.savefig(text, format="svg", metadata={"Date": None})
    path.parent.mkdir(parents=True, exist_ok=True)
    return atomic.write(path, text.getvalue())

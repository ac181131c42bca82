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
    """Write a figure as SVG or PDF; the same figure gives the same bytes.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        What to write.
    path : Path
        Where to, ending in ``.svg`` or ``.pdf``; missing folders are made.

    Returns
    -------
    Path
        The file.

    Examples
    --------
    >>> import tempfile
    >>> from matplotlib.figure import Figure
    >>> folder = Path(tempfile.mkdtemp()) / "figures"
    >>> save(Figure(), folder / "empty.svg").read_text().startswith("<?xml")
    True
    >>> save(Figure(), folder / "empty.pdf").read_bytes()[:5]
    b'%PDF-'
    """
    import matplotlib as mpl

    kind = path.suffix.lower().removeprefix(".")
    file = io.BytesIO()
    with mpl.rc_context({"svg.hashsalt": "mascarin", "svg.fonttype": "none"}):
        figure.savefig(
            file, format=kind, dpi=150, metadata={"Date" if kind == "svg" else "CreationDate": None}
        )
    path.parent.mkdir(parents=True, exist_ok=True)
    return atomic.write(path, file.getvalue())


def save_both(figure: Figure, path: Path) -> list[Path]:
    """Write a figure as SVG and as PDF.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        What to write.
    path : Path
        Where to, without ending.

    Returns
    -------
    list of Path
        The two files.

    Examples
    --------
    >>> import tempfile
    >>> from matplotlib.figure import Figure
    >>> [file.name for file in save_both(Figure(), Path(tempfile.mkdtemp()) / "empty")]
    ['empty.svg', 'empty.pdf']
    """
    first = save(figure, path.with_name(f"{path.name}.svg"))
    figure.set_layout_engine("none")  # the places are found
    return [first, save(figure, path.with_name(f"{path.name}.pdf"))]

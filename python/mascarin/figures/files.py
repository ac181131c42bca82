"""Figures as files."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from mascarin._io import atomic
from mascarin.errors import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FORMATS: Final = (".svg", ".png", ".pdf")
#: Resolution of pictures, and of what is a picture in a drawing. [1/inch]
_DPI: Final = 150


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
        if kind in ("svg", "pdf"):
            _write_once(figure, file, kind)
        else:
            figure.savefig(file, format=kind, dpi=_DPI, metadata={"CreationDate": None})
    path.parent.mkdir(parents=True, exist_ok=True)
    return atomic.write(path, file.getvalue())


def _write_once(figure: Figure, file: io.BytesIO, kind: str) -> None:
    """Write a figure as SVG or PDF and draw it once; `savefig` draws it twice if it has a layout."""
    from matplotlib.backends.backend_pdf import FigureCanvasPdf
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    before, canvas = (figure.canvas, figure.dpi), FigureCanvasSVG if kind == "svg" else FigureCanvasPdf
    now: Any = canvas(figure)
    engine = figure.get_layout_engine()
    if engine is not None:
        figure.dpi = now.fixed_dpi  # texts are as long as in the file
        engine.execute(figure)
        figure.set_layout_engine("none")  # the places are found, also for further files
    figure.dpi = _DPI
    metadata = {"Date" if kind == "svg" else "CreationDate": None}
    (now.print_svg if kind == "svg" else now.print_pdf)(file, metadata=metadata)
    figure.set_canvas(before[0])
    figure.dpi = before[1]


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
    return [save(figure, path.with_name(f"{path.name}.{kind}")) for kind in ("svg", "pdf")]

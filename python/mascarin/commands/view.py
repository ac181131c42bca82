"""The command that shows a building."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from mascarin._io.locks import writing
from mascarin.commands.options.inputs import Flag, Settings, Step, read_building, seconds
from mascarin.errors import InputError


def view(
    building: Path,
    /,
    *,
    out: Annotated[Path | None, Parameter(alias="-o")] = None,
    no_open: Annotated[bool, Flag] = False,
    step: Step = "15min",
    settings: Settings = None,
) -> None:
    """Show a building in three dimensions.

    Makes one HTML page and opens it in the browser: surfaces by construction, boundary, U value or zone,
    normals, windows, shades, layers to scale, warnings, and the path of the sun. The page needs no network.

    Parameters
    ----------
    building : Path
        Description of a building.
    out : Path
        File for the page (.html); it is written and not opened. Default: a file for this look alone.
    no_open : bool
        Write the page without opening it.
    """
    from mascarin.pages.view import write

    described = read_building(building, settings)
    target = page_file(out, building)
    with writing(target):
        write(described, target, seconds(step))
    print(f"wrote {target}", file=sys.stderr)
    if out is None and not no_open:
        open_page(target.resolve().as_uri(), target)


def page_file(out: Path | None, building: Path) -> Path:
    """File of a page: what is asked for, or a new one in the folder for temporary files.

    Raises
    ------
    InputError
        Its name does not end with .html.
    """
    if out is None:
        import tempfile

        return Path(tempfile.mkdtemp(prefix="mascarin-")) / f"{building.stem}.html"
    require_html("--out", out)
    return out


def require_html(option: str, file: Path | None) -> None:
    """Refuse a file that does not end with .html.

    Raises
    ------
    InputError
        It does not.
    """
    if file is not None and file.suffix.lower() not in (".html", ".htm"):
        raise InputError(f"{option}: found '{file}'; expected a file that ends with .html")


def open_page(address: str, shown: object) -> None:
    """Open a page in the browser, or say where it is."""
    import webbrowser

    if not webbrowser.open(address):
        print(f"no browser was found: open {shown}", file=sys.stderr)

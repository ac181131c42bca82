"""The report of a study: one HTML file that holds everything it shows.

The only input is what a study leaves behind: the content of ``study.json`` and its series
(:mod:`mascarin.report.payload`). Nothing is fetched: styles, scripts and pictures are part of the file, and
its content security policy forbids the browser to load anything else.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mascarin.report.series import Series

__all__ = ["render", "write", "write_folder"]


def render(study: Mapping[str, Any], series: Series) -> str:
    """Make the page.

    Parameters
    ----------
    study : mapping
        As in :class:`mascarin.report.schema.Study`.
    series : Series
        Curves; thinned if there are more values than a page should carry.

    Returns
    -------
    str
        HTML.

    Raises
    ------
    InputError
        The study has no title, or its parts do not fit together.
    """
    from mascarin.report.html import page
    from mascarin.report.payload import check, tidy

    check(study, series)
    return page(tidy(study), series.thinned())


def write_folder(out: Path) -> Path:
    """Make the page of a study that has been run, next to its other results.

    Parameters
    ----------
    out : Path
        Folder with ``study.json`` and ``tables/series.csv``.

    Returns
    -------
    Path
        ``report.html`` in that folder.

    Raises
    ------
    InputError
        A file is missing or cannot be read.
    """
    from mascarin.report.folder import read_folder

    return write(out / "report.html", *read_folder(out))


def write(path: Path, study: Mapping[str, Any], series: Series) -> Path:
    """Make the page and write it to a file, which appears only when it is complete.

    Parameters
    ----------
    path : Path
        Where to.
    study, series
        As for :func:`render`.

    Returns
    -------
    Path
        The file.
    """
    content = render(study, series)
    draft = path.with_name(path.name + ".part")
    draft.write_text(content, encoding="utf-8", newline="\n")
    draft.replace(path)
    return path

"""The report of a study: one HTML file without anything outside of it.

Its only input are the results of a study: the content of ``study.json``
(:mod:`mascarin.study_document`) and its series (:mod:`mascarin.pages.study.data.series`). Styles,
scripts and pictures are part of the file, and its content security policy forbids the browser to load
anything else.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from mascarin._io import atomic
from mascarin.errors import InputError
from mascarin.pages.study.data.folder import read_folder
from mascarin.pages.study.data.payload import check
from mascarin.pages.study.data.series import Column, Series
from mascarin.pages.study.html import page
from mascarin.study_document.document import StudyDocument

__all__ = ["Column", "Series", "is_report", "render", "write", "write_folder"]


_HEAD_BYTES: Final = 4096  # bytes


def render(study: StudyDocument | Mapping[str, Any], series: Series) -> str:
    """Make the page.

    Parameters
    ----------
    study : StudyDocument
        The results.
    series : Series
        Curves; they are thinned if there are too many values for a page.

    Returns
    -------
    str
        HTML.

    Raises
    ------
    InputError
        The study has no title, or its parts do not belong together.

    Examples
    --------
    >>> from mascarin.pages.study import Series, render
    >>> page = render({"title": "An empty study"}, Series("2024-01-01T00:00", 900.0))
    >>> "<h1>An empty study</h1>" in page
    True
    """
    document = StudyDocument.read(study)
    check(document, series)
    return page(document.without_repeated_periods(), series.thinned())


def write_folder(out: Path) -> Path:
    """Make the page of a study that has been run, in the folder of its results.

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

    Examples
    --------
    >>> import tempfile
    >>> from mascarin.pages.study import write_folder
    >>> write_folder(Path(tempfile.mkdtemp()))
    Traceback (most recent call last):
        ...
    mascarin.errors.InputError: ...study.json: No such file or directory; expected ...
    """
    from jinja2 import TemplateError

    try:
        return write(out / "report.html", *read_folder(out))
    except (LookupError, TypeError, ValueError, AttributeError, ArithmeticError, TemplateError) as error:
        raise InputError(
            f"{out / 'study.json'}: found results that cannot be shown ({type(error).__name__}: {error}); "
            "expected those that the study wrote. Run the study again"
        ) from error


def write(path: Path, study: StudyDocument | Mapping[str, Any], series: Series) -> Path:
    """Make the page and write it to a file.

    Parameters
    ----------
    path : Path
        File to write; its folder exists.
    study, series
        As for :func:`render`.

    Returns
    -------
    Path
        The file.

    Examples
    --------
    >>> import tempfile
    >>> from mascarin.pages.study import Series, write
    >>> file = Path(tempfile.mkdtemp()) / "report.html"
    >>> write(file, {"title": "An empty study"}, Series("2024-01-01T00:00", 900.0)).name
    'report.html'
    """
    return atomic.write(path, render(study, series))


def is_report(path: Path) -> bool:
    """Whether a file is a report of Mascarin; another page of the same name is not.

    Parameters
    ----------
    path : Path
        An existing file.

    Returns
    -------
    bool
        Whether its head names Mascarin as the program that made it.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "report.html"
    >>> is_report(write(file, {"title": "An empty study"}, Series("2024-01-01T00:00", 900.0)))
    True
    """
    with path.open("rb") as file:
        return b'<meta name="generator" content="Mascarin' in file.read(_HEAD_BYTES)


def __dir__() -> list[str]:
    return __all__

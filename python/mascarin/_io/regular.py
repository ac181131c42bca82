"""Input files: regular files only, and not more than memory can hold."""

from __future__ import annotations

import contextlib
import os
import stat
from collections.abc import Callable, Iterator
from contextvars import ContextVar
from pathlib import Path
from typing import Final

from mascarin._io import identity, memory
from mascarin.errors import InputError

_SPECIAL = {
    stat.S_IFIFO: "a named pipe",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
    stat.S_IFSOCK: "a socket",
}


#: What else is required of every file that is read, such as that it is inside a folder.
_REQUIRED: Final[ContextVar[Callable[[Path], object] | None]] = ContextVar("required", default=None)


def exists(path: str | Path) -> bool:
    """Whether a file or folder exists: not if the system cannot use its name (too long, a null character)."""
    return os.path.exists(path)  # noqa: PTH110 - the method of Path raises an error there


def is_file(path: str | Path) -> bool:
    """Whether a name is that of a regular file, as `exists`."""
    return os.path.isfile(path)  # noqa: PTH113 - the method of Path raises an error there


@contextlib.contextmanager
def requiring(check: Callable[[Path], object]) -> Iterator[None]:
    """Check every file that is read meanwhile, files that other files name included.

    Parameters
    ----------
    check : callable
        Raises an error for a file that may not be read.
    """
    token = _REQUIRED.set(check)
    try:
        yield
    finally:
        _REQUIRED.reset(token)


def require_text(path: Path) -> None:
    """Refuse a name of an output that is not text: files name others, and libraries open them by text.

    Parameters
    ----------
    path : Path
        File or folder.

    Raises
    ------
    InputError
        Its name, or that of a folder above it, is not UTF-8.

    Examples
    --------
    >>> require_text(Path("results"))
    """
    try:
        str(path.absolute()).encode()
    except UnicodeEncodeError:
        raise InputError(
            f"{str(path)!r}: found a name that is not UTF-8 text; expected one that other files can contain: "
            "choose another name or folder"
        ) from None


def special(path: Path) -> str | None:
    """What a path is, in words, if it is neither a file nor a folder; links are followed.

    Parameters
    ----------
    path : Path
        The path; there may be nothing.

    Returns
    -------
    str or None
        Such as ``a named pipe``.
    """
    try:
        return _SPECIAL.get(stat.S_IFMT(path.stat().st_mode))
    except (OSError, ValueError):  # nothing there; ValueError: a zero in the name
        return None


def require_regular(path: Path, expected: str = "a file", kind: str = "") -> Path:
    """Refuse what may never end (a pipe, a device) and what no memory holds, before it is opened.

    From now on the file is an input, which nothing is written onto; see `identity`.

    Parameters
    ----------
    path : Path
        File to read. That it is missing is said where it is opened.
    expected : str
        What it should be, in words.
    kind : str
        A kind that is written back over its own file; see `identity`.

    Returns
    -------
    Path
        The same path.

    Raises
    ------
    InputError
        It is a pipe, a device or a socket; it has no possible name; it is larger than the free memory; or it
        is an output of this command.

    Examples
    --------
    >>> require_regular(Path("/dev/zero"))  # doctest: +SKIP
    Traceback (most recent call last):
    mascarin.errors.InputError: /dev/zero: found a device, expected a file; copy its content to a file first
    """
    if "\0" in str(path):
        raise InputError(f"{str(path)!r}: found a name with a zero in it, expected {expected}")
    further = _REQUIRED.get()
    if further is not None:
        further(path)
    what = special(path)
    if what is not None:
        raise InputError(f"{path}: found {what}, expected {expected}; copy its content to a file first")
    identity.remember(path, kind)
    try:
        size = path.stat().st_size
    except OSError:
        return path
    memory.require(size, f"{path}: the file", "use a part of the file")
    return path

"""Files that appear complete or not at all."""

from __future__ import annotations

import contextlib
import errno
import glob
import os
import re
import shutil
import tempfile
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import BinaryIO, Final

from mascarin._io import identity
from mascarin._io.regular import special
from mascarin.errors import InputError

PART: Final = ".part"
"""Ending of a file that is being written; one that is found later was left by a killed process.

What a killed process left is removed by the next command that writes the same file or folder, which it holds
(`_io.locks`), and by any other writer in that folder after `OLD`: a process may still be writing before.
"""
#: Ending of the names of temporary files, by which they are known as our own.
_END: Final = f".mascarin{PART}"
OLD: Final = 86_400.0
"""Age from which no process is still writing a file. [s]"""


@contextlib.contextmanager
def replacing(path: Path, kind: str = "") -> Iterator[BinaryIO]:
    r"""Open a file for writing that takes the place of another only when it is complete.

    The content goes to a temporary file of a unique name in the same folder, is flushed to the disk, and is
    then renamed. Two processes that write the same file do not mix their content: the last one wins.

    Parameters
    ----------
    path : Path
        File to write; its folder exists.
    kind : str
        A kind that is written back over its own file; see `identity`.

    Yields
    ------
    BinaryIO
        The temporary file.

    Raises
    ------
    InputError
        It is an input, or no file.
    OSError
        The file cannot be written; the file that was there before is unchanged.

    Examples
    --------
    >>> import tempfile
    >>> target = Path(tempfile.mkdtemp()) / "table.csv"
    >>> with replacing(target) as file:
    ...     size = file.write(b"a,b\n")
    >>> target.read_text()
    'a,b\n'
    """
    _require_possible(path, kind)
    _remove_old(path.parent)
    with _named(path):
        handle, name = tempfile.mkstemp(prefix=_prefix(path), suffix=_END, dir=path.parent)
        draft = Path(name)
        try:
            with os.fdopen(handle, "wb") as file:
                yield file
                file.flush()
                os.fsync(file.fileno())
            draft.chmod(_usual_mode())
            identity.require_no_input(path, kind)
            draft.replace(path)
        except BaseException:
            draft.unlink(missing_ok=True)
            raise
    identity.written(path)
    _flush_folder(path.parent)


def _require_possible(path: Path, kind: str) -> None:
    """Name the folder that is missing, not the temporary file in it; keep inputs, pipes and devices."""
    identity.require_no_input(path, kind)
    what = special(path)
    if what is not None:
        raise InputError(f"{path}: found {what}, expected a file to write; choose another name")
    if not path.parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, f"cannot write {path.name}: no such folder", str(path.parent))
    if path.is_dir() and not path.is_symlink():
        raise InputError(
            f"{path}: found a folder, expected a file to write; remove the folder or choose another name"
        )


@contextlib.contextmanager
def _named(path: Path) -> Iterator[None]:
    """Put the name of the file into errors that have that of its temporary file, or none."""
    try:
        yield
    except Exception as error:
        draft = re.compile(
            rf"(?:{re.escape(str(path.parent))}[/\\])?{re.escape(_prefix(path))}[a-z0-9_]{{8}}{re.escape(_END)}"
            rf"(?:[/\\]{re.escape(path.name)})?"
        )
        if isinstance(error, OSError) and error.errno is not None:
            if error.filename is None or draft.fullmatch(str(error.filename)):
                raise OSError(error.errno, error.strerror, str(path)) from error
        else:
            error.args = tuple(
                draft.sub(lambda _: str(path), text) if isinstance(text, str) else text for text in error.args
            )
        raise


def _prefix(path: Path) -> str:
    """Beginning of the name of a temporary file; that of the file may be as long as the system allows."""
    return f".{path.name[:40]}."


@contextlib.contextmanager
def drafted(path: Path, kind: str = "") -> Iterator[Path]:
    """Give the name of a temporary file, for libraries that write to a name; see `replacing`.

    Parameters
    ----------
    path : Path
        File to write; its folder exists.
    kind : str
        A kind that is written back over its own file; see `identity`.

    Yields
    ------
    Path
        The temporary file, with the ending of `path`.

    Raises
    ------
    InputError
        It is an input, or no file.
    OSError
        The file cannot be written; the file that was there before is unchanged.
    """
    _require_possible(path, kind)
    _remove_old(path.parent)
    with (
        _named(path),
        tempfile.TemporaryDirectory(prefix=_prefix(path), suffix=_END, dir=path.parent) as folder,
    ):
        draft = Path(folder) / path.name
        yield draft
        with draft.open("rb+") as file:
            os.fsync(file.fileno())
        identity.require_no_input(path, kind)
        draft.replace(path)
    identity.written(path)
    _flush_folder(path.parent)


def write(path: Path, content: str | bytes, kind: str = "") -> Path:
    """Write a whole file at once; see `replacing`.

    Parameters
    ----------
    path : Path
        File to write.
    content : str or bytes
        Its content; text is written as UTF-8 with the line ends it has.
    kind : str
        A kind that is written back over its own file; see `identity`.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        It is an input, or no file.
    OSError
        The file cannot be written.
    """
    with replacing(path, kind) as file:
        # Names of files may have bytes that are no text; such a byte is written as an escape.
        file.write(content.encode("utf-8", "backslashreplace") if isinstance(content, str) else content)
    return path


def remove_drafts(folder: Path) -> None:
    """Remove incomplete files of killed processes from a folder that this process has locked."""
    _remove(folder.glob(f"*{PART}"))


def remove_drafts_of(path: Path) -> None:
    """Remove what killed processes left of one file; no other process may be writing it."""
    _remove(path.parent.glob(f"{glob.escape(_prefix(path))}*{PART}"))


def remove_named_drafts(folder: Path) -> None:
    """Remove what killed processes left in a folder that this process has locked, and that is not its own.

    Only names as `replacing` and `drafted` make them: other programs use the ending, too. What another
    process is writing under a lock of its own stays.
    """
    _remove(draft for draft in folder.glob(f".*{_END}") if _DRAFT.fullmatch(draft.name) and not _held(draft))


def _held(draft: Path) -> bool:
    """Whether there is a lock on the file of a draft, which its process removes at its end."""
    named = _DRAFT.fullmatch(draft.name)
    return named is not None and any(draft.parent.glob(f".{glob.escape(named[1])}*.lock"))


#: Folders in which old drafts have been looked for.
_cleaned: Final[set[Path]] = set()
_DRAFT: Final = re.compile(rf"\.(.+)\.[a-z0-9_]{{8}}{re.escape(_END)}")


def _remove_old(folder: Path) -> None:
    """Remove drafts of killed processes that no later command has found; once for a folder."""
    if folder in _cleaned:
        return
    _cleaned.add(folder)
    with contextlib.suppress(OSError):
        before = time.time() - OLD
        for draft in folder.glob(f".*{_END}"):
            if _DRAFT.fullmatch(draft.name) and draft.lstat().st_mtime < before:
                _remove([draft])


def _remove(drafts: Iterable[Path]) -> None:
    for draft in drafts:
        if draft.is_dir() and not draft.is_symlink():
            shutil.rmtree(draft, ignore_errors=True)
        else:
            draft.unlink(missing_ok=True)


def _usual_mode() -> int:
    """Permissions that a new file gets; temporary files are made readable to their owner alone."""
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask


def _flush_folder(folder: Path) -> None:
    """Flush the renaming to the disk, on systems that can flush a folder."""
    with contextlib.suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)

"""Outputs used by one process at a time, and refused before the work if they cannot be written."""

from __future__ import annotations

import contextlib
import hashlib
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Final, Self

from mascarin._io import atomic, identity
from mascarin._io.regular import require_text, special
from mascarin.errors import InputError, InUse

if TYPE_CHECKING:
    import filelock

NAME: Final = ".lock"
#: How long a lock is tried for. [s] A program that a killed process was just starting holds the open files of
#: that process for a moment, the lock among them.
_PATIENCE: Final = 1.0


class FolderLock:
    """A lock on a folder. The system releases it when the process ends, also when it is killed.

    Parameters
    ----------
    folder : Path
        The folder; it exists.
    file : Path, optional
        The file that is locked; default ``.lock`` in the folder.
    remove : bool
        Whether the file is removed at the end, so that only the results are in the folder.

    Raises
    ------
    InUse
        Another process holds the lock.
    InputError
        The folder cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> with FolderLock(Path(tempfile.mkdtemp())):
    ...     pass
    """

    def __init__(self, folder: Path, file: Path | None = None, *, remove: bool = False) -> None:
        self._file, self._remove = file or folder / NAME, remove
        self._lock = _acquired(
            self._file, f"{folder}: another process is writing to this folder", "another folder (-o)"
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.release()

    def release(self) -> None:
        """Release the lock; a second call changes nothing."""
        _release(self._lock, self._file if self._remove else None)


def _acquired(file: Path, held: str, other: str) -> filelock.BaseFileLock:
    """Lock a file, soon or not at all."""
    import filelock  # some commands write nothing

    if file.is_symlink():  # it would be emptied
        raise InputError(f"{file}: found a link, expected no such file; remove it")
    lock = filelock.FileLock(file, timeout=_PATIENCE)
    try:
        lock.acquire(poll_interval=0.02)
    except filelock.Timeout:
        raise InUse(
            f"{held}; expected one at a time. Wait until it has finished, or choose {other}"
        ) from None
    except OSError as error:
        raise InputError(f"{file.parent}: cannot be written ({error.strerror}); choose {other}") from None
    return lock


def _release(lock: filelock.BaseFileLock, remove: Path | None) -> None:
    if not lock.is_locked:
        return
    if remove is not None:
        # Before the release: whoever waits for the removed file finds that it has no name, and makes it anew.
        with contextlib.suppress(OSError):
            remove.unlink()
    lock.release()


@contextlib.contextmanager
def writing(*files: Path | None) -> Iterator[None]:
    """Hold output files for this process, and refuse those that cannot be written, before the work begins.

    Parameters
    ----------
    files : Path or None
        Files to write; None where an output is not wanted.

    Yields
    ------
    None
        While the files are held.

    Raises
    ------
    InputError
        There is no such folder, it cannot be written, the name is that of a folder, a pipe or a device, it
        is an input (read before, or while it is held), or another process is writing to the file.

    Examples
    --------
    >>> import tempfile
    >>> with writing(Path(tempfile.mkdtemp()) / "results.csv", None):
    ...     pass
    """
    with contextlib.ExitStack() as held:
        held.enter_context(identity.outputs(*(file for file in files if file is not None)))
        for file in files:
            if file is not None:
                _require_possible(file)
                _require_writable(file)
                # The name of the output may be as long as the system allows.
                resolved = file.resolve()
                name = (
                    resolved.name
                    if len(os.fsencode(resolved.name)) < 200
                    else hashlib.sha256(os.fsencode(resolved.name)).hexdigest()
                )
                guard = resolved.with_name(f".{name}{NAME}")
                taken = f"{file}: another process is writing to this file"
                held.callback(_release, _acquired(guard, taken, "another file"), guard)
                atomic.remove_drafts_of(file)
        yield


def _require_writable(file: Path) -> None:
    """Refuse a file that cannot be written; nothing is changed by trying."""
    kind = "a folder" if file.is_dir() else special(file)
    if kind is not None:
        raise InputError(f"{file}: found {kind}, expected a file to write; choose another name")
    if not file.parent.is_dir():
        raise InputError(f"{file}: expected an existing folder; make '{file.parent}' first")
    try:
        with tempfile.TemporaryFile(dir=file.parent):
            pass
    except OSError as error:
        raise InputError(f"{file}: cannot be written ({error.strerror}); choose another folder") from None


def _require_possible(path: Path) -> None:
    """Refuse a name that no system has."""
    if "\0" in str(path):
        raise InputError(f"{str(path)!r}: found a name with a zero in it; choose another name")
    require_text(path)


@contextlib.contextmanager
def writing_into(folder: Path | None) -> Iterator[None]:
    """Hold an output folder for this process; it is made, and removed again if nothing was written.

    Parameters
    ----------
    folder : Path or None
        The folder; None where no output is wanted.

    Yields
    ------
    None
        While the folder is held.

    Raises
    ------
    InputError
        The name is that of a file, the folder cannot be made or written, or another process is writing to it.

    Examples
    --------
    >>> import tempfile
    >>> with writing_into(Path(tempfile.mkdtemp()) / "results"):
    ...     pass
    """
    if folder is None:
        yield
        return
    _require_possible(folder)
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder}: found a file, expected a folder; choose another folder (-o)")
    before = folder.exists()
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{folder}: cannot be made ({error.strerror}); choose another folder (-o)") from None
    try:
        with FolderLock(folder, remove=True):
            atomic.remove_named_drafts(folder)
            yield
    finally:
        if not before:
            with contextlib.suppress(OSError):  # there is something in it
                folder.rmdir()

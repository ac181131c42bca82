"""A folder used by one process at a time."""

from __future__ import annotations

from pathlib import Path
from typing import Final, Self

import filelock

from mascarin.errors import InputError

NAME: Final = ".lock"


class FolderLock:
    """A lock on a folder. The system releases it when the process ends, also when it is killed.

    Parameters
    ----------
    folder : Path
        The folder; it exists.
    file : Path, optional
        The file that is locked; default ``.lock`` in the folder.

    Raises
    ------
    InputError
        Another process holds the lock.

    Examples
    --------
    >>> import tempfile
    >>> with FolderLock(Path(tempfile.mkdtemp())):
    ...     pass
    """

    def __init__(self, folder: Path, file: Path | None = None) -> None:
        self._lock = filelock.FileLock(file or folder / NAME, timeout=0)
        try:
            self._lock.acquire()
        except filelock.Timeout:
            raise InputError(
                f"{folder}: another process is writing to this folder; expected one at a time. Wait until it "
                "has finished, or choose another folder (-o)"
            ) from None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.release()

    def release(self) -> None:
        """Release the lock; a second call changes nothing."""
        self._lock.release()

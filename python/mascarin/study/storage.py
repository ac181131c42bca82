"""What a study keeps on disk while it works, so that a killed one goes on where it was.

Every file appears complete or not at all: it is written under another name and then renamed. The manifest
says which inputs the kept work belongs to.
"""

from __future__ import annotations

import hashlib
import json
import os
import sys
import warnings
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from mascarin.errors import InputError

if TYPE_CHECKING:
    from typing import Self

    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

_FOLDER = ".work"


def write_whole(path: Path, content: str | bytes) -> None:
    """Write a file that appears only when it is complete."""
    draft = path.with_name(path.name + ".part")
    with draft.open("wb") as file:
        file.write(content.encode() if isinstance(content, str) else content)
        file.flush()
        os.fsync(file.fileno())
    draft.replace(path)


class Lock:
    """A folder held by one process; the system lets go of it when the process ends, however it ends.

    Parameters
    ----------
    path : Path
        The file that is locked.
    folder : Path
        What it stands for, for the message.

    Raises
    ------
    InputError
        Another process holds it.
    """

    def __init__(self, path: Path, folder: Path) -> None:
        self._file = path.open("ab")
        try:
            _hold(self._file)
        except OSError:
            self._file.close()
            raise InputError(
                f"{folder}: another study is at work in this folder; expected one at a time: wait for it, or "
                "choose another -o"
            ) from None

    def release(self) -> None:
        """Let go; again and again does no harm."""
        self._file.close()


def _hold(file: BinaryIO) -> None:
    """Lock an open file for this process, at once or not at all; closing it lets go."""
    if sys.platform == "win32":
        import msvcrt

        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
    else:
        import fcntl

        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


class Workspace:
    """Unfinished work below a result folder.

    Parameters
    ----------
    out : Path
        The result folder; made when it is missing.
    inputs : mapping
        What the work belongs to: version, hashes, seeds.

    Raises
    ------
    InputError
        The folder is no folder, or another study works in it.
    """

    def __init__(self, out: Path, inputs: Mapping[str, Any]) -> None:
        if out.exists() and not out.is_dir():
            raise InputError(f"{out}: is a file; expected a folder for the results: choose another -o")
        self.out = out
        self.folder = out / _FOLDER
        self.folder.mkdir(parents=True, exist_ok=True)
        self._lock = Lock(self.folder / "lock", out)
        self._inputs = hashlib.sha256(json.dumps(inputs, sort_keys=True).encode()).hexdigest()
        manifest, text = self.folder / "manifest.json", json.dumps(inputs, indent=1, sort_keys=True)
        changed = _changed(manifest, inputs)
        if changed:
            warnings.warn(
                f"{out}: holds work on other inputs (different: {', '.join(changed)}); it cannot be "
                "continued, so everything is done anew",
                stacklevel=3,
            )
            self._clear("*.npy")
            self._clear("*.jsonl")
        # What was being written when the last run was killed.
        self._clear("*.part")
        write_whole(manifest, text)

    def __enter__(self) -> Self:
        """Keep others out until the end."""
        return self

    def __exit__(self, *error: object) -> None:
        """Let others in."""
        self._lock.release()

    def settle(self, command: str, files: Iterable[Path]) -> None:
        """Remember what a command has written, and remove what it, or work on other inputs, left before.

        Parameters
        ----------
        command : str
            Which command.
        files : iterable of Path
            Results below the folder.
        """
        record = self.path("results.json")
        before = json.loads(record.read_text(encoding="utf-8")) if record.exists() else {}
        written = sorted(file.relative_to(self.out).as_posix() for file in files)
        kept = {
            name: entry
            for name, entry in before.items()
            if name != command and entry["inputs"] == self._inputs
        }
        kept[command] = {"inputs": self._inputs, "files": written}
        wanted = {name for entry in kept.values() for name in entry["files"]}
        for name in {name for entry in before.values() for name in entry["files"]} - wanted:
            (self.out / name).unlink(missing_ok=True)
        write_whole(record, json.dumps(kept, indent=1))

    def _clear(self, names: str) -> None:
        for file in self.folder.glob(names):
            file.unlink()

    def path(self, name: str) -> Path:
        """Where a piece of work is kept."""
        return self.folder / name

    def keep(self, name: str, first: int, values: Array) -> None:
        """Keep outputs of consecutive runs, the first of which has a number."""
        import io

        buffer = io.BytesIO()
        np.save(buffer, values, allow_pickle=False)
        write_whole(self.path(f"{name}-{first:09d}.npy"), buffer.getvalue())

    def kept(self, name: str) -> Iterator[tuple[int, Array]]:
        """Outputs kept so far, by number of their first run; unreadable ones are dropped."""
        for file in sorted(self.folder.glob(f"{name}-*.npy")):
            try:
                yield int(file.stem.rsplit("-", 1)[1]), np.load(file, allow_pickle=False)
            except (ValueError, OSError):
                file.unlink()

    def drop(self, name: str) -> None:
        """Forget outputs that are no longer needed."""
        for file in self.folder.glob(f"{name}-*.npy"):
            file.unlink()


def _changed(manifest: Path, inputs: Mapping[str, Any]) -> list[str]:
    """Inputs that are not those of the work that is there."""
    if not manifest.exists():
        return []
    try:
        before = json.loads(manifest.read_text(encoding="utf-8"))
        return [key for key in sorted({*before, *inputs}) if before.get(key) != inputs.get(key)]
    except (ValueError, TypeError, AttributeError):
        return ["manifest"]

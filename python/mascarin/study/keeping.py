"""What a study keeps on disk while it works, so that a killed one goes on where it was.

Every file appears complete or not at all: it is written under another name and then renamed. The manifest
says which inputs the kept work belongs to.
"""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mascarin.errors import InputError

if TYPE_CHECKING:
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
        The folder is no folder.
    """

    def __init__(self, out: Path, inputs: Mapping[str, Any]) -> None:
        if out.exists() and not out.is_dir():
            raise InputError(f"{out}: is a file; expected a folder for the results: choose another -o")
        self.out = out
        self.folder = out / _FOLDER
        self.folder.mkdir(parents=True, exist_ok=True)
        manifest, text = self.folder / "manifest.json", json.dumps(inputs, indent=1, sort_keys=True)
        changed = _changed(manifest, inputs)
        if changed:
            warnings.warn(
                f"{out}: holds work on other inputs (different: {', '.join(changed)}); it cannot be "
                "continued, so everything is done anew",
                stacklevel=3,
            )
            self._clear("*")
        # What was being written when the last run was killed.
        self._clear("*.part")
        write_whole(manifest, text)

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

"""Intermediate results of a study on disk, so that an interrupted study continues where it was.

The manifest identifies the inputs of the intermediate results. It and the list of results (``results.json``)
have no seal: people read them, a changed manifest makes everything be computed again, and names in the list
are confined to results of the folder. What is computed is in sealed files (`_io.own_files`) and records that
are sealed line by line (`_io.own_records`).
"""

from __future__ import annotations

import hashlib
import json
import re
import warnings
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin._io import atomic, identity
from mascarin._io.locks import FolderLock
from mascarin._io.sealed import own_files
from mascarin.errors import InputError
from mascarin.pages.study import is_report

if TYPE_CHECKING:
    from typing import Self

    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

_FOLDER: Final = ".work"
#: The report of a study in the folder of its results.
REPORT: Final = "report.html"
#: Date and run time of a study, in the folder of its results.
RUN: Final = "run.json"
#: The page in which the calibrated building runs, beside the report.
MODEL: Final = "model.html"
#: Files of the result folder itself.
WRITTEN: Final = ("study.json", RUN, REPORT)
#: Files that single steps write into the result folder.
OF_STEPS: Final = (
    "sensitivity.json", "calibration.json", "validation.json", "series.csv", "calibrated.yaml",
    "posterior.nc",
)  # fmt: skip
#: Names of results in the folder of a study.
_RESULT: Final = re.compile(
    r"(tables/[^/]+\.csv|figures/[^/]+\.(svg|pdf|png)|"
    + "|".join(re.escape(name) for name in (*WRITTEN, MODEL, *OF_STEPS))
    + ")"
)
_STAYS: Final = "; the earlier report stays until a new one replaces it"


class Workspace:
    """Intermediate results below a result folder, locked for this process.

    Parameters
    ----------
    out : Path
        The result folder; made when it is missing.
    inputs : mapping
        What the results depend on: version and hashes.

    Raises
    ------
    InputError
        There is a file of that name, an input or a link is where results are written, or another process
        writes to the folder.
    """

    def __init__(self, out: Path, inputs: Mapping[str, Any]) -> None:
        if out.exists() and not out.is_dir():
            raise InputError(f"{out}: found a file, expected a folder; choose another folder (-o)")
        self.out = out
        self.folder = out / _FOLDER
        for name in (*WRITTEN, MODEL, *OF_STEPS):
            identity.require_no_input(out / name)
        for name in (_FOLDER, "tables", "figures"):
            identity.require_no_inputs_in(own_files.require_folder(out, name))
        if self.folder.exists() and not self.folder.is_dir():
            raise InputError(f"{self.folder}: found a file, expected a folder of Mascarin; remove the file")
        self.folder.mkdir(parents=True, exist_ok=True)
        self._lock = FolderLock(out, self.folder / "lock")
        self._inputs = hashlib.sha256(json.dumps(inputs, sort_keys=True).encode()).hexdigest()
        manifest, text = self.folder / "manifest.json", json.dumps(inputs, indent=1, sort_keys=True)
        self._earlier = self._report_is_earlier()
        changed = _changed(manifest, inputs)
        if changed:
            warnings.warn(
                f"{out}: found results of other inputs (different: {', '.join(changed)}); they "
                f"cannot be used, so everything is computed again{_STAYS if self._earlier else ''}",
                stacklevel=3,
            )
            self._clear("*.npy")
            self._clear("*.jsonl")
            self._clear("*.npz")
        for place in (self.folder, out / "tables", out / "figures"):
            atomic.remove_drafts(place)
        for name in (*WRITTEN, MODEL):
            atomic.remove_drafts_of(out / name)
        atomic.write(manifest, text)

    def __enter__(self) -> Self:
        """The folder is locked already."""
        return self

    def __exit__(self, *error: object) -> None:
        """Release the lock; after an error, say which report there is."""
        self._lock.release()
        if any(error) and self._earlier:
            warnings.warn(
                f"{self.out / REPORT}: of an earlier state of the study; it was not replaced, because this "
                "run did not end",
                stacklevel=2,
            )

    def record(self, command: str, files: Iterable[Path]) -> None:
        """Note the files that a command wrote; remove its older files, and those of a study of other inputs.

        Parameters
        ----------
        command : str
            Which command.
        files : iterable of Path
            Results below the folder.
        """
        before = self._recorded()
        written = sorted(file.relative_to(self.out).as_posix() for file in files)
        kept = {
            name: entry
            for name, entry in before.items()
            if name != command and entry["inputs"] == self._inputs
        }
        kept[command] = {"inputs": self._inputs, "files": written}
        named = {name for entry in kept.values() for name in entry["files"]}
        for name in {name for entry in before.values() for name in entry["files"]} - named - {REPORT}:
            self._remove(name)
        atomic.write(self.path("results.json"), json.dumps(kept, indent=1))

    def _recorded(self) -> dict[str, dict[str, Any]]:
        """Files of each command; nothing where the record is damaged."""
        try:
            entries = own_files.read_json(self.path("results.json"))
            for entry in entries.values():
                own_files.require(entry if isinstance(entry, dict) else {}, {"inputs": str, "files": list})
                # What is no text is no name.
                entry["files"] = [name for name in entry["files"] if isinstance(name, str)]
        except (OSError, own_files.DamagedError):
            return {}
        return entries

    def _remove(self, name: object) -> None:
        """Remove a result of this folder; a name that is none of a result is left alone.

        The record may come from someone else, with the folder.
        """
        file = own_files.inside(self.out, name)
        if file is not None and _RESULT.fullmatch(str(name)) and file.is_file() and not file.is_symlink():
            identity.require_no_input(file)
            file.unlink()

    def _report_is_earlier(self) -> bool:
        """Whether there is a report that is not known to be one of these inputs.

        It stays until a new one replaces it: a study that fails takes no result from the user.
        """
        report = self.out / REPORT
        if report.is_symlink() or not (report.is_file() and is_report(report)):
            return False
        return self._recorded().get("study", {}).get("inputs") != self._inputs

    def _clear(self, names: str) -> None:
        for file in self.folder.glob(names):
            own_files.remove(file)

    def path(self, name: str) -> Path:
        """File of an intermediate result."""
        return self.folder / name

    def keep(self, name: str, first: int, arrays: Mapping[str, Array]) -> None:
        """Save arrays of consecutive runs under the number of the first."""
        file = f"{name}-{first:09d}.npy"
        own_files.write(self.path(file), file, own_files.packed(None, arrays))

    def kept(self, name: str) -> Iterator[tuple[int, dict[str, Array]]]:
        """Arrays saved so far, by number of their first run; unreadable files are removed."""
        for file in sorted(self.folder.glob(f"{name}-*.npy")):
            try:
                _, arrays = own_files.unpacked(own_files.read(file, file.name))
                yield int(file.stem.rsplit("-", 1)[1]), arrays
            except (ValueError, LookupError, OSError):
                own_files.remove(file)

    def drop(self, name: str) -> None:
        """Remove outputs that are no longer needed."""
        for file in (*self.folder.glob(f"{name}-*.npy"), *self.folder.glob(f"{name}-*.npz")):
            own_files.remove(file)


def _changed(manifest: Path, inputs: Mapping[str, Any]) -> list[str]:
    """Names of the inputs that differ from those of the manifest."""
    if not manifest.exists():
        return []
    try:
        before = own_files.read_json(manifest)
    except (own_files.DamagedError, OSError):
        return ["manifest"]
    return [key for key in sorted({*before, *inputs}) if before.get(key) != inputs.get(key)]

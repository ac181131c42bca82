"""What reading and checking a weather file or a measured table gave, kept in the cache folder of the user.

A file of the cache is named by a hash of everything that its content depends on: the weather file, the
version of Mascarin, and the code that made it. It is an own file (`_io.own_files`): one that is cut, damaged
or of another program is read as if it were not there, and written again. The folder may be deleted at any
time. With ``MASCARIN_CACHE=off`` nothing is read from it or written to it; any other value is its folder.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType
from typing import Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt

from mascarin import __version__
from mascarin._io.sealed import own_files
from mascarin.errors import InputError

Array: TypeAlias = npt.NDArray[np.floating[Any]]

FOLDER: Final = "weather"
VARIABLE: Final = "MASCARIN_CACHE"
"""Environment variable that turns the cache off, or names its folder."""
#: Files that are kept; the oldest ones are removed. A year of weather has 0.7 MB.
MOST: Final = 64
#: Numbers of a file; larger tables are read anew each time.
LARGEST: Final = 2**21
_KIND: Final = "weather"


@dataclass(frozen=True)
class Cached:
    """What is kept.

    Attributes
    ----------
    notes : mapping of str to object
        Values that JSON can hold.
    columns : mapping of str to ndarray, shape (n,)
        Columns of numbers, all of one length.
    """

    notes: Mapping[str, Any] = field(default_factory=dict)
    columns: Mapping[str, Array] = field(default_factory=dict)


def cache_folder() -> Path:
    """Cache folder of the user: the one of the variable, or where the platform puts such files."""
    named = os.environ.get(VARIABLE, "")
    if named and named.lower() != "off":
        return Path(named)
    import platformdirs

    return Path(platformdirs.user_cache_dir("mascarin"))


def cached(key: Sequence[object], code: Sequence[ModuleType], make: Callable[[], Cached]) -> Cached:
    """Read what was kept for a key, or make and keep it.

    Parameters
    ----------
    key : sequence of object
        All that the content depends on, as texts and numbers.
    code : sequence of module
        The modules that make it: after a change of one of them it is made again.
    make : callable
        Makes it; what it raises is passed on, and nothing is kept.

    Returns
    -------
    Cached
        The same, whether it was kept or made.
    """
    if os.environ.get(VARIABLE, "").lower() == "off":
        return make()
    with contextlib.suppress(OSError):
        file = _file(key, code)
        stored = _read(file)
        if stored is not None:
            return stored
    result = make()
    # A folder that cannot be written, or a full disk, costs time and nothing else.
    if sum(len(column) for column in result.columns.values()) > LARGEST:
        return result
    with contextlib.suppress(OSError, InputError):
        file = _file(key, code)
        file.parent.mkdir(parents=True, exist_ok=True)
        own_files.write(file, _KIND, own_files.packed(result.notes, result.columns))
        _remove_oldest(file.parent)
    return result


def _file(key: Sequence[object], code: Sequence[ModuleType]) -> Path:
    made_by = [hashlib.sha256(Path(str(module.__file__)).read_bytes()).hexdigest() for module in code]
    name = hashlib.sha256(repr((__version__, made_by, *key)).encode()).hexdigest()
    return cache_folder() / FOLDER / f"{name[:40]}.bin"


def _read(file: Path) -> Cached | None:
    """The content of a file; None where there is none, or another one than was written."""
    try:
        notes, columns = own_files.unpacked(own_files.read(file, _KIND))
    except (FileNotFoundError, own_files.DamagedError):
        return None
    if not isinstance(notes, dict) or len({column.shape for column in columns.values()}) > 1:
        return None
    return Cached(notes, columns)


def _remove_oldest(folder: Path) -> None:
    files = sorted(folder.glob("*.bin"), key=lambda entry: entry.stat().st_mtime)
    for old in files[:-MOST]:
        own_files.remove(old)

"""Series of a run from a NetCDF file, whose structure is known and whose sizes are bounded.

xarray and h5netcdf would accept every structure, and follow what a damaged file claims. Here each size is
compared with the file before memory is taken, and nothing outside of the file is opened.
"""

from __future__ import annotations

import hashlib
import re
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import h5py
import numpy as np

from mascarin._io import memory
from mascarin.simulation.records import netcdf_probe

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

#: Before the hash, at the end of a file; HDF5 reads nothing there.
_SEAL: Final = b"\nmascarin results 1\n"
_HASH: Final = 32
_BLOCK: Final = 2**16
#: Compression of a series that is still read; deflate reaches 1032.
_RATIO: Final = 1100
#: Largest attribute: descriptions of outputs. [B]
_LARGEST: Final = 2**28
#: Longest time for the structure of a file on a busy machine. [s]
_PATIENCE: Final = 60.0
_UNITS: Final = {
    "days": 86_400_000_000_000,
    "hours": 3_600_000_000_000,
    "minutes": 60_000_000_000,
    "seconds": 1_000_000_000,
    "milliseconds": 1_000_000,
    "microseconds": 1_000,
    "nanoseconds": 1,
}
_SINCE: Final = re.compile(
    r"(?P<unit>[a-z]+) since (?P<date>\d{4}-\d\d-\d\d)([ T](?P<time>\d\d:\d\d:\d\d(\.\d{1,9})?))?"
)


def seal(path: Path) -> None:
    """Append the hash of a complete file."""
    digest = _hash(path, path.stat().st_size)
    with path.open("ab") as file:
        file.write(_SEAL + digest)


def _hash(path: Path, size: int) -> bytes:
    """SHA-256 of the first bytes of a file."""
    digest = hashlib.sha256()
    with path.open("rb") as file:
        remaining = size
        while remaining:
            block = file.read(min(remaining, _BLOCK))
            if not block:
                break
            digest.update(block)
            remaining -= len(block)
    return digest.digest()


def _require_whole(path: Path) -> None:
    """Refuse a file that is not as it was written; it is tried in another process: a hash can be forged.

    Raises
    ------
    ValueError
        It is damaged.
    """
    size = path.stat().st_size
    length = len(_SEAL) + _HASH
    with path.open("rb") as file:
        file.seek(max(0, size - length))
        end = file.read(length)
    if end.startswith(_SEAL) and _hash(path, size - length) != end[len(_SEAL) :]:
        raise ValueError("it is not as it was written: damaged, or changed since")
    words = [sys.executable, "-P", netcdf_probe.__file__, str(path)]
    try:
        done = subprocess.run(words, capture_output=True, timeout=_PATIENCE, check=False)  # noqa: S603
    except subprocess.TimeoutExpired:
        raise ValueError("its structure cannot be read within a minute: it is damaged") from None
    if done.returncode:
        said = done.stderr.decode(errors="replace").strip().splitlines()
        raise ValueError(said[-1] if said and done.returncode > 0 else "its structure cannot be read")


def read(path: Path) -> tuple[dict[str, Array], npt.NDArray[np.int64], dict[str, Any]]:
    """All series, their times and the attributes of a file.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    series : dict of str to ndarray, shape (rows,)
        By name. [unit of each]
    times : ndarray of int, shape (rows,)
        Since 1970-01-01 UTC. [ns]
    attributes : dict
        Texts and numbers.

    Raises
    ------
    ValueError
        It has another structure, or is damaged.
    """
    _require_whole(path)
    size = path.stat().st_size
    try:
        with h5py.File(path, "r") as file:
            attributes = {name: _attribute(file, name) for name in list(file.attrs)}
            offsets = {name: _series(file, name, size) for name in list(file)}
            times = offsets.pop("time")
            memory.require(8 * len(times) * len(offsets), f"{path}: the series", "use a part of the file")
            stamps = _nanoseconds(times[()], str(_attribute(times, "units")))
            series = {
                name: np.asarray(offset[()], dtype=np.float64)
                for name, offset in offsets.items()
                if name != "local_time" and len(offset) == len(times)
            }
    except RuntimeError as error:  # of the HDF5 library
        raise ValueError(str(error)) from None
    return series, stamps, attributes


def _attribute(part: Any, name: str) -> Any:
    """A text or a number; None for all else, such as references."""
    attribute_id = part.attrs.get_id(name)
    if (
        attribute_id.dtype.kind not in "iufSO"
        or attribute_id.get_storage_size() > _LARGEST
        or attribute_id.shape not in ((), (1,))
    ):
        return None
    value = part.attrs[name]
    value = value.item() if isinstance(value, np.ndarray | np.generic) else value
    return value.decode() if isinstance(value, bytes) else value


def _series(file: h5py.File, name: str, size: int) -> h5py.Dataset:
    """A series whose length the file can hold.

    Raises
    ------
    ValueError
        It is something else.
    """
    if not isinstance(file.get(name, getlink=True), h5py.HardLink):
        raise ValueError(f"{name}: it is in another file")
    variable = file[name]
    if not isinstance(variable, h5py.Dataset) or variable.ndim != 1 or variable.dtype.kind not in "iuf":
        raise ValueError(f"{name}: it is no series of numbers")
    if variable.external or variable.is_virtual:
        raise ValueError(f"{name}: it is in another file")
    claimed = len(variable) * variable.dtype.itemsize
    if claimed > size * (_RATIO if variable.chunks else 1):
        raise ValueError(f"{name}: it claims {claimed} bytes, which the file does not have")
    if {"scale_factor", "add_offset"} & set(variable.attrs):
        raise ValueError(f"{name}: its numbers are packed")
    return variable


def _nanoseconds(values: npt.NDArray[Any], units: str) -> npt.NDArray[np.int64]:
    """Times since 1970-01-01 UTC. [ns]

    Raises
    ------
    ValueError
        Units that are not those of times, or times outside of the calendar.
    """
    match = _SINCE.fullmatch(units)
    if match is None or match["unit"] not in _UNITS:
        raise ValueError(f"time: found units '{units[:60]}'")
    length = _UNITS[match["unit"]]
    first = np.datetime64(f"{match['date']}T{match['time'] or '00:00:00'}", "ns").astype(np.int64)
    spans = np.asarray(values)
    if spans.dtype.kind == "f" and not (np.isfinite(spans).all() and (spans == np.round(spans)).all()):
        raise ValueError("time: found spans that are not whole numbers")
    if spans.size and float(np.abs(spans.astype(np.float64)).max()) * length + abs(int(first)) > 2.0**62:
        raise ValueError("time: found a year outside of the calendar")
    return np.asarray(int(first) + spans.astype(np.int64) * length, dtype=np.int64)

"""Series of a run in a NetCDF file that is written in blocks of rows, while the run goes on.

The file is made with a place for every series, and HDF5 tells where each begins. Rows are put there without
HDF5, which would have to hold thousands of series open. The attributes, which need the whole run, come last;
after them, where HDF5 reads nothing, the hash of the file.
xarray would write the same file from all records in memory, and takes some milliseconds for each series.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Self, cast

import h5py
import numpy as np

from mascarin import __version__
from mascarin.simulation.records.labels import TIME_NAMES
from mascarin.simulation.records.netcdf_reading import seal

if TYPE_CHECKING:
    import io

    import numpy.typing as npt

    from mascarin.building import Output
    from mascarin.simulation.records.times import Times

    Array = npt.NDArray[np.float64]
    #: From the first row and the row behind the last one to the stamps between.
    Moments = Callable[[int, int], npt.NDArray[np.int64]]

#: Units of encoded times from long to short, and their length. [ns]
_UNITS: Final = (
    ("days", 86_400_000_000_000),
    ("hours", 3_600_000_000_000),
    ("minutes", 60_000_000_000),
    ("seconds", 1_000_000_000),
    ("milliseconds", 1_000_000),
    ("microseconds", 1_000),
    ("nanoseconds", 1),
)
#: Stamps that are written together.
_STAMPS: Final = 2**16
#: Series that are turned from rows to columns together.
_TOGETHER: Final = 512
_TEXT: Final = h5py.string_dtype()
_LIST: Final = h5py.vlen_dtype(h5py.ref_dtype)
_NUMBER: Final = np.dtype("<f8")


class _Lasting:
    """A file for HDF5 on a disk that may be full.

    A write that fails would leave objects that the library cannot close: it ends the process by a
    segmentation fault. So it is told that all was written, and the error is kept.

    Parameters
    ----------
    path : Path
        The file.
    mode : str
        As of `open`.
    """

    def __init__(self, path: Path, mode: str) -> None:
        self._file = cast("io.FileIO", path.open(mode, buffering=0))
        self.error: OSError | None = None
        self.seek, self.tell, self.close = self._file.seek, self._file.tell, self._file.close
        self.read, self.readinto, self.flush = self._file.read, self._file.readinto, self._file.flush

    def write(self, data: bytes | memoryview) -> int:
        """Write all, or keep the error."""
        remaining = memoryview(data).cast("B")
        try:
            while remaining:
                remaining = remaining[self._file.write(remaining) :]
        except OSError as error:
            self.error = self.error or error
        return len(memoryview(data).cast("B"))

    def truncate(self, size: int) -> int:
        """Set the size, or keep the error."""
        try:
            self._file.truncate(size)
        except OSError as error:
            self.error = self.error or error
        return size


@contextlib.contextmanager
def _hdf5(path: Path, mode: str) -> Iterator[h5py.File]:
    """Open a file with HDF5; raises the first error of writing when the library has closed it."""
    with contextlib.closing(_Lasting(path, {"w": "w+b", "r+": "r+b"}[mode])) as lasting:
        try:
            with h5py.File(lasting, mode, track_order=True) as file:
                yield file
        except Exception:
            if lasting.error is not None:
                raise lasting.error from None
            raise
        if lasting.error is not None:
            raise lasting.error


class NetcdfDraft:
    """A NetCDF file that grows by blocks of rows.

    Parameters
    ----------
    path : Path
        The file; it is made.
    outputs : sequence of Output
        What is recorded.
    times : Times
        Times of all rows.
    """

    def __init__(self, path: Path, outputs: Sequence[Output], times: Times) -> None:
        self._path = path
        self._rows = times.rows
        self._done = 0
        with _hdf5(path, "w") as file:
            stamps = _Stamps(file, self._rows)
            stamps.add("time", times.nanoseconds, scale=True)
            stamps.add("local_time", times.clock_nanoseconds)
            series = _Series(file, stamps, times.timezone)
            self._places = [series.add(output.name, output.unit) for output in outputs]
            stamps.close(series.references)
        self._raw = path.open("r+b", buffering=0)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self._raw.close()

    def take(self, rows: Array) -> None:
        """Write the next rows.

        Parameters
        ----------
        rows : ndarray, shape (n, outputs)
            Values. [unit of each output]

        Raises
        ------
        OSError
            They cannot be written; the disk is full.
        """
        offset = self._done * _NUMBER.itemsize
        for first in range(0, len(self._places), _TOGETHER):
            offsets = self._places[first : first + _TOGETHER]
            columns = np.ascontiguousarray(rows[:, first : first + _TOGETHER].T, dtype=_NUMBER)
            for start, column in zip(offsets, columns, strict=True):
                self._raw.seek(start + offset)
                remaining = memoryview(column).cast("B")
                while remaining:  # a full disk takes a part, and refuses the next
                    remaining = remaining[self._raw.write(remaining) :]
        self._done += len(rows)

    def finish(self, attributes: Mapping[str, Any]) -> None:
        """Write what is known at the end of the run.

        Parameters
        ----------
        attributes : mapping
            Attributes of the file: texts and whole numbers.
        """
        if self._done != self._rows:
            raise RuntimeError(f"{self._done} rows were written, expected {self._rows}")
        self._raw.close()
        with _hdf5(self._path, "r+") as file:
            for name, value in attributes.items():
                if isinstance(value, str):
                    file.attrs.create(name, value, dtype=_TEXT)
                else:
                    file.attrs.create(name, np.array([value]))
            made_by = f"version=2,mascarin={__version__},hdf5={h5py.version.hdf5_version}"
            file.attrs["_NCProperties"] = np.bytes_(made_by)
        seal(self._path)


class _Stamps:
    """The times of a file: the dimension, which is a series itself, and the local clock along it."""

    def __init__(self, file: h5py.File, rows: int) -> None:
        self.space = h5py.h5s.create_simple((rows,))
        self._file = file
        self._references: list[h5py.h5r.Reference] = []

    @property
    def dimension(self) -> h5py.h5d.DatasetID:
        """The series of the dimension."""
        return self._file["time"].id

    def add(self, name: str, moments: Moments, *, scale: bool = False) -> None:
        """Add stamps, from rows to stamps since 1970-01-01. [ns]"""
        rows = self.space.get_simple_extent_npoints()
        blocks = [(row, min(row + _STAMPS, rows)) for row in range(0, rows, _STAMPS)]
        steps: set[int] = set()
        for first, last in blocks:  # from the last stamp of the block before on
            steps.update(np.unique(np.diff(moments(max(first - 1, 0), last))).tolist())
        unit, length = next(each for each in _UNITS if not any(step % each[1] for step in steps))
        start = int(moments(0, 1)[0])
        text = str(np.datetime64(start, "ns").astype("datetime64[s]")).replace("T", " ")
        fraction = start % 1_000_000_000
        if fraction:
            text += f".{fraction:09d}"
        stamps = self._file.create_dataset(name, (rows,), dtype="<i8", track_order=True)
        for first, last in blocks:
            stamps[first:last] = (moments(first, last) - start) // length
        if scale:
            h5py.h5ds.set_scale(stamps.id, name.encode())
        else:
            _attach(stamps.id, self.dimension)
            self._references.append(stamps.ref)
        _number(stamps.id, "_Netcdf4Coordinates", np.zeros(1, np.int32))
        _number(stamps.id, "_Netcdf4Dimid", np.int32(0))
        _text(stamps.id, "units", f"{unit} since {text}")
        _text(stamps.id, "calendar", "proleptic_gregorian")
        _text(stamps.id, "long_name", TIME_NAMES[name])

    def close(self, references: Sequence[h5py.h5r.Reference]) -> None:
        """Tell the dimension which series run along it."""
        # All at once: `attach_scale` of HDF5 writes the whole list again for each.
        kind = np.dtype([("dataset", h5py.ref_dtype), ("dimension", "<u4")])
        all_references = [*self._references, *references]
        listed = np.array([(reference, 0) for reference in all_references], dtype=kind)
        self._file["time"].attrs.create("REFERENCE_LIST", listed)


@dataclass
class _Series:
    """Makes the series of a file. Each costs a tenth of a millisecond by HDF5's own functions."""

    file: h5py.File
    stamps: _Stamps
    timezone: str

    def __post_init__(self) -> None:
        self.references: list[h5py.h5r.Reference] = []
        plan = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        plan.set_layout(h5py.h5d.CONTIGUOUS)
        # The place is known at once, and its content is written once.
        plan.set_alloc_time(h5py.h5d.ALLOC_TIME_EARLY)
        plan.set_fill_time(h5py.h5d.FILL_TIME_NEVER)
        plan.set_fill_value(np.array(np.nan))
        plan.set_obj_track_times(False)  # the same run gives the same bytes
        plan.set_attr_creation_order(h5py.h5p.CRT_ORDER_TRACKED | h5py.h5p.CRT_ORDER_INDEXED)
        self._plan = plan
        self._kind = h5py.h5t.py_create(_NUMBER, logical=True)
        self._dimension = self.stamps.dimension

    def add(self, name: str, unit: str) -> int:
        """Add a series. Returns where its values begin in the file. [B]"""
        dataset = h5py.h5d.create(self.file.id, name.encode(), self._kind, self.stamps.space, self._plan)
        _attach(dataset, self._dimension)
        _number(dataset, "_Netcdf4Coordinates", np.zeros(1, np.int32))
        _number(dataset, "_Netcdf4Dimid", np.int32(0))
        _number(dataset, "_FillValue", np.array([np.nan]))
        for key, value in (
            ("units", unit),
            ("long_name", name),
            ("timezone", self.timezone),
            ("coordinates", "local_time"),
        ):
            _text(dataset, key, value)
        self.references.append(h5py.h5r.create(self.file.id, name.encode(), h5py.h5r.OBJECT))
        offset = dataset.get_offset()
        if offset is None:
            raise RuntimeError(f"{name}: HDF5 gave its values no place in the file")
        return int(offset)


def _attach(series: h5py.h5d.DatasetID, dimension: h5py.h5d.DatasetID) -> None:
    """Let a series run along the dimension; `_Stamps.close` tells the dimension."""
    listed = np.empty(1, dtype=_LIST)
    listed[0] = np.array([h5py.h5r.create(dimension, b".", h5py.h5r.OBJECT)], dtype=h5py.ref_dtype)
    kind = h5py.h5t.py_create(_LIST, logical=True)
    h5py.h5a.create(series, b"DIMENSION_LIST", kind, h5py.h5s.create_simple((1,))).write(listed)


def _number(series: h5py.h5d.DatasetID, name: str, value: Any) -> None:
    array = np.asarray(value)
    space = h5py.h5s.create_simple(array.shape) if array.shape else h5py.h5s.create(h5py.h5s.SCALAR)
    h5py.h5a.create(series, name.encode(), h5py.h5t.py_create(array.dtype), space).write(array)


def _text(series: h5py.h5d.DatasetID, name: str, value: str) -> None:
    kind = h5py.h5t.py_create(_TEXT, logical=True)
    attribute = h5py.h5a.create(series, name.encode(), kind, h5py.h5s.create(h5py.h5s.SCALAR))
    attribute.write(np.array(value, dtype=_TEXT))

"""Opens a NetCDF file in a process of its own: ``netcdf_probe.py FILE``.

The HDF5 library follows links between parts of a file; in a damaged one it may follow them without end, or
end the process. A file with the hash that Mascarin writes is not probed. This file imports nothing of
Mascarin, so that it starts quickly.
"""

from __future__ import annotations

import contextlib
import sys

import h5py

#: Processor time for the structure of a file, whatever its size. [s]
SECONDS = 3
#: Address space of the process. [B]
MEMORY = 4 * 2**30


def main() -> int:
    """Read the structure of a file, and a value of each series."""
    with contextlib.suppress(ImportError, ValueError, OSError):  # not on Windows
        import resource

        resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with h5py.File(sys.argv[1], "r") as file:
        _read_attributes(file)
        for name in list(file):
            if isinstance(file.get(name, getlink=True), h5py.HardLink) and isinstance(
                file[name], h5py.Dataset
            ):
                series = file[name]
                _read_attributes(series)
                if series.ndim == 1 and len(series):
                    series[-1:]
    return 0


def _read_attributes(part: h5py.HLObject) -> None:
    for name in list(part.attrs):
        # References are not followed.
        if part.attrs.get_id(name).dtype.kind in "iufSO":
            part.attrs[name]


if __name__ == "__main__":
    sys.exit(main())

"""Series of a run in files: NetCDF, CSV and Parquet, each with units and with what the run was made from."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Protocol

from mascarin._io import arrow_files, atomic, identity, memory
from mascarin._io.regular import require_regular, require_text
from mascarin._io.sealed import own_files
from mascarin.errors import InputError
from mascarin.simulation.records.blocks import InMemory
from mascarin.tables.timezones import parse_timezone

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    import pandas as pd

    from mascarin.building import Output
    from mascarin.simulation.records.times import Times

    Array = npt.NDArray[np.float64]

ENDINGS: Final = (".nc", ".csv", ".parquet")
"""Endings of the names of files."""

#: The file beside a table with units and provenance, by W3C Tabular Data (2015), section 5.3.
BESIDE: Final = "-metadata.json"
_KEY: Final = b"mascarin"


def require_ending(path: Path, option: str) -> None:
    """Refuse a file whose ending is none of `ENDINGS`, and Parquet where it cannot be written."""
    ending = path.suffix.lower()
    if ending not in ENDINGS:
        raise InputError(f"{option}: found '{path}'; expected a file ending in .nc, .csv or .parquet")
    if ending == ".parquet":
        _require_pyarrow(path)


def _require_pyarrow(path: Path) -> None:
    require_text(path)
    try:
        import pyarrow  # noqa: F401
    except ImportError:
        raise InputError(
            f"{path}: Parquet needs the package pyarrow, which is not installed; install it with "
            "'pip install mascarin[parquet]', or choose a file ending in .nc or .csv"
        ) from None


class Draft(Protocol):
    """A file that is being written in blocks of rows."""

    def take(self, rows: Array) -> None:
        """Write the next rows, shape (n, outputs). [unit of each output]"""

    def finish(self, attributes: Mapping[str, Any]) -> None:
        """Write units and provenance, which are known at the end."""


@contextlib.contextmanager
def drafted(path: Path, outputs: Sequence[Output], times: Times, ending: str) -> Iterator[Draft]:
    """A file for the series of a run; it appears when it is complete.

    Parameters
    ----------
    path : Path
        The file; its folder exists. A file beside a CSV file holds units and provenance.
    outputs : sequence of Output
        What is recorded.
    times : Times
        Times of all rows.
    ending : str
        One of `ENDINGS`: what kind of file it is.

    Yields
    ------
    Draft
        Takes the rows, one block after the other, and then the attributes.

    Raises
    ------
    OSError
        The file cannot be written; the file that was there before is unchanged.
    """
    if ending == ".csv":
        identity.require_no_input(Path(f"{path}{BESIDE}"), identity.RESULTS)
    with atomic.drafted(path, identity.RESULTS) as part:
        if ending == ".nc":
            from mascarin.simulation.records.netcdf import NetcdfDraft  # h5py, which most runs do without

            with NetcdfDraft(part, outputs, times) as series:
                yield series
            return
        table = (_Csv if ending == ".csv" else _Parquet)(part, outputs, times)
        with contextlib.closing(table):
            yield table
    if isinstance(table, _Csv):
        table.write_beside(path)


class _Csv:
    """A table in local time."""

    def __init__(self, part: Path, outputs: Sequence[Output], times: Times) -> None:
        self._names = [output.name for output in outputs]
        self._times = times
        self._file = part.open("w", encoding="utf-8", newline="")
        self._done = 0
        self._attributes: Mapping[str, Any] = {}

    def take(self, rows: Array) -> None:
        import pandas as pd

        index = self._times.part(self._done, self._done + len(rows)).rename("time")
        table = pd.DataFrame(rows, index=index, columns=self._names)
        table.to_csv(self._file, header=self._done == 0, index_label="time", lineterminator="\n")
        self._done += len(rows)

    def finish(self, attributes: Mapping[str, Any]) -> None:
        self._attributes = attributes

    def close(self) -> None:
        self._file.close()

    def write_beside(self, path: Path) -> None:
        """Write the file beside the table, with units and attributes."""
        columns = [{"titles": "time", "datatype": "string"}]
        columns += [
            {"titles": name, "datatype": "double", "unit": unit}
            for name, unit in _units(self._attributes).items()
        ]
        described = {
            "@context": "http://www.w3.org/ns/csvw",
            "url": path.name,
            "tableSchema": {"columns": columns},
            "mascarin": dict(self._attributes),
        }
        atomic.write(
            Path(f"{path}{BESIDE}"),
            json.dumps(described, indent=1, ensure_ascii=False) + "\n",
            identity.RESULTS,
        )


class _Parquet:
    """A table in local time, with the unit of each column; in memory until the end.

    A Parquet file of many small groups of rows is larger and slower to read than its numbers.
    """

    def __init__(self, part: Path, outputs: Sequence[Output], times: Times) -> None:
        self._part = part
        self._names = [output.name for output in outputs]
        self._index = times.index.rename("time")
        self._whole = InMemory(times.rows, len(outputs))

    def take(self, rows: Array) -> None:
        self._whole.take(rows)

    def finish(self, attributes: Mapping[str, Any]) -> None:
        import pandas as pd
        import pyarrow as pa
        import pyarrow.parquet as pq

        table = pa.Table.from_pandas(
            pd.DataFrame(self._whole.records, index=self._index, columns=self._names)
        )
        by_name = _units(attributes)
        fields = [
            field.with_metadata({"unit": by_name[field.name]}) if field.name in by_name else field
            for field in table.schema
        ]
        schema = pa.schema(
            fields, metadata={**(table.schema.metadata or {}), _KEY: json.dumps(dict(attributes)).encode()}
        )
        # Open files: Parquet's library takes no names with bytes that are no text.
        with self._part.open("wb") as file:
            pq.write_table(table.cast(schema), file, write_page_checksum=True)

    def close(self) -> None:
        """Nothing is open."""


def read(path: Path) -> tuple[Array, pd.DatetimeIndex, dict[str, Any]]:
    """Records, local times and attributes of a file of any of the kinds.

    Raises
    ------
    InputError
        There is no such file, or it was not written by a run.
    """
    if not path.is_file():
        raise InputError(f"{path}: no such file; give the path from the folder you work in.")
    ending = path.suffix.lower()
    if ending == ".parquet":
        _require_pyarrow(path)
    require_regular(path, "results of a run", identity.RESULTS)
    if ending == ".csv":
        require_regular(Path(f"{path}{BESIDE}"), "a file beside results", identity.RESULTS)
    reader = {".csv": _read_csv, ".parquet": _read_parquet}.get(ending, _read_netcdf)
    try:
        records, times, attributes = reader(path)
        _require_regular_times(times)
        return records, times.tz_convert(parse_timezone(attributes["timezone"])), attributes
    except (OSError, LookupError, ValueError, TypeError, AttributeError, OverflowError) as error:
        raise InputError(
            f"{path}: found no results of a run ({error}); expected a file that Results.write or "
            "`mascarin run -o FILE` wrote"
        ) from None


def _require_regular_times(times: pd.DatetimeIndex) -> None:
    """Refuse times that no run has.

    Raises
    ------
    ValueError
        There is none, one is missing, or their distances differ.
    """
    import numpy as np

    if not len(times) or times.hasnans or len(np.unique(np.diff(times.asi8))) > 1:
        raise ValueError("its times are not at equal distances")


def _read_netcdf(path: Path) -> tuple[Array, pd.DatetimeIndex, dict[str, Any]]:
    import numpy as np
    import pandas as pd

    from mascarin.simulation.records import netcdf_reading  # h5py

    series, moments, attributes = netcdf_reading.read(path)
    times = pd.DatetimeIndex(moments.view("datetime64[ns]")).tz_localize("UTC")
    names = list(_units(attributes))
    records = np.empty((len(times), len(names)))
    for k, name in enumerate(names):
        records[:, k] = series[name]
    return records, times, attributes


def _read_csv(path: Path) -> tuple[Array, pd.DatetimeIndex, dict[str, Any]]:
    import pandas as pd

    beside = Path(f"{path}{BESIDE}")
    if not beside.is_file():
        raise KeyError(f"there is no '{beside.name}' beside it, with units and provenance")
    attributes = own_files.read_json(beside)["mascarin"]
    # As text: not every version of pandas reads numbers to the last bit, numpy does.
    table = pd.read_csv(path, index_col="time", dtype=str)
    return _named(table, attributes), pd.to_datetime(table.index, utc=True, format="ISO8601"), attributes


def _read_parquet(path: Path) -> tuple[Array, pd.DatetimeIndex, dict[str, Any]]:
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        with arrow_files.opened(path) as raw, pq.ParquetFile(raw, page_checksum_verification=True) as file:
            numbers = file.metadata.num_rows * file.metadata.num_columns
            memory.require(8 * numbers, f"{path}: the series", "use a part of the file")
            table = file.read()
    except pa.ArrowException as error:
        raise ValueError(str(error).splitlines()[0]) from None
    attributes = own_files.json_of((table.schema.metadata or {})[_KEY])
    # What the file says for pandas is not needed.
    frame = table.replace_schema_metadata(None).to_pandas().set_index("time")
    return _named(frame, attributes), frame.index.tz_convert("UTC"), attributes


def _named(table: pd.DataFrame, attributes: Mapping[str, Any]) -> Array:
    """The columns of the outputs, in their order."""
    import numpy as np

    columns = table[list(_units(attributes))]
    return np.ascontiguousarray(columns.to_numpy(dtype=object).astype(np.float64))


def _units(attributes: Mapping[str, Any]) -> dict[str, str]:
    """Unit of each output, in their order."""
    return {output["name"]: output["unit"] for output in own_files.json_of(attributes["outputs"])}

"""Series of a run in files: NetCDF, CSV and Parquet, each with units and with what the run was made from."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from mascarin._io import atomic
from mascarin.errors import InputError
from mascarin.weather.timezones import parse_timezone

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    import pandas as pd
    import xarray as xr

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
    try:
        import pyarrow  # noqa: F401
    except ImportError:
        raise InputError(
            f"{path}: Parquet needs the package pyarrow, which is not installed; install it with "
            "'pip install mascarin[parquet]', or choose a file ending in .nc or .csv"
        ) from None


def write_table(frame: pd.DataFrame, attributes: Mapping[str, Any], path: Path) -> None:
    """Write a table in local time as CSV or Parquet, by the ending of its file."""
    write = _write_csv if path.suffix.lower() == ".csv" else _write_parquet
    write(frame, attributes, path)


def _write_csv(frame: pd.DataFrame, attributes: Mapping[str, Any], path: Path) -> None:
    """Write a table in local time, and a file beside it with units and attributes; each appears whole."""
    columns = [{"titles": "time", "datatype": "string"}]
    columns += [
        {"titles": name, "datatype": "double", "unit": unit} for name, unit in _units(attributes).items()
    ]
    described = {
        "@context": "http://www.w3.org/ns/csvw",
        "url": path.name,
        "tableSchema": {"columns": columns},
        "mascarin": dict(attributes),
    }
    with atomic.drafted(path) as part:
        frame.to_csv(part, index_label="time", lineterminator="\n")
    atomic.write(Path(f"{path}{BESIDE}"), json.dumps(described, indent=1, ensure_ascii=False) + "\n")


def _write_parquet(frame: pd.DataFrame, attributes: Mapping[str, Any], path: Path) -> None:
    """Write a table in local time with the unit of each column and the attributes."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    table = pa.Table.from_pandas(frame)
    by_name = _units(attributes)
    fields = [
        field.with_metadata({"unit": by_name[field.name]}) if field.name in by_name else field
        for field in table.schema
    ]
    schema = pa.schema(
        fields, metadata={**(table.schema.metadata or {}), _KEY: json.dumps(dict(attributes)).encode()}
    )
    with atomic.drafted(path) as part:
        pq.write_table(table.cast(schema), part)


def write_netcdf(data: xr.Dataset, path: Path) -> None:
    """Write a data set, which appears when it is complete."""
    with atomic.drafted(path) as part:
        data.to_netcdf(part, engine="h5netcdf")


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
    reader = {".csv": _read_csv, ".parquet": _read_parquet}.get(ending, _read_netcdf)
    try:
        records, times, attributes = reader(path)
        return records, times.tz_convert(parse_timezone(attributes["timezone"])), attributes
    except (OSError, KeyError, ValueError, TypeError) as error:
        raise InputError(
            f"{path}: found no results of a run ({error}); expected a file that Results.write or "
            "`mascarin run -o FILE` wrote"
        ) from None


def _read_netcdf(path: Path) -> tuple[Array, pd.DatetimeIndex, dict[str, Any]]:
    import numpy as np
    import pandas as pd
    import xarray as xr

    with xr.open_dataset(path, engine="h5netcdf") as data:
        data.load()
    times = pd.DatetimeIndex(data["time"].to_numpy()).tz_localize("UTC")
    names = _units(data.attrs)
    return np.stack([data[name].to_numpy() for name in names], axis=-1), times, dict(data.attrs)


def _read_csv(path: Path) -> tuple[Array, pd.DatetimeIndex, dict[str, Any]]:
    import pandas as pd

    beside = Path(f"{path}{BESIDE}")
    if not beside.is_file():
        raise KeyError(f"there is no '{beside.name}' beside it, with units and provenance")
    attributes = json.loads(beside.read_text(encoding="utf-8"))["mascarin"]
    # As text: not every version of pandas reads numbers to the last bit, numpy does.
    table = pd.read_csv(path, index_col="time", dtype=str)
    return _named(table, attributes), pd.to_datetime(table.index, utc=True, format="ISO8601"), attributes


def _read_parquet(path: Path) -> tuple[Array, pd.DatetimeIndex, dict[str, Any]]:
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        table = pq.read_table(path)
    except pa.ArrowInvalid as error:
        raise ValueError(str(error).splitlines()[0]) from None
    attributes = json.loads((table.schema.metadata or {})[_KEY])
    frame = table.to_pandas()
    return _named(frame, attributes), frame.index.tz_convert("UTC"), attributes


def _named(table: pd.DataFrame, attributes: Mapping[str, Any]) -> Array:
    """The columns of the outputs, in their order."""
    import numpy as np

    columns = table[list(_units(attributes))]
    return np.ascontiguousarray(columns.to_numpy(dtype=object).astype(np.float64))


def _units(attributes: Mapping[str, Any]) -> dict[str, str]:
    """Unit of each output, in their order."""
    return {output["name"]: output["unit"] for output in json.loads(attributes["outputs"])}

"""Files of tables: CSV and Parquet, without any change."""

from __future__ import annotations

import hashlib
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

from mascarin._io.tables import read_csv
from mascarin.errors import InputError

if TYPE_CHECKING:
    import pandas as pd


def file_hash(path: Path) -> str:
    """SHA-256 of a file, in hexadecimal.

    Raises
    ------
    InputError
        There is no such file.
    """
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except FileNotFoundError as error:
        raise InputError(f"{path}: no such file; give the path from the folder you work in.") from error
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}).") from error


def with_time_column(frame: pd.DataFrame) -> pd.DataFrame:
    """A time index becomes the first column."""
    import pandas as pd

    if isinstance(frame.index, pd.DatetimeIndex):
        name = "time" if frame.index.name is None else str(frame.index.name)
        frame.insert(0, name, frame.index, allow_duplicates=True)
    return frame.reset_index(drop=True)


def read_frame(path: Path, separator: str | None, decimal: str, skip_lines: int) -> tuple[pd.DataFrame, int]:
    """Read a CSV or Parquet file without changing it.

    Parameters
    ----------
    path : Path
        The file; its ending shows whether it is Parquet.
    separator : str or None
        Between entries of a CSV file; None: found from the header.
    decimal : str
        Decimal mark.
    skip_lines : int
        Lines before the header.

    Returns
    -------
    frame : pandas.DataFrame
        The table; a time index has become the first column.
    first_line : int
        Line of the first row.

    Raises
    ------
    InputError
        The file cannot be read as a table.
    """
    import pandas as pd

    if path.suffix.lower() in {".parquet", ".pq"}:
        try:
            return with_time_column(pd.read_parquet(path)), 1
        except ImportError as error:
            raise InputError(
                f"{path.name}: reading Parquet needs pyarrow: install mascarin[parquet]."
            ) from error
        except (ValueError, OSError) as error:
            raise InputError(f"{path.name}: cannot be read as Parquet: {error}") from error
    found = separator or _separator(path, skip_lines)
    try:
        with warnings.catch_warnings():
            # Rows with more entries than the header has names: which name they belong to is not known.
            warnings.simplefilter("error", pd.errors.ParserWarning)
            frame = read_csv(
                path,
                sep=found,
                decimal=decimal,
                skiprows=skip_lines,
                skip_blank_lines=False,
                skipinitialspace=True,
                encoding="utf-8-sig",
                low_memory=False,
                index_col=False,
            )
    except pd.errors.ParserWarning as error:
        raise InputError(
            f"{path.name}:{skip_lines + 2}: the row has more entries than the header has names; name every "
            "column."
        ) from error
    except (pd.errors.ParserError, pd.errors.EmptyDataError, UnicodeDecodeError, ValueError) as error:
        raise InputError(
            f"{path.name}: cannot be read as a table separated by {found!r}: {error}".strip()
        ) from error
    frame.columns = pd.Index([str(name).strip() for name in frame.columns])
    _refuse_cut(path, found, len(frame.columns), skip_lines + 1 + len(frame))
    return frame, skip_lines + 2


def _refuse_cut(path: Path, separator: str, fields: int, line: int) -> None:
    """Refuse a file whose last line has no line end and fewer entries than the header: it was cut."""
    with path.open("rb") as file:
        file.seek(max(0, path.stat().st_size - 65536))
        last = file.read().decode("utf-8", errors="replace").rsplit("\n", 1)[-1]
    count = last.count(separator) + 1
    if last.strip() and count < fields:
        raise InputError(
            f"{path.name}:{line}: the last line has {count} of {fields} entries and no line end: the file "
            "is cut; get the whole file, or remove that line."
        )


def _separator(path: Path, skip_lines: int) -> str:
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        for _ in range(skip_lines):
            file.readline()
        header = file.readline()
    counts = {mark: header.count(mark) for mark in (";", "\t", ",", "|")}
    best = max(counts, key=lambda mark: counts[mark])
    if counts[best] == 0:
        raise InputError(
            f"{path.name}: no separator found in the header {header.strip()[:40]!r}, expected the names of "
            "columns; state separator, or skip_lines if the header is further down."
        )
    return best

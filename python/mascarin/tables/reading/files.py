"""Files of tables: CSV and Parquet, without any change."""

from __future__ import annotations

import hashlib
import re
import warnings
from collections.abc import Sequence
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING

from mascarin._io.regular import require_regular
from mascarin._io.tables import read_csv
from mascarin.errors import InputError
from mascarin.tables.reading.layout import Layout, decoded, find_layout

if TYPE_CHECKING:
    import pandas as pd


def file_hash(path: Path) -> str:
    """SHA-256 of a file, in hexadecimal.

    Raises
    ------
    InputError
        There is no such file, or it is a pipe or a device.
    """
    require_regular(path)
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


def read_frame(
    path: Path, separator: str | None, decimal: str | None, skip_lines: int | None
) -> tuple[pd.DataFrame, int, tuple[str, ...]]:
    """Read a CSV or Parquet file without changing it.

    Parameters
    ----------
    path : Path
        The file; its ending shows whether it is Parquet.
    separator, decimal : str or None
        Between entries of a CSV file, and its decimal mark; None: found.
    skip_lines : int or None
        Lines before the line with the names of the columns; None: found.

    Returns
    -------
    frame : pandas.DataFrame
        The table; a time index has become the first column.
    first_line : int
        Line of the first row.
    notes : tuple of str
        What was found where nothing was stated.

    Raises
    ------
    InputError
        The file cannot be read as a table.
    """
    import pandas as pd

    if path.suffix.lower() in {".parquet", ".pq"}:
        try:
            return with_time_column(pd.read_parquet(path)), 1, ()
        except ImportError as error:
            raise InputError(
                f"{path.name}: reading Parquet needs pyarrow: install mascarin[parquet]."
            ) from error
        except (ValueError, OSError) as error:
            raise InputError(f"{path.name}: cannot be read as Parquet: {error}") from error
    text, encoding = decoded(path.read_bytes(), path.name)
    lines = text.splitlines()
    layout = find_layout(lines, path.name, separator, decimal, skip_lines)
    frame = _parsed(lines, layout, path.name)
    frame.columns = pd.Index([str(name).strip() for name in frame.columns])
    if layout.trailing:
        frame = frame.iloc[:, :-1]
    _refuse_cut(text, layout, len(frame.columns), path.name, layout.first + len(frame))
    return frame, layout.first + 1, _notes(layout, encoding, lines, path.name)


def _parsed(lines: Sequence[str], layout: Layout, where: str) -> pd.DataFrame:
    import pandas as pd

    header = lines[layout.header] if layout.header < len(lines) else ""
    body = [header + layout.separator * layout.trailing, *lines[layout.first :]]
    # pandas counts the lines of the body.
    offset = layout.first - 1
    try:
        with warnings.catch_warnings():
            # Rows with more entries than the header has names: which name they belong to is not known.
            warnings.simplefilter("error", pd.errors.ParserWarning)
            return read_csv(
                StringIO("\n".join(body)),
                sep=layout.separator,
                decimal=layout.decimal,
                skip_blank_lines=False,
                skipinitialspace=True,
                low_memory=False,
                index_col=False,
            )
    except pd.errors.ParserWarning as error:
        raise InputError(
            f"{where}:{layout.first + 1}: the row has more entries than the header has names; name every "
            f"column, or, if {layout.separator!r} is also the decimal mark, write the table with another "
            "separator."
        ) from error
    except (pd.errors.ParserError, pd.errors.EmptyDataError, ValueError) as error:
        said = re.sub(r"(?<=line )\d+", lambda found: str(int(found[0]) + offset), str(error))
        raise InputError(
            f"{where}: cannot be read as a table separated by {layout.separator!r}: {said}".strip()
        ) from error


def _notes(layout: Layout, encoding: str, lines: Sequence[str], where: str) -> tuple[str, ...]:
    notes = []
    if encoding != "utf-8-sig":
        names = {"cp1252": "Windows-1252, because it is not UTF-8", "latin-1": "Latin-1"}
        notes.append(f"{where}: read as {names.get(encoding, encoding.upper())}.")
    if layout.header > 0:
        notes.append(
            f"{where}: the names of the columns are in line {layout.header + 1}, "
            f"{lines[layout.header].strip()[:60]!r}; the lines above were left out."
        )
    if layout.units:
        notes.append(
            f"{where}: line {layout.header + 2} has units, {', '.join(layout.units)[:60]!r}; they were not "
            "used."
        )
    if layout.decimal != ".":
        notes.append(f"{where}: the decimal mark is {layout.decimal!r}.")
    return tuple(notes)


def _refuse_cut(text: str, layout: Layout, fields: int, where: str, line: int) -> None:
    """Refuse a file whose last line has no line end and fewer entries than the header: it was cut."""
    last = re.split("[\r\n]", text)[-1]
    count = last.count(layout.separator) + 1
    if last.strip() and count < fields:
        raise InputError(
            f"{where}:{line}: the last line has {count} of {fields} entries and no line end: the file "
            "is cut; get the whole file, or remove that line."
        )

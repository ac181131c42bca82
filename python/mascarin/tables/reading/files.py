"""Files of tables: CSV, spreadsheets and Parquet, without any change."""

from __future__ import annotations

import codecs
import hashlib
import re
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin._io.regular import require_regular
from mascarin._io.tables import read_csv
from mascarin.errors import InputError
from mascarin.tables.arrays import Lines
from mascarin.tables.reading.archives import is_bsrn, is_meteo_france, of_one_station, read_bsrn, unpacked
from mascarin.tables.reading.influx import is_influx, read_influx
from mascarin.tables.reading.layout import Layout, decoded, find_layout, footer_of
from mascarin.tables.reading.numbers import suspicious_decimals
from mascarin.tables.reading.own_readers import name_of, read_own, reader_of
from mascarin.tables.reading.preamble import clock_of_preamble, units_of_preamble
from mascarin.tables.reading.spreadsheets import ENDINGS, sheet_text

if TYPE_CHECKING:
    import pandas as pd


def file_hash(path: Path) -> str:
    """SHA-256 of a file, in hexadecimal.

    Raises
    ------
    InputError
        There is no such file, or it is a pipe or a device.
    """
    return hashlib.sha256(content_of(path)).hexdigest()


def content_of(path: Path) -> bytes:
    """Bytes of a file.

    Raises
    ------
    InputError
        There is no such file, or it is a pipe or a device.
    """
    require_regular(path)
    try:
        return path.read_bytes()
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


@dataclass(frozen=True)
class Read:
    """A file as it was read.

    Attributes
    ----------
    frame : pandas.DataFrame
        Its rows.
    lines : ndarray, shape (n,)
        Line of each row.
    notes : tuple of str
        What was found where nothing was stated.
    units : mapping of str to str
        Entries of the row of units, by the name of the column.
    units_line : int
        Line of that row.
    decimal : str
        Decimal mark.
    decimal_stated : bool
        Whether the user states it.
    decimal_evident : bool
        Whether entries of the file can have this one alone.
    preamble_units : mapping of str to (str, int)
        Units that lines above the names state, and the number of the line.
    clock : (str, int)
        Clock that they state, and the number of the line.
    """

    frame: pd.DataFrame
    lines: Lines
    notes: tuple[str, ...] = ()
    units: Mapping[str, str] = field(default_factory=dict)
    units_line: int = 0
    decimal: str = "."
    decimal_stated: bool = False
    decimal_evident: bool = False
    preamble_units: Mapping[str, tuple[str, int]] = field(default_factory=dict)
    clock: tuple[str, int] = ("", 0)

    @property
    def said_of_itself(self) -> dict[str, Any]:
        """What the file says of its units and marks, for `Table`."""
        names = ("units", "units_line", "decimal", "decimal_stated", "decimal_evident", "preamble_units")
        return {name: getattr(self, name) for name in names}


def _of_archive(path: Path, content: bytes) -> Read | None:
    """A file that says by its first letters how it is read."""
    if is_bsrn(content):
        frame = read_bsrn(path, content)
        said = f"{path.name}: a station-to-archive file of BSRN, record 0100, minutes in UTC."
    elif is_influx(content):
        frame = read_influx(decoded(content, path.name)[0], path.name)
        said = f"{path.name}: annotated CSV of InfluxDB, {len(frame.columns) - 1} series."
    else:
        return None
    rows = 1 + np.arange(len(frame), dtype=np.int64)
    return Read(with_time_column(frame), rows, (said,), dict(frame.attrs.get("units", {})))


def read_frame(
    path: Path, content: bytes, separator: str | None, decimal: str | None, skip_lines: int | None
) -> Read:
    """Read a CSV or Parquet file, or a spreadsheet, without changing it.

    Parameters
    ----------
    path : Path
        The file; its ending shows whether it is Parquet or a spreadsheet.
    content : bytes
        What is in it.
    separator, decimal : str or None
        Between entries of a CSV file, and its decimal mark; None: found.
    skip_lines : int or None
        Lines before the line with the names of the columns; None: found.

    Returns
    -------
    Read
        The table; a time index has become the first column.

    Raises
    ------
    InputError
        The file cannot be read as a table.
    """
    import pandas as pd

    reader = reader_of(path)
    if reader is not None:
        frame = read_own(path, reader)
        units = {str(name): str(unit) for name, unit in dict(frame.attrs.get("units", {})).items()}
        frame = with_time_column(frame)
        said = (f"{path.name}: read by {name_of(reader)}.",)
        return Read(frame, 1 + np.arange(len(frame), dtype=np.int64), said, units)
    if path.suffix.lower() in {".parquet", ".pq"}:
        return _parquet(path)
    named, content = unpacked(path, content)
    archive = _of_archive(path, content)
    if archive is not None:
        return archive
    sheet: tuple[str, ...] = ()
    if named.suffix.lower() in ENDINGS:
        text, sheet = sheet_text(path)
        # Numbers of cells have no marks that could be read in two ways.
        encoding, separator, decimal = "utf-8-sig", separator or "\t", decimal or "."
        content = b""  # a large sheet is put together from its text
    else:
        text, encoding = decoded(content, path.name)
    raw = content.removeprefix(codecs.BOM_UTF8) if encoding == "utf-8-sig" else b""
    body = _large_body(text, raw, path.name, separator, decimal, skip_lines) or _body(
        text, path.name, separator, decimal, skip_lines
    )
    del text  # a large table is in memory once, as far as that is possible
    layout, rows = body.layout, body.rows
    notes = (*sheet, *_notes(layout, encoding, body.head, path.name), *body.notes)
    frame = _parsed(body.content, rows, layout, path.name, doubt=decimal is None)
    frame.columns = pd.Index([str(name).strip() for name in frame.columns])
    notes += _twice(list(frame.columns), path.name)
    if layout.trailing:
        frame = frame.iloc[:, :-1]
    if is_meteo_france(frame):
        frame, station_units, clock = of_one_station(frame, path.name)
        note = f"{path.name}: hourly data of Meteo-France: {clock or 'local clock'}, units as described."
        return Read(frame, rows[: len(frame)] + 1, (*notes, note), station_units, clock=(clock, 1))
    _refuse_cut(body.last, layout, len(frame.columns), path.name, body.count)
    preamble = body.head[: layout.header]
    units = dict(zip(map(str, frame.columns), layout.units, strict=False))
    stated = decimal is not None
    said_units = {
        name: (text, 1 + k) for name, (text, k) in units_of_preamble(preamble, list(frame.columns)).items()
    }
    words, line = clock_of_preamble(preamble)
    return Read(
        frame, rows[: len(frame)] + 1, notes, units, layout.header + 2, layout.decimal, stated,
        layout.evident, said_units, (words, line + 1),
    )  # fmt: skip


def _parquet(path: Path) -> Read:
    import pandas as pd

    try:
        frame = with_time_column(pd.read_parquet(path))
        return Read(frame, 1 + np.arange(len(frame), dtype=np.int64))
    except ImportError as error:
        raise InputError(f"{path.name}: reading Parquet needs pyarrow: install mascarin[parquet].") from error
    except (ValueError, OSError) as error:
        raise InputError(
            f"{path.name}: cannot be read as Parquet ({error}), expected a whole file; write it again."
        ) from error


@dataclass(frozen=True)
class _Body:
    """The rows of a text file below a line with the names."""

    layout: Layout
    content: bytes
    rows: Lines
    head: Sequence[str]
    last: str
    count: int
    notes: tuple[str, ...] = ()


def _body(text: str, where: str, separator: str | None, decimal: str | None, skip_lines: int | None) -> _Body:
    """Line by line: heads that a restart repeats, and remarks at the end, are left out."""
    lines = text.splitlines()
    last, count = text[max(text.rfind("\n"), text.rfind("\r")) + 1 :], len(lines)
    layout = find_layout(lines, where, separator, decimal, skip_lines)
    end = footer_of(lines, layout.first, layout.separator)
    notes: tuple[str, ...] = ()
    if end < len(lines):
        notes += (
            f"{where}: {len(lines) - end} lines below the table, from line {end + 1} on, were left out.",
        )
        lines, last = lines[:end], ""
    rows, repeated = _rows(lines, layout)
    if repeated:
        notes += (f"{where}: the head is repeated in line {repeated[0] + 1}; {len(repeated)} such lines "
                  "were left out.",)  # fmt: skip
    data = (lines[k] for k in rows.tolist()) if repeated else lines[layout.first :]
    body = "\n".join([_names_line(lines, layout), *data])
    return _Body(layout, body.encode(), rows, lines[: layout.first], last, count, notes)


def _names_line(lines: Sequence[str], layout: Layout) -> str:
    header = lines[layout.header] if layout.header < len(lines) else ""
    return (layout.separator.join(layout.names) or header) + layout.separator * layout.trailing


def _large_body(
    text: str, raw: bytes, where: str, separator: str | None, decimal: str | None, skip_lines: int | None
) -> _Body | None:
    """A large file without a loop over its lines; None where it is small, repeats heads or has remarks."""
    if len(text) < _LARGE or "\n" not in text[:_HEAD] or (skip_lines or 0) > _HEAD_LINES:
        return None
    lines = text[: text.rfind("\n", 0, _HEAD)].splitlines()
    layout = find_layout(lines, where, separator, decimal, skip_lines)
    if layout.first > _HEAD_LINES or layout.first >= len(lines):
        return None
    first = 0
    for _ in range(layout.first):
        first = text.find("\n", first) + 1
    starts = {line[:8] for line in lines[: layout.first] if line.strip()}
    tail = text[text.find("\n", len(text) - _HEAD) + 1 :].splitlines()
    if any(text.find("\n" + start, max(first - 1, 0)) >= 0 for start in starts) or footer_of(
        tail, 0, layout.separator
    ) < len(tail):
        return None
    last = text[text.rfind("\n") + 1 :]
    count = text.count("\n", first) + bool(last)
    rows = layout.first + np.arange(count, dtype=np.int64)
    # The head may have letters of several bytes; the rows are not copied before they are put together.
    data_bytes = memoryview(raw or text.encode())[len(text[:first].encode()) :]
    body = b"".join([f"{_names_line(lines, layout)}\n".encode(), data_bytes])
    return _Body(layout, body, rows, lines[: layout.first], last, layout.first + count)


#: Characters from which on a file is not read line by line; characters at both ends that are looked at.
_LARGE: Final = 2_000_000
_HEAD: Final = 200_000
_HEAD_LINES: Final = 150


def _rows(lines: Sequence[str], layout: Layout) -> tuple[Lines, list[int]]:
    """Numbers of the lines with data, and of lines of the head that a restart of the logger wrote again."""
    head = {line.strip() for line in lines[: layout.first] if line.strip()}
    start = {line[:8] for line in head}
    repeated = [
        k
        for k in range(layout.first, len(lines))
        if lines[k][:8] in start and (lines[k].strip() in head or _is_head_again(lines[k], lines, layout))
    ]
    rows = np.arange(layout.first, len(lines), dtype=np.int64)
    return (np.setdiff1d(rows, repeated) if repeated else rows), repeated


def _is_head_again(line: str, lines: Sequence[str], layout: Layout) -> bool:
    """Whether a line is one of the preamble with another number or date in it."""
    if layout.header == 0:
        return False
    first = lines[0]
    return line[:5] == first[:5] and line.count(layout.separator) == first.count(layout.separator)


def _parsed(body: bytes, rows: Lines, layout: Layout, where: str, *, doubt: bool) -> pd.DataFrame:
    import pandas as pd

    options: dict[str, Any] = {
        "sep": layout.separator, "decimal": layout.decimal, "skip_blank_lines": False,
        "skipinitialspace": True, "low_memory": False, "index_col": False,
    }  # fmt: skip
    try:
        with warnings.catch_warnings():
            # Rows with more entries than the header has names: which name they belong to is not known.
            warnings.simplefilter("error", pd.errors.ParserWarning)
            frame = read_csv(BytesIO(body), **options)
    except pd.errors.ParserWarning as error:
        raise InputError(
            f"{where}:{layout.first + 1}: the row has more entries than the header has names, expected as "
            f"many; name every column, or, if {layout.separator!r} is also the decimal mark, write the table "
            "with another separator."
        ) from error
    except (pd.errors.ParserError, pd.errors.EmptyDataError, ValueError) as error:
        said = re.sub(
            r"(?<=line )\d+",
            lambda match: str(int(rows[int(match[0]) - 2]) + 1),
            " ".join(str(error).split()),
        )
        raise InputError(
            f"{where}: cannot be read as a table separated by {layout.separator!r}: {said}; expected the "
            "same number of entries in each line: repair the line, or state another separator."
        ) from error
    doubtful = [
        k
        for k, name in enumerate(frame.columns)
        if doubt
        and k
        and frame.dtypes.iloc[k].kind == "f"
        and suspicious_decimals(frame.iloc[:, k].to_numpy())
    ]
    if doubtful:  # the texts decide between decimals and thousands
        texts = read_csv(BytesIO(body), dtype=str, **options)
        parts = [texts.iloc[:, k] if k in doubtful else frame.iloc[:, k] for k in range(frame.shape[1])]
        frame = pd.concat(parts, axis=1)
    return frame


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
        notes.append(f"{where}: line {layout.header + 2} has units, {', '.join(layout.units)[:60]!r}.")
    if layout.decimal != ".":
        notes.append(f"{where}: the decimal mark is {layout.decimal!r}.")
    return tuple(notes)


def _twice(names: Sequence[str], where: str) -> tuple[str, ...]:
    """A note about names that stand above several columns: the reader of CSV numbers the later ones."""
    later = [name for name in names if name.endswith(".1") and name[:-2] in names]
    return tuple(
        f"{where}: {name[:-2]!r} stands above several columns: the second one is called {name!r}."
        for name in later
    )


def _refuse_cut(last: str, layout: Layout, fields: int, where: str, line: int) -> None:
    """Refuse a file whose last line has no line end and fewer entries than the header: it was cut."""
    count = last.count(layout.separator) + 1
    if last.strip() and count < fields:
        raise InputError(
            f"{where}:{line}: the last line has {count} of {fields} entries, "
            f"{last.strip()[:40]!r}, and no line end, expected all: the file is cut; get the whole file, or "
            "remove that line."
        )

"""Files of tables: CSV, spreadsheets and Parquet, without any change."""

from __future__ import annotations

import codecs
import hashlib
import re
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin._io.regular import require_regular
from mascarin._io.tables import JoinedBytes, read_csv
from mascarin.errors import InputError
from mascarin.tables.arrays import Lines
from mascarin.tables.reading.archives import is_bsrn, is_meteo_france, of_one_station, read_bsrn, unpacked
from mascarin.tables.reading.influx import is_influx, read_influx
from mascarin.tables.reading.layout import Layout, cells_of, decoded, find_layout, footer_of
from mascarin.tables.reading.numbers import suspicious_decimals
from mascarin.tables.reading.own_readers import Reader, name_of, read_own, reader_of
from mascarin.tables.reading.preamble import clock_of_preamble, repeated_names, units_of_preamble
from mascarin.tables.reading.spreadsheets import ENDINGS, sheet_text
from mascarin.tables.stamps.iso_stamps import ISO_TEXT, MIDNIGHT

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
    path: Path,
    content: bytes,
    separator: str | None,
    decimal: str | None,
    skip_lines: int | None,
    time: str | None = None,
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
    time : str or None
        The column whose stamps may come back as times: where it is the first one of a large file, they are
        read with the numbers. Empty: whichever is the first; None: none.

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
        return _by_own_reader(path, reader)
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
    elif _is_plain(content):
        text, encoding = "", "utf-8-sig"  # its bytes are its letters
    else:
        text, encoding = decoded(content, path.name)
    raw = content.removeprefix(codecs.BOM_UTF8) if encoding == "utf-8-sig" else b""
    body = _large_body(raw or text.encode(), path.name, separator, decimal, skip_lines) or _body(
        text or decoded(content, path.name)[0], path.name, separator, decimal, skip_lines
    )
    del text  # a large table is in memory once, as far as that is possible
    layout = body.layout
    notes = (*sheet, *_notes(layout, encoding, body.head, path.name), *body.notes)
    frame = _parsed(body, path.name, doubt=decimal is None, dated=_is_dated(body, time))
    rows = layout.first + np.arange(1, len(frame) + 1) if body.rows is None else body.rows[: len(frame)] + 1
    frame.columns = pd.Index([str(name).strip() for name in frame.columns])
    notes += repeated_names(list(frame.columns), path.name)
    if layout.trailing:
        frame = frame.iloc[:, :-1]
    if is_meteo_france(frame):
        frame, station_units, clock = of_one_station(frame, path.name)
        note = f"{path.name}: hourly data of Meteo-France: {clock or 'local clock'}, units as described."
        return Read(frame, rows, (*notes, note), station_units, clock=(clock, 1))
    count = layout.first + len(frame) if body.rows is None else body.count
    _refuse_cut(body.last, layout, len(frame.columns), path.name, count)
    preamble = body.head[: layout.header]
    units = dict(zip(map(str, frame.columns), layout.units, strict=False))
    stated = decimal is not None
    said_units = {
        name: (text, 1 + k) for name, (text, k) in units_of_preamble(preamble, list(frame.columns)).items()
    }
    words, line = clock_of_preamble(preamble)
    return Read(
        frame, rows, notes, units, layout.header + 2, layout.decimal, stated,
        layout.evident, said_units, (words, line + 1),
    )  # fmt: skip


def _by_own_reader(path: Path, reader: Reader) -> Read:
    frame = read_own(path, reader)
    units = {str(name): str(unit) for name, unit in dict(frame.attrs.get("units", {})).items()}
    said = (f"{path.name}: read by {name_of(reader)}.",)
    return Read(with_time_column(frame), 1 + np.arange(len(frame), dtype=np.int64), said, units)


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
    """The rows of a text file below a line with the names.

    Attributes
    ----------
    layout : Layout
        Where they begin, and how they are written.
    names : bytes
        The line with the names.
    content : bytes
        The file, or its rows alone.
    begin : int
        Where they begin in it.
    rows : ndarray, shape (n,), or None
        Number of the line of each, from 0; None where all lines below the names are rows.
    head : sequence of str
        Lines above them.
    first : sequence of str
        The first rows; empty for a small file.
    last : str
        The last line.
    count : int
        Lines of the file; 0 where all lines below the names are rows.
    notes : tuple of str
        What was left out.
    """

    layout: Layout
    names: bytes
    content: bytes
    begin: int
    rows: Lines | None
    head: Sequence[str]
    first: Sequence[str]
    last: str
    count: int = 0
    notes: tuple[str, ...] = ()

    def stream(self) -> JoinedBytes:
        """The names and the rows as a file."""
        return JoinedBytes([self.names, memoryview(self.content)[self.begin :]])

    def has_blanks(self, size: int | None = None) -> bool:
        """Whether entries in the first bytes, or in all, begin with a blank: skipping them takes time."""
        mark = self.layout.separator.encode()
        stop = len(self.content) if size is None else self.begin + size
        in_rows = any(
            self.names.find(before + b" ") >= 0 or self.content.find(before + b" ", self.begin, stop) >= 0
            for before in (mark, b"\n", b"\r")
        )
        return in_rows or self.content[self.begin : self.begin + 1] == b" "


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
    content = "\n".join(data).encode()
    return _Body(
        layout, _names_line(lines, layout), content, 0, rows, lines[: layout.first], (), last, count, notes
    )


def _names_line(lines: Sequence[str], layout: Layout) -> bytes:
    header = lines[layout.header] if layout.header < len(lines) else ""
    names = (layout.separator.join(layout.names) or header) + layout.separator * layout.trailing
    return f"{names}\n".encode()


def _is_plain(content: bytes) -> bool:
    """Whether a large file has letters of ASCII alone: its text is not made, which would take memory."""
    return len(content) >= _LARGE and content.isascii() and b"\0" not in content


def _large_body(
    raw: bytes, where: str, separator: str | None, decimal: str | None, skip_lines: int | None
) -> _Body | None:
    """A large file without a loop over its lines; None where it is small, repeats heads or has remarks."""
    if len(raw) < _LARGE or b"\n" not in raw[:_HEAD] or (skip_lines or 0) > _HEAD_LINES:
        return None
    lines = raw[: raw.rfind(b"\n", 0, _HEAD)].decode().splitlines()
    layout = find_layout(lines, where, separator, decimal, skip_lines)
    if layout.first > _HEAD_LINES or layout.first >= len(lines):
        return None
    first = 0
    for _ in range(layout.first):
        first = raw.find(b"\n", first) + 1
    starts = {line[:8] for line in lines[: layout.first] if line.strip()}
    tail = raw[raw.find(b"\n", len(raw) - _HEAD) + 1 :].decode().splitlines()
    if any(raw.find(f"\n{start}".encode(), max(first - 1, 0)) >= 0 for start in starts) or footer_of(
        tail, 0, layout.separator
    ) < len(tail):
        return None
    last = raw[raw.rfind(b"\n") + 1 :].decode()
    names, head = _names_line(lines, layout), lines[: layout.first]
    return _Body(layout, names, raw, first, None, head, lines[layout.first :][:2], last)


def _is_dated(body: _Body, time: str | None) -> bool:
    """Whether the first column has stamps of ISO 8601, with a time of day that is not in another column."""
    if len(body.first) < 2 or time is None:
        return False
    name = cells_of(body.names.decode(), body.layout.separator)[0]
    entries = [cells_of(line, body.layout.separator)[0] for line in body.first]
    return time in ("", name) and bool(
        all(ISO_TEXT.fullmatch(entry) for entry in entries) and not MIDNIGHT.search(entries[1])
    )


#: Bytes from which on a file is not read line by line; bytes at both ends that are looked at.
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


def _parsed(body: _Body, where: str, *, doubt: bool, dated: bool) -> pd.DataFrame:
    """The rows as a frame; with `dated`, the stamps of the first column as times where all can be read."""
    import pandas as pd

    layout = body.layout
    options: dict[str, Any] = {
        "sep": layout.separator, "decimal": layout.decimal, "skip_blank_lines": False, "index_col": False,
    }  # fmt: skip
    try:
        with warnings.catch_warnings():
            # Rows with more entries than the header has names: which name they belong to is not known.
            warnings.simplefilter("error", pd.errors.ParserWarning)
            frame = _read(body, options, dated)
    except pd.errors.ParserWarning as error:
        raise InputError(
            f"{where}:{layout.first + 1}: the row has more entries than the header has names, expected as "
            f"many; name every column, or, if {layout.separator!r} is also the decimal mark, write the table "
            "with another separator."
        ) from error
    except (pd.errors.ParserError, pd.errors.EmptyDataError, ValueError) as error:

        def line(match: re.Match[str]) -> str:
            row = int(match[0]) - 2
            return str((layout.first + row if body.rows is None else int(body.rows[row])) + 1)

        said = re.sub(r"(?<=line )\d+", line, " ".join(str(error).split()))
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
        texts = read_csv(
            body.stream(),
            dtype=str,
            skipinitialspace=True,
            **options,
        )
        parts = [texts.iloc[:, k] if k in doubtful else frame.iloc[:, k] for k in range(frame.shape[1])]
        frame = pd.concat(parts, axis=1)
    return frame


def _read(body: _Body, options: Mapping[str, Any], dated: bool) -> pd.DataFrame:
    """Blanks before entries are skipped where there are some: numbers are read with them, too."""
    import pandas as pd

    skip = {"skipinitialspace": True}
    if body.layout.separator.isspace() or body.has_blanks(_HEAD):
        return _in_pieces(body, {**options, **skip}, dated)
    try:
        frame = _in_pieces(body, options, dated)
    except (pd.errors.ParserError, pd.errors.ParserWarning, ValueError):
        if not body.has_blanks():
            raise
        return _in_pieces(body, {**options, **skip}, dated)
    plain = all(dtype.kind in "iufM" for dtype in frame.dtypes)
    return frame if plain or not body.has_blanks() else _in_pieces(body, {**options, **skip}, dated)


def _in_pieces(body: _Body, options: Mapping[str, Any], dated: bool) -> pd.DataFrame:
    """Read the rows piece by piece, and all at once where the pieces disagree on what a column holds."""
    import pandas as pd

    dates: dict[str, Any] = {"parse_dates": [0], "date_format": "ISO8601"} if dated else {}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", pd.errors.DtypeWarning)
            frame = read_csv(body.stream(), **options, **dates)
    except pd.errors.DtypeWarning:
        frame = read_csv(body.stream(), low_memory=False, **options, **dates)
    if dates and (frame.dtypes.iloc[0].kind != "M" or frame.iloc[:, 0].isna().any()):
        return _in_pieces(body, options, dated=False)  # an offset, 24:00, no time at all: read with care
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


def _refuse_cut(last: str, layout: Layout, fields: int, where: str, line: int) -> None:
    """Refuse a file whose last line has no line end and fewer entries than the header: it was cut."""
    count = last.count(layout.separator) + 1
    if last.strip() and count < fields:
        raise InputError(
            f"{where}:{line}: the last line has {count} of {fields} entries, "
            f"{last.strip()[:40]!r}, and no line end, expected all: the file is cut; get the whole file, or "
            "remove that line."
        )

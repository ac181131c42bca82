"""Spreadsheets as the text of a table, for the reader of all other tables."""

from __future__ import annotations

import csv
import io
from datetime import date, datetime, time, timedelta
from pathlib import Path
from typing import Any, Final
from zipfile import BadZipFile

from mascarin._io import memory
from mascarin.errors import InputError

ENDINGS: Final = (".xlsx", ".xlsm")
"""Endings of the files that are read."""

#: Memory for a cell while it becomes text (measured: 150). [B]
_BYTES: Final = 200.0


def sheet_text(path: Path) -> tuple[str, tuple[str, ...]]:
    """The first sheet with a table as text, with tabs between entries and points before decimals.

    Parameters
    ----------
    path : Path
        The spreadsheet.

    Returns
    -------
    text : str
        One line for each row; dates in ISO 8601.
    notes : tuple of str
        Which sheet was read, where there are several.

    Raises
    ------
    InputError
        openpyxl is not installed, or the file cannot be read.
    """
    try:
        import openpyxl
    except ImportError:
        raise InputError(
            f"{path.name}: reading a spreadsheet needs openpyxl: install mascarin[xlsx], or save the sheet "
            "as CSV."
        ) from None
    try:
        book = openpyxl.load_workbook(path, read_only=True, data_only=True)
        names = list(book.sheetnames)
        for name in names:
            sheet = book[name]
            memory.require(
                float(sheet.max_row or 1) * float(sheet.max_column or 1) * _BYTES,
                f"{path.name}: {sheet.max_row} rows of {sheet.max_column} cells",
                "save the part that is needed as CSV",
            )
            out = io.StringIO()
            writer = csv.writer(out, delimiter="\t", lineterminator="\n")
            writer.writerows([_text(value) for value in row] for row in sheet.iter_rows(values_only=True))
            # A sheet of remarks alone stands before that of the table in many workbooks.
            if sum(bool(line.strip()) for line in out.getvalue().splitlines()) > 2 or (
                name == names[-1] and out.getvalue().strip()
            ):
                skipped = [other for other in names if other != name]
                said = f"{path.name}: read from the sheet {name!r}; {', '.join(map(repr, skipped))} left out."
                return out.getvalue(), (said,) if skipped else ()
    except (BadZipFile, KeyError, ValueError, OSError, TypeError) as error:
        raise InputError(
            f"{path.name}: cannot be read as a spreadsheet ({error}), expected a whole workbook; save the "
            "sheet as CSV."
        ) from error
    raise InputError(f"{path.name}: found no cell with content; expected a table in one of its sheets.")


def _text(value: Any) -> str:
    """A cell as text."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return str(int(value))
    if isinstance(value, datetime):
        rounded = value + timedelta(microseconds=500)
        return f"{rounded:%Y-%m-%d %H:%M:%S}" + (
            f".{rounded.microsecond // 1000:03d}" * (rounded.microsecond >= 1000)
        )
    if isinstance(value, date):
        return value.isoformat()
    if isinstance(value, time):
        return f"{value:%H:%M:%S}"
    return repr(value) if isinstance(value, int | float) else str(value).replace("\n", " ").strip()

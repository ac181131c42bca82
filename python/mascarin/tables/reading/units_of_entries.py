"""Units that stand in the rows of a table: behind each number, or in a column of their own."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from mascarin.errors import InputError
from mascarin.tables.reading.numbers import EMPTY
from mascarin.tables.reading.rows import has_numbers
from mascarin.tables.units import parse_unit

if TYPE_CHECKING:
    import pandas as pd

#: A number, and what is written behind it.
_WITH_UNIT: Final = r"^\s*([-+\u2212]?\d[\d.,' ]*?)\s*([^\d\s.,'+-].*?)\s*$"


def without_units(frame: pd.DataFrame, where: str) -> tuple[pd.DataFrame, dict[str, str]]:
    """Columns whose entries all have the same known unit behind the number, without it.

    Parameters
    ----------
    frame : pandas.DataFrame
        As read.
    where : str
        File, for errors.

    Returns
    -------
    frame : pandas.DataFrame
        Numbers as texts, where there were units.
    units : mapping of str to str
        The units, by column; also those of a column beside it.

    Raises
    ------
    InputError
        Rows of one column have different units.
    """
    import pandas as pd

    units = units_beside(frame, where)
    if not frame.columns.is_unique:
        return frame, units
    columns = {}
    for name in frame.columns:
        if pd.api.types.is_numeric_dtype(frame[name].dtype):
            continue
        entries = frame[name].dropna()
        if not len(entries) or not isinstance(entries.iloc[0], str):
            continue
        first = re.match(_WITH_UNIT, entries.iloc[0])
        if first is None or parse_unit(first[2]) is None:
            continue
        parts = frame[name].astype(str).str.extract(_WITH_UNIT)
        numbers, written = parts[0], parts[1]
        has_number = numbers.notna()
        empty = frame[name].isna() | frame[name].astype(str).str.strip().str.lower().isin(EMPTY)
        if (has_number | empty).all() and (written[has_number] == first[2]).all():
            columns[name], units[str(name)] = numbers, first[2]
    if not columns:
        return frame, units
    return frame.assign(**{str(name): column for name, column in columns.items()}), units


#: Names of a column that holds the units of the one beside it, such as that of an iButton.
_UNIT_NAME: Final = re.compile(r"units?|uom|einheit|unité|unidad|unidade|unità|jednostka", re.IGNORECASE)


def units_beside(frame: pd.DataFrame, where: str) -> dict[str, str]:
    """Units that a column called so states for the column beside it.

    Parameters
    ----------
    frame : pandas.DataFrame
        As read.
    where : str
        File, for errors.

    Returns
    -------
    dict of str to str
        Unit of the column behind it that has numbers, else of that before it.

    Raises
    ------
    InputError
        The rows have different units.
    """
    units: dict[str, str] = {}
    names = list(frame.columns)
    if not frame.columns.is_unique:
        return units
    for position, name in enumerate(names):
        if not _UNIT_NAME.fullmatch(str(name).strip()):
            continue
        entries = frame[name].dropna().astype(str).str.strip()
        written = [text for text in entries.unique().tolist() if text.lower() not in EMPTY]
        if not written or any(parse_unit(text) is None for text in written):
            continue
        beside = [
            k for k in (position + 1, position - 1) if 0 < k < len(names) and has_numbers(frame[names[k]])
        ]
        if not beside:
            continue
        column = str(names[beside[0]])
        if len({parse_unit(text) for text in written}) > 1:
            raise InputError(
                f"{where}: column {name!r} has the units {' and '.join(map(repr, written[:4]))} for the rows "
                f"of {column!r}; expected one unit in a column: write a file for each unit."
            )
        units[column] = written[0]
    return units

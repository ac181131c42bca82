"""Columns of a table as a record on a regular grid."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from mascarin.errors import InputError, did_you_mean
from mascarin.tables.arrays import Array
from mascarin.tables.columns import Column
from mascarin.tables.reading.interval_labels import knot_lines, to_starts
from mascarin.tables.reading.numbers import without_codes
from mascarin.tables.reading.table import Stamps, Table
from mascarin.tables.record import Kind, Origin, Record
from mascarin.tables.units import ENERGIES, HEATS, StatedUnit

Columns = Mapping[str, str | Column | Mapping[str, object]]


def record_of_columns(
    table: Table, columns: Iterable[str] | Columns | None, mean: Iterable[str], stamps: Stamps
) -> Record:
    """Some columns of a table as a record.

    Parameters
    ----------
    table : Table
        From `read_table`.
    columns : iterable or mapping or None
        Columns to read, or name -> column or `{column, unit, scale, offset, kind, overrule}`. None: all.
    mean : iterable of str
        Columns that are means over their interval; the others are values at the stamp.
    stamps : str
        `start` or `end`: which end of its interval a stamp marks.

    Returns
    -------
    Record
        The columns, labelled by the start of each interval.

    Raises
    ------
    InputError
        A column is missing, or an entry cannot be used.
    """
    selection: Iterable[str] | Columns
    selection, words = (table.numeric, table.words) if columns is None else (columns, [])
    pairs = selection.items() if isinstance(selection, Mapping) else [(name, name) for name in selection]
    chosen = {name: Column.of(entry, f"{table.where}: columns.{name}") for name, entry in pairs}
    kinds: dict[str, Kind] = {name: column.kind or "instant" for name, column in chosen.items()}
    for name in mean:
        if name not in kinds:
            raise InputError(
                f"{table.where}: mean: {name!r} is not read, expected a column that is. "
                f"{did_you_mean(name, kinds)}".rstrip()
            )
        kinds[name] = "mean"
    values, origins = {}, {}
    for name, column in chosen.items():
        values[name], origins[name] = converted(table, column, name, "")
        if column.kind is None and origins[name].of_interval:
            kinds[name] = "mean"
    start_values, closing, grid, note = to_starts(table, values, kinds, stamps)
    left_out = [f"{table.where}: left out, without a number: {', '.join(words)}."] if words else []
    said = (*table.notes, note, *left_out, *(f"{table.where}: {origin.line}" for origin in origins.values()))
    return Record(
        start_values, kinds, grid, closing, table.where, table.sha256, said, table.lines,
        knot_lines(table.lines, stamps), origins=origins,
    )  # fmt: skip


def converted(table: Table, column: Column, name: str, unit: str) -> tuple[Array, Origin]:
    """Values of a column in the wanted unit.

    Parameters
    ----------
    table : Table
        From `read_table`.
    column : Column
        Which column, and what the user states of it.
    name : str
        What it is read for.
    unit : str
        Wanted unit; empty where the use of the column is not known.

    Returns
    -------
    values : ndarray, shape (n,)
        In the wanted unit.
    origin : Origin
        Where they come from.

    Raises
    ------
    InputError
        There is no such column, an entry is no number, or units contradict each other.
    """
    where = f"{table.where}: {name}"
    raw, codes = without_codes(table.numbers(column.column, name, compass=unit == "deg"))
    stated = None if column.overrule else table.stated_unit(column.column)
    if stated is None and column.unit is None and not column.overrule:
        _require_settled_letter(raw, column, name, table)
    settled = column.settled(stated, unit, table.interval, table.names, where)
    if settled.unit in HEATS and _is_meter(raw):
        return _as_read(raw, settled, stated, name, table)
    values = settled.convert(raw, unit, table.interval, where)
    if settled.unit == "degC" and not column.overrule:
        _require_celsius(values, column, where)
    words = {**table.empty_words(column.column), **codes}
    remaining_unit = "" if stated is None or settled.unit is not None else stated.unit
    stated_somewhere = stated is not None or settled != Column(column.column, kind=column.kind)
    of_interval = settled.unit in ENERGIES or settled.unit in HEATS
    return values, Origin(
        remaining_unit, stated_somewhere, settled.line(name, unit, values, stated, words), of_interval
    )


def _require_settled_letter(values: Array, column: Column, name: str, table: Table) -> None:
    """Refuse a column called such as T_F whose values can be degF alone, or degC of something hot."""
    letter = _LETTER.fullmatch(column.column.strip())
    if letter is None or column.scale != 1.0 or column.offset != 0.0:
        return
    middle = float(np.nanmedian(values)) if np.any(np.isfinite(values)) else 0.0
    if _USUAL < middle < _BOILING:
        raise InputError(
            f"{table.where}: {name}: the column {column.column!r} has {np.nanmin(values):g} .. "
            f"{np.nanmax(values):g} and a name that may say degF; expected a stated unit. Write "
            f"{{column: {column.column!r}, unit: degF}}, or unit: degC."
        )


def _require_celsius(values: Array, column: Column, where: str) -> None:
    """Refuse temperatures that are stated in degC and look like kelvins throughout."""
    valid = values[np.isfinite(values)]
    if len(valid) and valid.min() > _KELVINS[0] and valid.max() < _KELVINS[1]:
        raise InputError(
            f"{where}: found {valid.min():g} .. {valid.max():g} degC in the column {column.column!r}, as the "
            "unit is stated; expected temperatures of a building. They look like K: write "
            f"{{column: {column.column!r}, unit: K, overrule: true}}, or unit: degC with overrule: true where"
            " they are right."
        )


#: Temperatures of weather and buildings in kelvins.
_KELVINS: Final = (220.0, 345.0)
_LETTER: Final = re.compile(r"(?i:t|temp|temperature)[a-z0-9]*[_ ]F")
#: Temperatures of rooms and of outdoors are below the first one in degC, and below the second one in degF.
_USUAL: Final = 42.0
_BOILING: Final = 130.0


def _is_meter(values: Array) -> bool:
    """Whether a column never falls and is far above its steps: the total of a meter."""
    valid = values[np.isfinite(values)]
    steps = np.diff(valid)
    return bool(
        len(valid) > 5 and np.all(steps >= 0.0) and valid[-1] > valid[0] and valid[-1] > 3.0 * steps.max()
    )


def _as_read(
    raw: Array, column: Column, stated: StatedUnit | None, name: str, table: Table
) -> tuple[Array, Origin]:
    """The total of a meter without a conversion; a power that a user wants from it is refused elsewhere."""
    plain = replace(column, unit=None)
    unit = str(column.unit)
    line = plain.line(name, "", raw, stated, table.empty_words(column.column))
    return raw * column.scale + column.offset, Origin(
        unit, True, f"{line} It never falls: the total of a meter in {unit}."
    )

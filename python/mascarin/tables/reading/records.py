"""Columns of a table as a record on a regular grid."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from mascarin.errors import InputError, did_you_mean
from mascarin.tables.columns import Column
from mascarin.tables.interval_labels import knot_lines, to_starts
from mascarin.tables.reading.table import Stamps, Table
from mascarin.tables.record import Kind, Record

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
        Columns to read, or name -> column or `{column, unit, scale, offset, kind}`. None: all.
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
    wanted: Iterable[str] | Columns
    wanted = [str(name) for name in table.frame.columns] if columns is None else columns
    pairs = wanted.items() if isinstance(wanted, Mapping) else [(name, name) for name in wanted]
    chosen = {name: Column.of(given, f"{table.where}: columns.{name}") for name, given in pairs}
    kinds: dict[str, Kind] = {name: column.kind or "instant" for name, column in chosen.items()}
    for name in mean:
        if name not in kinds:
            raise InputError(
                f"{table.where}: mean: {name!r} is not read. {did_you_mean(name, kinds)}".rstrip()
            )
        kinds[name] = "mean"
    values, notes = {}, []
    for name, column in chosen.items():
        raw = table.numbers(column.column, name)
        values[name] = column.convert(raw, "", table.interval, f"{table.where}: {name}")
        notes.append(column.sentence(name, ""))
    kept, closing, grid, note = to_starts(table, values, kinds, stamps)
    said = (*table.notes, note, *(f"{table.where}: {text}" for text in notes if text))
    return Record(
        kept, kinds, grid, closing, table.where, table.sha256, said, table.lines,
        knot_lines(table.lines, stamps),
    )  # fmt: skip

"""Label the intervals of a table by their start, whichever end its stamps mark."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, cast

import numpy as np

from mascarin.errors import InputError
from mascarin.tables.arrays import Array, Lines
from mascarin.tables.grid import Grid
from mascarin.tables.reading.table import Table
from mascarin.tables.record import Kind
from mascarin.tables.times import epoch_seconds

if TYPE_CHECKING:
    import pandas as pd


def to_starts(
    table: Table, values: Mapping[str, Array], kinds: Mapping[str, Kind], stamps: str
) -> tuple[dict[str, Array], dict[str, float], Grid, str]:
    """Label intervals by their start.

    Parameters
    ----------
    table : Table
        Gives times and step.
    values : mapping of str to ndarray, shape (n,)
        Columns in the order of the stamps.
    kinds : mapping
        Kind of each column.
    stamps : str
        `start` or `end`.

    Returns
    -------
    columns : dict
        Columns by the start of the interval, shape (n,).
    closing : dict
        Instants at the end of the record.
    grid : Grid
        The intervals.
    note : str
        What was done.

    Raises
    ------
    InputError
        `stamps` is neither `start` nor `end`.
    """
    if stamps not in ("start", "end"):
        raise InputError(f"{table.where}: stamps is {stamps!r}, expected 'start' or 'end'.")
    first = float(epoch_seconds(cast("pd.DatetimeIndex", table.frame.index[:1]))[0])
    late = stamps == "end"
    grid = Grid(first - (table.interval if late else 0.0), table.interval, len(table.frame), table.zone)
    columns, closing = {}, {}
    for name, column in values.items():
        if kinds[name] == "instant":
            columns[name] = np.concatenate([column[:1], column[:-1]]) if late else column
            closing[name] = float(column[-1])
        else:
            columns[name] = column
    means = [name for name in values if kinds[name] == "mean"]
    edge = "the end" if late else "the start"
    note = f"{table.where}: a stamp marks {edge} of its interval; "
    note += f"means: {', '.join(means)}; " if means else "no means; "
    note += "all other columns are values at the stamp"
    note += ", means moved to the start" if late and means else ""
    held = "the first is also used at the start" if late else "the last is also used at the end"
    note += f"; of these {held} of the record."
    return columns, closing, grid, note


def knot_lines(lines: Lines, stamps: str) -> Lines:
    """Line of the instants at the start of each interval and at the end of the last.

    Parameters
    ----------
    lines : ndarray, shape (n,)
        Line of each row of the table.
    stamps : str
        `start` or `end`; with `end`, instants are those of the next row.

    Returns
    -------
    ndarray, shape (n + 1,)
        Lines.
    """
    return np.concatenate([lines[:1], lines] if stamps == "end" else [lines, lines[-1:]])

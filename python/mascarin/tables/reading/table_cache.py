"""What reading a measured table gave, kept as what a weather file gave: pandas takes longer than a run."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any, Final, TypeVar

import numpy as np

from mascarin._io.sealed.cache import Cached, cached
from mascarin.tables import columns, encodings, timezones, units
from mascarin.tables.grid import Grid
from mascarin.tables.reading import (
    archives,
    files,
    interval_labels,
    layout,
    numbers,
    order,
    preamble,
    records,
    rows,
    spreadsheets,
    table,
    units_of_entries,
)
from mascarin.tables.reading.files import file_hash
from mascarin.tables.reading.own_readers import reader_of
from mascarin.tables.record import Origin, Record
from mascarin.tables.stamps import clocks, digit_groups, formats, iso_stamps, months, time_columns
from mascarin.tables.timezones import parse_timezone

AnyRecord = TypeVar("AnyRecord", bound=Record)

#: Modules that make a record of a table, beside that of the caller.
_CODE: Final = (
    archives, clocks, columns, digit_groups, encodings, files, formats, interval_labels, iso_stamps, layout,
    months, numbers, order, preamble, records, rows, spreadsheets, table, time_columns, timezones, units,
    units_of_entries,
)  # fmt: skip
#: Larger files have more numbers than the cache keeps: their hash alone would take time. [B]
_LARGEST: Final = 48 * 2**20
_LINES: Final = "lines"
_KNOTS: Final = "knots"


def cached_record(
    kind: type[AnyRecord],
    source: object,
    timezone: str | None,
    options: Sequence[object],
    code: Sequence[ModuleType],
    make: Callable[[], AnyRecord],
) -> AnyRecord:
    """Read the record that was kept for a file and these options, or make and keep it.

    Parameters
    ----------
    kind : type
        `Record`, or a class made from it.
    source : str, Path or other object
        The table. Only what was read from a file is kept.
    timezone : str or None
        Zone of the stamps.
    options : sequence of object
        All else that the record depends on: plain values, mappings and sequences of them.
    code : sequence of module
        The modules that make it, beside those that read every table.
    make : callable
        Makes it; what it raises is passed on.

    Returns
    -------
    Record
        The same, whether it was kept or made.
    """
    # What readers of others make depends on their code, which is not known.
    if not isinstance(source, str | Path) or timezone is None or reader_of(Path(source)) is not None:
        return make()
    path = Path(source)
    if path.is_file() and path.stat().st_size > _LARGEST:
        return make()
    zone = parse_timezone(timezone, f"{path.name}: timezone")
    # The representation of plain values says all about them.
    key = (kind.__name__, file_hash(path), path.name, timezone, *map(_plain, options))
    entry = cached(key, (*_CODE, *code), lambda: _packed(make()))
    return _unpacked(kind, entry, Grid(zone=zone, **entry.notes["grid"]), path.name)


def _plain(value: object) -> object:
    """Mappings in their order, and sequences as tuples."""
    if isinstance(value, Mapping):
        return tuple((key, _plain(item)) for key, item in value.items())
    return tuple(map(_plain, value)) if isinstance(value, list | tuple) else value


def _packed(record: Record) -> Cached:
    """A record as the cache keeps it."""
    grid, knots = record.grid, record.knots
    notes: dict[str, Any] = {
        "grid": {"start": grid.start, "interval": grid.interval, "count": grid.count},
        "kinds": dict(record.kinds),
        "closing": {name: float(value) for name, value in record.closing.items()},
        "sha256": record.sha256,
        "provenance": list(record.provenance),
        "origins": {
            name: [origin.unit, origin.stated, origin.line, origin.of_interval]
            for name, origin in record.origins.items()
        },
        "last": None if knots is None else int(knots[-1]),
    }
    notes |= {name: sorted(getattr(record, name)) for name in record.name_sets}
    numbers = {f"column {name}": values for name, values in record.columns.items()}
    numbers[_LINES] = record.lines.astype(np.float64)
    if knots is not None:
        numbers[_KNOTS] = knots[:-1].astype(np.float64)
    return Cached(notes, numbers)


def _unpacked(kind: type[AnyRecord], entry: Cached, grid: Grid, where: str) -> AnyRecord:
    """The record of `_packed`."""
    notes, numbers = entry.notes, dict(entry.columns)
    lines = numbers.pop(_LINES).astype(np.int64)
    knots = None
    if notes["last"] is not None:
        knots = np.append(numbers.pop(_KNOTS).astype(np.int64), np.int64(notes["last"]))
    origins = {name: Origin(*parts) for name, parts in notes["origins"].items()}
    more: dict[str, Any] = {name: frozenset(notes[name]) for name in kind.name_sets}
    return kind(
        columns={name.removeprefix("column "): values for name, values in numbers.items()},
        kinds=notes["kinds"], grid=grid, closing=notes["closing"], file=where, sha256=notes["sha256"],
        provenance=tuple(notes["provenance"]), lines=lines, knots=knots, origins=origins, **more,
    )  # fmt: skip

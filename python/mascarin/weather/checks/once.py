"""What a check of a record says, kept in this process and in the cache of the user.

A check may take as long as a run, and each run of a building in the same weather asks for it.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Sequence
from types import ModuleType
from typing import Final

from mascarin._io.sealed.cache import Cached, cached
from mascarin.tables.arrays import Array
from mascarin.tables.timezones import zone_name
from mascarin.weather.records.record import WeatherRecord

#: Sentences by key, for this process; the oldest ones are forgotten.
_SAID: Final[dict[tuple[object, ...], tuple[str, ...]]] = {}
_MOST: Final = 1024


def said_once(
    record: WeatherRecord,
    columns: Iterable[Array],
    key: Sequence[object],
    code: Sequence[ModuleType],
    check: Callable[[], Sequence[str]],
) -> tuple[str, ...]:
    """Sentences of a check of a record, or what was kept of it.

    Parameters
    ----------
    record : WeatherRecord
        Its file and its times are a part of the key.
    columns : iterable of ndarray
        The numbers that the check reads.
    key : sequence of object
        Name of the check, and all else that it depends on.
    code : sequence of module
        The modules that make it.
    check : callable
        Makes the sentences; what it raises is passed on, and nothing is kept.
    """
    grid = record.grid
    digest = hashlib.sha256(b"".join(column.tobytes() for column in columns)).hexdigest()
    of_record = (record.file, grid.start, grid.interval, zone_name(grid.zone))
    identity = (digest, *map(repr, key), *of_record)
    said = _SAID.get(identity)
    if said is None:
        entry = cached((digest, *key, *of_record), code, lambda: Cached({"said": [*check()]}))
        said = tuple(entry.notes["said"])
        if len(_SAID) >= _MOST:
            _SAID.pop(next(iter(_SAID)), None)
        _SAID[identity] = said
    return said

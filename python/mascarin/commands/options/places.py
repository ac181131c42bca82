"""Lines of a building file in errors that are found after it has been read."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from mascarin.errors import InputError

#: An error about a zone, and one about a column that a table does not have.
_ZONE: Final = re.compile(r"zones\.(?P<name>[\w-]+): ")
_COLUMN: Final = re.compile(r"no column '(?P<name>[^']+)'")
#: Keys of a building that name a column.
_KEYS: Final = ("column", "measured", "irradiance")


@contextmanager
def lines_named(building: Path) -> Iterator[None]:
    """Put file and line of the building in front of errors about its flows and columns.

    Parameters
    ----------
    building : Path
        The building, which has been read before.

    Raises
    ------
    InputError
        The same error, with its place.
    """
    try:
        yield
    except InputError as error:
        where = _location(str(error), building)
        if where is None:
            raise
        raise InputError(f"{where}: {error}") from None


def _location(text: str, building: Path) -> str | None:
    from mascarin.study.file.locations import Places

    if zone := _ZONE.match(text):
        return Places(building).at("zones", zone["name"]).removesuffix(f": zones.{zone['name']}")
    if column := _COLUMN.search(text):
        source = Places(building)
        return next((line for key in _KEYS if (line := source.find(key, column["name"]))), None)
    return None

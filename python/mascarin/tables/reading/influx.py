"""Annotated CSV of InfluxDB: one value a row, with its field and its tags, becomes a column for each series.

References
----------
InfluxData, Annotated CSV, documentation of InfluxDB v2 (rows ``#group``, ``#datatype``, ``#default``).
"""

from __future__ import annotations

import csv
import io
import re
from typing import TYPE_CHECKING, Final, TypeAlias

from mascarin._io.tables import csv_refused
from mascarin.errors import InputError

if TYPE_CHECKING:
    import pandas as pd

#: Beginning of a file, with or without the rows of annotations.
_BEGINNING: Final = re.compile(rb"(?:\xef\xbb\xbf)?\s*(?:#(?:group|datatype|default)\b|,result,table,)")
_TIME: Final = "_time"
_VALUE: Final = "_value"
#: Field and tags of a series.
_Key: TypeAlias = tuple[str, tuple[tuple[str, str], ...]]
#: Columns that say nothing of a series.
_ABOUT: Final = frozenset({"", "result", "table", "_start", "_stop", _TIME, _VALUE})


def is_influx(content: bytes) -> bool:
    """Whether a file is annotated CSV.

    Parameters
    ----------
    content : bytes
        What is in it.

    Examples
    --------
    >>> is_influx(b"#group,false,false"), is_influx(b"time,air")
    (True, False)
    """
    return _BEGINNING.match(content) is not None


def read_influx(text: str, where: str) -> pd.DataFrame:
    """A column for each series, by time.

    Parameters
    ----------
    text : str
        Content of the file.
    where : str
        File, for errors.

    Returns
    -------
    pandas.DataFrame
        The time first. A series is named by its field, and by the tags that tell it from others.

    Raises
    ------
    InputError
        There are no times or values, or two values of a series have one time.
    """
    import pandas as pd

    series: dict[_Key, dict[str, str]] = {}
    header: list[str] = []
    with csv_refused(where):
        for number, row in enumerate(csv.reader(io.StringIO(text)), 1):
            if not any(row) or row[0].startswith("#"):
                header = []
            elif header:
                _take(dict(zip(header, row, strict=False)), series, f"{where}:{number}")
            elif _TIME in row:
                header = row
            else:
                raise InputError(
                    f"{where}:{number}: found the columns {', '.join(filter(None, row))}; expected {_TIME!r} "
                    "among them. Export the query with its times, without an aggregate of its whole range"
                )
    if not series:
        raise InputError(f"{where}: found annotated CSV without values; expected some. Export it again")
    columns = dict(zip(_names(list(series)), map(pd.Series, series.values()), strict=True))
    frame = pd.DataFrame(columns).sort_index()
    return frame.rename_axis("time").reset_index()


def _take(entries: dict[str, str], series: dict[_Key, dict[str, str]], location: str) -> None:
    """Add the values of a row to their series."""
    if _TIME not in entries:
        raise InputError(
            f"{location}: found {len(entries)} entries; expected those of the line of names, {_TIME!r} among "
            "them. The file is cut or damaged: export it again, or remove the line"
        )
    tags = {name: text for name, text in entries.items() if name not in _ABOUT}
    if _VALUE in entries:
        values = {tags.pop("_field", _VALUE): entries[_VALUE]}
    else:  # after pivot(): a column for each field
        values = {name: tags.pop(name) for name in list(tags) if _is_number(tags[name])}
    for field, value in values.items():
        column = series.setdefault((field, tuple(sorted(tags.items()))), {})
        if entries[_TIME] in column:
            raise InputError(
                f"{location}: found a second value of {field!r} at {entries[_TIME]}; expected one. Group the "
                "query by what tells the two apart, or export them to different files"
            )
        column[entries[_TIME]] = value


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _names(keys: list[_Key]) -> list[str]:
    """Names of series: the field, and the tags in which series differ."""
    differing = {
        tag
        for _, tags in keys
        for tag, value in tags
        if any(dict(other).get(tag) != value for _, other in keys)
    }
    fields = [field for field, _ in keys]
    return [
        field
        if fields.count(field) == 1
        else " ".join([*(value for tag, value in tags if tag in differing), field])
        for field, tags in keys
    ]

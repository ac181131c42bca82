"""Records that grow line by line, each line sealed: evaluations of a calibration and runs of a search.

A record is a text file of JSON lines. The last value of each line is a hash of the line and of the first
line, which says what the record is about: an edited line, and a line of another record, are known. Lines are
appended in one write each; what a killed process left of a line is cut. A damaged line is left out, so that
what it held is computed again; the lines after it are used, because each holds a result of its own.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, Final

from mascarin._io.sealed import own_files

#: Length of the hash in hexadecimal digits: 128 bits.
_DIGITS: Final = 32
_KEY: Final = ',"seal":"'
_LAST: Final = '"}'
_LENGTH: Final = len(_KEY) + _DIGITS + len(_LAST)


def sealed(head: str, entry: Mapping[str, Any]) -> str:
    r"""One line of a record.

    Parameters
    ----------
    head : str
        The seal of the first line, or for the first line the kind of the record, with the version where
        results of another version are other results.
    entry : mapping
        What JSON can hold; numbers are finite.

    Raises
    ------
    ValueError
        A number is not finite.

    Examples
    --------
    >>> line = sealed("test", {"x": 1.5})
    >>> line[:8], opened("test", line.encode())
    ('{"x":1.5', {'x': 1.5})
    >>> opened("test", line.replace("1.5", "1.6").encode())
    Traceback (most recent call last):
    mascarin._io.sealed.own_files.DamagedError: it is not the line that was written
    """
    body = json.dumps(entry, separators=(",", ":"), allow_nan=False)[:-1]
    return f"{body}{_KEY}{_seal(head, body.encode())}{_LAST}\n"


def opened(head: str, line: bytes) -> dict[str, Any]:
    """The entry of a line.

    Parameters
    ----------
    head : str
        As for `sealed`.
    line : bytes
        The line with its end.

    Raises
    ------
    DamagedError
        It is cut, edited, of another record, or no line of a record.
    """
    line = line.removesuffix(b"\n")
    body, seal = line[:-_LENGTH], line[-_LENGTH:]
    if seal != f"{_KEY}{_seal(head, body)}{_LAST}".encode():
        raise own_files.DamagedError("it is not the line that was written")
    entry = own_files.json_of(body + b"}", finite=True)
    if not isinstance(entry, dict):
        raise own_files.DamagedError("it holds no mapping")
    return entry


def seal_of(line: str) -> str:
    """The seal of a line, to which the further lines of its record are bound."""
    return line.rstrip("\n")[-_DIGITS - len(_LAST) : -len(_LAST)]


def _seal(head: str, body: bytes) -> str:
    return hashlib.sha256(f"{head}\n".encode() + body).hexdigest()[:_DIGITS]


def first_line(path: Path) -> bytes:
    """The first line of a record, with its end; empty where it has no whole line.

    Raises
    ------
    DamagedError
        It is no regular file.
    OSError
        It cannot be read.
    """
    first, end, _ = own_files.whole(path).partition(b"\n")
    return first + end if end else b""


def further(path: Path, damaged: Callable[[int, str], object]) -> Iterator[tuple[int, bytes, dict[str, Any]]]:
    """The sound lines of a record after the first, each with its number and its entry.

    Parameters
    ----------
    path : Path
        The record, whose first line is sound.
    damaged : callable
        Called with the number of each damaged line and what is wrong. A last line without an end was being
        written when a process was killed: it is no damage, and is left out.

    Yields
    ------
    tuple of int, bytes and dict
        Number from 2 on, the line with its end, and what it holds, without its seal.
    """
    first, _, records = own_files.whole(path).partition(b"\n")
    head = seal_of(first.decode("ascii", "replace"))
    for number, line in enumerate(records.split(b"\n")[:-1], start=2):
        try:
            entry = opened(head, line)
        except own_files.DamagedError as error:
            damaged(number, str(error))
        else:
            yield number, line + b"\n", entry

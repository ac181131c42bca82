"""Values of entries: numbers, bounds, booleans, and entries in any order."""

from __future__ import annotations

import math
from collections.abc import Sequence

from mascarin.genopt.files.numbers import parse_double
from mascarin.genopt.files.syntax import Block, Entry, Report, ordered


def no_loose_entries(root: Block, report: Report) -> None:
    """Report entries outside all sections.

    Parameters
    ----------
    root : Block
        A whole file.
    report : Report
        Takes errors.
    """
    for entry in root.entries:
        report.error(entry.location, f"'{entry.key}' is outside all sections")


def any_order(
    block: Block, keys: Sequence[str], report: Report, *, optional: Sequence[str] = ()
) -> dict[str, Entry]:
    """Return the entries of a block by key, in any order, each once.

    Parameters
    ----------
    block : Block
        The block.
    keys, optional : sequence of str
        Keys that it may have, and those that may be missing.
    report : Report
        Takes errors.

    Returns
    -------
    dict of str to Entry
        The entries.
    """
    order = [e.key for e in block.entries if e.key in keys]
    sequence = [*dict.fromkeys(order), *(k for k in keys if k not in order)]
    for inner in block.blocks:
        report.error(inner.location, f"unexpected section '{inner.name}' in '{block.name}'")
    return ordered(block, sequence, report, optional=optional)


def integer(entry: Entry, report: Report, *, least: int | None = None) -> int | None:
    """Read a whole number; a fraction is cut as GenOpt does.

    Parameters
    ----------
    entry : Entry
        The entry.
    report : Report
        Takes errors and notes.
    least : int, optional
        Smallest value.

    Returns
    -------
    int or None
        The value, None where it cannot be read.
    """
    value = parse_double(entry.value)
    if value is None or not math.isfinite(value):
        report.error(entry.location, f"'{entry.key}' is '{entry.value}'; expected a whole number")
        return None
    if value != int(value):
        report.notes.append(f"{entry.location}: '{entry.key} = {entry.value}' is cut to {int(value)}")
    if least is not None and int(value) < least:
        report.error(entry.location, f"'{entry.key}' is {int(value)}; expected at least {least}")
        return None
    return int(value)


def real(entry: Entry, report: Report) -> float | None:
    """Read a number.

    Parameters
    ----------
    entry : Entry
        The entry.
    report : Report
        Takes errors and notes.

    Returns
    -------
    float or None
        The value, None where it cannot be read.
    """
    value = parse_double(entry.value)
    if value is None or not math.isfinite(value):
        report.error(entry.location, f"'{entry.key}' is '{entry.value}'; expected a number")
        return None
    return value


def bound(entry: Entry | None, none: str, report: Report) -> float | None:
    """Read a bound; None where it is missing or the word for no bound.

    Parameters
    ----------
    entry : Entry
        The entry.
    none : str
        The word for no bound, ``SMALL`` or ``BIG``.
    report : Report
        Takes errors.

    Returns
    -------
    float or None
        The value, None where it cannot be read.
    """
    if entry is None or entry.value.upper() == none:
        return None
    return real(entry, report)


def boolean(entry: Entry, report: Report) -> bool:
    """Read ``true`` or ``false``.

    Parameters
    ----------
    entry : Entry
        The entry.
    report : Report
        Takes errors and notes.

    Returns
    -------
    bool
        The value.
    """
    if entry.value not in ("true", "false"):
        report.error(entry.location, f"'{entry.key}' is '{entry.value}'; expected true or false")
    return entry.value == "true"

"""Other programs in a suite: how many of their numbers lie within the limits that ours are asked to keep."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Final

from mascarin._io.limits import at_least, at_most
from mascarin.verification.suites.verdict import VerdictLine

#: What stands in place of numbers of other programs.
NONE: Final = "none"


def standing(lines: Iterable[VerdictLine]) -> dict[str, tuple[int, int]]:
    """Count what each program has inside.

    Parameters
    ----------
    lines : iterable of VerdictLine
        Of one suite.

    Returns
    -------
    dict of str to (int, int)
        By program: numbers inside, and numbers given; programs in the order of their appearance.

    Examples
    --------
    >>> line = VerdictLine("1", "load", "W", 101.0, 100.0, (99.0, 102.0), {"A": 99.5, "B": 103.0})
    >>> standing([line])
    {'A': (1, 1), 'B': (0, 1)}
    """
    counts: dict[str, tuple[int, int]] = {}
    for line in lines:
        if line.limits is None:
            continue
        low, high = line.limits
        for program, value in line.peers.items():
            if math.isfinite(value):
                inside, total = counts.get(program, (0, 0))
                counts[program] = inside + (at_least(value, low) and at_most(value, high)), total + 1
    return counts


def in_words(counts: Mapping[str, tuple[int, int]]) -> str:
    """Say what other programs have inside.

    Examples
    --------
    >>> in_words({"A": (1, 2), "B": (2, 2)}), in_words({})
    ('A 1 of 2, B 2 of 2', 'none')
    """
    return ", ".join(f"{program} {inside} of {total}" for program, (inside, total) in counts.items()) or NONE

"""Paths with ``*``, which stands for any name between two dots or for a part of one."""

from __future__ import annotations

from collections.abc import Iterable
from fnmatch import fnmatchcase

from mascarin.errors import InputError, did_you_mean


def is_pattern(path: str) -> bool:
    """Whether a path has a ``*``."""
    return "*" in path


def matching(pattern: str, paths: Iterable[str], *, parts: bool = False) -> list[str]:
    """Paths that a pattern stands for, in their order.

    Parameters
    ----------
    pattern : str
        Such as ``zones.*.infiltration.constant`` or ``surfaces.wall_*.outside.absorptance``.
    paths : iterable of str
        All paths of numbers.
    parts : bool
        Whether it may also stand for parts, of which the numbers are leaves.

    Returns
    -------
    list of str
        Each once.

    Raises
    ------
    InputError
        Nothing matches; the text names the nearest patterns.

    Examples
    --------
    >>> matching("zones.*.volume", ["zones.hall.volume", "zones.hall.height", "zones.attic.volume"])
    ['zones.hall.volume', 'zones.attic.volume']
    """
    wanted, known = pattern.split("."), [path.split(".") for path in paths]
    there = [steps[: len(wanted)] if parts else steps for steps in known]
    found = [".".join(steps) for steps in there if _fits(steps, wanted)]
    if not found:
        raise InputError(
            f"{pattern}: found nothing in the building that matches; expected paths as listed by 'mascarin "
            f"parameters'. {did_you_mean(pattern, _nearest(wanted, known))}".rstrip()
        )
    return list(dict.fromkeys(found))


def _fits(steps: list[str], wanted: list[str]) -> bool:
    return len(steps) == len(wanted) and all(map(_same, steps, wanted))


def _same(step: str, wanted: str) -> bool:
    # Names of layers and materials may have brackets, which fnmatch would read as a choice of letters.
    return fnmatchcase(step, wanted.replace("[", "[[]"))


def _nearest(wanted: list[str], known: list[list[str]]) -> set[str]:
    """All paths with the stars of a pattern where they have the names that these stand for."""
    return {
        ".".join(
            star if is_pattern(star) and _same(step, star) else step
            for step, star in zip(steps, [*wanted, *[""] * len(steps)], strict=False)
        )
        for steps in known
    }

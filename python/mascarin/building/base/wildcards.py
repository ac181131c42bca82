"""Paths with ``*``, which stands for any name between two dots or for a part of one."""

from __future__ import annotations

import re
from collections.abc import Iterable
from fnmatch import fnmatchcase
from functools import lru_cache

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
    all_paths, expression = list(paths), _expression(pattern, parts)
    matches = [fitting[0] for fitting in map(expression.match, all_paths) if fitting]
    if not matches:
        all_steps = [path.split(".") for path in all_paths]
        raise InputError(
            f"{pattern}: found nothing in the building that matches; expected paths as listed by 'mascarin "
            f"parameters'. {did_you_mean(pattern, _nearest(pattern.split('.'), all_steps))}".rstrip()
        )
    return list(dict.fromkeys(matches))


@lru_cache(maxsize=256)
def _expression(pattern: str, parts: bool) -> re.Pattern[str]:
    """What fits a pattern as `fits` has it, step by step; with `parts` the beginning of a path."""
    wild = {"*": "[^.]*", "?": "[^.]"}
    text = "".join(wild.get(letter) or re.escape(letter) for letter in pattern)
    return re.compile(text + (r"(?=\.|\Z)" if parts else r"\Z"), re.DOTALL)


def fits(step: str, pattern_step: str) -> bool:
    """Whether a name between two dots is one that a step of a pattern stands for."""
    # Names of layers and materials may have brackets, which fnmatch would read as a choice of letters.
    return fnmatchcase(step, pattern_step.replace("[", "[[]"))


def _nearest(pattern_steps: list[str], all_steps: list[list[str]]) -> set[str]:
    """All paths with the stars of a pattern where they have the names that these stand for."""
    return {
        ".".join(
            star if is_pattern(star) and fits(step, star) else step
            for step, star in zip(steps, [*pattern_steps, *[""] * len(steps)], strict=False)
        )
        for steps in all_steps
    }

"""All cases with a closed answer, by topic."""

from __future__ import annotations

import math
from collections.abc import Callable

from mascarin.errors import MascarinError
from mascarin.verification.analytical import conduction, melting, phase, radiation, sun, zones
from mascarin.verification.analytical.check import Case, Check, Topic


def cases(topic: Topic | None = None) -> list[Case]:
    """Cases of a topic, in the order they are shown; all without one.

    Parameters
    ----------
    topic : str, optional
        ``building`` or ``pcm``.
    """
    every = (*conduction.CASES, *phase.CASES, *melting.CASES, *zones.CASES, *radiation.CASES, *sun.CASES)
    return [case for case in every if topic is None or topic in case.topics]


def run(topic: Topic, progress: Callable[[float, float], object] | None = None) -> list[Check]:
    """Run the cases of a topic.

    Parameters
    ----------
    topic : str
        ``building`` or ``pcm``.
    progress : callable, optional
        Called with the number of cases done and in all.

    Returns
    -------
    list of Check
        Rows of the table. A case that cannot be run leaves one row without a value, which fails.
    """
    chosen = cases(topic)
    rows: list[Check] = []
    for done, case in enumerate(chosen):
        if progress is not None:
            progress(done, len(chosen))
        try:
            rows += case.run()
        except MascarinError as error:
            rows.append(Check.most(case.name, f"could not be run: {error}", "-", math.nan, high=0.0))
    return rows

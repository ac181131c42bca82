"""All cases with an analytical solution, by topic."""

from __future__ import annotations

import math

from mascarin.errors import MascarinError
from mascarin.progress import ProgressOption, reporting
from mascarin.verification.analytical import conduction, melting, moisture, phase, radiation, sun, zones
from mascarin.verification.analytical.check import Case, Check, Topic


def cases(topic: Topic | None = None) -> list[Case]:
    """List the cases of a topic, in the order in which they are shown.

    Parameters
    ----------
    topic : str, optional
        ``building`` or ``pcm``; all cases when absent.

    Returns
    -------
    list of Case

    Examples
    --------
    >>> cases("pcm")[0].name
    'Stefan, one phase'
    """
    topics = (conduction, phase, melting, zones, moisture, radiation, sun)
    catalogue = [case for module in topics for case in module.CASES]
    return [case for case in catalogue if topic is None or topic in case.topics]


def run(topic: Topic, progress: ProgressOption = False) -> list[Check]:
    """Run the cases of a topic.

    Parameters
    ----------
    topic : str
        ``building`` or ``pcm``.
    progress : bool or callable, optional
        Shows progress; a function is called with the number of cases done and their total.

    Returns
    -------
    list of Check
        Rows of the table. A case that cannot be run gives one row without a value, which fails.
    """
    chosen = cases(topic)
    rows: list[Check] = []
    with reporting(progress, "cases") as report:
        for done, case in enumerate(chosen):
            report(done, len(chosen))
            try:
                rows += case.run()
            except MascarinError as error:
                rows.append(Check.most(case.name, f"could not be run: {error}", "-", math.nan, high=0.0))
    return rows

"""The exit code of a command that has done its work: one rule for all commands.

Where a run, or a member of an ensemble, is unsound or has failed, or a criterion is missed, the results are
written, the terminal says so, and the exit code is 1. Where nothing can be made of the runs, because all have
failed or a method needs each of them, that is an error of the solver (exit code 3).

Searches are no ensembles: an evaluation of a calibration or of ``mascarin optimize`` that fails has no cost,
and the search goes on without it. What counts is the run at the estimates.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mascarin.simulation.checks.warning_kinds import RunWarning


def exit_code(
    *, warnings: Iterable[RunWarning] = (), sound: bool = True, failed: int = 0, missed: int = 0
) -> int:
    """0, or 1 where a result is not to be used as it is.

    Parameters
    ----------
    warnings : iterable of RunWarning
        Warnings of runs; their kinds count.
    sound : bool
        Whether all runs are sound, where the command has them.
    failed : int
        Number of runs that failed.
    missed : int
        Number of criteria that are missed.

    Examples
    --------
    >>> exit_code(sound=True), exit_code(failed=1), exit_code(missed=2)
    (0, 1, 1)
    """
    unsound = any(line.unsound for line in warnings)
    return 1 if unsound or not sound or failed or missed else 0

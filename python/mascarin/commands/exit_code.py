"""The exit code of a command that has done its work: one rule for all commands.

Where a run, or a member of an ensemble, is unsound or has failed, or a criterion is missed, the results are
written, the terminal says so, and the exit code is 1. Where nothing can be made of the runs, because all have
failed or a method needs each of them, that is an error of the solver (exit code 3).

Searches are no ensembles: an evaluation of a calibration or of ``mascarin optimize`` that fails has no cost,
and the search goes on without it. What counts is the run at the estimates.
"""

from __future__ import annotations

from collections.abc import Iterable


def exit_code(*, warnings: Iterable[str] = (), sound: bool = True, failed: int = 0, missed: int = 0) -> int:
    """0, or 1 where a result is not to be used as it is.

    Parameters
    ----------
    warnings : iterable of str
        Warnings of runs, as the command has printed them.
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
    from mascarin.simulation.run_warnings import says_unsound

    return 1 if says_unsound(warnings) or not sound or failed or missed else 0

"""Commands for GenOpt projects."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

if TYPE_CHECKING:
    from mascarin.genopt import Outcome

_FAILED = 1
_OK = 0


def optimize(
    project: Path,
    *,
    workers: int | None = None,
    ahead: bool = True,
    on_failure: str = "stop",
    time_limit: float | None = None,
    resume: bool = False,
    lenient: bool = False,
    table: Annotated[Path | None, Parameter(name=["--table", "-t"])] = None,
    check: bool = False,
    quiet: Annotated[bool, Parameter(name=["--quiet", "-q"], negative="")] = False,
) -> int:
    """Run a GenOpt project with any simulation program.

    Without options it works like GenOpt and writes the same listings. The exit code is that of GenOpt: 0 at
    the end and when MaxIte is reached, 1 for every error.

    Parameters
    ----------
    project : Path
        The initialization file, such as opt.ini.
    workers : int
        Number of simulations at the same time, instead of UnitsOfExecution. [-]
    ahead : bool
        With several workers: free workers simulate points that a sequential search will probably need. The
        results do not change; some of these simulations may not be needed.
    on_failure : str
        What to do after a failed simulation: "stop", or a number to use as its cost.
    time_limit : float
        Longest time of one simulation. [s]
    resume : bool
        Continue an interrupted run from its log.
    lenient : bool
        Accept what GenOpt rejects, with a note each time.
    table : Path
        Write all evaluations to this file, .csv or .parquet.
    check : bool
        Only read and check the project.
    quiet : bool
        Print only the result.

    Returns
    -------
    int
        Exit code.
    """
    from mascarin.building.files.recognition import GENOPT, described
    from mascarin.errors import InputError, InUse, MascarinError

    file_kind = described(project)
    if file_kind is not None and file_kind.what != GENOPT:
        raise InputError(
            f"{project}: found {file_kind.what}; expected the ini file of a GenOpt project: "
            f"{file_kind.remedy.removesuffix('.')}"
        )
    try:
        return _optimize(
            project,
            workers=workers,
            ahead=ahead,
            on_failure=on_failure,
            time_limit=time_limit,
            resume=resume,
            lenient=lenient,
            table=table,
            check=check,
            quiet=quiet,
        )
    except InUse:  # GenOpt has no such error: exit code 2, and the log is that of the other process
        raise
    except MascarinError as error:
        _say(f"error: {error}")
        if not check and project.is_file():
            _say(f"Optimization terminated with error. See '{project.absolute().parent / 'GenOpt.log'}'.")
        return _FAILED


def _optimize(
    project: Path,
    *,
    workers: int | None,
    ahead: bool,
    on_failure: str,
    time_limit: float | None,
    resume: bool,
    lenient: bool,
    table: Path | None,
    check: bool,
    quiet: bool,
) -> int:
    """Run or check a project."""
    from mascarin.errors import InputError
    from mascarin.genopt import Options, optimize
    from mascarin.genopt.run import check as check_project
    from mascarin.genopt.run import interrupted, summary

    for name, value in (("--workers", workers), ("--time-limit", time_limit)):
        if value is not None and value <= 0:
            msg = f"{name} is {value}; expected more than 0"
            raise InputError(msg)
    options = Options(
        workers=workers,
        ahead=ahead,
        penalty=_penalty(on_failure),
        time_limit=time_limit,
        resume=resume,
        lenient=lenient,
        table=table,
        progress=not quiet,
    )
    if check:
        checked, lines = check_project(project, options)
        print("\n".join(lines))
        _notes(checked.report.notes)
        return _OK
    if not quiet and not resume:
        remainder = interrupted(project)
        if remainder:
            _say(remainder)
    try:
        outcome = optimize(project, options)
    except KeyboardInterrupt:
        _say(f"interrupted; continue with: mascarin optimize {project} --resume")
        raise
    if not quiet:
        _report(outcome)
    print("\n".join(summary(outcome)))
    return _OK


def _penalty(text: str) -> float | None:
    """Cost of a failed simulation, None to stop."""
    import math

    from mascarin.errors import InputError

    if text == "stop":
        return None
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        msg = f"--on-failure is '{text}'; expected 'stop' or a finite number that a failed simulation costs"
        raise InputError(msg)
    return value


def _report(outcome: Outcome) -> None:
    """Notes, warnings and the reason for an early end, on standard error."""
    _notes(outcome.project.report.notes)
    for text in outcome.warnings:
        _say(f"warning: {text}")
    if outcome.exhausted:
        _say("Maximum number of iteration exceeded.")


def _notes(notes: list[str]) -> None:
    for text in notes:
        _say(f"note: {text}")


def _say(text: str) -> None:
    print(text, file=sys.stderr)

"""One evaluation of a study for an optimization program: files in, files out."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import TYPE_CHECKING

from mascarin import __version__
from mascarin._io import atomic, identity
from mascarin._io.locks import writing
from mascarin.errors import InputError, MascarinError
from mascarin.genopt.export.exchange import (
    COMPILED,
    FAILURE,
    RESULT_BEGINS,
    read_parameters,
    read_settings,
    result_lines,
)

if TYPE_CHECKING:
    from mascarin.genopt.export.case import Case


def evaluate_files(
    parameters: Path, out: Path, log: Path, study: Path | None = None, *, allow_outside: bool = False
) -> list[str]:
    """Evaluate the parameters of one file and write the costs to another one.

    Parameters
    ----------
    parameters : Path
        Parameter file.
    out : Path
        File for the costs; an existing one is removed first, so that there is none after a failure.
    log : Path
        File for the result or the reason of a failure; always written.
    study : Path, optional
        The study; default: that of the project that the parameter file names.
    allow_outside : bool
        Whether the study may name files outside its folder.

    Returns
    -------
    list of str
        The lines of the result.

    Raises
    ------
    InputError
        An input cannot be used.
    SolverError
        The building cannot be simulated with these values.
    """
    if len({path.absolute() for path in (parameters, out, log)}) < 3:
        raise InputError(f"'{parameters}', '{out}' and '{log}' must be three different files")
    try:
        with writing(out), identity.outputs(log):
            _remove_result(out)
            lines, notes = _evaluated(parameters, study, allow_outside)
            atomic.write(out, "\n".join(lines) + "\n")
        _write_log(log, [*lines, *notes])
    except MascarinError as error:
        _write_log(log, _failure(str(error)))
        raise
    except Exception as error:
        _write_log(log, _failure(f"{type(error).__name__}: {error}"))
        raise
    return lines


def _remove_result(out: Path) -> None:
    """Remove the result of an earlier evaluation, so that none is there if this one fails."""
    if not out.exists():
        return
    with out.open("rb") as file:
        begins = file.read(len(RESULT_BEGINS))
    if begins != RESULT_BEGINS and begins:
        raise InputError(
            f"--out: found {out}, which is no result of this command; expected one, or a new file: choose "
            "another name"
        )
    out.unlink()


def _evaluated(parameters: Path, study: Path | None, allow_outside: bool) -> tuple[list[str], list[str]]:
    """Lines of the result, and notes for the log."""
    request = read_parameters(parameters)
    try:
        costs = _case(request.project, study, parameters, allow_outside).evaluate(request.values)
    except InputError as error:
        if str(parameters) in str(error):
            raise
        raise InputError(f"{parameters}: {error}") from None
    notes = [f"kept the value of the study: {', '.join(costs.defaults)}"] if costs.defaults else []
    return result_lines(costs), notes


def _case(project: Path | None, study: Path | None, parameters: Path, allow_outside: bool) -> Case:
    from mascarin.genopt.export.case import open_case

    if study is None and project is None:
        raise InputError(
            f"{parameters}: found no study; add a line 'project = FOLDER' as 'mascarin genopt' does, or give "
            "--study"
        )
    if study is not None or project is None:
        saved, chosen = None, study
    else:
        saved, chosen = project / COMPILED, read_settings(project)
    if chosen is None:
        raise InputError(f"{parameters}: found no study")
    if saved is not None:
        case = open_case(saved, str(chosen.resolve()))
        if case is not None:
            return case
    # Imported here, because it imports everything that reads studies.
    from mascarin.genopt.export.compiling import compiled

    return compiled(chosen, saved, allow_outside=allow_outside)


def _failure(text: str) -> list[str]:
    """Lines of the log after a failure; the mark is in the first line, which optimization programs show."""
    first, *following = text.splitlines() or [""]
    return [f"{FAILURE}: {first}", *following]


def _write_log(log: Path, lines: list[str]) -> None:
    # A log that cannot be written must not hide the error that it would contain.
    with contextlib.suppress(OSError, InputError):
        text = "\n".join([f"mascarin {__version__} cost", *lines])
        atomic.write(log, text + "\n")

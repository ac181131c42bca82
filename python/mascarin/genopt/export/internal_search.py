"""Runs the project of a study in this process: the same search, without a program for each point."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING

from mascarin.errors import InputError, MascarinError
from mascarin.genopt import Options, Outcome, optimize
from mascarin.genopt.export.compiling import compiled
from mascarin.genopt.export.exchange import COMPILED, read_settings
from mascarin.genopt.files.loading import load
from mascarin.genopt.program import Result, RunFailed

if TYPE_CHECKING:
    from collections.abc import Callable

    from mascarin.optimization import Point


def search(initialization: Path, options: Options | None = None) -> Outcome:
    """Run a project that `mascarin genopt` has written, without its simulation program.

    Parameters
    ----------
    initialization : Path
        The initialization file.
    options : Options, optional
        As for any project. Default: one worker, because the engine itself works in parallel.

    Returns
    -------
    Outcome
        The same evaluations, counters and listings as with the program.

    Raises
    ------
    InputError
        The project is not one of a study, or has other costs, functions or discrete parameters.
    """
    return optimize(initialization, options or Options(workers=1), run=_runner(initialization))


def _runner(initialization: Path) -> Callable[[Point, Path], Result]:
    project = load(initialization)
    folder = project.folder
    case = compiled(read_settings(folder), folder / COMPILED)
    names = [objective.name for objective in project.objectives]
    if names != case.names or project.discrete or project.functions:
        raise InputError(
            f"{initialization}: has costs ({', '.join(names)}), discrete parameters or functions other than "
            f"those of the study ({', '.join(case.names)}); run it with 'mascarin optimize'"
        )
    paths = [parameter.name for parameter in project.continuous]

    def run(point: Point, _: Path) -> Result:
        began = time.perf_counter()
        try:
            costs = case.evaluate(dict(zip(paths, point.x, strict=True)))
        except MascarinError as error:
            raise RunFailed(str(error)) from None
        return Result((costs.total, *costs.parts.values()), time.perf_counter() - began)

    return run

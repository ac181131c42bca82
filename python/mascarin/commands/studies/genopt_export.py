"""Commands that export the calibration of a study to GenOpt."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from mascarin.commands.options.exit_code import exit_code
from mascarin.commands.options.inputs import Outside


def genopt(
    study: str,
    /,
    *,
    out: Annotated[Path, Parameter(alias="-o")],
    algorithm: str = "hooke-jeeves",
    starts: int | None = None,
    evaluations: int | None = None,
    reductions: int = 10,
    seed: int | None = None,
    program: str | None = None,
    force: Annotated[bool, Parameter(negative="")] = False,
    allow_outside: Outside = False,
) -> int:
    """Write the calibration of a study as a GenOpt project.

    The project starts ``mascarin cost`` for each simulation. Run it with ``mascarin optimize`` or GenOpt.

    Parameters
    ----------
    study : str
        Study file (YAML), or the name of an example study: wall-bench, lgi, twin-house, twin-house-n2.
    out : Path
        Folder for the project.
    algorithm : str
        hooke-jeeves, coordinate-search, pso, pso-inertia, pso-mesh, hybrid, nelder-mead, gradient,
        golden-section, fibonacci, mesh, parametric, or GenOpt's own name.
    starts : int
        Number of starts, instead of the number in the study. [-]
    evaluations : int
        Largest number of simulations, instead of the budget in the study. [-]
    reductions : int
        Number of times a pattern search halves its step before it stops. [-]
    seed : int
        Seed of the random numbers, instead of the seed in the study.
    program : str
        Command that starts the simulation program. Default: ``mascarin``.
    force : bool
        Write into a folder that is not empty.
    """
    from mascarin.examples import locate
    from mascarin.genopt.export.writing import Options, write_project
    from mascarin.simulation.nominal import of_nominal
    from mascarin.study import Study

    options = Options(algorithm, starts, evaluations, seed, reductions, program, force, allow_outside)
    print(write_project(study, out, options))
    opened = Study.from_yaml(locate(study), allow_outside=allow_outside)
    # Each evaluation is a process of its own, which says nothing: what holds for the runs is said here.
    lines = of_nominal(opened.context.models.for_calibration())
    for line in lines:
        print(f"warning: {line}", file=sys.stderr)
    return exit_code(warnings=lines)


def cost(
    parameters: Path = Path("parameters.txt"),
    /,
    *,
    study: str | None = None,
    out: Annotated[Path, Parameter(alias="-o")] = Path("result.txt"),
    log: Path = Path("log.txt"),
    allow_outside: Outside = False,
) -> int:
    """Evaluate the calibration cost of a study once.

    This is the simulation program of the projects that ``mascarin genopt`` writes. Errors are also written
    to the log, after the words MASCARIN ERROR.

    Parameters
    ----------
    parameters : Path
        Parameter file: lines ``path = value``, and ``project = FOLDER`` relative to the file.
    study : str
        Study file, instead of the one of the project.
    out : Path
        File for the costs, the sum first, then each sensor.
    log : Path
        Log file.
    """
    from mascarin.genopt.export.evaluation import evaluate_files

    chosen = None
    if study is not None:
        from mascarin.examples import locate

        chosen = locate(study)
    print("\n".join(evaluate_files(parameters, out, log, chosen, allow_outside=allow_outside)))
    return 0

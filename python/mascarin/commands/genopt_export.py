"""Commands that couple a study to GenOpt."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter


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
) -> int:
    """Write a study's identification as a GenOpt project.

    The project starts ``mascarin cost`` for each simulation. Run it with ``mascarin optimize`` or GenOpt.

    Parameters
    ----------
    study : str
        Study file (YAML), or the name of a study that comes with Mascarin: wall-bench, lgi.
    out : Path
        Folder for the project.
    algorithm : str
        hooke-jeeves, coordinate-search, pso, pso-inertia, pso-mesh, hybrid, nelder-mead, gradient,
        golden-section, fibonacci, mesh, parametric, or GenOpt's own name.
    starts : int
        Number of starts, in place of the study's. [-]
    evaluations : int
        Largest number of simulations, in place of the study's budget. [-]
    reductions : int
        How often a pattern search halves its step before it ends. [-]
    seed : int
        Of the random numbers, in place of the study's.
    program : str
        How the simulation program is started, if not as ``mascarin``.
    force : bool
        Write into a folder that is not empty.
    """
    from mascarin.genopt.export.writing import Options, write_project

    options = Options(algorithm, starts, evaluations, seed, reductions, program, force)
    print(write_project(study, out, options))
    return 0


def cost(
    parameters: Path = Path("parameters.txt"),
    /,
    *,
    study: str | None = None,
    out: Annotated[Path, Parameter(alias="-o")] = Path("result.txt"),
    log: Path = Path("log.txt"),
) -> int:
    """Evaluate the cost of a study's identification once.

    This is the simulation program of the projects that ``mascarin genopt`` writes. What goes wrong stands
    in the log too, behind the words MASCARIN ERROR.

    Parameters
    ----------
    parameters : Path
        Parameter file: lines ``path = value``, and ``project = FOLDER`` relative to the file.
    study : str
        Study file, in place of that of the project.
    out : Path
        File for the costs, the sum first, then each sensor.
    log : Path
        File for what was done or what went wrong.
    """
    from mascarin.genopt.export.evaluation import evaluate_files

    chosen = None
    if study is not None:
        from mascarin.examples import locate

        chosen = locate(study)
    print("\n".join(evaluate_files(parameters, out, log, chosen)))
    return 0

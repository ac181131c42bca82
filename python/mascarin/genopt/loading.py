"""Reads and checks a GenOpt project."""

from __future__ import annotations

from pathlib import Path

from mascarin.genopt.command_file import read_command_file, resolve_functions
from mascarin.genopt.configuration import read_configuration
from mascarin.genopt.initialization import read_initialization
from mascarin.genopt.project import Project
from mascarin.genopt.syntax import Report


def load(path: str | Path, *, lenient: bool = False) -> Project:
    """Read a project from its initialization file.

    Parameters
    ----------
    path : str or Path
        The initialization file.
    lenient : bool
        Whether to accept and note what GenOpt cannot run.

    Returns
    -------
    Project
        The project.

    Raises
    ------
    InputError
        Every error found, each with file and line.
    """
    ini = Path(path).absolute()
    project = Project(ini, report=Report(lenient))
    read_initialization(project)
    project.report.raise_if_any()
    own = list(project.objectives)
    read_configuration(project)
    project.report.raise_if_any()
    if own and project.objectives != own:
        place = project.objectives[0].place
        project.report.notes.append(
            f"{place}: ObjectiveFunctionLocation is also in the initialization file; that one is used"
        )
        project.objectives = own
    if not project.objectives:
        project.report.error(
            str(project.ini), "ObjectiveFunctionLocation is missing here and in the configuration file"
        )
    read_command_file(project)
    project.report.raise_if_any()
    resolve_functions(project)
    project.report.raise_if_any()
    return project

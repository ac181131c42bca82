"""Reads and checks a GenOpt project."""

from __future__ import annotations

from pathlib import Path

from mascarin.genopt.files.command_file import read_command_file, resolve_functions
from mascarin.genopt.files.configuration import read_configuration
from mascarin.genopt.files.initialization import read_initialization
from mascarin.genopt.files.project import Project
from mascarin.genopt.files.syntax import Report


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
    from_initialization = list(project.objectives)
    read_configuration(project)
    project.report.raise_if_any()
    if from_initialization and project.objectives != from_initialization:
        location = project.objectives[0].location
        project.report.notes.append(
            f"{location}: ObjectiveFunctionLocation is also in the initialization file; that one is used"
        )
        project.objectives = from_initialization
    if not project.objectives:
        project.report.error(
            str(project.ini), "ObjectiveFunctionLocation is missing here and in the configuration file"
        )
    read_command_file(project)
    project.report.raise_if_any()
    resolve_functions(project)
    project.report.raise_if_any()
    return project

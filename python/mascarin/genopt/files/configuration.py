"""Reads the configuration file of a GenOpt project."""

from __future__ import annotations

from mascarin._io.regular import is_file
from mascarin.genopt.files.entries import boolean, no_loose_entries
from mascarin.genopt.files.initialization import objectives
from mascarin.genopt.files.project import Project
from mascarin.genopt.files.syntax import expect_blocks, ordered, read


def read_configuration(project: Project) -> None:
    """Read error texts, number format and command.

    Parameters
    ----------
    project : Project
        Takes what is read; names the file.

    Raises
    ------
    InputError
        Every error found, each with file and line.
    """
    report = project.report
    if not is_file(project.configuration):
        report.error(project.configuration_location, f"'{project.configuration}' does not exist")
        return
    root = read(project.configuration, report)
    no_loose_entries(root, report)
    blocks = expect_blocks(
        root,
        ["SimulationError", "IO", "SimulationStart", "ObjectiveFunctionLocation"],
        report,
        optional=["ObjectiveFunctionLocation"],
    )
    report.raise_if_any()
    ordered(blocks["SimulationError"], ["ErrorMessage"], report, repeated=True)
    project.errors = [e.value for e in blocks["SimulationError"].entries if e.key == "ErrorMessage"]
    for entry in blocks["SimulationError"].entries:
        if entry.value == "":
            report.error(entry.location, "an empty ErrorMessage is found in every line; write a text")
    form = ordered(blocks["IO"], ["NumberFormat"], report).get("NumberFormat")
    if form is not None:
        if form.value == "Float":
            project.number_format = "Float"
        elif form.value != "Double":
            report.error(form.location, f"NumberFormat is '{form.value}'; expected Double or Float")
    start = ordered(blocks["SimulationStart"], ["Command", "WriteInputFileExtension"], report)
    if "Command" in start:
        project.command, project.command_location = start["Command"].value, start["Command"].location
    if "WriteInputFileExtension" in start:
        project.keep_extension = boolean(start["WriteInputFileExtension"], report)
    if "ObjectiveFunctionLocation" in blocks:
        project.objectives = objectives(blocks["ObjectiveFunctionLocation"], report)

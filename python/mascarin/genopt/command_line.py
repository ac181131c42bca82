"""The command line of the simulation program."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from pathlib import Path

from mascarin._io.regular import exists
from mascarin.errors import did_you_mean
from mascarin.genopt.files import functions
from mascarin.genopt.files.project import FileEntry, Project


def variables(project: Project, folder: Path) -> dict[str, str]:
    """Return the variables of the command line.

    Parameters
    ----------
    project : Project
        The project.
    folder : Path
        Directory of the run.

    Returns
    -------
    dict of str to str
        Values by name.
    """
    out: dict[str, str] = {}

    def put(role: str, entries: Sequence[FileEntry], *, inside: bool) -> None:
        for i, e in enumerate(entries, start=1):
            name = e.name
            if role == "Input" and not project.keep_extension:
                name = name.rpartition(".")[0] or name
            base = folder / e.folder.relative_to(project.folder) if inside else e.folder
            out[f"Simulation.Files.{role}.File{i}"] = name
            out[f"Simulation.Files.{role}.Path{i}"] = str(base)
            if e.save is not None:
                out[f"Simulation.Files.{role}.SavePath{i}"] = str(e.save)

    put("Template", project.template, inside=False)
    put("Input", project.input, inside=True)
    put("Log", project.log, inside=True)
    put("Output", project.output, inside=True)
    out["Simulation.Files.Configuration.Name1"] = project.configuration.name
    out["Simulation.Files.Configuration.Path1"] = str(project.configuration.parent)
    out["Simulation.CallParameter.Prefix"] = project.prefix
    out["Simulation.CallParameter.Suffix"] = project.suffix
    out["Optimization.Files.Command.File1"] = project.command_file.name
    out["Optimization.Files.Command.Path1"] = str(project.command_file.parent)
    out["CLASSPATH"] = os.environ.get("CLASSPATH", "")
    return out


def split_command(project: Project) -> list[str]:
    """Split the command into words; quotes keep blanks together, and the name of a file stays one word.

    Parameters
    ----------
    project : Project
        The project.

    Returns
    -------
    list of str
        Words that still contain the variables.

    Raises
    ------
    InputError
        Unknown variables, or an odd number of quotes.
    """
    text = project.command
    for key in ("Prefix", "Suffix"):
        value = project.prefix if key == "Prefix" else project.suffix
        text = text.replace(f"%Simulation.CallParameter.{key}%", value)
    replacements = variables(project, project.folder)
    for name in re.findall(r"%((?:Simulation|Optimization)\.[\w.]+)%", text):
        if name not in replacements:
            project.report.error(
                project.command_location,
                f"'%{name}%' in the command is not known. {did_you_mean(name, replacements)}".rstrip(),
            )
    if text.count('"') % 2:
        project.report.error(project.command_location, "the command has an odd number of double quotes")
    project.report.raise_if_any()
    words: list[str] = []
    for piece in re.findall(r'(?:[^\s"]|"[^"]*")+', text):
        word = piece.replace('"', "")
        if re.match(r"\.\d+\Z", word):
            project.report.beyond(
                project.command_location,
                f"the argument '{word}' begins with a point, so GenOpt takes it for a file and puts "
                "a directory in front",
                f"write 0{word}",
            )
        words.append(word)
    project.report.raise_if_any()
    return words


def place_word(word: str, values: dict[str, str], folder: Path, file_names: set[str]) -> str:
    """Replace the variables of a word and make its path absolute where GenOpt does so.

    Parameters
    ----------
    word : str
        From `split_command`.
    values : dict of str to str
        From `variables`.
    folder : Path
        Directory of the initialization file.
    file_names : set of str
        Names of the files of a run.

    Returns
    -------
    str
        The word as it is given to the program.
    """
    text = functions.substitute(word, values)
    if text.startswith(".") and not re.match(r"\.\d+\Z", text):
        return os.path.normpath(folder / text)
    # The name of a file of the run means that file, also when the directory from which the optimization was
    # started has a file of the same name.
    literal = text == word and text not in file_names
    if literal and text and not Path(text).is_absolute() and exists(text):
        return str(Path(text).absolute())
    return text

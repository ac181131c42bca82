"""Reads the initialization file of a GenOpt project."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Literal

from mascarin._io.regular import is_file
from mascarin.errors import did_you_mean
from mascarin.genopt.files.entries import integer, no_loose_entries
from mascarin.genopt.files.project import FileEntry, Objective, Project
from mascarin.genopt.files.syntax import Block, Entry, Report, expect_blocks, ordered, read

_NUMBERED = re.compile(r"([A-Za-z]+?)(\d+)\Z")


def read_initialization(project: Project) -> None:
    """Read files, call parameters and objectives.

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
    root = read(project.ini, report)
    no_loose_entries(root, report)
    _resolve_references(root, report)
    report.raise_if_any()
    top = expect_blocks(root, ["Simulation", "Optimization"], report)
    report.raise_if_any()
    simulation = expect_blocks(
        top["Simulation"],
        ["Files", "CallParameter", "ObjectiveFunctionLocation"],
        report,
        optional=["CallParameter", "ObjectiveFunctionLocation"],
    )
    report.raise_if_any()
    files = expect_blocks(
        simulation["Files"], ["Template", "Input", "Log", "Output", "Configuration"], report
    )
    report.raise_if_any()
    base = project.folder
    project.template = _files(files["Template"], base, report, ["File", "Path"])
    project.input = _files(files["Input"], base, report, ["File", "Path", "SavePath"])
    project.log = _files(files["Log"], base, report, ["File", "Path", "SavePath"])
    project.output = _files(files["Output"], base, report, ["File", "Path", "SavePath"])
    if len(project.template) != len(project.input):
        report.error(
            files["Input"].location,
            f"{len(project.input)} input files for {len(project.template)} templates; "
            "the first template makes the first input file, and so on",
        )
    _one_file(project, "configuration", files["Configuration"])
    if "CallParameter" in simulation:
        entries = ordered(
            simulation["CallParameter"], ["Prefix", "Suffix"], report, optional=["Prefix", "Suffix"]
        )
        project.prefix = entries["Prefix"].value if "Prefix" in entries else ""
        project.suffix = entries["Suffix"].value if "Suffix" in entries else ""
    if "ObjectiveFunctionLocation" in simulation:
        project.objectives = objectives(simulation["ObjectiveFunctionLocation"], report)
    optimization = expect_blocks(top["Optimization"], ["Files"], report)
    report.raise_if_any()
    command = expect_blocks(optimization["Files"], ["Command"], report)
    report.raise_if_any()
    _one_file(project, "command_file", command["Command"])
    _check_inside(project)


def _resolve_references(root: Block, report: Report) -> None:
    """Replace full dotted names of other entries in values."""
    paths: dict[str, tuple[Block, int]] = {}

    def walk(block: Block, prefix: str) -> None:
        for i, entry in enumerate(block.entries):
            paths.setdefault(f"{prefix}{entry.key}", (block, i))
        for inner in block.blocks:
            walk(inner, f"{prefix}{inner.name}.")

    walk(root, "")
    # Longer names first: File1 is the beginning of File10.
    names = sorted(paths, key=len, reverse=True)
    values = {n: paths[n][0].entries[paths[n][1]].value for n in names}
    for name in names:
        block, i = paths[name]
        entry = block.entries[i]
        value = entry.value
        for _ in range(len(names) + 1):
            # A name inside %...% belongs to the command line, not to this file.
            hit = next((n for n in names if re.search(rf"(?<!%){re.escape(n)}(?![\w%])", value)), None)
            if hit is None:
                break
            value = re.sub(rf"(?<!%){re.escape(hit)}(?![\w%])", lambda _, h=hit: values[h], value)  # type: ignore[misc]
        else:
            report.error(entry.location, f"'{name}' refers to itself in a circle; write the value out")
        if value != entry.value:
            block.entries[i] = Entry(entry.key, value, entry.quoted, entry.location, entry.raw)


def _numbered(block: Block, report: Report, kinds: Sequence[str], *, required: str) -> list[dict[str, Entry]]:
    """Entries with numbered keys such as ``File1``, grouped by number."""
    groups: list[dict[str, Entry]] = []
    for entry in block.entries:
        match = _NUMBERED.match(entry.key)
        if match is None or match[1] not in kinds:
            keys = [f"{kind}{i}" for kind in kinds for i in (1, 2)]
            report.error(
                entry.location,
                f"unknown or unexpected keyword '{entry.key}' in '{block.name}'. "
                f"{did_you_mean(entry.key, keys)}".rstrip(),
            )
            continue
        number = int(match[2])
        if number == len(groups) + 1:
            groups.append({})
        elif number > len(groups) + 1 or number < 1:
            report.error(
                entry.location,
                f"'{entry.key}' comes before number {len(groups) + 1}; number them 1, 2, 3, ...",
            )
            continue
        elif number < len(groups):
            report.beyond(
                entry.location, f"'{entry.key}' comes after number {len(groups)}", "the numbers must rise"
            )
        if match[1] in groups[number - 1]:
            report.error(entry.location, f"'{entry.key}' is written a second time; remove one")
            continue
        groups[number - 1][match[1]] = entry
    for i, group in enumerate(groups, start=1):
        if required not in group:
            report.error(
                next(iter(group.values())).location,
                f"missing specification of '{required}{i}' in '{block.name}'",
            )
    if not groups:
        report.error(block.location, f"missing specification of '{required}1' in '{block.name}'")
    return [g for g in groups if required in g]


def _files(block: Block, base: Path, report: Report, kinds: Sequence[str]) -> list[FileEntry]:
    """Files of one role."""
    entries = []
    for group in _numbered(block, report, kinds, required="File"):
        folder = base / group["Path"].value if "Path" in group else base
        path = Path(os.path.normpath(folder / group["File"].value))
        save = base / group["SavePath"].value if "SavePath" in group else None
        entries.append(FileEntry(path.parent, path.name, save, group["File"].location))
    return entries


def _one_file(project: Project, which: Literal["configuration", "command_file"], block: Block) -> None:
    """The configuration or the command file."""
    files = _files(block, project.folder, project.report, ["File", "Path"])
    if len(files) > 1:
        project.report.error(files[1].location, f"'{block.name}' takes one file")
    if files:
        setattr(project, which, files[0].path)
        setattr(project, f"{which}_location", files[0].location)


def _check_inside(project: Project) -> None:
    """Input, log and output files must be in the directory of the initialization file or below it."""
    for entry in (*project.input, *project.log, *project.output):
        if not entry.path.is_relative_to(project.folder):
            project.report.error(
                entry.location,
                f"'{entry.path}' is outside the directory of the initialization file; every run has its own "
                f"directory below '{project.folder}': move the file there (templates may be anywhere)",
            )
    for entry in project.template:
        if not is_file(entry.path):
            project.report.error(entry.location, f"template '{entry.path}' does not exist")


def objectives(block: Block, report: Report) -> list[Objective]:
    """Read which numbers are taken from the output files after a run.

    Parameters
    ----------
    block : Block
        The section ObjectiveFunctionLocation.
    report : Report
        Takes errors.

    Returns
    -------
    list of Objective
        The cost first.
    """
    out: list[Objective] = []
    groups = _numbered(block, report, ["Name", "Delimiter", "FirstCharacterAt", "Function"], required="Name")
    for i, group in enumerate(groups, start=1):
        name, location = group["Name"].value, group["Name"].location
        if any(o.name == name for o in out):
            report.error(location, f"the name '{name}' is used twice")
        if ("Delimiter" in group) == ("Function" in group):
            report.error(location, f"'Name{i}' needs either 'Delimiter{i}' or 'Function{i}'")
            continue
        column = 0
        if "FirstCharacterAt" in group:
            column = integer(group["FirstCharacterAt"], report, least=0) or 0
            if "Function" in group:
                report.error(location, f"'FirstCharacterAt{i}' belongs to a delimiter, not to a function")
        out.append(
            Objective(
                name,
                group["Delimiter"].value if "Delimiter" in group else None,
                column,
                group["Function"].value if "Function" in group else None,
                location,
            )
        )
    return out

"""Reads the command file of a GenOpt project."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

from mascarin._io.regular import is_file
from mascarin.errors import InputError, did_you_mean
from mascarin.genopt.files import functions
from mascarin.genopt.files.entries import any_order, boolean, bound, integer, no_loose_entries, real
from mascarin.genopt.files.numbers import single_text
from mascarin.genopt.files.project import ContinuousInput, DiscreteInput, Objective, Project, Settings
from mascarin.genopt.files.syntax import Block, Entry, Report, expect_blocks, read


def read_command_file(project: Project) -> None:
    """Read parameters, functions, settings and algorithm.

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
    if not is_file(project.command_file):
        report.error(project.command_file_location, f"'{project.command_file}' does not exist")
        return
    root = read(project.command_file, report)
    no_loose_entries(root, report)
    blocks = expect_blocks(root, ["Vary", "OptimizationSettings", "Algorithm"], report)
    report.raise_if_any()
    no_loose_entries(Block("", "", entries=blocks["Vary"].entries), report)
    for block in blocks["Vary"].blocks:
        if block.name == "Parameter":
            _parameter(project, block)
        elif block.name == "Function":
            _function(project, block)
        else:
            report.error(
                block.location,
                f"unknown or unexpected section '{block.name}'. "
                f"{did_you_mean(block.name, ['Parameter', 'Function'])}".rstrip(),
            )
    if not project.names:
        report.error(blocks["Vary"].location, "no Parameter is given; add at least one")
    project.settings = _settings(blocks["OptimizationSettings"], report)
    project.algorithm = blocks["Algorithm"]


def _settings(block: Block, report: Report) -> Settings:
    """The section OptimizationSettings, keys in any order."""
    keys = ["MaxIte", "WriteStepNumber", "MaxEqualResults", "UnitsOfExecution"]
    entries = any_order(block, keys, report, optional=["MaxEqualResults", "UnitsOfExecution"])
    number = {
        k: integer(entries[k], report, least=m)
        for k, m in (("MaxIte", 1), ("MaxEqualResults", 2), ("UnitsOfExecution", 0))
        if k in entries
    }
    return Settings(
        number.get("MaxIte") or 1,
        boolean(entries["WriteStepNumber"], report) if "WriteStepNumber" in entries else False,
        number.get("MaxEqualResults") or 5,
        number.get("UnitsOfExecution") or 0,
    )


def _parameter(project: Project, block: Block) -> None:
    """One parameter."""
    report = project.report
    keys = ["Name", "Ini", "Step", "Min", "Max", "Values", "Type"]
    entries = any_order(block, keys, report, optional=["Step", "Min", "Max", "Values", "Type"])
    if "Name" not in entries or "Ini" not in entries:
        return
    name = entries["Name"].value
    _check_name(project, name, entries["Name"].location)
    kind = (
        entries["Type"].value.upper() if "Type" in entries else "SET" if "Values" in entries else "CONTINUOUS"
    )
    if kind not in ("SET", "CONTINUOUS"):
        report.error(
            entries["Type"].location, f"Type is '{entries['Type'].value}'; expected CONTINUOUS or SET"
        )
    elif kind == "SET":
        _discrete(project, name, entries)
    else:
        _continuous(project, name, entries, block)


def _continuous(project: Project, name: str, entries: Mapping[str, Entry], block: Block) -> None:
    """A continuous parameter."""
    report = project.report
    if "Values" in entries:
        report.error(entries["Values"].location, f"'{name}' is continuous; 'Values' belongs to Type = SET")
        return
    if "Step" not in entries:
        report.error(block.end, f"missing specification of 'Step' of '{name}'")
        return
    initial, step = real(entries["Ini"], report), real(entries["Step"], report)
    lower = bound(entries.get("Min"), "SMALL", report)
    upper = bound(entries.get("Max"), "BIG", report)
    if initial is None or step is None:
        return
    if lower is not None and upper is not None and lower > upper:
        report.error(
            entries["Min"].location, f"'{name}': Min {lower!r} is above Max {upper!r}; exchange them"
        )
    project.continuous.append(ContinuousInput(name, initial, step, lower, upper, entries["Name"].location))


def _discrete(project: Project, name: str, entries: Mapping[str, Entry]) -> None:
    """A discrete parameter, from a list or from equal or logarithmic spacing."""
    report = project.report
    if "Values" in entries:
        for key in ("Step", "Min", "Max"):
            if key in entries:
                report.error(entries[key].location, f"'{name}' has 'Values'; remove '{key}'")
        values = tuple(entries["Values"].value.split(","))
    else:
        values = _spaced(name, entries, report)
    initial = integer(entries["Ini"], report, least=1)
    if initial is None or not values:
        return
    if initial > len(values):
        report.error(
            entries["Ini"].location,
            f"'{name}': Ini = {initial} is the index of the first value, counted from 1; "
            f"there are {len(values)} values",
        )
        return
    project.discrete.append(DiscreteInput(name, initial - 1, values, entries["Name"].location))


def _spaced(name: str, entries: Mapping[str, Entry], report: Report) -> tuple[str, ...]:
    """Values of a discrete parameter given by limits and a number of intervals."""
    missing = [k for k in ("Min", "Max", "Step") if k not in entries]
    if missing:
        report.error(
            entries["Name"].location, f"'{name}' of Type SET needs 'Values', or 'Min', 'Max' and 'Step'"
        )
        return ()
    low, high = real(entries["Min"], report), real(entries["Max"], report)
    count = integer(entries["Step"], report)
    if low is None or high is None or count is None:
        return ()
    n = abs(count)
    if n == 0:
        return (single_text(low),)
    if count > 0:
        return tuple(single_text(low + i * (high - low) / n) for i in range(n + 1))
    if low <= 0 or high <= 0:
        report.error(entries["Step"].location, f"'{name}': logarithmic spacing needs Min and Max above zero")
        return ()
    return tuple(single_text(low * math.exp(i * math.log(high / low) / n)) for i in range(n + 1))


def _function(project: Project, block: Block) -> None:
    """An input function."""
    entries = any_order(block, ["Name", "Function"], project.report)
    if len(entries) == 2:
        name = entries["Name"].value
        _check_name(project, name, entries["Name"].location)
        project.functions[name] = entries["Function"].value
        project.function_locations[name] = entries["Function"].location


def _check_name(project: Project, name: str, location: str) -> None:
    """Names of parameters and functions are unique."""
    if name in project.names or name in project.functions:
        project.report.error(location, f"the name '{name}' is used twice")
    if name == "stepNumber":
        project.report.error(
            location, "the name 'stepNumber' is reserved for the step number; choose another"
        )


def resolve_functions(project: Project) -> None:
    """Insert functions into each other and check that they can be evaluated.

    Parameters
    ----------
    project : Project
        Its functions are replaced; errors go to its report.
    """
    try:
        project.functions = functions.resolve(
            project.functions, lambda n: project.function_locations.get(n, str(project.command_file))
        )
        cost_functions = {o.name: o.function for o in project.objectives if o.function is not None}
        locations = {o.name: o.location for o in project.objectives}
        cost_functions = functions.resolve(cost_functions, lambda n: locations[n])
    except InputError as error:
        project.report.errors.append(str(error))
        return
    project.objectives = [
        Objective(o.name, o.delimiter, o.column, cost_functions.get(o.name), o.location)
        for o in project.objectives
    ]
    inputs = dict.fromkeys((*project.names, "stepNumber"), "1")
    read_names = {o.name: "1" for o in project.objectives if o.delimiter is not None}
    for name, text in project.functions.items():
        _try_function(project.report, project.function_locations[name], functions.substitute(text, inputs))
    values = {**inputs, **dict.fromkeys(project.functions, "1"), **read_names}
    for o in project.objectives:
        if o.function is not None:
            _try_function(project.report, o.location, functions.substitute(cost_functions[o.name], values))


def _try_function(report: Report, location: str, text: str) -> None:
    """Evaluate a function once with ones for its variables."""
    unresolved = re.search(r"%([^%\s]+)%", text)
    if unresolved:
        report.error(location, f"'{unresolved[0]}' in a function is not a parameter, function or cost")
        return
    try:
        functions.evaluate(text)
    except InputError as error:
        report.error(location, str(error))

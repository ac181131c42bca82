"""Reads the command file of a GenOpt project."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

from mascarin._io.regular import is_file
from mascarin.errors import InputError, did_you_mean
from mascarin.genopt import functions
from mascarin.genopt.entries import any_order, boolean, bound, integer, no_loose_entries, real
from mascarin.genopt.numbers import single_text
from mascarin.genopt.project import ContinuousInput, DiscreteInput, Objective, Project, Settings
from mascarin.genopt.syntax import Block, Entry, Report, expect_blocks, read


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
        report.error(project.command_file_place, f"'{project.command_file}' does not exist")
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
                block.place,
                f"unknown or unexpected section '{block.name}'. "
                f"{did_you_mean(block.name, ['Parameter', 'Function'])}".rstrip(),
            )
    if not project.names:
        report.error(blocks["Vary"].place, "no Parameter is given; add at least one")
    project.settings = _settings(blocks["OptimizationSettings"], report)
    project.algorithm = blocks["Algorithm"]


def _settings(block: Block, report: Report) -> Settings:
    """The section OptimizationSettings, keys in any order."""
    keys = ["MaxIte", "WriteStepNumber", "MaxEqualResults", "UnitsOfExecution"]
    found = any_order(block, keys, report, optional=["MaxEqualResults", "UnitsOfExecution"])
    number = {
        k: integer(found[k], report, least=m)
        for k, m in (("MaxIte", 1), ("MaxEqualResults", 2), ("UnitsOfExecution", 0))
        if k in found
    }
    return Settings(
        number.get("MaxIte") or 1,
        boolean(found["WriteStepNumber"], report) if "WriteStepNumber" in found else False,
        number.get("MaxEqualResults") or 5,
        number.get("UnitsOfExecution") or 0,
    )


def _parameter(project: Project, block: Block) -> None:
    """One parameter."""
    report = project.report
    keys = ["Name", "Ini", "Step", "Min", "Max", "Values", "Type"]
    found = any_order(block, keys, report, optional=["Step", "Min", "Max", "Values", "Type"])
    if "Name" not in found or "Ini" not in found:
        return
    name = found["Name"].value
    _check_name(project, name, found["Name"].place)
    kind = found["Type"].value.upper() if "Type" in found else "SET" if "Values" in found else "CONTINUOUS"
    if kind not in ("SET", "CONTINUOUS"):
        report.error(found["Type"].place, f"Type is '{found['Type'].value}'; expected CONTINUOUS or SET")
    elif kind == "SET":
        _discrete(project, name, found)
    else:
        _continuous(project, name, found, block)


def _continuous(project: Project, name: str, found: Mapping[str, Entry], block: Block) -> None:
    """A continuous parameter."""
    report = project.report
    if "Values" in found:
        report.error(found["Values"].place, f"'{name}' is continuous; 'Values' belongs to Type = SET")
        return
    if "Step" not in found:
        report.error(block.end, f"missing specification of 'Step' of '{name}'")
        return
    initial, step = real(found["Ini"], report), real(found["Step"], report)
    lower = bound(found.get("Min"), "SMALL", report)
    upper = bound(found.get("Max"), "BIG", report)
    if initial is None or step is None:
        return
    if lower is not None and upper is not None and lower > upper:
        report.error(found["Min"].place, f"'{name}': Min {lower!r} is above Max {upper!r}; exchange them")
    project.continuous.append(ContinuousInput(name, initial, step, lower, upper, found["Name"].place))


def _discrete(project: Project, name: str, found: Mapping[str, Entry]) -> None:
    """A discrete parameter, from a list or from equal or logarithmic spacing."""
    report = project.report
    if "Values" in found:
        for key in ("Step", "Min", "Max"):
            if key in found:
                report.error(found[key].place, f"'{name}' has 'Values'; remove '{key}'")
        values = tuple(found["Values"].value.split(","))
    else:
        values = _spaced(name, found, report)
    initial = integer(found["Ini"], report, least=1)
    if initial is None or not values:
        return
    if initial > len(values):
        report.error(
            found["Ini"].place,
            f"'{name}': Ini = {initial} is the index of the first value, counted from 1; "
            f"there are {len(values)} values",
        )
        return
    project.discrete.append(DiscreteInput(name, initial - 1, values, found["Name"].place))


def _spaced(name: str, found: Mapping[str, Entry], report: Report) -> tuple[str, ...]:
    """Values of a discrete parameter given by limits and a number of intervals."""
    missing = [k for k in ("Min", "Max", "Step") if k not in found]
    if missing:
        report.error(found["Name"].place, f"'{name}' of Type SET needs 'Values', or 'Min', 'Max' and 'Step'")
        return ()
    low, high = real(found["Min"], report), real(found["Max"], report)
    count = integer(found["Step"], report)
    if low is None or high is None or count is None:
        return ()
    n = abs(count)
    if n == 0:
        return (single_text(low),)
    if count > 0:
        return tuple(single_text(low + i * (high - low) / n) for i in range(n + 1))
    if low <= 0 or high <= 0:
        report.error(found["Step"].place, f"'{name}': logarithmic spacing needs Min and Max above zero")
        return ()
    return tuple(single_text(low * math.exp(i * math.log(high / low) / n)) for i in range(n + 1))


def _function(project: Project, block: Block) -> None:
    """An input function."""
    found = any_order(block, ["Name", "Function"], project.report)
    if len(found) == 2:
        name = found["Name"].value
        _check_name(project, name, found["Name"].place)
        project.functions[name] = found["Function"].value
        project.function_places[name] = found["Function"].place


def _check_name(project: Project, name: str, place: str) -> None:
    """Names of parameters and functions are unique."""
    if name in project.names or name in project.functions:
        project.report.error(place, f"the name '{name}' is used twice")
    if name == "stepNumber":
        project.report.error(place, "the name 'stepNumber' is reserved for the step number; choose another")


def resolve_functions(project: Project) -> None:
    """Insert functions into each other and check that they can be evaluated.

    Parameters
    ----------
    project : Project
        Its functions are replaced; errors go to its report.
    """
    try:
        project.functions = functions.resolve(
            project.functions, lambda n: project.function_places.get(n, str(project.command_file))
        )
        own = {o.name: o.function for o in project.objectives if o.function is not None}
        places = {o.name: o.place for o in project.objectives}
        own = functions.resolve(own, lambda n: places[n])
    except InputError as error:
        project.report.errors.append(str(error))
        return
    project.objectives = [
        Objective(o.name, o.delimiter, o.column, own.get(o.name), o.place) for o in project.objectives
    ]
    inputs = dict.fromkeys((*project.names, "stepNumber"), "1")
    read_names = {o.name: "1" for o in project.objectives if o.delimiter is not None}
    for name, text in project.functions.items():
        _try_function(project.report, project.function_places[name], functions.substitute(text, inputs))
    values = {**inputs, **dict.fromkeys(project.functions, "1"), **read_names}
    for o in project.objectives:
        if o.function is not None:
            _try_function(project.report, o.place, functions.substitute(own[o.name], values))


def _try_function(report: Report, place: str, text: str) -> None:
    """Evaluate a function once with ones for its variables."""
    left = re.search(r"%([^%\s]+)%", text)
    if left:
        report.error(place, f"'{left[0]}' in a function is not a parameter, function or cost")
        return
    try:
        functions.evaluate(text)
    except InputError as error:
        report.error(place, str(error))

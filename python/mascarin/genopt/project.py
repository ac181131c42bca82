"""A GenOpt project: initialization, configuration and command file, read and checked."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from mascarin.errors import InputError, did_you_mean
from mascarin.genopt import functions
from mascarin.genopt.numbers import double_text, parse_double, single, single_text
from mascarin.genopt.syntax import Block, Entry, Report, expect_blocks, ordered, read

_NUMBERED = re.compile(r"([A-Za-z]+?)(\d+)\Z")


@dataclass(frozen=True)
class FileEntry:
    """One file of a project.

    Parameters
    ----------
    folder : Path
        Its directory, absolute.
    name : str
        Its name.
    save : Path or None
        Directory that keeps a copy of every run's file.
    place : str
        File and line where it is named.
    """

    folder: Path
    name: str
    save: Path | None
    place: str

    @property
    def path(self) -> Path:
        """Directory and name."""
        return self.folder / self.name


@dataclass(frozen=True)
class Objective:
    """One number that is read or computed after a run.

    Parameters
    ----------
    name : str
        Its name in the listings.
    delimiter : str or None
        Text in front of the number in an output file.
    column : int
        Column in which the delimiter starts, counted from 1; 0 for anywhere [-].
    function : str or None
        Function object, when the number is computed.
    place : str
        File and line.
    """

    name: str
    delimiter: str | None
    column: int
    function: str | None
    place: str


@dataclass(frozen=True)
class ContinuousInput:
    """A continuous parameter of the command file; bounds are None where absent."""

    name: str
    initial: float
    step: float
    lower: float | None
    upper: float | None
    place: str


@dataclass(frozen=True)
class DiscreteInput:
    """A discrete parameter of the command file with the texts of its values."""

    name: str
    initial: int
    values: tuple[str, ...]
    place: str


@dataclass(frozen=True)
class Settings:
    """The section OptimizationSettings."""

    max_iterations: int
    write_step: bool
    max_equal: int
    units: int


@dataclass
class Project:
    """Everything the three files say.

    Parameters
    ----------
    ini : Path
        The initialization file, absolute.
    template, input, log, output : list of FileEntry
        Files by role.
    configuration, command_file : Path
        The other two files.
    prefix, suffix : str
        Call parameters.
    errors : list of str
        Texts that mean an error in a log file.
    number_format : str
        How continuous values are written, "Double" or "Float".
    command : str
        The command line with its variables.
    command_place : str
        File and line of the command.
    keep_extension : bool
        Whether the extension of input files is written in the command.
    objectives : list of Objective
        Numbers read after a run, the cost first.
    continuous, discrete : list
        Parameters.
    functions : dict of str to str
        Input functions without references to each other.
    function_places : dict of str to str
        File and line of each function.
    settings : Settings
        General settings.
    algorithm : Block
        The section Algorithm.
    report : Report
        Notes.
    """

    ini: Path
    template: list[FileEntry] = field(default_factory=list)
    input: list[FileEntry] = field(default_factory=list)
    log: list[FileEntry] = field(default_factory=list)
    output: list[FileEntry] = field(default_factory=list)
    configuration: Path = Path()
    configuration_place: str = ""
    command_file: Path = Path()
    command_file_place: str = ""
    prefix: str = ""
    suffix: str = ""
    errors: list[str] = field(default_factory=list)
    number_format: Literal["Double", "Float"] = "Double"
    command: str = ""
    command_place: str = ""
    keep_extension: bool = True
    objectives: list[Objective] = field(default_factory=list)
    continuous: list[ContinuousInput] = field(default_factory=list)
    discrete: list[DiscreteInput] = field(default_factory=list)
    functions: dict[str, str] = field(default_factory=dict)
    function_places: dict[str, str] = field(default_factory=dict)
    settings: Settings = field(default_factory=lambda: Settings(1, False, 5, 0))
    algorithm: Block = field(default_factory=lambda: Block("", ""))
    report: Report = field(default_factory=Report)

    @property
    def folder(self) -> Path:
        """Directory of the initialization file."""
        return self.ini.parent

    @property
    def names(self) -> list[str]:
        """Names of the parameters, continuous ones first."""
        return [p.name for p in self.continuous] + [p.name for p in self.discrete]

    def number_text(self, value: float) -> str:
        """Text of a continuous value in files and listings."""
        return single_text(value) if self.number_format == "Float" else double_text(value)


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
        With every error found, each with file and line.
    """
    ini = Path(path).absolute()
    project = Project(ini, report=Report(lenient))
    _read_initialization(project)
    project.report.raise_if_any()
    own = list(project.objectives)
    _read_configuration(project)
    project.report.raise_if_any()
    if own and project.objectives != own:
        place = project.objectives[0].place
        project.report.notes.append(
            f"{place}: ObjectiveFunctionLocation stands in the initialization file too; that one is used"
        )
        project.objectives = own
    if not project.objectives:
        project.report.error(
            str(project.ini), "ObjectiveFunctionLocation is missing here and in the configuration file"
        )
    _read_command_file(project)
    project.report.raise_if_any()
    _resolve_functions(project)
    project.report.raise_if_any()
    return project


# ---------------------------------------------------------------------- initialization file


def _read_initialization(project: Project) -> None:
    """Files, call parameters and objectives."""
    report = project.report
    root = read(project.ini, report)
    _no_loose_entries(root, report)
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
            files["Input"].place,
            f"{len(project.input)} input files for {len(project.template)} templates; "
            "the first template makes the first input file, and so on",
        )
    _one_file(project, "configuration", files["Configuration"])
    if "CallParameter" in simulation:
        found = ordered(
            simulation["CallParameter"], ["Prefix", "Suffix"], report, optional=["Prefix", "Suffix"]
        )
        project.prefix = found["Prefix"].value if "Prefix" in found else ""
        project.suffix = found["Suffix"].value if "Suffix" in found else ""
    if "ObjectiveFunctionLocation" in simulation:
        project.objectives = _objectives(simulation["ObjectiveFunctionLocation"], report)
    optimization = expect_blocks(top["Optimization"], ["Files"], report)
    report.raise_if_any()
    command = expect_blocks(optimization["Files"], ["Command"], report)
    report.raise_if_any()
    _one_file(project, "command_file", command["Command"])
    _check_inside(project)


def _no_loose_entries(root: Block, report: Report) -> None:
    """Entries outside all sections."""
    for entry in root.entries:
        report.error(entry.place, f"'{entry.key}' stands outside all sections")


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
            report.error(entry.place, f"'{name}' refers to itself in a circle; write the value out")
        if value != entry.value:
            block.entries[i] = Entry(entry.key, value, entry.quoted, entry.place, entry.raw)


def _numbered(block: Block, report: Report, kinds: Sequence[str], *, required: str) -> list[dict[str, Entry]]:
    """Entries with numbered keys such as ``File1``, grouped by number."""
    groups: list[dict[str, Entry]] = []
    for entry in block.entries:
        found = _NUMBERED.match(entry.key)
        if found is None or found[1] not in kinds:
            known = [f"{kind}{i}" for kind in kinds for i in (1, 2)]
            report.error(
                entry.place,
                f"unknown or unexpected keyword '{entry.key}' in '{block.name}'. "
                f"{did_you_mean(entry.key, known)}".rstrip(),
            )
            continue
        number = int(found[2])
        if number == len(groups) + 1:
            groups.append({})
        elif number > len(groups) + 1 or number < 1:
            report.error(
                entry.place, f"'{entry.key}' comes before number {len(groups) + 1}; number them 1, 2, 3, ..."
            )
            continue
        elif number < len(groups):
            report.beyond(
                entry.place, f"'{entry.key}' stands behind number {len(groups)}", "the numbers must rise"
            )
        if found[1] in groups[number - 1]:
            report.error(entry.place, f"'{entry.key}' is written a second time; remove one")
            continue
        groups[number - 1][found[1]] = entry
    for i, group in enumerate(groups, start=1):
        if required not in group:
            report.error(
                next(iter(group.values())).place,
                f"missing specification of '{required}{i}' in '{block.name}'",
            )
    if not groups:
        report.error(block.place, f"missing specification of '{required}1' in '{block.name}'")
    return [g for g in groups if required in g]


def _files(block: Block, base: Path, report: Report, kinds: Sequence[str]) -> list[FileEntry]:
    """Files of one role."""
    entries = []
    for group in _numbered(block, report, kinds, required="File"):
        folder = base / group["Path"].value if "Path" in group else base
        whole = Path(os.path.normpath(folder / group["File"].value))
        save = base / group["SavePath"].value if "SavePath" in group else None
        entries.append(FileEntry(whole.parent, whole.name, save, group["File"].place))
    return entries


def _one_file(project: Project, which: Literal["configuration", "command_file"], block: Block) -> None:
    """The configuration or the command file."""
    found = _files(block, project.folder, project.report, ["File", "Path"])
    if len(found) > 1:
        project.report.error(found[1].place, f"'{block.name}' takes one file")
    if found:
        setattr(project, which, found[0].path)
        setattr(project, f"{which}_place", found[0].place)


def _check_inside(project: Project) -> None:
    """Input, log and output files must lie under the directory of the initialization file."""
    for entry in (*project.input, *project.log, *project.output):
        if not entry.path.is_relative_to(project.folder):
            project.report.error(
                entry.place,
                f"'{entry.path}' is outside the directory of the initialization file; every run has its own "
                f"directory below '{project.folder}', so move it there (templates may be anywhere)",
            )
    for entry in project.template:
        if not entry.path.is_file():
            project.report.error(entry.place, f"template '{entry.path}' does not exist")


def _objectives(block: Block, report: Report) -> list[Objective]:
    """Numbers to be read after a run."""
    out: list[Objective] = []
    groups = _numbered(block, report, ["Name", "Delimiter", "FirstCharacterAt", "Function"], required="Name")
    for i, group in enumerate(groups, start=1):
        name, place = group["Name"].value, group["Name"].place
        if any(o.name == name for o in out):
            report.error(place, f"the name '{name}' is used twice")
        if ("Delimiter" in group) == ("Function" in group):
            report.error(place, f"'Name{i}' needs either 'Delimiter{i}' or 'Function{i}'")
            continue
        column = 0
        if "FirstCharacterAt" in group:
            column = _integer(group["FirstCharacterAt"], report, least=0) or 0
            if "Function" in group:
                report.error(place, f"'FirstCharacterAt{i}' belongs to a delimiter, not to a function")
        out.append(
            Objective(
                name,
                group["Delimiter"].value if "Delimiter" in group else None,
                column,
                group["Function"].value if "Function" in group else None,
                place,
            )
        )
    return out


# ---------------------------------------------------------------------- configuration file


def _read_configuration(project: Project) -> None:
    """Error texts, number format and command."""
    report = project.report
    if not project.configuration.is_file():
        report.error(project.configuration_place, f"'{project.configuration}' does not exist")
        return
    root = read(project.configuration, report)
    _no_loose_entries(root, report)
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
            report.error(entry.place, "an empty ErrorMessage is found in every line; write a text")
    form = ordered(blocks["IO"], ["NumberFormat"], report).get("NumberFormat")
    if form is not None:
        if form.value == "Float":
            project.number_format = "Float"
        elif form.value != "Double":
            report.error(form.place, f"NumberFormat is '{form.value}'; expected Double or Float")
    start = ordered(blocks["SimulationStart"], ["Command", "WriteInputFileExtension"], report)
    if "Command" in start:
        project.command, project.command_place = start["Command"].value, start["Command"].place
    if "WriteInputFileExtension" in start:
        project.keep_extension = _boolean(start["WriteInputFileExtension"], report)
    if "ObjectiveFunctionLocation" in blocks:
        project.objectives = _objectives(blocks["ObjectiveFunctionLocation"], report)


# ---------------------------------------------------------------------- command file


def _read_command_file(project: Project) -> None:
    """Parameters, functions, settings and algorithm."""
    report = project.report
    if not project.command_file.is_file():
        report.error(project.command_file_place, f"'{project.command_file}' does not exist")
        return
    root = read(project.command_file, report)
    _no_loose_entries(root, report)
    blocks = expect_blocks(root, ["Vary", "OptimizationSettings", "Algorithm"], report)
    report.raise_if_any()
    _no_loose_entries(Block("", "", entries=blocks["Vary"].entries), report)
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
    found = _any_order(block, keys, report, optional=["MaxEqualResults", "UnitsOfExecution"])
    integer = {
        k: _integer(found[k], report, least=m)
        for k, m in (("MaxIte", 1), ("MaxEqualResults", 2), ("UnitsOfExecution", 0))
        if k in found
    }
    return Settings(
        integer.get("MaxIte") or 1,
        _boolean(found["WriteStepNumber"], report) if "WriteStepNumber" in found else False,
        integer.get("MaxEqualResults") or 5,
        integer.get("UnitsOfExecution") or 0,
    )


def _parameter(project: Project, block: Block) -> None:
    """One parameter."""
    report = project.report
    keys = ["Name", "Ini", "Step", "Min", "Max", "Values", "Type"]
    found = _any_order(block, keys, report, optional=["Step", "Min", "Max", "Values", "Type"])
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
    initial, step = _real(found["Ini"], report), _real(found["Step"], report)
    lower = _bound(found.get("Min"), "SMALL", report)
    upper = _bound(found.get("Max"), "BIG", report)
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
    initial = _integer(found["Ini"], report, least=1)
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
    low, high = _real(found["Min"], report), _real(found["Max"], report)
    count = _integer(found["Step"], report)
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
    found = _any_order(block, ["Name", "Function"], project.report)
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
        project.report.error(place, "the name 'stepNumber' is taken by the step number; choose another")


def _resolve_functions(project: Project) -> None:
    """Insert functions in each other and check that they can be evaluated."""
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
        report.error(place, f"'{left[0]}' in a function is no parameter, function or cost")
        return
    try:
        functions.evaluate(text)
    except InputError as error:
        report.error(place, str(error))


# ---------------------------------------------------------------------- values


def _any_order(
    block: Block, keys: Sequence[str], report: Report, *, optional: Sequence[str] = ()
) -> dict[str, Entry]:
    """Entries of a block by key, each once."""
    order = [e.key for e in block.entries if e.key in keys]
    sequence = [*dict.fromkeys(order), *(k for k in keys if k not in order)]
    for inner in block.blocks:
        report.error(inner.place, f"unexpected section '{inner.name}' in '{block.name}'")
    return ordered(block, sequence, report, optional=optional)


def _integer(entry: Entry, report: Report, *, least: int | None = None) -> int | None:
    """A whole number; a fraction is cut as GenOpt does."""
    value = parse_double(entry.value)
    if value is None or not math.isfinite(value):
        report.error(entry.place, f"'{entry.key}' is '{entry.value}'; expected a whole number")
        return None
    if value != int(value):
        report.notes.append(f"{entry.place}: '{entry.key} = {entry.value}' is cut to {int(value)}")
    if least is not None and int(value) < least:
        report.error(entry.place, f"'{entry.key}' is {int(value)}; expected at least {least}")
        return None
    return int(value)


def _real(entry: Entry, report: Report) -> float | None:
    """A number."""
    value = parse_double(entry.value)
    if value is None or not math.isfinite(value):
        report.error(entry.place, f"'{entry.key}' is '{entry.value}'; expected a number")
        return None
    return value


def _bound(entry: Entry | None, none: str, report: Report) -> float | None:
    """A bound, None where it is absent or said to be absent."""
    if entry is None or entry.value.upper() == none:
        return None
    return _real(entry, report)


def _boolean(entry: Entry, report: Report) -> bool:
    """Exactly true or false."""
    if entry.value not in ("true", "false"):
        report.error(entry.place, f"'{entry.key}' is '{entry.value}'; expected true or false")
    return entry.value == "true"


def single_rounding(value: float, _index: int) -> float:
    """GenOpt's rounding of coordinates, for the `rounding` of searches on a mesh."""
    return single(value)

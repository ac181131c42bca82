"""A GenOpt project: the content of its three files."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from mascarin.genopt.files.numbers import double_text, single_text
from mascarin.genopt.files.syntax import Block, Report


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
        Directory in which the file of every run is kept.
    location : str
        File and line of its name.
    """

    folder: Path
    name: str
    save: Path | None
    location: str

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
    location : str
        File and line.
    """

    name: str
    delimiter: str | None
    column: int
    function: str | None
    location: str


@dataclass(frozen=True)
class ContinuousInput:
    """A continuous parameter of the command file; bounds are None where they are not given."""

    name: str
    initial: float
    step: float
    lower: float | None
    upper: float | None
    location: str


@dataclass(frozen=True)
class DiscreteInput:
    """A discrete parameter of the command file with the texts of its values."""

    name: str
    initial: int
    values: tuple[str, ...]
    location: str


@dataclass(frozen=True)
class Settings:
    """The section OptimizationSettings."""

    max_iterations: int
    write_step: bool
    max_equal: int
    units: int


@dataclass
class Project:
    """Everything in the three files.

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
    command_location : str
        File and line of the command.
    keep_extension : bool
        Whether the extension of input files is written in the command.
    objectives : list of Objective
        Numbers read after a run, the cost first.
    continuous, discrete : list
        Parameters.
    functions : dict of str to str
        Input functions without references to each other.
    function_locations : dict of str to str
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
    configuration_location: str = ""
    command_file: Path = Path()
    command_file_location: str = ""
    prefix: str = ""
    suffix: str = ""
    errors: list[str] = field(default_factory=list)
    number_format: Literal["Double", "Float"] = "Double"
    command: str = ""
    command_location: str = ""
    keep_extension: bool = True
    objectives: list[Objective] = field(default_factory=list)
    continuous: list[ContinuousInput] = field(default_factory=list)
    discrete: list[DiscreteInput] = field(default_factory=list)
    functions: dict[str, str] = field(default_factory=dict)
    function_locations: dict[str, str] = field(default_factory=dict)
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
        """Write a continuous value as in files and listings."""
        return single_text(value) if self.number_format == "Float" else double_text(value)

"""Writes a study's identification as a GenOpt project.

The command has no file names and no file has an absolute path: the program finds its files in the directory
in which it is started. There are two reasons. GenOpt splits the command at blanks, so that a path through a
folder with a blank in its name would not work. And for a name in the command GenOpt could use a file of the
directory from which it was started, instead of the file of the run.
"""

from __future__ import annotations

import os
import re
import shutil
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_EVEN, Context, Decimal
from pathlib import Path
from typing import TYPE_CHECKING, Final

from mascarin._io import atomic
from mascarin._io.locks import writing_into
from mascarin.errors import InputError
from mascarin.genopt.export.algorithms import INTERVALS, Algorithm, Plan, chosen
from mascarin.genopt.export.exchange import (
    COMPILED,
    FAILURE,
    LOG,
    PARAMETERS,
    RESULT,
    SETTINGS,
    write_settings,
)

if TYPE_CHECKING:
    from mascarin.calibration import FitParameter
    from mascarin.genopt.export.case import Case

INITIALIZATION: Final = "opt.ini"
_CONFIGURATION, _COMMAND, _TEMPLATE, _README = "mascarin.cfg", "command.txt", "template.txt", "README.txt"
#: What this module writes; no other file is overwritten.
FILES: Final = (INITIALIZATION, _CONFIGURATION, _COMMAND, _TEMPLATE, _README, SETTINGS, COMPILED)

#: Digits that GenOpt's rounding of coordinates to single precision keeps.
_DIGITS: Final = 6
#: First step of a search, as a part of the range.
_STEP: Final = 0.1
_REDUCTIONS: Final = 10
#: MaxIte of a study without a budget; pattern searches end long before.
_UNLIMITED: Final = 100_000
_WORD: Final = re.compile(r"[A-Za-z][A-Za-z0-9_.-]*\Z")
_SEEDS: Final = 2**31


@dataclass(frozen=True)
class Options:
    """Options of an export.

    Attributes
    ----------
    algorithm : str
        Name of `mascarin.genopt.export.algorithms`, or GenOpt's name.
    starts, evaluations, seed : int, optional
        They replace starts, budget and seed of the study's identification. [-]
    reductions : int
        Number of times that a pattern search halves its step. [-]
    program : str, optional
        Command of the simulation program; default ``mascarin`` or its full path.
    force : bool
        Whether to write into a folder that is not empty.
    allow_outside : bool
        Whether the study may name files outside its folder.
    """

    algorithm: str = "hooke-jeeves"
    starts: int | None = None
    evaluations: int | None = None
    seed: int | None = None
    reductions: int = _REDUCTIONS
    program: str | None = None
    force: bool = False
    allow_outside: bool = False


@dataclass(frozen=True)
class Variable:
    """A parameter of the command file: short decimal numbers, the bounds rounded inwards."""

    name: str
    initial: Decimal
    lower: Decimal
    upper: Decimal
    step: Decimal
    unit: str


def write_project(study: str, out: Path, options: Options | None = None) -> Path:
    """Write a project.

    Parameters
    ----------
    study : str
        Study file, or the name of a study that is shipped.
    out : Path
        Folder of the project.
    options : Options, optional
        Options of the export.

    Returns
    -------
    Path
        The initialization file.

    Raises
    ------
    InputError
        Study, folder or options cannot be used; nothing is written.
    """
    from mascarin.examples import locate
    from mascarin.genopt.export.compiling import compile_study
    from mascarin.study import Study

    o = options or Options()
    _check_folder(out, force=o.force)
    path = locate(study)
    opened = Study(path, allow_outside=o.allow_outside)
    stated = opened.context.inputs.calibration_plan
    plan = _plan(o, stated.starts, stated.seed, stated.budget)
    case = compile_study(opened)
    algorithm = chosen(o.algorithm, len(case.parameters))
    _check_sensors([sensor.name for sensor in case.sensors], path)
    variables = [variable(p, path, intervals=algorithm.intervals) for p in case.parameters]
    texts = {
        INITIALIZATION: _initialization(case.names),
        _CONFIGURATION: _configuration(_program(o.program), " --allow-outside" if o.allow_outside else ""),
        _COMMAND: _command(variables, algorithm, plan),
        _TEMPLATE: _template(variables),
        _README: _readme(opened.plan.name, case, algorithm),
    }
    with writing_into(out):
        for name, text in texts.items():
            atomic.write(out / name, text)
        write_settings(out, _reference(study, path, out))
        case.save(out / COMPILED)
    return out / INITIALIZATION


# --- checks -------------------------------------------------------------------------------------------------


def _check_folder(out: Path, *, force: bool) -> None:
    if out.exists() and not out.is_dir():
        raise InputError(f"{out}: is a file; expected a folder for the project: choose another -o")
    if out.is_dir() and not force:
        names = sorted(entry.name for entry in out.iterdir())
        if names:
            listed = ", ".join(names[:3]) + (", ..." if len(names) > 3 else "")
            raise InputError(
                f"{out}: the folder is not empty (it has {listed}), expected an empty or a new one. Choose "
                f"another -o, or give --force to overwrite {', '.join(FILES)} and keep the rest"
            )


def _plan(o: Options, starts: int, seed: int, budget: int | None) -> Plan:
    for name, value in (
        ("--starts", o.starts),
        ("--evaluations", o.evaluations),
        ("--reductions", o.reductions),
    ):
        if value is not None and value < 1:
            raise InputError(f"{name}: found {value}, expected 1 or more")
    taken = seed if o.seed is None else o.seed
    if not -_SEEDS <= taken < _SEEDS:
        raise InputError(
            f"seed: found {taken}, expected a whole number of 32 bits for GenOpt; choose a smaller --seed"
        )
    return Plan(o.starts or starts, taken, o.reductions, o.evaluations or budget)


def _check_sensors(names: Sequence[str], study: Path) -> None:
    for name in names:
        if not _WORD.match(name):
            raise InputError(
                f"{study}: sensors.{name}: found a name that GenOpt cannot take; expected letters of the "
                "English alphabet, digits, '_' and '-', the first a letter. Rename the sensor"
            )
        if name == "priors":
            raise InputError(
                f"{study}: sensors.{name}: this is the name of the cost of the priors; rename the sensor"
            )


def variable(parameter: FitParameter, study: Path, *, intervals: bool = False) -> Variable:
    """Convert a parameter of the identification to one of GenOpt.

    Parameters
    ----------
    parameter : FitParameter
        The parameter.
    study : Path
        The study file, for texts.
    intervals : bool
        Whether the step is a number of intervals.

    Returns
    -------
    Variable
        The parameter of the command file.

    Raises
    ------
    InputError
        GenOpt cannot take its name, or its range is too narrow for single precision.
    """
    if not _WORD.match(parameter.path):
        raise InputError(
            f"{study}: identification.parameters.{parameter.path}: found a name that GenOpt cannot take; "
            "expected letters of the English alphabet, digits, '_', '-' and '.', the first a letter. Rename "
            "the part in the building"
        )
    lower, upper = _short(parameter.lower, ROUND_CEILING), _short(parameter.upper, ROUND_FLOOR)
    if float(upper - lower) < 1e-4 * max(abs(parameter.lower), abs(parameter.upper)):
        raise InputError(
            f"{study}: identification.parameters.{parameter.path}: found the range {parameter.lower!r} .. "
            f"{parameter.upper!r}, too narrow for GenOpt, which keeps about seven digits; widen it"
        )
    initial = min(max(_short(parameter.first, ROUND_HALF_EVEN), lower), upper)
    step = _short(_STEP * float(upper - lower), ROUND_HALF_EVEN, digits=3)
    return Variable(
        parameter.path, initial, lower, upper, Decimal(INTERVALS) if intervals else step, parameter.unit
    )


def _short(value: float, rounding: str, digits: int = _DIGITS) -> Decimal:
    return Context(prec=digits, rounding=rounding).create_decimal(repr(value)).normalize()


def _program(program: str | None) -> str:
    """How the simulation program is started.

    GenOpt starts it without a shell and searches for it on the path; a full path is written only if needed.
    """
    if program is None:
        if shutil.which("mascarin") is not None:
            return "mascarin"
        beside = shutil.which("mascarin", path=str(Path(sys.executable).parent))
        if beside is None:
            raise InputError(
                "the program 'mascarin' is not on the path and GenOpt could not start it; add its folder "
                "to PATH, or give its full path with --program"
            )
        program = Path(beside).as_posix()
    if re.search(r"[\s\"\\]", program):
        raise InputError(
            f"--program: found '{program}', with blanks, quotes or backslashes, which GenOpt cannot start; "
            "put its folder on the PATH and give 'mascarin', or write slashes"
        )
    return program


def _reference(study: str, path: Path, out: Path) -> str:
    """Reference to the study: relative to the folder, by the name of a shipped one, or absolute."""
    from mascarin.examples import STUDIES

    if STUDIES.get(study) == path:
        return study
    try:
        return Path(os.path.relpath(path.resolve(), out.resolve())).as_posix()
    except ValueError:
        # On another drive of Windows there is no relative path.
        return path.resolve().as_posix()


# --- texts --------------------------------------------------------------------------------------------------


def _initialization(names: Sequence[str]) -> str:
    locations = "".join(
        f'    Name{k} = "{name}";\n    Delimiter{k} = "{name}=";\n    FirstCharacterAt{k} = 1;\n'
        for k, name in enumerate(names, start=1)
    )
    return f"""// Initialization file, written by mascarin genopt
Simulation {{
  Files {{
    Template {{ File1 = "{_TEMPLATE}"; }}
    Input {{ File1 = "{PARAMETERS}"; }}
    Log {{ File1 = "{LOG}"; }}
    Output {{ File1 = "{RESULT}"; }}
    Configuration {{ File1 = "{_CONFIGURATION}"; }}
  }}
  ObjectiveFunctionLocation {{
{locations}  }}
}}
Optimization {{
  Files {{
    Command {{ File1 = "{_COMMAND}"; }}
  }}
}}
"""


def _configuration(program: str, option: str) -> str:
    return f"""// Configuration file, written by mascarin genopt
SimulationError {{
  ErrorMessage = "{FAILURE}";
}}
IO {{
  NumberFormat = Double;
}}
// The program finds its files in the directory of the run: the command has no file names.
SimulationStart {{
  Command = "{program} cost{option}";
  WriteInputFileExtension = true;
}}
"""


def _command(variables: Sequence[Variable], algorithm: Algorithm, plan: Plan) -> str:
    parameters = "\n".join(
        f'  Parameter {{ Name = "{v.name}"; Min = {v.lower:f}; Ini = {v.initial:f}; Max = {v.upper:f}; '
        f"Step = {v.step:f}; }}"
        for v in variables
    )
    lines = "".join(f"  {line};\n" for line in (f"Main = {algorithm.main}", *algorithm.lines(plan)))
    return f"""// Command file, written by mascarin genopt
Vary {{
{parameters}
}}
OptimizationSettings {{
  MaxIte = {plan.budget or _UNLIMITED};
  MaxEqualResults = 100;
  WriteStepNumber = false;
  UnitsOfExecution = 0;
}}
Algorithm {{
{lines}}}
"""


def _template(variables: Sequence[Variable]) -> str:
    lines = "".join(
        f"{v.name} = %{v.name}%{f'  # {v.unit}' if v.unit.isascii() and v.unit not in ('', '%') else ''}\n"
        for v in variables
    )
    return f"# Parameters of one run. The folder is relative to this file.\nproject = ..\n{lines}"


def _readme(name: str, case: Case, algorithm: Algorithm) -> str:
    sensors, count = ", ".join(sensor.name for sensor in case.sensors), len(case.parameters)
    return f"""Identification of the study "{name}" as a GenOpt project

Run it with
    mascarin optimize {INITIALIZATION}
or with GenOpt itself
    java -cp genopt.jar genopt.GenOpt {INITIALIZATION}
The program 'mascarin' must be on the PATH. Start either in this folder.

{INITIALIZATION:<15} initialization file: the files, and where the costs are
{_CONFIGURATION:<15} configuration file: how one simulation is started, and the mark of a failure
{_COMMAND:<15} command file: {count} parameters with their bounds, and the algorithm {algorithm.main}
{_TEMPLATE:<15} template of {PARAMETERS}, the input of one simulation
{SETTINGS:<15} where the study is, relative to this folder
{COMPILED:<15} the compiled study; made again when the study changes; may be deleted

One simulation is 'mascarin cost': it reads {PARAMETERS}, runs the identification period, and writes {RESULT}
and {LOG}. The cost '{case.cost}' is the sum over the sensors {sensors}; the listings have each of them.
"""

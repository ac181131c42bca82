"""The files between an optimization program and one evaluation: parameters in, costs and a log out."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from mascarin._io import atomic
from mascarin._io.regular import is_file, require_regular
from mascarin._io.sealed import own_files
from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.genopt.export.case import Costs

PARAMETERS: Final = "parameters.txt"
RESULT: Final = "result.txt"
LOG: Final = "log.txt"
SETTINGS: Final = "coupling.json"
COMPILED: Final = "compiled.npz"
#: Mark in the log of an evaluation that failed.
FAILURE: Final = "MASCARIN ERROR"

#: Beginning of a file of results.
RESULT_BEGINS: Final = b"cost="

_FORMAT: Final = 1
_PROJECT: Final = "project"


@dataclass(frozen=True)
class Request:
    """The content of a parameter file.

    Attributes
    ----------
    values : dict of str to float
        Path -> value. [unit of each]
    project : Path or None
        Folder of the project that the file belongs to.
    """

    values: dict[str, float]
    project: Path | None


def read_parameters(path: Path) -> Request:
    """Read a parameter file: lines ``path = value``, and ``project = folder`` relative to the file.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    Request
        Values and project.

    Raises
    ------
    InputError
        A line that cannot be read, with its number.
    """
    try:
        lines = require_regular(path).read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise InputError(
            f"{path}: cannot be read ({error.strerror}); expected the parameter file that the template "
            f"makes, by default '{PARAMETERS}' in the current folder"
        ) from None
    except UnicodeDecodeError:
        raise InputError(f"{path}: is not text in UTF-8; write parameter names in plain letters") from None
    values: dict[str, float] = {}
    project: Path | None = None
    for number, line in enumerate(lines, start=1):
        text = line.partition("#")[0].strip()
        if not text:
            continue
        name, equals, value = (part.strip() for part in text.partition("="))
        where = f"{path}:{number}"
        if not (name and equals and value):
            raise InputError(f"{where}: found '{text}', expected 'path = value'")
        if name in values or (name == _PROJECT and project is not None):
            raise InputError(f"{where}: '{name}' occurs a second time; remove one of the two lines")
        if name == _PROJECT:
            project = path.parent / value
        else:
            values[name] = _number(value, f"{where}: {name}")
    if not values:
        raise InputError(f"{path}: found no parameter, expected lines 'path = value'")
    return Request(values, project)


def _number(text: str, where: str) -> float:
    if text.startswith("%") and text.endswith("%"):
        raise InputError(
            f"{where}: found {text}, which the optimization program should have replaced by a number; write "
            "the name of the parameter in the command file exactly as between the percent signs"
        )
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{where}: found '{text}', expected a number such as 0.04 or 1.0E-4")
    return value


def write_settings(folder: Path, study: str) -> None:
    """Write the study to which a project belongs.

    Parameters
    ----------
    folder : Path
        The project.
    study : str
        The study file, relative to the project where possible, or the name of one that is shipped.
    """
    text = json.dumps({"mascarin_coupling": _FORMAT, "study": study}, indent=1, ensure_ascii=False)
    atomic.write(folder / SETTINGS, text + "\n")


def read_settings(folder: Path) -> Path:
    """Return the study file to which a project belongs.

    Parameters
    ----------
    folder : Path
        The project.

    Returns
    -------
    Path
        The study file.

    Raises
    ------
    InputError
        The folder is not such a project, or its study does not exist.
    """
    from mascarin.examples import STUDIES

    path = folder / SETTINGS
    try:
        content = own_files.read_json(path)
        name = content["study"] if content["mascarin_coupling"] == _FORMAT else None
    except OSError as error:
        raise InputError(
            f"{path}: cannot be read ({error.strerror}); expected what 'mascarin genopt' has written into "
            "the project's folder: write the project again, or give the study with --study"
        ) from None
    except (ValueError, KeyError, TypeError):
        name = None
    if not isinstance(name, str):
        raise InputError(
            f"{path}: was not written by 'mascarin genopt'; write the project again with --force"
        )
    study = folder / name
    if is_file(study):
        return study
    if name in STUDIES:
        return STUDIES[name]
    raise InputError(
        f"{path}: study: found '{name}', but there is no such file; correct the path, which is "
        "relative to the project's folder, or write the project again"
    )


def result_lines(costs: Costs) -> list[str]:
    """Write costs as an optimization program extracts them: at the start of a line, with all digits.

    Parameters
    ----------
    costs : Costs
        The costs.

    Returns
    -------
    list of str
        Lines.
    """
    return [
        f"{RESULT_BEGINS.decode()} {costs.total!r}",
        *(f"cost_{name}= {value!r}" for name, value in costs.parts.items()),
    ]

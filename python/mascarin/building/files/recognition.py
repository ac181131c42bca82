"""What a text is that was given in place of a description: a table, a weather file, a model of EnergyPlus."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final, NamedTuple

GENOPT: Final = "a file of GenOpt"
#: Characters of a file that are looked at.
_HEAD = 20_000
_IDF = re.compile(r"^\s*(version|timestep|building|zone)\s*,", re.IGNORECASE | re.MULTILINE)
_GENOPT = re.compile(r"^\s*(Vary|OptimizationSettings|Simulation)\s*\{", re.MULTILINE)


class Recognized(NamedTuple):
    """What a file is, and what it is good for.

    Attributes
    ----------
    what : str
        Such as 'a weather file (EPW)'.
    remedy : str
        A command that takes it.
    """

    what: str
    remedy: str


def recognized(text: str, file: str) -> Recognized | None:
    r"""What a text is, if it is no description of Mascarin.

    Parameters
    ----------
    text : str
        Content of the file.
    file : str
        Its name, for the command.

    Examples
    --------
    >>> recognized("time,T_in\n2024-01-01 00:00,20.1\n", "log.csv").what
    'a table, as loggers write them'
    >>> recognized("name: wall\nsite: {}\n", "building.yaml") is None
    True
    """
    head = text[:_HEAD]
    if head.startswith("LOCATION,"):
        return Recognized(
            "a weather file (EPW)", f"'mascarin weather {file}' shows it; runs take it with --weather."
        )
    if (_IDF.search(head) and ";" in head) or re.match(r'\s*\{\s*"[A-Z]\w*(:\w+)*"\s*:\s*\{', head):
        return Recognized(
            "a model of EnergyPlus", f"'mascarin convert {file} -o building.yaml' makes a building of it."
        )
    if _GENOPT.search(head):
        return Recognized(GENOPT, "'mascarin optimize' takes the ini file of a project.")
    lines = [line for line in head.splitlines() if line.strip()]
    lines = lines[:-1] if len(text) > _HEAD else lines  # the last one may be cut
    for separator in (",", ";", "\t"):
        counts = [line.count(separator) for line in lines[-3:]]
        if (
            counts
            and min(counts) == max(counts) > 0
            and re.search(r"\d", lines[-1])
            and ": " not in lines[-1]
        ):
            return Recognized(
                "a table, as loggers write them",
                f"'mascarin new wall' and 'new cell' make a study of it with --data {file}; runs take it "
                "with --weather and --column, or --measurements.",
            )
    return None


def described(path: Path) -> Recognized | None:
    """What a file is: a building, a study, a design study, or what `recognized` tells; None if not known.

    Parameters
    ----------
    path : Path
        The file.
    """
    try:
        text = path.read_text("utf-8", errors="replace") if path.is_file() else ""
    except OSError:
        return None
    if path.suffix.lower() not in (".yaml", ".yml"):
        return recognized(text, str(path))
    keys = dict.fromkeys(re.findall(r"^(\w+)\s*:", text, re.MULTILINE))
    return of_keys(keys, str(path)) or recognized(text, str(path))


def of_keys(keys: Mapping[str, Any], file: str) -> Recognized | None:
    """What a description is, by its keys.

    Parameters
    ----------
    keys : mapping
        Its keys.
    file : str
        Its name, for the command.

    Examples
    --------
    >>> of_keys({"building": 0, "sensors": 0}, "study.yaml")
    Recognized(what='a study', remedy="'mascarin validate study.yaml' takes it.")
    """
    if "surfaces" in keys:
        return Recognized("a building", f"'mascarin check {file}' takes it.")
    if "objectives" in keys or "variables" in keys:
        return Recognized("a design study", f"'mascarin design {file} -o FOLDER' takes it.")
    if "building" in keys:
        return Recognized("a study", f"'mascarin validate {file}' takes it.")
    return None

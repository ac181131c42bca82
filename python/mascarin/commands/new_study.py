"""The command that copies an example study into a new folder."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from mascarin._io.atomic import write
from mascarin._io.locks import writing_into
from mascarin.errors import InputError, did_you_mean


def init(folder: Path, /, *, example: Annotated[str, Parameter(name=("--example", "-e"))] = "lgi") -> None:
    """Copy an example study into a new folder.

    Copies building, study and measurements, and prints the next commands.

    Parameters
    ----------
    folder : Path
        The new folder.
    example : str
        lgi: a test cell with a phase-change material in the roof; wall-bench: a single wall.
    """
    from mascarin.examples import STUDIES

    if example not in STUDIES:
        raise InputError(
            f"--example: found '{example}', expected one of {', '.join(STUDIES)}. "
            f"{did_you_mean(example, STUDIES)}".rstrip()
        )
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder}: is a file; expected a new folder: choose another name")
    if folder.is_dir() and any(folder.iterdir()):
        raise InputError(f"{folder}: is not empty; expected a new folder, as nothing is overwritten")
    with writing_into(folder):
        for source in sorted(STUDIES[example].parent.iterdir()):
            if source.is_file():
                print(write(folder / source.name, source.read_bytes()))
    study = folder / "study.yaml"
    print(
        f"next: mascarin check '{folder / 'building.yaml'}'\n"
        f"      mascarin validate '{study}'\n"
        f"      mascarin study '{study}' -o '{folder / 'out'}'",
        file=sys.stderr,
    )

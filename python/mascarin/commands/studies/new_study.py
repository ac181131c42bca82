"""The command that copies an example study into a new folder."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Annotated, Final

from cyclopts import Parameter

from mascarin._io.atomic import write
from mascarin._io.locks import writing_into
from mascarin.commands.studies.schema import HEADER, schema_file
from mascarin.errors import InputError, did_you_mean

_STUDY: Final = "study.yaml"
#: Files with a JSON Schema beside them, each with its kind.
_KINDS: Final = {"building.yaml": "building", _STUDY: "study"}
#: Keys of a study file that describe its data.
_TEXTS: Final = {
    "name": "name: New study\n",
    "about": "about: Describe your data here.\n",
    "observed": "observed: observation\n",
    "observed_note": "",
    # Published numbers belong to the data of the example.
    "reference": "",
}
#: What a publication gives for a parameter.
_PUBLISHED: Final = re.compile(r"(?:, )?reference: \[[^\]]*\]")


def init(folder: Path, /, *, example: Annotated[str, Parameter(name=("--example", "-e"))] = "lgi") -> None:
    """Copy an example study into a new folder.

    Copies building, study and measurements, and prints the next commands. Texts of the study that describe
    the data of the example are replaced: they would be wrong for other data. Files that end with .schema.json
    let an editor complete and check building and study.

    Parameters
    ----------
    folder : Path
        The new folder.
    example : str
        lgi: a test cell with a phase-change material in the roof; wall-bench: a single wall.
    """
    from mascarin.examples import STUDIES

    # A study that extends the one beside it is no start of its own.
    folders = [name for name, file in STUDIES.items() if file.name == _STUDY]
    if example not in folders:
        raise InputError(
            f"--example: found '{example}', expected one of {', '.join(folders)}. "
            f"{did_you_mean(example, folders)}".rstrip()
        )
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder}: is a file; expected a new folder: choose another name")
    if folder.is_dir() and any(folder.iterdir()):
        raise InputError(f"{folder}: is not empty; expected a new folder, as nothing is overwritten")
    with writing_into(folder):
        for source in sorted(STUDIES[example].parent.iterdir()):
            if source.is_file():
                content = source.read_bytes()
                if source.name == _STUDY:
                    content = undescribed(content.decode("utf-8")).encode("utf-8")
                kind = _KINDS.get(source.name)
                if kind is not None:
                    schema = f"{kind}.schema.json"
                    content = HEADER.format(file=schema).encode("utf-8") + content
                    print(write(folder / schema, schema_file(kind)))
                print(write(folder / source.name, content))
    study = folder / _STUDY
    print(
        f"next: describe your data in '{study}' (name, about)\n"
        f"      mascarin check '{folder / 'building.yaml'}'\n"
        f"      mascarin validate '{study}'\n"
        f"      mascarin study '{study}' -o '{folder / 'out'}'",
        file=sys.stderr,
    )


def undescribed(text: str) -> str:
    r"""A study file without the texts that describe the data of an example.

    Parameters
    ----------
    text : str
        The study file.

    Returns
    -------
    str
        The same with a placeholder for the description, and without published numbers.

    Examples
    --------
    >>> undescribed("name: The cell\nabout: |\n  A cell.\n  Measured.\nstep: 1h\n")
    'name: New study\nabout: Describe your data here.\nstep: 1h\n'
    """
    lines_kept, comments = [], ""
    for part in re.split(r"(?m)^(?=[A-Za-z_]+:|#)", text):
        if part.startswith("#"):
            comments += part
            continue
        # A comment above a key describes it.
        key = part.partition(":")[0]
        lines_kept.append(_TEXTS.get(key, comments + part))
        comments = ""
    return _PUBLISHED.sub("", "".join(lines_kept)) + comments

"""The command that copies an example into a new folder: a study, or designs of a house."""

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
_DESIGN: Final = "design.yaml"
#: Files with a JSON Schema beside them, each with its kind.
_KINDS: Final = {"building.yaml": "building", _STUDY: "study", _DESIGN: "design"}
#: Keys of a file that describe the example, with what replaces them.
_TEXTS: Final = {
    _STUDY: {
        "name": "name: New study\n",
        "about": "about: Describe your data here.\n",
        "observed": "observed: observation\n",
        "observed_note": "",
        # Published numbers belong to the data of the example.
        "reference": "",
    },
    _DESIGN: {
        "name": "name: New comparison of designs\n",
        "about": "about: Describe your building and your question here.\n",
    },
}
#: What a publication gives for a parameter.
_PUBLISHED: Final = re.compile(r"(?:, )?reference: \[[^\]]*\]")


def init(folder: Path, /, *, example: Annotated[str, Parameter(name=("--example", "-e"))] = "lgi") -> None:
    """Copy an example into a new folder: a study, or designs of a house.

    Copies building, study or designs, and measurements, and prints the next commands. Texts that describe
    the data of the example are replaced: they would be wrong for other data. Files that end with .schema.json
    let an editor complete and check the files.

    Parameters
    ----------
    folder : Path
        The new folder.
    example : str
        lgi: a test cell with a phase-change material in the roof; wall-bench: a single wall; twin-house: a
        measured house of seven rooms, whose data are fetched separately; reunion-house: a light house, with
        products, thicknesses and roofs to compare (mascarin design).
    """
    from mascarin.examples import DESIGNS, STUDIES

    # A study that extends the one beside it is no start of its own.
    files = {name: file for name, file in {**STUDIES, **DESIGNS}.items() if file.name in _TEXTS}
    if example not in files:
        raise InputError(
            f"--example: found '{example}', expected the name of an example. {did_you_mean(example, files)}"
        )
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder}: is a file; expected a new folder: choose another name")
    if folder.is_dir() and any(folder.iterdir()):
        raise InputError(f"{folder}: is not empty; expected a new folder, as nothing is overwritten")
    with writing_into(folder):
        for source in sorted(files[example].parent.iterdir()):
            if source.is_file():
                content = source.read_bytes()
                if source.name in _TEXTS:
                    content = undescribed(content.decode("utf-8"), source.name).encode("utf-8")
                kind = _KINDS.get(source.name)
                if kind is not None:
                    schema = f"{kind}.schema.json"
                    content = HEADER.format(file=schema).encode("utf-8") + content
                    print(write(folder / schema, schema_file(kind)))
                print(write(folder / source.name, content))
    copied, building = folder / files[example].name, folder / "building.yaml"
    lines = [f"describe your {'data' if copied.name == _STUDY else 'building'} in '{copied}' (name, about)"]
    lines.append(f"mascarin check '{building}'")
    if copied.name == _STUDY:
        lines += [f"mascarin validate '{copied}'", f"mascarin study '{copied}' -o '{folder / 'out'}'"]
    else:
        lines.append(
            f"mascarin run '{building}' --weather shipped:saint-denis --report '{folder / 'run.html'}'"
        )
        lines += [f"mascarin design '{copied}' --check", f"mascarin design '{copied}' -o '{folder / 'out'}'"]
    print("next: " + "\n      ".join(lines), file=sys.stderr)


def undescribed(text: str, file: str = _STUDY) -> str:
    r"""A file without the texts that describe the data of an example.

    Parameters
    ----------
    text : str
        A study file, or a file of designs.
    file : str
        Its name: study.yaml or design.yaml.

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
        lines_kept.append(_TEXTS[file].get(key, comments + part))
        comments = ""
    return _PUBLISHED.sub("", "".join(lines_kept)) + comments

"""The command that prints the JSON Schema of a kind of file."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any, Final, Literal

from cyclopts import Parameter

from mascarin._io.atomic import write
from mascarin._io.locks import writing
from mascarin.commands.options.output import json_text
from mascarin.errors import InputError

#: First line of a YAML file that names its schema, as editors with the YAML language server read it.
HEADER: Final = "# yaml-language-server: $schema={file}\n"


def schema(
    kind: Literal["building", "study", "design"] = "building",
    /,
    *,
    out: Annotated[Path | None, Parameter(alias="-o")] = None,
) -> None:
    """Print the JSON Schema of a building, a study or a design.

    With it an editor completes and checks the file, and shows what each key means. Write it into a file, and
    name that file in the first line of the YAML file: '# yaml-language-server: $schema=building.schema.json'.
    'mascarin init' does both. Keys of a building are also a page of the documentation, with examples.

    Parameters
    ----------
    kind : str
        Kind of file: building, study or design.
    out : Path
        File for the schema (.json), in place of standard output.
    """
    if out is None:
        print(json_text(json_schema(kind)))
        return
    if out.suffix.lower() != ".json":
        raise InputError(f"--out: found '{out}'; expected a file that ends with .json")
    with writing(out):
        write(out, schema_file(kind))
    print(f"wrote {out}", file=sys.stderr)


def schema_file(kind: str) -> bytes:
    """Content of the file of a schema."""
    return f"{json_text(json_schema(kind))}\n".encode()


def json_schema(kind: str) -> dict[str, Any]:
    """JSON Schema of a kind of file: building, study or design."""
    if kind == "study":
        from mascarin.study.file.schema import study_schema

        return study_schema()
    if kind == "design":
        from mascarin.design.schema import design_schema

        return design_schema()
    from mascarin.building import json_schema as building_schema

    return building_schema()

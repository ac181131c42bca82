"""The command that converts a model of EnergyPlus."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from mascarin._io import atomic
from mascarin._io.locks import writing
from mascarin.commands.options.inputs import AsJson
from mascarin.commands.options.output import print_json
from mascarin.errors import InputError


def convert(
    model: Path,
    /,
    *,
    out: Annotated[Path | None, Parameter(alias="-o")] = None,
    weather: Path | None = None,
    force: bool = False,
    as_json: AsJson = False,
) -> int:
    """Convert a model of EnergyPlus to a building.

    Reads IDF and epJSON files of EnergyPlus 8.9 and later; EnergyPlus itself is not needed. Lists object by
    object what is not carried over, and what this does to the results; the same list is in the comments of
    the file. Ends with exit code 1 where something that changes the results was left out.

    Parameters
    ----------
    model : Path
        Model of EnergyPlus: .idf or .epJSON.
    out : Path
        File for the building. Default: the name of the model with .yaml, in the current folder.
    weather : Path
        Weather file (EPW) that gives the site: for a model without Site:Location, or of another place.
    force : bool
        Write over a building file that was changed since it was converted.
    """
    from mascarin.energyplus import convert as converted
    from mascarin.energyplus import report, run_options, terminal_lines, was_edited, yaml_text

    target = Path(f"{model.stem}.yaml") if out is None else out
    if target.suffix.lower() not in (".yaml", ".yml"):
        raise InputError(f"--out: found '{target}'; expected a file that ends with .yaml")
    with writing(target):
        if not force and was_edited(target):
            raise InputError(
                f"{target}: found a building that was changed since it was converted, or never was; "
                "expected a new file. Give another name with --out, or write over it with --force"
            )
        conversion = converted(model, weather=weather)
        atomic.write(target, yaml_text(conversion))
    if as_json:
        print_json(report(conversion) | {"building": str(target)})
    else:
        print("\n".join(terminal_lines(conversion)))
    print(f"wrote {target}; mascarin run {target} --weather EPW {run_options(conversion)}", file=sys.stderr)
    return 0 if conversion.complete else 1

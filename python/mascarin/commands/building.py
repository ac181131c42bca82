"""Commands that read a building without simulating it."""

from __future__ import annotations

import sys
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from mascarin.commands.options.inputs import AsJson, Flag, Settings, Step, read_building, seconds
from mascarin.commands.options.output import print_json, print_table
from mascarin.commands.options.places import lines_named
from mascarin.errors import InputError, did_you_mean

if TYPE_CHECKING:
    from mascarin.building import Building


def check(
    building: Path, /, *, step: Step = "15min", settings: Settings = None, as_json: AsJson = False
) -> None:
    """Check a building description and print a summary.

    Prints zones, surfaces with their U value, constructions with their mesh, warnings, and all values that
    are assumed.

    Parameters
    ----------
    building : Path
        Description of a building.
    """
    from mascarin.building import check as findings
    from mascarin.building.checks.conductances import conductances

    described = read_building(building, settings)
    with lines_named(building):
        lines = findings(described, seconds(step))
    if not as_json:
        print("\n".join(lines))
        return
    sorted_lines: dict[str, list[str]] = {"summary": [], "warning": [], "assumed": []}
    for line in lines:
        kind, colon, text = line.partition(": ")
        if colon and kind in ("warning", "assumed"):
            sorted_lines[kind].append(text)
        else:
            sorted_lines["summary"].append(line)
    table = [entry.to_dict() for entry in conductances(described)]
    print_json({**sorted_lines, "conductances": table})


def parameters(
    building: Path,
    /,
    *patterns: str,
    varying: Annotated[bool, Flag] = False,
    reach: Annotated[bool, Flag] = False,
    weather: Path | None = None,
    settings: Settings = None,
    as_json: AsJson = False,
) -> None:
    """List every parameter of a building.

    Each with its path, value, unit and plausible range. A note gives the reason when a parameter has no
    effect or cannot vary. With --reach each parameter is changed a little in a simulation of three days, and
    only the parameters are listed on which no output and no heat flow depends.

    Parameters
    ----------
    building : Path
        Description of a building.
    patterns : str
        Only paths that fit these patterns, such as "surfaces.roof.*".
    varying : bool
        Only parameters that have a range and affect a result.
    reach : bool
        Only parameters on which nothing depends; needs --weather.
    weather : Path
        Weather file for --reach: EPW, or TMY3 as CSV.
    """
    from mascarin.building import parameter_table

    described = read_building(building, settings)
    table = parameter_table(described)
    if reach:
        idle = _unreached(described, weather)
        table = [row | {"reason": idle[row["path"]]} for row in table if row["path"] in idle]
        print(f"{len(described.parameters())} parameters, {len(table)} without effect", file=sys.stderr)
    shown = [row for row in table if _matches(row["path"], patterns)]
    if not shown and not reach:
        paths = [row["path"] for row in table]
        hint = did_you_mean(patterns[0], paths) if patterns else ""
        raise InputError(
            f"found no parameter that fits {' '.join(patterns)}; expected a path. {hint}".rstrip()
        )
    if varying:
        shown = [row for row in shown if described.parameter(row["path"]).varies]
    if as_json:
        print_json(shown)
        return
    rows = [
        (row["path"], row["value"], row["unit"], row["low"], row["high"], row["reason"] or "")
        for row in shown
    ]
    print_table(("path", "value", "unit", "low", "high", "note"), rows)


def outputs(building: Path, /, *patterns: str, settings: Settings = None, as_json: AsJson = False) -> None:
    """List every output of a building.

    Each with its name, unit, other names, and whether a run records it without --output; with --json also
    what it means. The names are those of 'mascarin run --output' and of the sensors of a study. All kinds of
    outputs are listed under "Outputs" in the reference of the documentation.

    Parameters
    ----------
    building : Path
        Description of a building.
    patterns : str
        Only outputs that fit these patterns, such as "roof.*" or "*_temperature".
    """
    from mascarin.simulation.preparation.prepare import chosen_outputs

    described = read_building(building, settings)
    usual = {output.name for output in chosen_outputs(described, None)}
    table: list[dict[str, Any]] = [
        {
            "name": output.name,
            "unit": output.unit,
            "aliases": list(output.aliases),
            "mean": output.mean,
            "default": output.name in usual,
            "meaning": output.meaning,
        }
        for output in described.outputs()
    ]
    shown = [row for row in table if any(_matches(name, patterns) for name in (row["name"], *row["aliases"]))]
    if not shown:
        names = [row["name"] for row in table]
        raise InputError(
            f"found no output that fits {' '.join(patterns)}; expected a name or a pattern such as 'roof.*'. "
            f"{did_you_mean(patterns[0], names) if patterns else ''}".rstrip()
        )
    if as_json:
        print_json(shown)
        return
    rows = [
        (row["name"], row["unit"], ", ".join(row["aliases"]), "default" if row["default"] else "")
        for row in shown
    ]
    print_table(("output", "unit", "other names", "recorded"), rows)


def _unreached(building: Building, weather: Path | None) -> dict[str, str]:
    """Parameters on which nothing depends, each with the reason."""
    if weather is None:
        raise InputError("--reach: found no --weather; expected a weather file to run the building in")
    from mascarin.commands.options.inputs import read_weather
    from mascarin.simulation.unused_parameters import inactive_parameters

    return inactive_parameters(building, read_weather(weather))


def _matches(path: str, patterns: tuple[str, ...]) -> bool:
    return not patterns or any(fnmatchcase(path, pattern) for pattern in patterns)


def cite(building: Path, /, *, as_json: AsJson = False) -> None:
    """List the sources of numbers and methods.

    Sources of the numbers in the building file, and references of the correlations and methods it uses.

    Parameters
    ----------
    building : Path
        Description of a building.
    """
    sources = read_building(building, None).sources()
    if as_json:
        print_json(sources)
    else:
        print("\n".join(sources))

"""A conversion as text: the YAML file with what is not carried over, and the lines for the terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

from mascarin.building.files.yaml_text import text_of
from mascarin.energyplus.conversion import Conversion
from mascarin.energyplus.model.findings import LEVELS

_HEADINGS: Final = {
    "left out": "Left out; the results change:",
    "approximated": "Carried over in another form:",
    "no effect": "Not needed:",
}


def terminal_lines(conversion: Conversion) -> Iterator[str]:
    """What is not carried over as it is, by level and line.

    Parameters
    ----------
    conversion : Conversion
        From `convert`.
    """
    for level in LEVELS:
        findings = sorted(
            (finding for finding in conversion.findings if finding.level == level),
            key=lambda finding: finding.line or 0,
        )
        if findings:
            yield _HEADINGS[level]
            yield from (f"  {finding.text()}" for finding in findings)


def run_options(conversion: Conversion) -> str:
    """Options of ``mascarin run`` for the same period, days of the week and step."""
    step = f"--step {60 // conversion.steps_per_hour}min"
    return f"--start {conversion.start} --end {conversion.end} {step}"


def yaml_text(conversion: Conversion) -> str:
    """YAML file of the building, with comments on its origin and on what is not carried over.

    Parameters
    ----------
    conversion : Conversion
        From `convert`.
    """
    head = [
        f"Converted from {conversion.file.name} (EnergyPlus {conversion.version}) by mascarin convert.",
        f"The same period and days of the week: mascarin run FILE --weather EPW {run_options(conversion)}",
        *terminal_lines(conversion),
    ]
    comments = "".join(f"# {line}\n" for part in head for line in part.splitlines())
    return f"{comments}\n{text_of(conversion.description)}"


def report(conversion: Conversion) -> dict[str, Any]:
    """A conversion as JSON.

    Parameters
    ----------
    conversion : Conversion
        From `convert`.

    Returns
    -------
    dict
        File, version, period, findings by level, names of the building by names in the file.
    """
    return {
        "file": str(conversion.file),
        "version": conversion.version,
        "complete": conversion.complete,
        "run": {
            "start": conversion.start,
            "end": conversion.end,
            "steps_per_hour": conversion.steps_per_hour,
        },
        "findings": [
            {
                "level": finding.level, "class": finding.kind, "name": finding.name, "line": finding.line,
                "found": finding.what, "effect": finding.effect,
            }
            for finding in conversion.findings
        ],
        "names": conversion.names,
    }  # fmt: skip

"""A conversion as text: the YAML file with what is not carried over, and the lines for the terminal."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

from mascarin.building.files.yaml_text import text_of
from mascarin.energyplus.conversion import Conversion
from mascarin.energyplus.model.findings import LEVELS, Finding, Level

#: What stands before the mark of a written file.
_MARK: Final = "unchanged while its mark is "
#: Objects of a group that are named.
_NAMED: Final = 3
_HEADINGS: Final = {
    "left out": "Left out; the results change:",
    "approximated": "Carried over in another form:",
    "no effect": "Not needed:",
}


def terminal_lines(conversion: Conversion) -> Iterator[str]:
    """What is not carried over as it is: by level, one line for the objects of a class with one effect.

    The largest measured effects come first, then those of which there are most objects.

    Parameters
    ----------
    conversion : Conversion
        From `convert`.
    """
    for level in LEVELS:
        lines = level_lines(conversion, level)
        if lines:
            yield _HEADINGS[level]
            yield from (f"  {line}" for line in lines)


def level_lines(conversion: Conversion, level: Level) -> list[str]:
    """Lines on the findings of one level, the largest measured effects first.

    Parameters
    ----------
    conversion : Conversion
        From `convert`.
    level : str
        One of `LEVELS`.
    """
    groups: dict[tuple[str, str], list[Finding]] = {}
    for finding in conversion.findings:
        if finding.level == level:
            groups.setdefault((finding.kind, finding.consequence), []).append(finding)
    return [_line(findings) for findings in sorted(groups.values(), key=_rank)]


def _rank(findings: list[Finding]) -> tuple[float, int, int]:
    sizes = [finding.measured.rank for finding in findings if finding.measured is not None]
    return -max(sizes, default=0.0), -len(findings), findings[0].line or 0


def _line(findings: list[Finding]) -> str:
    """One line for objects of a class with one effect, with the places of the first ones."""
    first = findings[0]
    if len(findings) == 1:
        return first.text()
    whats = list(dict.fromkeys(finding.what for finding in findings))
    what = whats[0] if len(whats) == 1 else f"{whats[0]} and the like"
    named = [finding for finding in findings if finding.name]
    labels = [
        f"'{finding.name}'" + ("" if finding.line is None else f" in line {finding.line}")
        for finding in named[:_NAMED]
    ]
    more = f" and {len(findings) - len(labels)} more" if labels and len(findings) > len(labels) else ""
    where = f" ({', '.join(labels)}{more})" if labels else ""
    return f"{first.kind}, {len(findings)} times{where}: {what}: {first.consequence}"


def run_options(conversion: Conversion) -> str:
    """Options of ``mascarin run`` for the same period, days of the week and step."""
    step = f"--step {60 // conversion.steps_per_hour}min"
    return f"--start {conversion.start} --end {conversion.end} {step}"


def yaml_text(conversion: Conversion) -> str:
    """YAML file of the building, with comments on its origin and on what is not carried over.

    The first line ends with a mark of all that follows, by which a file that was edited is known.

    Parameters
    ----------
    conversion : Conversion
        From `convert`.
    """
    head = [
        f"The same period and days of the week: mascarin run FILE --weather EPW {run_options(conversion)}",
        *terminal_lines(conversion),
    ]
    comments = "".join(f"# {line}\n" for part in head for line in part.splitlines())
    body = f"{comments}\n{text_of(conversion.description)}"
    origin = f"Converted from {conversion.file.name} (EnergyPlus {conversion.version}) by mascarin convert"
    return f"# {origin}, {_MARK}{_mark(body)}.\n{body}"


def was_edited(file: Path) -> bool:
    """Whether a file is there that is not as a conversion has written it."""
    if not file.is_file():
        return False
    first, _, body = file.read_text(encoding="utf-8", errors="replace").partition("\n")
    return not first.endswith(f"{_MARK}{_mark(body)}.")


def _mark(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:16]


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
                "found": finding.what, "effect": finding.effect, "kelvin": finding.kelvin,
                "loads_percent": None if finding.measured is None else finding.measured.percent,
            }
            for finding in conversion.findings
        ],
        "names": conversion.names,
    }  # fmt: skip

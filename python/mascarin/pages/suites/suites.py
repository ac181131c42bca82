"""The page of the test suites: how far to trust Mascarin, as one HTML file."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from mascarin import __version__
from mascarin._io import atomic
from mascarin.figures import text
from mascarin.pages.frame.template import environment, frame
from mascarin.verification.suites.peers import in_words, standing
from mascarin.verification.suites.running import SuiteResult
from mascarin.verification.suites.verdict import WITHOUT_NUMBER, SuiteVerdict, VerdictLine

#: Significant digits of the numbers.
_DIGITS: Final = 4
#: Verdict -> class of its mark.
_CLASSES: Final = {SuiteVerdict.INSIDE: "pass", SuiteVerdict.MISS: "fail"}


def write(path: Path, results: Sequence[SuiteResult], facts: Mapping[str, str]) -> Path:
    """Write the page to a file.

    Parameters
    ----------
    path : Path
        Where to.
    results : sequence of SuiteResult
        All suites.
    facts : mapping of str to str
        How to reproduce the results, as name and value.

    Returns
    -------
    Path
        The file.
    """
    return atomic.write(path, render(results, facts))


def render(results: Sequence[SuiteResult], facts: Mapping[str, str]) -> str:
    """Make the page; the parameters are those of `write`."""
    lines = [line for result in results for line in result.lines]
    ranks = [line.rank for line in lines if line.rank is not None]
    return (
        environment()
        .get_template("pages/suites/suites.html")
        .render(
            frame(styles=["pages/suites/bestest.css"]),
            title="How far to trust Mascarin",
            version=__version__,
            sections=[
                *({"id": r.suite.name, "title": r.suite.title, "content": _content(r)} for r in results),
                {"id": "repeat", "title": "How to reproduce the results", "content": dict(facts)},
            ],
            summary=[
                {
                    "name": result.suite.name,
                    "title": result.suite.title,
                    "summary": result.summary,
                    "peers": in_words(standing(result.lines)),
                }
                for result in results
            ],
            inside=sum(line.verdict == SuiteVerdict.INSIDE for line in lines),
            count=sum(line.limits is not None for line in lines),
            misses=sum(line.verdict == SuiteVerdict.MISS for line in lines),
            first=sum(rank[0] == 1 for rank in ranks),
            ranked=len(ranks),
        )
    )


def _content(result: SuiteResult) -> dict[str, Any]:
    suite = result.suite
    facts = {
        "Source": suite.source, "Licence": suite.licence, "A number is inside if it is": suite.rule,
        "Result": result.summary,
    }  # fmt: skip
    causes = {
        f"{line.case}, {line.quantity}" if line.quantity else line.case: line.cause
        for line in result.lines
        if line.cause
    }
    programs = list(dict.fromkeys(name for line in result.lines for name in line.peers))
    return {
        "about": suite.about,
        "facts": facts,
        "settings": suite.settings,
        "causes": causes,
        "programs": programs,
        "rows": [_row(line, programs) for line in result.lines if line.verdict not in WITHOUT_NUMBER],
    }


def _row(line: VerdictLine, programs: Sequence[str]) -> dict[str, Any]:
    low, high = line.limits if line.limits is not None else (math.nan, math.nan)
    rank = "" if line.rank is None else f"{line.rank[0]} of {line.rank[1]}"
    return {
        "case": line.case,
        "quantity": line.quantity,
        "unit": line.unit,
        "numbers": [_number(value) for value in (line.value, line.reference, low, high)],
        "rank": rank,
        "peers": [_number(line.peers.get(program, math.nan)) for program in programs],
        "verdict": line.verdict.value,
        "class": _CLASSES.get(line.verdict, ""),
    }


def _number(value: float) -> str:
    return text.significant(value, _DIGITS) if math.isfinite(value) else ""

"""Runs of suites, and what they add up to."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mascarin.progress import ProgressOption, reporting
from mascarin.verification.suites.case_data import FOLDER, CaseData, folder_of
from mascarin.verification.suites.suite import Suite
from mascarin.verification.suites.verdict import SuiteVerdict, VerdictLine


@dataclass(frozen=True)
class SuiteResult:
    """A suite with its numbers.

    Parameters
    ----------
    suite : Suite
        The suite.
    lines : tuple of VerdictLine
        Its numbers; none where its reference is missing.
    missing : str
        Why it was not run; empty where it was.
    """

    suite: Suite
    lines: tuple[VerdictLine, ...] = ()
    missing: str = ""

    @property
    def counts(self) -> dict[SuiteVerdict, int]:
        """Number of lines by verdict."""
        return dict(Counter(line.verdict for line in self.lines))

    @property
    def failed(self) -> bool:
        """Whether a number is a new miss, or a worse one than was written down."""
        return SuiteVerdict.MISS in self.counts

    @property
    def summary(self) -> str:
        """Say how many numbers are inside, and what the others are."""
        if self.missing:
            return self.missing
        counts = self.counts
        judged = sum(number for verdict, number in counts.items() if verdict in _JUDGED)
        uncommon = [
            f"{number} {verdict.value}"
            for verdict, number in counts.items()
            if verdict != SuiteVerdict.INSIDE
        ]
        return ", ".join([f"{counts.get(SuiteVerdict.INSIDE, 0)} of {judged} inside", *uncommon])

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        suite = self.suite
        return {
            "suite": suite.name,
            "title": suite.title,
            "source": suite.source,
            "licence": suite.licence,
            "rule": suite.rule,
            "settings": list(suite.settings),
            "missing": self.missing,
            "lines": [line.to_dict() for line in self.lines],
        }


#: Verdicts of numbers that a suite asks for.
_JUDGED = (SuiteVerdict.INSIDE, SuiteVerdict.MISS, SuiteVerdict.KNOWN_MISS, SuiteVerdict.AMBIGUOUS)


def run(suites: Sequence[Suite], progress: ProgressOption = False) -> list[SuiteResult]:
    """Run suites, one after the other.

    Parameters
    ----------
    suites : sequence of Suite
        The suites.
    progress : bool or callable, optional
        Shows progress; a function is called with the number of suites done and their total.

    Returns
    -------
    list of SuiteResult
        In the same order; one whose reference numbers are not there says so.
    """
    results = []
    with reporting(progress, "suites") as report:
        for number, suite in enumerate(suites):
            report(number, len(suites))
            # Where the numbers are typed, no folder is needed.
            folder = folder_of(suite.data) if suite.data else Path()
            if folder is None:
                missing = (
                    f"not run: no folder suites/{suite.data} in {FOLDER}. Set the environment variable "
                    f"{FOLDER} to the folder with the reference numbers (sources: mascarin suites --list)"
                )
                results.append(SuiteResult(suite, missing=missing))
            else:
                results.append(SuiteResult(suite, tuple(suite.lines(CaseData(folder)))))
        report(len(suites), len(suites))
    return results

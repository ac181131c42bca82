"""The analytical tests in the order of the project: steady, over time, enclosures, sun."""

from __future__ import annotations

from collections.abc import Iterator

from mascarin.verification.suites.case_data import CaseData
from mascarin.verification.suites.catalogue.rp1052 import enclosure, steady, sun, transient
from mascarin.verification.suites.verdict import VerdictLine


def lines(data: CaseData) -> Iterator[VerdictLine]:
    """Every number."""
    for part in (steady, transient, enclosure, sun):
        yield from part.lines(data)

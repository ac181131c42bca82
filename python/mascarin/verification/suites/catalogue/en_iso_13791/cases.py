"""Components, then the whole method."""

from __future__ import annotations

from collections.abc import Iterator

from mascarin.verification.suites.case_data import CaseData
from mascarin.verification.suites.catalogue.en_iso_13791 import components, whole
from mascarin.verification.suites.verdict import VerdictLine


def lines(data: CaseData) -> Iterator[VerdictLine]:
    """Every number."""
    yield from components.lines(data)
    yield from whole.lines(data)

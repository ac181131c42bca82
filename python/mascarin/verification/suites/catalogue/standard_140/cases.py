"""The cases of `mascarin.verification.bestest`."""

from __future__ import annotations

from collections.abc import Iterator

from mascarin.verification.suites.case_data import CaseData
from mascarin.verification.suites.verdict import VerdictLine


def lines(data: CaseData) -> Iterator[VerdictLine]:
    """Every number of every case."""
    from mascarin.verification.bestest.catalogue import CASES
    from mascarin.verification.bestest.quantities import quantities
    from mascarin.verification.bestest.running import run
    from mascarin.verification.bestest.weather import read

    years, _ = run(list(CASES.values()), read(data.file("725650TYCST.epw")))
    for case in CASES.values():
        for row in quantities(years, case):
            if row.range is not None:
                limits = row.range.low, row.range.high
                yield VerdictLine(
                    row.case,
                    row.quantity,
                    row.unit,
                    row.value,
                    row.range.mean,
                    limits,
                    dict(row.range.programs),
                )

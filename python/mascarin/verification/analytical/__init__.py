"""Cases with an analytical solution, each simulated like the building of a user: from YAML to results."""

from __future__ import annotations

from mascarin.verification.analytical.catalogue import cases, run
from mascarin.verification.analytical.check import Case, Check

__all__ = ["Case", "Check", "cases", "run"]


def __dir__() -> list[str]:
    return __all__

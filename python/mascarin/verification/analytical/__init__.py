"""Cases whose answer is known without Mascarin, each run through the whole chain from YAML to results."""

from __future__ import annotations

from mascarin.verification.analytical.catalogue import cases, run
from mascarin.verification.analytical.check import Case, Check

__all__ = ["Case", "Check", "cases", "run"]

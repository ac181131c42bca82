"""Cases whose answer is known without Mascarin, each run through the whole chain from YAML to results."""

from __future__ import annotations

from mascarin.validation.cases.analytic import cases, run
from mascarin.validation.cases.check import Case, Check

__all__ = ["Case", "Check", "cases", "run"]

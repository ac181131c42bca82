"""Cases and checks: simulated numbers, their expected values and bounds."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Literal

Topic = Literal["building", "pcm"]


@dataclass(frozen=True)
class Check:
    """One simulated number, its expected value and its bounds.

    Attributes
    ----------
    name : str
        The case.
    quantity : str
        Which number of the case.
    unit : str
        Unit of all its numbers.
    value : float
        Simulated value. [unit]
    expected : float or None
        The analytical solution; None: the number is shown for information. [unit]
    low, high : float or None
        Bounds; None on a side without a bound. [unit]

    Examples
    --------
    >>> Check.near("box", "temperature", "degC", 20.01, 20.0, within=0.1).passed
    True
    """

    name: str
    quantity: str
    unit: str
    value: float
    expected: float | None = None
    low: float | None = None
    high: float | None = None

    @classmethod
    def near(
        cls, name: str, quantity: str, unit: str, value: float, expected: float, *, within: float
    ) -> Check:
        """Make a check of a number that may differ from the expected one by `within`. [unit]"""
        return cls(name, quantity, unit, float(value), expected, expected - within, expected + within)

    @classmethod
    def most(cls, name: str, quantity: str, unit: str, value: float, *, high: float) -> Check:
        """Make a check of an error that should be 0 and may be at most `high`. [unit]"""
        return cls(name, quantity, unit, float(value), 0.0, 0.0, high)

    @property
    def informs(self) -> bool:
        """Whether the number is shown for information, without bounds."""
        return self.low is None and self.high is None

    @property
    def passed(self) -> bool:
        """Whether the number is within its bounds; NaN and infinity are not."""
        low = -math.inf if self.low is None else self.low
        high = math.inf if self.high is None else self.high
        return bool(math.isfinite(self.value) and low <= self.value <= high)

    def to_dict(self) -> dict[str, Any]:
        """Return the row of ``mascarin verify --json``."""
        return {
            "name": self.name,
            "quantity": self.quantity,
            "unit": self.unit,
            "value": float(self.value),
            "min": _plain(self.low),
            "max": _plain(self.high),
            "expected": _plain(self.expected),
            "passed": self.passed,
        }


def _plain(value: float | None) -> float | None:
    """Convert a number of numpy to a plain float for JSON."""
    return None if value is None else float(value)


@dataclass(frozen=True)
class Case:
    """A problem with an analytical solution.

    Attributes
    ----------
    name : str
        Its name.
    problem : str
        Description of the problem.
    answer : str
        The analytical solution, as a formula.
    source : str
        Where the solution is published.
    tolerance : str
        Reason for the bounds.
    topics : tuple of str
        Where it is shown: ``building``, ``pcm`` (``mascarin verify --pcm``), or both.
    work : callable
        Simulates the problem and gives the checks.
    """

    name: str
    problem: str
    answer: str
    source: str
    tolerance: str
    topics: tuple[Topic, ...]
    work: Callable[[str], Iterable[Check]]

    def run(self) -> list[Check]:
        """Simulate the problem and compare it with the solution."""
        return list(self.work(self.name))

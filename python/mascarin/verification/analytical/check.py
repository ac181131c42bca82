"""What a case leaves behind: numbers held against what they must be."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Literal

Topic = Literal["building", "pcm"]


@dataclass(frozen=True)
class Check:
    """One number and the bounds it must keep.

    Attributes
    ----------
    name : str
        The case.
    quantity : str
        What of it.
    unit : str
        Unit of all its numbers.
    value : float
        What Mascarin gives. [unit]
    expected : float or None
        The closed answer; none: the number is shown for information. [unit]
    low, high : float or None
        Bounds; none on a side that is not bounded. [unit]
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
        """A number that may differ from the expected one by `within`. [unit]"""
        return cls(name, quantity, unit, float(value), expected, expected - within, expected + within)

    @classmethod
    def most(cls, name: str, quantity: str, unit: str, value: float, *, high: float) -> Check:
        """The size of an error, which should be 0 and may be `high`. [unit]"""
        return cls(name, quantity, unit, float(value), 0.0, 0.0, high)

    @property
    def informs(self) -> bool:
        """Whether the number is shown for information and nothing is demanded of it."""
        return self.low is None and self.high is None

    @property
    def passed(self) -> bool:
        """Whether the number keeps its bounds; what is no number keeps none."""
        low = -math.inf if self.low is None else self.low
        high = math.inf if self.high is None else self.high
        return bool(math.isfinite(self.value) and low <= self.value <= high)

    def to_dict(self) -> dict[str, Any]:
        """The row as it stands in ``mascarin verify --json``."""
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
    """A number as JSON knows it: what numpy computed is no plain float."""
    return None if value is None else float(value)


@dataclass(frozen=True)
class Case:
    """A problem whose answer is known without Mascarin.

    Attributes
    ----------
    name : str
        Its name.
    problem : str
        What is simulated.
    answer : str
        The closed answer, as a formula.
    source : str
        Where the answer is published.
    tolerance : str
        Why the bounds are where they are.
    topics : tuple of str
        Where it is shown: ``building``, ``pcm`` (``mascarin verify --pcm``), or both.
    work : callable
        Gives the rows.
    """

    name: str
    problem: str
    answer: str
    source: str
    tolerance: str
    topics: tuple[Topic, ...]
    work: Callable[[str], Iterable[Check]]

    def run(self) -> list[Check]:
        """Simulate and compare."""
        return list(self.work(self.name))

"""What a case of a suite gave: numbers beside their reference, and what is said of them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin._io.limits import at_least, at_most

if TYPE_CHECKING:
    import numpy.typing as npt


class SuiteVerdict(StrEnum):
    """What is said of a number."""

    INSIDE = "inside"
    """Within the tolerance of the suite."""
    MISS = "miss"
    """Beyond it, and nobody knows why."""
    KNOWN_MISS = "known miss"
    """Beyond it by no more than was written down, with its cause."""
    AMBIGUOUS = "ambiguous specification"
    """The specification leaves open what decides it."""
    NOT_EXPRESSIBLE = "not expressible"
    """The case cannot be described."""
    NOT_RUN = "not run"
    """What the case needs is not among the data."""
    INFORMATION = "information"
    """No tolerance is stated."""


#: Verdicts of lines without a number.
WITHOUT_NUMBER: Final = (SuiteVerdict.NOT_EXPRESSIBLE, SuiteVerdict.NOT_RUN)
#: A known miss may grow by this part of half the width of its limits before it counts as a worse one. [-]
_GROWTH: Final = 0.1


@dataclass(frozen=True)
class VerdictLine:
    """A number of a case.

    Parameters
    ----------
    case, quantity : str
        What it is.
    unit : str
        Of the value, the reference and the limits.
    value, reference : float
        Ours, and that of the suite.
    limits : tuple of float or None
        Lowest and highest value that is inside; None where the suite states none.
    peers : mapping of str to float
        Numbers of other programs.
    note : str
        What else is worth to know.

    Examples
    --------
    >>> line = VerdictLine("1", "load", "W", 101.0, 100.0, around(100.0, 2.0), {"A": 99.5, "B": 103.0})
    >>> line.inside, line.rank
    (True, (2, 3))
    """

    case: str
    quantity: str
    unit: str
    value: float
    reference: float
    limits: tuple[float, float] | None = None
    peers: Mapping[str, float] = field(default_factory=dict)
    note: str = ""
    verdict: SuiteVerdict = SuiteVerdict.INFORMATION
    cause: str = ""

    @property
    def deviation(self) -> float:
        """Value minus reference. [unit]"""
        return self.value - self.reference

    @property
    def inside(self) -> bool | None:
        """Whether the value is within its limits, which NaN is not; None without limits."""
        if self.limits is None:
            return None
        low, high = self.limits
        return bool(at_least(self.value, low) and at_most(self.value, high))

    @property
    def rank(self) -> tuple[int, int] | None:
        """Place among all programs by the distance from the reference, and their number; None without."""
        distances = [abs(peer - self.reference) for peer in self.peers.values() if math.isfinite(peer)]
        if not distances:
            return None
        return 1 + sum(distance < abs(self.deviation) for distance in distances), 1 + len(distances)

    def judged(
        self, misses: Mapping[tuple[str, str], KnownMiss], open_cases: Mapping[str, str]
    ) -> VerdictLine:
        """Say what is known of it.

        Parameters
        ----------
        misses : mapping of (str, str) to KnownMiss
            By case and quantity.
        open_cases : mapping of str to str
            What the specification leaves open, by case.

        Examples
        --------
        >>> line = VerdictLine("1", "load", "W", 104.0, 100.0, around(100.0, 2.0))
        >>> line.judged({}, {}).verdict.value
        'miss'
        >>> line.judged({("1", "load"): KnownMiss(4.0, "films are fixed")}, {}).verdict.value
        'known miss'
        """
        if self.inside is None:
            return self
        if self.inside:
            return replace(self, verdict=SuiteVerdict.INSIDE)
        miss = misses.get((self.case, self.quantity))
        if miss is not None and miss.covers(self):
            return replace(self, verdict=SuiteVerdict.KNOWN_MISS, cause=miss.cause)
        if self.case in open_cases:
            return replace(self, verdict=SuiteVerdict.AMBIGUOUS, cause=open_cases[self.case])
        return replace(self, verdict=SuiteVerdict.MISS)

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON; a number that is none is null."""
        rank = self.rank
        return {
            "case": self.case,
            "quantity": self.quantity,
            "unit": self.unit,
            "value": _finite(self.value),
            "reference": _finite(self.reference),
            "limits": None if self.limits is None else list(self.limits),
            "peers": {name: _finite(value) for name, value in self.peers.items()},
            "rank": None if rank is None else {"place": rank[0], "of": rank[1]},
            "verdict": self.verdict.value,
            "cause": self.cause,
            "note": self.note,
        }


@dataclass(frozen=True)
class KnownMiss:
    """A miss that was written down.

    Parameters
    ----------
    deviation : float
        Value minus reference as it was. [unit of the line]
    cause : str
        Why.
    """

    deviation: float
    cause: str

    def covers(self, line: VerdictLine) -> bool:
        """Whether a line deviates to the same side, and not by more than it did."""
        low, high = line.limits or (0.0, 0.0)
        growth = _GROWTH * 0.5 * (high - low)
        same_side = line.deviation * self.deviation > 0.0
        return same_side and abs(line.deviation) <= abs(self.deviation) + growth


def around(reference: float, tolerance: float) -> tuple[float, float]:
    """Limits on both sides of a reference.

    Examples
    --------
    >>> around(100.0, 2.0)
    (98.0, 102.0)
    """
    return reference - tolerance, reference + tolerance


def largest(
    case: str,
    quantity: str,
    unit: str,
    series: tuple[npt.ArrayLike, npt.ArrayLike, npt.ArrayLike],
    tolerance: float,
) -> VerdictLine:
    """A line of the place at which a series deviates most from its reference.

    Parameters
    ----------
    case, quantity, unit : str
        As of a line.
    series : tuple of array_like, each of shape (n,)
        Times [h], values and references.
    tolerance : float
        Largest deviation. [unit]

    Examples
    --------
    >>> line = largest("1", "load", "W", ([1, 2], [5.0, 8.0], [5.0, 7.0]), 2.0)
    >>> line.value, line.reference, line.note
    (8.0, 7.0, 'at 2 h, root mean square 0.707 W')
    """
    times, values, references = (np.asarray(numbers, dtype=np.float64) for numbers in series)
    errors = values - references
    worst = int(np.abs(errors).argmax())
    reference = float(references[worst])
    spread = float(np.sqrt((errors**2).mean()))
    return VerdictLine(
        case,
        quantity,
        unit,
        float(values[worst]),
        reference,
        around(reference, tolerance),
        note=f"at {times[worst]:.4g} h, root mean square {spread:.3g} {unit}",
    )


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None

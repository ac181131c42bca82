"""Random numbers and choices from one seed, for the generators of buildings and weather."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from typing import Any

from mascarin.building.base.law_table import LawRow


class Draw:
    """A stream of random choices; the same seed gives the same choices on every machine.

    Parameters
    ----------
    seed : str
        The seed: a text, so that parts of a case have streams of their own.
    """

    def __init__(self, seed: str) -> None:
        self._random = random.Random(seed)

    def chance(self, probability: float) -> bool:
        """Whether something is drawn that has this probability."""
        return self._random.random() < probability

    def of(self, *choices: Any) -> Any:
        """One of several values, all with the same probability."""
        return choices[self._random.randrange(len(choices))]

    def one(self, choices: Sequence[Any]) -> Any:
        """One of the values of a list."""
        return self.of(*choices)

    def whole(self, low: int, high: int) -> int:
        """A whole number from `low` to `high`, both included."""
        return self._random.randint(low, high)

    def number(self, low: float, high: float) -> float:
        """A number of four digits between two others."""
        return four(self._random.uniform(low, high))

    def log(self, low: float, high: float) -> float:
        """A number of four digits between two others whose logarithm is uniform."""
        return four(math.exp(self._random.uniform(math.log(low), math.log(high))))

    def some(self, choices: Sequence[Any], least: int = 0) -> list[Any]:
        """Some of the values of a list, in its order."""
        count = self.whole(min(least, len(choices)), len(choices))
        positions = set(self._random.sample(range(len(choices)), count))
        return [value for at, value in enumerate(choices) if at in positions]

    def noted(self, value: float, half: float) -> Any:
        """A number as a plain one, or with a range around it, a source, and whether it is assumed.

        Parameters
        ----------
        value : float
            The number.
        half : float
            Largest distance of the ends of the range; the number without it must be possible. [its unit]
        """
        if self.chance(0.8):
            return value
        notes: dict[str, Any] = {"value": value}
        if half > 0.0 and self.chance(0.8):
            notes["range"] = [value - half * self.number(0.1, 1.0), value + half * self.number(0.1, 1.0)]
        if self.chance(0.3):
            notes["source"] = self.of("a table", "EN ISO 10456:2007", "a data sheet: page 3")
        if self.chance(0.3):
            notes["assumed"] = True
        return notes


def four(value: float) -> float:
    """A number rounded to four significant digits, so that a printed case is short and exact."""
    return float(f"{value:.4g}")


def numbers_of(draw: Draw, row: LawRow, *, outdoors: bool = True) -> dict[str, Any]:
    """Some numbers of a published law, within their ranges."""
    return {
        number.name: draw.number(*number.quantity.default_range(number.example))
        for number in row.numbers
        if (outdoors or not number.outdoors) and (number.required or draw.chance(0.5))
    }

"""Measured effects of what is not carried over: a room in EnergyPlus with the object, and without it."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import cache
from importlib.resources import files


@dataclass(frozen=True)
class Effect:
    """Effect of a kind of object in EnergyPlus 25.2, by ``bench/energyplus_effects.py``.

    Attributes
    ----------
    kelvin, kelvin_other : float
        Rms of the hourly air temperature of a small room without loads, over a year with the object and
        without it, and of another room. [K]
    percent, percent_other : float
        Change of heating and cooling of the same rooms with ideal loads. [%]
    """

    kelvin: float
    kelvin_other: float
    percent: float
    percent_other: float

    @property
    def rank(self) -> float:
        """Size by which effects are ordered: some per cent of the loads count as a kelvin. [K]"""
        return max(self.kelvin, self.kelvin_other, 0.2 * self.percent, 0.2 * self.percent_other)

    def text(self) -> str:
        """The effect in words.

        Examples
        --------
        >>> Effect(0.6, 0.7, 2.0, 2.5).text()
        'about 0.6 K in a small room, 2 % of its loads'
        >>> Effect(0.6, 1.4, 0.0, 0.0).text()
        'about 0.6 K in a small room (1.4 K in another)'
        >>> Effect(0.0, 0.0, 0.0, 0.0).text()
        'nothing in two small rooms'
        """
        parts = []
        if max(self.kelvin, self.kelvin_other) > 0.0:
            parts.append(
                f"about {self.kelvin:g} K in a small room{_other(self.kelvin, self.kelvin_other, 'K')}"
            )
        if max(self.percent, self.percent_other) > 0.0:
            parts.append(f"{self.percent:g} % of its loads{_other(self.percent, self.percent_other, '%')}")
        return ", ".join(parts) or "nothing in two small rooms"


def _other(first: float, second: float, unit: str) -> str:
    """The second of two numbers, where it is not the same within a factor of two."""
    alike = 0.5 * first <= second <= 2.0 * first
    return "" if alike else f" ({second:g} {unit} in another)"


def effect_of(kind: str, what: str) -> Effect | None:
    """Measured effect of a finding; None where it was not measured.

    Parameters
    ----------
    kind : str
        Class of the object.
    what : str
        What was found.

    Examples
    --------
    >>> effect_of("Version", "not carried over") is None
    True
    """
    low = kind.casefold()
    for start, pattern, effect in _table():
        if low.startswith(start) and fnmatchcase(what.casefold(), pattern):
            return effect
    return None


@cache
def _table() -> tuple[tuple[str, str, Effect], ...]:
    """Effects with the beginnings of their classes and what is said of them, the longest first."""
    text = files("mascarin.energyplus.model").joinpath("effects.csv").read_text(encoding="utf-8")
    rows = [
        (
            row["class"].casefold(),
            row["found"].casefold(),
            Effect(
                float(row["kelvin"]), float(row["kelvin_other"]),
                float(row["loads_percent"]), float(row["loads_percent_other"]),
            ),
        )
        for row in csv.DictReader(text.splitlines())
    ]  # fmt: skip
    return tuple(sorted(rows, key=lambda row: (-len(row[0]), -len(row[1]))))

"""Thermal comfort: indices of the standards, their limits, and hours and degree-hours outside of them.

The temperatures of a room are those of its air and its mean radiant temperature. The second is the mean of
the surface temperatures of the zone, weighted by area, or by what is seen of them from a given seat. No
index is extrapolated: outside its validity a value is NaN, and the time is counted.
"""

from __future__ import annotations

from mascarin.comfort.assessment import Comfort, assess
from mascarin.comfort.conditions import Conditions, operative_temperature
from mascarin.comfort.evaluation import Discomfort, Evaluation, discomfort
from mascarin.comfort.indices import INDICES, Index, index_named
from mascarin.comfort.seat import SeatView, seen_from
from mascarin.comfort.settings import ComfortSettings
from mascarin.comfort.surroundings import Surroundings

__all__ = [
    "INDICES",
    "Comfort",
    "ComfortSettings",
    "Conditions",
    "Discomfort",
    "Evaluation",
    "Index",
    "SeatView",
    "Surroundings",
    "assess",
    "discomfort",
    "index_named",
    "operative_temperature",
    "seen_from",
]


def __dir__() -> list[str]:
    return sorted(__all__)

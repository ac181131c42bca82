"""Air and sun of the two days of the whole method."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Day:
    """A day that repeats.

    Parameters
    ----------
    latitude : float
        [deg]
    air : sequence of float
        At the ends of hours 1 to 24. [degC]
    level : tuple of sequence of float
        Direct and diffuse sun on a level plane, at hours 4 to 20. [W/m2]
    west : tuple of sequence of float
        On the facade: direct, diffuse, and where it is not in the diffuse one, reflected. [W/m2]
    """

    latitude: float
    air: Sequence[float]
    level: tuple[Sequence[float], ...]
    west: tuple[Sequence[float], ...]

    @property
    def on_facade(self) -> Array:
        """Sun on the facade, at hours 1 to 24. [W/m2]"""
        return _by_hour(self.west)

    @property
    def on_roof(self) -> Array:
        """Sun on a level plane, at hours 1 to 24. [W/m2]"""
        return _by_hour(self.level)


def _by_hour(parts: tuple[Sequence[float], ...]) -> Array:
    total = np.sum(parts, axis=0)
    day: Array = np.interp(np.arange(1, 25), np.arange(4, 21), total, left=0.0, right=0.0)
    return day


# Table 9 (A) has the light from the ground in the diffuse sun, as the report of EnergyPlus says; table 10
# has not.
DAYS: Final = {
    "A": Day(
        40.0,
        (
            23.6, 23.0, 22.5, 22.1, 22.0, 22.2, 22.8, 23.9, 25.8, 27.3, 29.3, 31.2,
            32.7, 33.6, 34.0, 33.6, 32.8, 31.5, 29.9, 28.4, 27.0, 25.8, 24.9, 24.2,
        ),
        (
            (0, 1, 106, 278, 452, 606, 725, 801, 827, 801, 725, 606, 452, 278, 106, 1, 0),
            (0, 3, 62, 91, 105, 112, 117, 119, 120, 119, 117, 112, 105, 91, 62, 3, 0),
        ),
        (
            (0, 0, 0, 0, 0, 0, 0, 0, 0, 209, 396, 539, 616, 595, 418, 17, 0),
            (0, 2, 45, 78, 103, 122, 137, 145, 160, 172, 180, 181, 172, 146, 93, 3, 0),
        ),
    ),
    "B": Day(
        52.0,
        (
            14.1, 13.3, 12.6, 12.2, 12.0, 12.3, 13.1, 14.6, 16.6, 19.0, 21.8, 24.3,
            26.2, 27.5, 28.0, 27.5, 26.4, 24.6, 22.6, 20.5, 18.7, 17.1, 15.8, 14.9,
        ),
        (
            (0, 35, 153, 295, 435, 558, 654, 714, 735, 714, 654, 558, 435, 295, 153, 35, 0),
            (0, 34, 73, 93, 104, 110, 114, 116, 117, 116, 114, 110, 104, 93, 73, 34, 0),
        ),
        (
            (0, 0, 0, 0, 0, 0, 0, 0, 0, 204, 387, 529, 609, 606, 492, 223, 0),
            (0, 15, 33, 42, 47, 50, 51, 52, 64, 78, 94, 107, 115, 111, 89, 41, 0),
            (0, 7, 23, 39, 54, 67, 77, 83, 85, 83, 77, 67, 54, 39, 23, 7, 0),
        ),
    ),
}  # fmt: skip

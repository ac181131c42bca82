"""Places on the earth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol


class SiteLike(Protocol):
    """Any object with a latitude and a longitude, such as the site of a building."""

    @property
    def latitude(self) -> float:
        """Positive north. [deg]"""
        ...

    @property
    def longitude(self) -> float:
        """Positive east. [deg]"""
        ...


@dataclass(frozen=True)
class Place:
    """A place on the earth.

    Parameters
    ----------
    latitude, longitude : float
        Positive north and east. [deg]
    altitude : float
        Height above sea level. [m]
    name : str
        Name of the station.

    Examples
    --------
    >>> Place(45.76, 4.84, 170.0, "Lyon").latitude
    45.76
    """

    latitude: float
    longitude: float
    altitude: float = 0.0
    name: str = ""

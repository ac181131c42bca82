"""The sun of a record: at the position that its columns state, else at that of the place and the time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Protocol

import numpy as np

from mascarin.tables.arrays import Array
from mascarin.weather.derived.sun import SunPath, direction, lagrange
from mascarin.weather.records.channels import SUN_POSITION
from mascarin.weather.records.record import WeatherRecord
from mascarin.weather.records.window import window

#: Positions that a cubic goes through.
_NODES: Final = 4


class Sun(Protocol):
    """The sun in one span of time."""

    def vector(self, time: Array) -> Array:
        """Unit vector to the sun (east, north, up), shape (..., 3). [-]"""
        ...

    def normal_irradiance(self, time: Array) -> Array:
        """Extraterrestrial normal irradiance, shape (...,). [W/m2]"""
        ...


@dataclass(frozen=True)
class StatedSun:
    """The sun at positions that a table states.

    Between them the direction follows a cubic through the four that are nearest: from positions of every
    hour, it is within 0.01 deg of the sun. Before the first and after the last one it does not move.

    Attributes
    ----------
    times : ndarray, shape (n,)
        Of the positions, seconds since the origin. [s]
    vectors : ndarray, shape (n, 3)
        Unit vectors (east, north, up). [-]
    path : SunPath
        The sun of place and time, which gives the extraterrestrial irradiance.
    """

    times: Array
    vectors: Array
    path: SunPath

    def vector(self, time: Array) -> Array:
        """Unit vector to the sun at some times [s], shape (..., 3). [-]"""
        rows = np.interp(np.asarray(time, dtype=np.float64), self.times, np.arange(len(self.times)))
        short = len(self.vectors) < _NODES
        between = _straight(self.vectors, rows) if short else lagrange(self.vectors, rows)
        length = np.sqrt(np.sum(between * between, axis=-1, keepdims=True))
        # Opposite positions one after the other have no middle.
        nearest = self.vectors[np.round(rows).astype(np.int64)]
        return np.asarray(np.where(length > 0.1, between / np.maximum(length, 0.1), nearest))

    def normal_irradiance(self, time: Array) -> Array:
        """Extraterrestrial normal irradiance at some times [s], shape (...,). [W/m2]"""
        return self.path.normal_irradiance(time)


def _straight(vectors: Array, rows: Array) -> Array:
    number = np.arange(len(vectors))
    return np.stack([np.interp(rows, number, part) for part in vectors.T], axis=-1)


def states_position(record: WeatherRecord) -> bool:
    """Whether the position of the sun is stated by columns of a record."""
    return all(name in record.columns for name in SUN_POSITION)


def sun_over(
    record: WeatherRecord, latitude: float, longitude: float, span: tuple[float, float], origin: float = 0.0
) -> Sun:
    """The sun of a record over a span of time.

    Parameters
    ----------
    record : WeatherRecord
        Whose columns `SUN_POSITION` are used where it has them.
    latitude, longitude : float
        Positive north and east. [deg]
    span : (float, float)
        Seconds since 1970-01-01 UTC. [s]
    origin : float
        Time from which the times of the sun count, seconds since 1970-01-01 UTC. [s]

    Raises
    ------
    InputError
        A position in the span is missing.
    """
    path = SunPath.over(latitude, longitude, *span, origin)
    if not states_position(record):
        return path
    edges = (max(span[0], record.grid.start), min(span[1], record.grid.end))
    starts, angles = [], []
    for name in SUN_POSITION:
        start, values, kind = window(record, name, *edges)
        starts.append(start + (0.5 * record.grid.interval if kind == "mean" else 0.0))
        angles.append(values)
    elevation, azimuth = angles
    count = min(len(elevation), len(azimuth))
    vectors = direction(np.radians(90.0 - elevation[:count]), np.radians(azimuth[:count]))
    times = starts[0] - origin + record.grid.interval * np.arange(count)
    return StatedSun(times, vectors, path)


def angle_from_path(record: WeatherRecord, latitude: float, longitude: float) -> float:
    """Largest angle between the stated positions above the horizon and the sun of place and time. [deg]"""
    grid = record.grid
    sun = sun_over(record, latitude, longitude, (grid.start, grid.end))
    if not isinstance(sun, StatedSun):
        return 0.0
    sunlit = sun.vectors[:, 2] > 0.0
    if not sunlit.any():
        return 0.0
    cosine = np.sum(sun.vectors[sunlit] * sun.path.vector(sun.times[sunlit]), axis=-1)
    return float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)).max()))

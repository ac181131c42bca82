"""Direction of the sun and extraterrestrial irradiance at any time, from pvlib.

The solar position algorithm of pvlib is evaluated once an hour. Between, the direction is turned with the
earth, and the rest, which changes by one degree a day, is interpolated by a cubic. The result is within
1e-6 rad of pvlib at any time, and a million times take less than a second.

References
----------
Reda & Andreas 2004, Solar Energy 76(5), 577-589, doi:10.1016/j.solener.2003.12.003 (sun position).
Kopp & Lean 2011, Geophysical Research Letters 38, L01706, doi:10.1029/2010GL045777 (solar constant).
"""

from __future__ import annotations

import importlib
import importlib.machinery
import importlib.util
import sys
from dataclasses import dataclass
from functools import cache, lru_cache
from types import ModuleType
from typing import Final

import numpy as np

from mascarin.physics import STANDARD_PRESSURE
from mascarin.tables.arrays import Array

SOLAR_CONSTANT: Final = 1361.0
"""Total solar irradiance at the mean distance of the earth (Kopp & Lean 2011, 1360.8) [W/m2]."""

_NODE_STEP: Final = 3600.0
#: Terrestrial time less universal time [s], pvlib's default; one second more moves the sun by 2e-7 rad.
_DELTA_T: Final = 67.0
_TURN: Final = 2.0 * np.pi / 86400.0


@dataclass(frozen=True)
class SunPath:
    """The sun over one place in one span of time.

    Attributes
    ----------
    latitude : float
        Positive north [deg].
    first : float
        Time of the first node, seconds since the origin [s].
    slow : ndarray, shape (nodes, 3)
        Direction to the sun in axes (meridian, east, pole) that turn with the mean sun [-].
    extra : ndarray, shape (nodes,)
        Extraterrestrial normal irradiance [W/m2].
    before : int
        Nodes from the first one on that are not there: a part of a span has the bits of the whole.
    """

    latitude: float
    first: float
    slow: Array
    extra: Array
    before: int = 0

    @classmethod
    def over(
        cls,
        latitude: float,
        longitude: float,
        start: float,
        end: float,
        origin: float = 0.0,
        part: tuple[float, float] | None = None,
    ) -> SunPath:
        """Prepare the sun for a span of time.

        Parameters
        ----------
        latitude, longitude : float
            Positive north and east [deg].
        start, end : float
            Span, seconds since 1970-01-01 UTC [s].
        origin : float
            Time from which the times of the other methods count, seconds since 1970-01-01 UTC [s].
        part : (float, float), optional
            The part of the span that is asked for, seconds since 1970-01-01 UTC [s].
        """
        first = (np.floor(start / _NODE_STEP) - 2.0) * _NODE_STEP
        count = int(np.ceil((end - first) / _NODE_STEP)) + 4
        before = 0
        if part is not None:
            before = max(int(np.floor((part[0] - first) / _NODE_STEP)) - 2, 0)
            count = min(int(np.ceil((part[1] - first) / _NODE_STEP)) + 4, count) - before
        nodes = _nodes(latitude, longitude, float(first), count, before)
        return cls(latitude, first - origin, *nodes, before)

    def vector(self, time: Array) -> Array:
        """Unit vector to the centre of the sun, without refraction.

        Parameters
        ----------
        time : ndarray, shape (...,)
            Seconds since the origin, inside the span [s].

        Returns
        -------
        ndarray, shape (..., 3)
            East, north and up components; up <= 0 below the horizon [-].
        """
        position = (np.asarray(time, dtype=np.float64) - self.first) / _NODE_STEP
        slow = lagrange(self.slow, position, self.before)
        slow /= np.sqrt(np.sum(slow * slow, axis=-1, keepdims=True))
        return _from_pole(_turn(slow, -_TURN * _NODE_STEP * position), np.radians(self.latitude))

    def normal_irradiance(self, time: Array) -> Array:
        """Extraterrestrial normal irradiance.

        Parameters
        ----------
        time : ndarray, shape (...,)
            Seconds since the origin, inside the span [s].

        Returns
        -------
        ndarray, shape (...,)
            Irradiance on a plane facing the sun, outside the atmosphere [W/m2].
        """
        position = (np.asarray(time, dtype=np.float64) - self.first) / _NODE_STEP
        return lagrange(self.extra[:, None], position, self.before)[..., 0]


@lru_cache(maxsize=16)
def _nodes(
    latitude: float, longitude: float, first: float, count: int, before: int = 0
) -> tuple[Array, Array]:
    """`SunPath.slow` and `SunPath.extra`. Checks, runs and reports of one building ask for the same hours."""
    spa = _algorithm()
    seconds = first + _NODE_STEP * np.arange(before, before + count)
    # At sea level; pressure and temperature only change the refraction, which is not used.
    _, zenith, _, _, azimuth, _ = spa.solar_position(
        seconds, latitude, longitude, 0.0, STANDARD_PRESSURE / 100.0, 12.0, _DELTA_T, 0.5667, 1
    )
    distance = spa.earthsun_distance(seconds, _DELTA_T, 1)
    vector = direction(np.radians(zenith), np.radians(azimuth))
    slow = _turn(_to_pole(vector, np.radians(latitude)), _TURN * (seconds - first))
    extra = SOLAR_CONSTANT / distance**2
    for shared in (slow, extra):
        shared.flags.writeable = False
    return slow, extra


@cache
def _algorithm() -> ModuleType:
    """The file of pvlib with the algorithm, without the rest of pvlib if that is not imported yet.

    All of pvlib takes half a second to import; this file needs numpy alone.
    """
    name = "pvlib.spa"
    if name in sys.modules:
        return sys.modules[name]
    package = importlib.util.find_spec("pvlib")
    folders = package.submodule_search_locations if package else None
    spec = importlib.machinery.PathFinder.find_spec(name, folders)
    if spec is None or spec.loader is None:
        return importlib.import_module(name)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def direction(zenith: Array, azimuth: Array) -> Array:
    """Unit vectors (east, north, up), shape (..., 3), from angles; the azimuth clockwise from north. [rad]"""
    sine = np.sin(zenith)
    return np.stack([sine * np.sin(azimuth), sine * np.cos(azimuth), np.cos(zenith)], axis=-1)


def _to_pole(vector: Array, latitude: float) -> Array:
    """(east, north, up) -> (meridian, east, pole)."""
    east, north, up = vector[..., 0], vector[..., 1], vector[..., 2]
    sine, cosine = np.sin(latitude), np.cos(latitude)
    return np.stack([cosine * up - sine * north, east, sine * up + cosine * north], axis=-1)


def _from_pole(vector: Array, latitude: float) -> Array:
    """(meridian, east, pole) -> (east, north, up)."""
    meridian, east, pole = vector[..., 0], vector[..., 1], vector[..., 2]
    sine, cosine = np.sin(latitude), np.cos(latitude)
    return np.stack([east, cosine * pole - sine * meridian, sine * pole + cosine * meridian], axis=-1)


def _turn(vector: Array, angle: Array) -> Array:
    """Turn about the pole, eastwards for a positive angle [rad]."""
    sine, cosine = np.sin(angle), np.cos(angle)
    meridian, east = vector[..., 0], vector[..., 1]
    return np.stack(
        [cosine * meridian - sine * east, sine * meridian + cosine * east, vector[..., 2]], axis=-1
    )


def lagrange(nodes: Array, position: Array, before: int = 0) -> Array:
    """Four-point Lagrange interpolation of nodes (n, k) at fractional node numbers; n is 4 at least.

    Parameters
    ----------
    nodes : ndarray, shape (n, k)
        Values at whole numbers.
    position : ndarray, shape (...,)
        Where to interpolate. [-]
    before : int
        Number of the first node. [-]

    Returns
    -------
    ndarray, shape (..., k)
    """
    base = np.clip(np.floor(position).astype(np.int64), before + 1, before + len(nodes) - 3)
    x = position - base
    base -= before
    before, current = -x * (x - 1.0) * (x - 2.0) / 6.0, (x + 1.0) * (x - 1.0) * (x - 2.0) / 2.0
    after, beyond = (x + 1.0) * x * (x - 2.0) / 2.0, (x + 1.0) * x * (x - 1.0) / 6.0
    result = np.empty((*x.shape, nodes.shape[1]))
    # Column by column, because numpy is slow over a last axis of three.
    for k, column in enumerate(np.ascontiguousarray(nodes.T)):
        result[..., k] = (
            before * column.take(base - 1)
            + current * column.take(base)
            - after * column.take(base + 1)
            + beyond * column.take(base + 2)
        )
    return result

"""Short-wave radiation inside the intervals of its source, following the sun.

At every node the three horizontal and normal irradiances agree: global = direct sun_up + diffuse.

References
----------
Meinel & Meinel 1976, Applied Solar Energy, Addison-Wesley (clear beam 0.7^(m^0.678)).
Kasten & Young 1989, Applied Optics 28(22), 4735-4738, doi:10.1364/AO.28.004735 (air mass m).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from mascarin.tables.arrays import Array
from mascarin.tables.profile import PiecewiseProfile, index_nodes, node_times, pieces_for, trapezoid_weights
from mascarin.weather.derived.sun_position import Sun
from mascarin.weather.records.channels import Basis

BEAM_CEILING: Final = 2.0
"""A beam above this multiple of the clear-sky beam is not plausible (low sun, noise). [-]"""
BEAM_CLEAR: Final = 1.2
"""Multiple of the clear-sky beam that a reconstruction does not exceed, unless the mean needs more. [-]"""
SHAPE_MATTERS: Final = 0.002
"""The shape of the beam is derived where it changes the mean of the horizontal beam by this part. [-]"""
DIFFUSE_CEILING: Final = 2.0
"""Diffuse as a multiple of the extraterrestrial horizontal irradiance; what is above is spread evenly. [-]"""
DIFFUSE_USUAL: Final = 0.6
"""The same ratio that a reconstruction does not exceed, unless the mean needs more. [-]"""


@dataclass(frozen=True)
class SkyProfiles:
    """The three irradiances inside their intervals. [W/m2]

    Attributes
    ----------
    direct_normal, diffuse_horizontal, global_horizontal : PiecewiseProfile
        The irradiances over time. [W/m2]
    moved : ndarray, shape (n,)
        Beam on the horizontal that was added to the diffuse part, mean of each interval. [W/m2]
    """

    direct_normal: PiecewiseProfile
    diffuse_horizontal: PiecewiseProfile
    global_horizontal: PiecewiseProfile
    moved: Array


def clear_beam(sun_up: Array) -> Array:
    """Transmittance of a clear sky for the beam (Meinel & Meinel 1976).

    Parameters
    ----------
    sun_up : ndarray, shape (...,)
        Sine of the solar elevation [-].

    Returns
    -------
    ndarray, shape (...,)
        Part of the extraterrestrial beam; zero with the sun below the horizon. [-]
    """
    up = np.maximum(sun_up, 0.0)
    elevation = np.degrees(np.arcsin(np.minimum(up, 1.0)))
    mass = 1.0 / (up + 0.50572 * (6.07995 + elevation) ** -1.6364)
    return np.asarray(np.where(sun_up > 0.0, 0.7 ** (mass**0.678), 0.0))


def from_means(
    sun: Sun,
    start: float,
    interval: float,
    direct: Array,
    diffuse: Array,
    total: Array,
    basis: Basis,
    before: int = 0,
) -> SkyProfiles:
    """Reconstruct the sky from interval means.

    Parameters
    ----------
    sun : Sun
        The sun over the span.
    start, interval : float
        Start of the first interval, in the sun's time, and length of one [s].
    direct, diffuse, total : ndarray, shape (n,)
        Means of direct normal, diffuse horizontal and global horizontal irradiance; the one that the basis
        does not name is not read [W/m2].
    basis : str
        The two whose means are kept; the third follows. With `all` the direct and the diffuse mean are kept.
        Inside the interval, the beam then lies between a constant beam and the beam of a clear sky, such
        that the mean of the global irradiance comes nearest to the given one.
    before : int
        Intervals between `start` and that of the first value.

    Returns
    -------
    SkyProfiles
        The irradiances inside the intervals.
    """
    pieces = pieces_for(interval)
    times = node_times(start, interval, len(diffuse), pieces, before)
    up = np.maximum(sun.vector(times)[..., 2], 0.0)
    extra = sun.normal_irradiance(times)
    weights = trapezoid_weights(pieces)
    clear = extra * clear_beam(up)
    moved = np.zeros(len(diffuse))
    if basis != "global+diffuse":
        beam = _normal_beam(direct, clear, up, weights)
        if basis == "all":
            beam = _towards(total - diffuse, beam, _even(direct, up, weights), up, weights)
    else:
        horizontal = np.maximum(total - diffuse, 0.0)
        # The limit also holds where the horizontal part of the beam is negligible: such a beam is diffuse.
        bounded = np.minimum(horizontal, BEAM_CEILING * ((clear * up) @ weights))
        beam = clear * index_nodes(bounded, clear * up, BEAM_CLEAR)
        moved = total - diffuse - bounded
    sky = _diffuse(diffuse + moved, extra * up, weights)
    return _sky(start, interval, (beam, sky, beam * up + sky), moved, before)


def from_instants(
    sun: Sun,
    start: float,
    interval: float,
    direct: Array,
    diffuse: Array,
    total: Array,
    basis: Basis,
    before: int = 0,
) -> SkyProfiles:
    """The sky from values at the stamps, linear between them.

    Parameters are those of `from_means`, with arrays of shape (n + 1,): a value at each end of each interval.
    """
    times = start + interval * np.arange(before, before + len(diffuse))
    up = np.maximum(sun.vector(times)[:, 2], 0.0)
    sky = diffuse
    beam = direct
    moved = np.zeros(len(diffuse))
    if basis == "global+diffuse":
        beam = direct_by_closure(total, diffuse, up, sun.normal_irradiance(times) * clear_beam(up))
        moved = total - diffuse - beam * up
        sky = diffuse + moved
    return _sky(start, interval, (_pairs(beam), _pairs(sky), _pairs(beam * up + sky)), moved, before)


def direct_by_closure(total: Array, diffuse: Array, up: Array, clear: Array) -> Array:
    """Direct normal irradiance from global and diffuse.

    Parameters
    ----------
    total, diffuse : ndarray, shape (n,)
        Global and diffuse horizontal irradiance [W/m2].
    up : ndarray, shape (n,)
        Sine of the solar elevation, or its mean over the interval [-].
    clear : ndarray, shape (n,)
        Clear beam; the result is at most `BEAM_CEILING` times this [W/m2].
    """
    sunlit = up > 0.0
    beam = np.where(sunlit, np.maximum(total - diffuse, 0.0) / np.where(sunlit, up, 1.0), 0.0)
    return np.asarray(np.minimum(beam, BEAM_CEILING * clear))


def _normal_beam(means: Array, clear: Array, up: Array, weights: Array) -> Array:
    """Beam at the nodes: a clear beam times an index; what is not plausible, evenly while the sun is up."""
    if np.any(means < 0.0):
        # Night offsets of a sensor: kept as they are, evenly.
        return _normal_beam(np.maximum(means, 0.0), clear, up, weights) + np.minimum(means, 0.0)[:, None]
    bounded = np.minimum(means, BEAM_CEILING * (clear @ weights))
    return np.asarray(clear * index_nodes(bounded, clear, BEAM_CLEAR) + _even(means - bounded, up, weights))


def _even(means: Array, up: Array, weights: Array) -> Array:
    """Means at the nodes, evenly while the sun is up; evenly all the time where it is not."""
    sunlit = (up > 0.0).astype(np.float64)
    share = sunlit @ weights
    sunlit = np.where(share[:, None] > 0.0, sunlit, 1.0)
    return np.asarray((means / (sunlit @ weights))[:, None] * sunlit)


def _towards(horizontal: Array, clear: Array, even: Array, up: Array, weights: Array) -> Array:
    """The beam, between two of the same means, whose mean on the horizontal is nearest to the given one."""
    high, low = (clear * up) @ weights, (even * up) @ weights
    apart = high - low
    # With a high sun both are nearly the same, and the mean does not say which one is right.
    usable = np.abs(apart) > SHAPE_MATTERS * np.maximum(high, 1e-6)
    share = np.where(usable, (horizontal - low) / np.where(usable, apart, 1.0), 1.0)
    share = np.clip(share, 0.0, 1.0)[:, None]
    return np.asarray(share * clear + (1.0 - share) * even)


def _diffuse(means: Array, horizontal: Array, weights: Array) -> Array:
    """Diffuse at the nodes: extraterrestrial horizontal times an index; twilight and offsets evenly."""
    bounded = np.minimum(np.maximum(means, 0.0), DIFFUSE_CEILING * (horizontal @ weights))
    sky = horizontal * index_nodes(bounded, horizontal, DIFFUSE_USUAL)
    return np.asarray(sky + (means - bounded)[:, None])


def _sky(
    start: float, interval: float, nodes: tuple[Array, Array, Array], moved: Array, before: int
) -> SkyProfiles:
    beam, sky, total = (PiecewiseProfile(start, interval, values, before) for values in nodes)
    return SkyProfiles(beam, sky, total, moved)


def _pairs(values: Array) -> Array:
    return np.stack([values[:-1], values[1:]], axis=1)

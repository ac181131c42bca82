"""Quantities derived from measured ones: diffuse irradiance, cloud cover.

References
----------
Erbs, Klein & Duffie 1982, Solar Energy 28(4), 293-302, doi:10.1016/0038-092X(82)90302-4.
Haurwitz 1945, Journal of Meteorology 2(3), 154-166, doi:10.1175/1520-0469(1945)002<0154:IIRTCA>2.0.CO;2.
Kasten & Czeplak 1980, Solar Energy 24(2), 177-189, doi:10.1016/0038-092X(80)90391-6.
Kimball 1928, Monthly Weather Review 56(10), 393-398 (0.29 + 0.71 (1 - N) of the radiation of a clear sky).
"""

from __future__ import annotations

from typing import Final

import numpy as np

from mascarin.tables.arrays import Array

_CLOUD_LOSS: Final = 0.71
_CLEAR_GAIN: Final = 1098.0
_CLEAR_DECAY: Final = -0.057
_LOWEST_SUN: Final = float(np.sin(np.radians(10.0)))


def diffuse_erbs(total: Array, up: Array, extra: Array) -> Array:
    """Diffuse horizontal irradiance by the correlation of Erbs et al., through pvlib.

    Parameters
    ----------
    total : ndarray, shape (n,)
        Global horizontal irradiance [W/m2].
    up : ndarray, shape (n,)
        Sine of the solar elevation, mean over the interval counting night as zero [-].
    extra : ndarray, shape (n,)
        Extraterrestrial normal irradiance [W/m2].

    Returns
    -------
    ndarray, shape (n,)
        Diffuse irradiance, between zero and the global one; all of it where the sun is below 3 deg [W/m2].
    """
    from pvlib.irradiance import erbs

    sunlit = up > np.sin(np.radians(3.0))
    # pvlib uses the day of the year only for the extraterrestrial irradiance. Scaling the global irradiance
    # to that day gives the clearness index for the irradiance that is used here.
    zenith = np.degrees(np.arccos(np.clip(up, 0.0, 1.0)))
    day = np.full(len(total), 94.0)
    from pvlib.irradiance import get_extra_radiation

    scale = float(get_extra_radiation(94.0)) / extra
    result = erbs(np.maximum(total, 0.0) * scale, zenith, day)
    diffuse = np.asarray(result["dhi"], dtype=np.float64) / scale
    return np.where(sunlit, np.clip(diffuse, 0.0, np.maximum(total, 0.0)), total)


def cloud_cover(total: Array, up: Array, interval: float) -> Array:
    """Cloud cover from global irradiance, by the linear relation of Kimball.

    G / G_clear = 1 - 0.71 N, on running means of an hour; with the sun below 10 deg, and at night, linear
    between the last and the next value. G_clear is Haurwitz's 1098 sin h exp(-0.057 / sin h) W/m2.

    The relation of Kasten and Czeplak, 1 - 0.75 N^3.4, is the mean radiation at a given cloud cover. Its
    inverse has no finite slope at a clear sky: 5 % less than Haurwitz's clear sky, which haze makes, would be
    4.5 tenths of cloud. Here it is 0.7 tenths. A clear sky of another model than his (turbid air, a low sun)
    is still up to 4 tenths in single hours, 2 tenths in the mean of a day.

    Parameters
    ----------
    total : ndarray, shape (n,)
        Global horizontal irradiance, NaN where missing [W/m2].
    up : ndarray, shape (n,)
        Sine of the solar elevation, mean over the interval [-].
    interval : float
        Length of an interval [s].

    Returns
    -------
    ndarray, shape (n,)
        Cloud cover [tenths].
    """
    width = max(1, round(3600.0 / interval))
    high = np.maximum(up, _LOWEST_SUN)
    clear = np.where(up > _LOWEST_SUN, _CLEAR_GAIN * up * np.exp(_CLEAR_DECAY / high), np.nan)
    usable = np.isfinite(clear) & np.isfinite(total)
    if not usable.any():
        return np.zeros(len(total))
    ratio = _running(np.where(usable, total, 0.0), width) / np.maximum(
        _running(np.where(usable, clear, 0.0), width), 1e-9
    )
    tenths = 10.0 * np.clip(1.0 - ratio, 0.0, _CLOUD_LOSS) / _CLOUD_LOSS
    position = np.arange(len(total))
    return np.interp(position, position[usable], tenths[usable])


def _running(values: Array, width: int) -> Array:
    return np.convolve(values, np.ones(width), mode="same") if width > 1 else values

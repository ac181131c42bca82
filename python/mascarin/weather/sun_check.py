"""Check that the radiation follows the sun; if not, the time zone, the stamps or the place are wrong."""

from __future__ import annotations

from typing import Final

import numpy as np

from mascarin.errors import InputError
from mascarin.weather.arrays import Array
from mascarin.weather.channels import RADIATION
from mascarin.weather.record import WeatherRecord
from mascarin.weather.sun import SunPath
from mascarin.weather.timezones import zone_name

_SHORTEST: Final = 2.0 * 86400.0
_DARK: Final = -0.02
"""Sine of the elevation below which daylight is neglected (1.1 deg below the horizon)."""
_NIGHT_MOST: Final = 0.005
"""More radiation than this part at night is refused. [-]"""
_NIGHT_TRACE: Final = 0.0003
"""More than this part at night is refused where the center is off by `_NOON_OFF` as well. [-]"""
_NOON_FAR: Final = 1.5
"""A center that is farther from solar noon than this is refused. [h]"""
_NOON_OFF: Final = 0.75
"""See `_NIGHT_TRACE`. [h]"""


def check_clock(record: WeatherRecord, latitude: float, longitude: float) -> None:
    """Refuse a climate whose radiation does not follow the sun over the given place.

    Two numbers are checked: the part of the radiation that is recorded while the sun is below the
    horizon, and the hour angle around which the radiation is centered. Clouds and hills shift the
    center by up to an hour. A wrong time zone shifts it by whole hours and puts radiation into the night.

    Parameters
    ----------
    record : WeatherRecord
        With at least one irradiance; a record without radiation, or with a constant one, passes.
    latitude, longitude : float
        Positive north and east [deg].

    Raises
    ------
    InputError
        The radiation and the sun do not agree; the shift is named.
    """
    values = _radiation(record)
    grid = record.grid
    if values is None or grid.count * grid.interval < _SHORTEST or np.ptp(values) == 0.0:
        return
    shift = 0.0 if record.kinds[_name(record)] == "instant" else 0.5
    middle = grid.start + grid.interval * (np.arange(grid.count) + shift)
    sun = SunPath.over(latitude, longitude, grid.start - grid.interval, grid.end + grid.interval)
    night = _night_part(values, sun, middle, grid.interval)
    late = _hours_late(values, sun.vector(middle), latitude)
    if night <= _NIGHT_MOST and abs(late) <= _NOON_FAR and (night <= _NIGHT_TRACE or abs(late) <= _NOON_OFF):
        return
    when = "after" if late > 0.0 else "before"
    raise InputError(
        f"{record.file}: the radiation does not follow the sun at latitude {latitude:g}, longitude "
        f"{longitude:g}: it is centered {abs(late):.1f} h {when} solar noon, and {100.0 * night:.2g} % of it "
        "is recorded while the sun is below the horizon; expected less than one hour, and none. Check the "
        f"time zone (now {zone_name(grid.zone)}), whether stamps mark the start or the end of their "
        "interval, and the sign of the longitude (east is positive). If all of these are right, the record "
        "itself is wrong: repair the file (in Python it can be read as it is: check_sun=False)."
    )


def _name(record: WeatherRecord) -> str:
    return next(name for name in reversed(RADIATION) if name in record.data.columns)


def _radiation(record: WeatherRecord) -> Array | None:
    if not any(name in record.data.columns for name in RADIATION):
        return None
    values = record.data[_name(record)].to_numpy(dtype=np.float64)
    values = np.maximum(np.nan_to_num(values), 0.0)
    return values if values.sum() > 0.0 else None


def _night_part(values: Array, sun: SunPath, middle: Array, interval: float) -> float:
    """Part of the radiation in intervals that are dark from start to end. [-]"""
    highest = np.max([sun.vector(middle + part * interval)[:, 2] for part in (-0.5, 0.0, 0.5)], axis=0)
    return float(values[highest < _DARK].sum() / values.sum())


def _hours_late(values: Array, vector: Array, latitude: float) -> float:
    """Hours from solar noon to the center of the radiation. [h]"""
    sine, cosine = np.sin(np.radians(latitude)), np.cos(np.radians(latitude))
    angle = np.arctan2(-vector[:, 0], cosine * vector[:, 2] - sine * vector[:, 1])
    center = np.angle(np.sum(values * np.exp(1j * angle)))
    return float(np.degrees(center) / 15.0)

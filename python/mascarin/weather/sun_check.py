"""Does the radiation follow the sun? If not, the time zone, the stamps or the place are wrong."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.errors import InputError
from mascarin.weather.channels import RADIATION
from mascarin.weather.sun import SunPath
from mascarin.weather.timezones import zone_name

if TYPE_CHECKING:
    from mascarin.weather.arrays import Array
    from mascarin.weather.climate import Climate

_SHORTEST: Final = 2.0 * 86400.0
_DARK: Final = -0.02
"""Sine of the elevation below which there is no daylight worth counting (1.1 deg below the horizon)."""
_NIGHT_SHARE: Final = 0.005
_NIGHT_TRACE: Final = 0.0003
_NOON_FAR: Final = 1.5
_NOON_OFF: Final = 0.75


def check_clock(climate: Climate, latitude: float, longitude: float) -> None:
    """Refuse a climate whose radiation does not follow the sun over the given place.

    Two things are looked at: the share of the radiation that falls while the sun is down, and the
    hour angle around which the radiation is centred. Clouds and hills shift the second by up to an
    hour, a wrong zone by whole ones and then the first shows it too.

    Parameters
    ----------
    climate : Climate
        With at least one irradiance; without any sun, or with a constant one, it passes.
    latitude, longitude : float
        Positive north and east [deg].

    Raises
    ------
    InputError
        The radiation and the sun do not agree; the shift is named.
    """
    values = _radiation(climate)
    grid = climate.grid
    if values is None or grid.count * grid.interval < _SHORTEST or np.ptp(values) == 0.0:
        return
    shift = 0.0 if climate.kinds[_name(climate)] == "instant" else 0.5
    middle = grid.start + grid.interval * (np.arange(grid.count) + shift)
    sun = SunPath.over(latitude, longitude, grid.start - grid.interval, grid.end + grid.interval)
    night = _night_share(values, sun, middle, grid.interval)
    late = _hours_late(values, sun.vector(middle), latitude)
    if night <= _NIGHT_SHARE and abs(late) <= _NOON_FAR and (night <= _NIGHT_TRACE or abs(late) <= _NOON_OFF):
        return
    when = "after" if late > 0.0 else "before"
    raise InputError(
        f"{climate.file}: the radiation does not follow the sun at latitude {latitude:g}, longitude "
        f"{longitude:g}: "
        f"it is centred {abs(late):.1f} h {when} solar noon, and {100.0 * night:.2g} % of it falls "
        "while the sun is "
        f"down. Expected less than an hour, and none. Check the time zone (now {zone_name(grid.zone)}), "
        "whether "
        "stamps mark the start or the end of their interval, and the sign of the longitude (east is "
        "positive). "
        "If all of these are right, the record itself is wrong: repair the file (in Python it can be read "
        "as it is: from_table(..., check_sun=False))."
    )


def _name(climate: Climate) -> str:
    return next(name for name in reversed(RADIATION) if name in climate.data.columns)


def _radiation(climate: Climate) -> Array | None:
    if not any(name in climate.data.columns for name in RADIATION):
        return None
    values = climate.data[_name(climate)].to_numpy(dtype=np.float64)
    values = np.maximum(np.nan_to_num(values), 0.0)
    return values if values.sum() > 0.0 else None


def _night_share(values: Array, sun: SunPath, middle: Array, interval: float) -> float:
    """Share of the radiation in intervals that are dark from end to end."""
    highest = np.max([sun.vector(middle + part * interval)[:, 2] for part in (-0.5, 0.0, 0.5)], axis=0)
    return float(values[highest < _DARK].sum() / values.sum())


def _hours_late(values: Array, vector: Array, latitude: float) -> float:
    """Hour angle of the radiation's centre, as hours after solar noon."""
    sine, cosine = np.sin(np.radians(latitude)), np.cos(np.radians(latitude))
    angle = np.arctan2(-vector[:, 0], cosine * vector[:, 2] - sine * vector[:, 1])
    centre = np.angle(np.sum(values * np.exp(1j * angle)))
    return float(np.degrees(centre) / 15.0)

"""Clear days at any place, for examples and first trials without a weather file."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mascarin.weather import Climate


def clear_days(
    latitude: float,
    longitude: float,
    *,
    timezone: str,
    start: str,
    days: int = 7,
    mean: float = 20.0,
    swing: float = 5.0,
    wind: float = 2.5,
    altitude: float = 100.0,
) -> Climate:
    """Hourly weather of clear days: the sun of a clear sky, an air temperature that follows a sinusoid.

    Parameters
    ----------
    latitude, longitude : float
        Place. [deg]
    timezone : str
        Time zone of the clock, such as ``Europe/Paris`` or ``UTC+4``.
    start : str
        First day.
    days : int
        Number of days.
    mean, swing : float
        Mean of the air temperature [degC], and half of the difference of its extremes. [K]
    wind : float
        Wind speed, from the west. [m/s]
    altitude : float
        Above sea level. [m]

    Returns
    -------
    Climate
        The weather; the relative humidity is 60 %, the sky has no clouds.

    References
    ----------
    Ineichen & Perez 2002, doi:10.1016/S0038-092X(02)00045-2 (clear sky, Linke turbidity 3)

    Examples
    --------
    >>> from mascarin.examples import clear_days
    >>> climate = clear_days(48.0, 2.0, timezone="UTC+1", start="2024-07-01", days=2, mean=22, swing=6)
    >>> float(climate.to_dataframe()["air_temperature"].max())
    28.0
    """
    import numpy as np  # not needed to list the example studies
    import pandas as pd
    from pvlib.location import Location

    from mascarin.weather import Climate, parse_timezone

    zone = parse_timezone(timezone)
    times = pd.date_range(start, periods=24 * days, freq="1h", tz=zone)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # pvlib calls functions that newer versions of pandas deprecate
        frame = Location(latitude, longitude, altitude=altitude).get_clearsky(
            times, model="ineichen", linke_turbidity=3.0
        )
    frame["temp_air"] = mean + swing * np.sin(2.0 * np.pi * (times.hour.to_numpy() - 9.0) / 24.0)
    frame["relative_humidity"] = 60.0
    frame["wind_speed"] = wind
    frame["wind_direction"] = 270.0
    return Climate.from_pvlib(
        frame,
        latitude=latitude,
        longitude=longitude,
        altitude=altitude,
        stamps="instant",
        absent={"cloud_cover": 0.0},
    )

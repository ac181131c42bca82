"""Comfort of the outdoor air itself: how many hours of a climate lie in Givoni's zones."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.comfort.conditions import Conditions
from mascarin.comfort.evaluation import discomfort
from mascarin.comfort.givoni import givoni
from mascarin.physics import STANDARD_PRESSURE, humidity_of_dew_point

if TYPE_CHECKING:
    from mascarin.weather import Climate

SPEEDS: Final = (0.2, 1.0, 2.0)
"""Air speeds of the zones. [m/s]"""


def hours_in_givoni_zones(climate: Climate) -> dict[str, dict[str, float]]:
    """Hours of the outdoor air in the shade in Givoni's zones, by air speed.

    Parameters
    ----------
    climate : Climate
        With dew point.

    Returns
    -------
    dict
        Air speed -> hours that are comfortable, too hot, too cold, too humid, and too dry to be rated [h].

    Examples
    --------
    >>> import mascarin as mc
    >>> found = hours_in_givoni_zones(mc.Climate.shipped("tampa"))
    >>> found["2 m/s"]["comfortable"] > found["0.2 m/s"]["comfortable"]
    True
    """
    data = climate.data
    air = data["air_temperature"].to_numpy(dtype=np.float64)
    humid = humidity_of_dew_point(air, data["dew_point"].to_numpy(dtype=np.float64))
    pressure = data["pressure"].to_numpy(dtype=np.float64) if "pressure" in data else STANDARD_PRESSURE
    weights = np.full(len(air), climate.grid.interval / 3600.0)
    hours = {}
    for speed in SPEEDS:
        conditions = Conditions(air, air, humid, pressure=pressure, air_speed=speed)
        totals = discomfort(givoni(conditions, "hot climate"), weights)
        hours[f"{speed:g} m/s"] = {
            "comfortable": float(totals.assessed_hours - totals.hours - totals.undefined_hours),
            "hot": float(totals.hot_hours),
            "cold": float(totals.cold_hours),
            "humid": float(totals.humid_hours),
            "dry": float(totals.undefined_hours),
        }
    return hours

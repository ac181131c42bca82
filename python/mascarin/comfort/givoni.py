"""Givoni's zones of comfort on the psychrometric chart, for hot climates, with air speed.

In still air people used to a hot climate are comfortable from 18 to 29 degC; in humid air only up to 26 degC.
The air holds from 4 to 17 g/kg of vapour, and its relative humidity is at most 80 %. With an air speed of
2 m/s the upper temperatures are 3 K higher (32 degC).

Between still air (0.2 m/s and below) and 2 m/s the zone grows in proportion to the air speed; above 2 m/s it
grows no more. The upper limit is 29 degC up to 50 % relative humidity and falls from there on in a straight
line to 26 degC and 80 %. Both are readings of the published chart and are assumptions of this program, as is
that the limits of humidity move with the corners of the zone.

References
----------
Givoni 1992, Comfort, climate analysis and building design guidelines, Energy and Buildings 18(1), 11-23,
doi:10.1016/0378-7788(92)90047-K (zones of still air and of ventilation for hot developing countries).
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from mascarin._io.limits import above, below
from mascarin.comfort.conditions import Conditions
from mascarin.comfort.evaluation import Evaluation, Floats
from mascarin.physics import humidity_ratio, relative_humidity

LOWEST: Final = 18.0
"""Lowest temperature of the zones [degC]."""
DRIEST: Final = 0.004
"""Lowest humidity ratio of the zones [kg/kg]."""

_STILL, _MOVING = 0.2, 2.0  # m/s
_RISE: Final = 3.0  # K, at 2 m/s
_DRY_CORNER: Final = (29.0, 50.0)  # degC, %
_HUMID_CORNER: Final = (26.0, 80.0)  # degC, %


def zone(air_speed: float) -> Floats:
    """Corners of the zone of comfort on the psychrometric chart.

    Parameters
    ----------
    air_speed : float
        Air speed. [m/s]

    Returns
    -------
    ndarray, shape (corners, 2)
        Temperature [degC] and humidity ratio [kg/kg] at sea level, clockwise from the lowest temperature and
        humidity; the side of constant relative humidity has several points.

    Examples
    --------
    >>> zone(2.0)[-1].tolist()
    [32.0, 0.004]
    """
    rise = float(_rise(air_speed))
    humid, dry = _HUMID_CORNER[0] + rise, _DRY_CORNER[0] + rise
    along = np.linspace(LOWEST, humid, 20)
    points = [
        (LOWEST, DRIEST),
        *zip(along, humidity_ratio(along, _HUMID_CORNER[1]), strict=True),
        (dry, float(humidity_ratio(dry, _DRY_CORNER[1]))),
        (dry, DRIEST),
    ]
    return np.array(points, dtype=np.float64)


def givoni(conditions: Conditions, _category: str) -> Evaluation:
    """Operative temperature between the sides of the zone at the humidity of the room."""
    rise = _rise(conditions.air_speed)
    values = conditions.operative_temperature
    ratio = humidity_ratio(conditions.air_temperature, conditions.humidity, conditions.pressure)
    dry_t, humid_t = _DRY_CORNER[0] + rise, _HUMID_CORNER[0] + rise
    dry_w = humidity_ratio(dry_t, _DRY_CORNER[1])
    humid_w = humidity_ratio(humid_t, _HUMID_CORNER[1])
    share = np.clip((ratio - dry_w) / (humid_w - dry_w), 0.0, 1.0)
    high = dry_t + share * (humid_t - dry_t)
    # At a given humidity ratio cool air is the more humid one: above 80 % it is outside the zone.
    too_humid = above(relative_humidity(values, ratio, conditions.pressure), _HUMID_CORNER[1]) | above(
        1000.0 * ratio, 1000.0 * humid_w
    )
    dry = below(1000.0 * ratio, 1000.0 * DRIEST)  # g/kg, the unit of the limit
    outside = {f"drier than {1000.0 * DRIEST:g} g/kg": dry}
    valid = np.where(dry, np.nan, values)
    return Evaluation(valid, LOWEST, high, outside, too_humid)


def _rise(air_speed: npt.ArrayLike) -> Floats:
    speed = np.asarray(air_speed, dtype=np.float64)
    return np.asarray(_RISE * np.clip((speed - _STILL) / (_MOVING - _STILL), 0.0, 1.0), dtype=np.float64)

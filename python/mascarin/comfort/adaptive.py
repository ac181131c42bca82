"""Comfort in rooms without mechanical cooling, by the adaptive models of EN 16798-1 and ASHRAE 55.

References
----------
EN 16798-1:2019, clause 6.2.2 and annex B.2.2 (tables B.3 and B.4; formula for the running mean).
ANSI/ASHRAE Standard 55-2020, section 5.4.2 (acceptable operative temperature, table 5-13) and appendix I
(prevailing mean outdoor air temperature).
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from mascarin._io.limits import above, at_least, below
from mascarin.comfort.conditions import Conditions
from mascarin.comfort.evaluation import Evaluation, Flags, Floats

EN_CATEGORIES: Final = {"I": (-3.0, 2.0), "II": (-4.0, 3.0), "III": (-5.0, 4.0)}
"""Distance of the limits from the comfort temperature, EN 16798-1 table B.3. [K]"""
ASHRAE_CATEGORIES: Final = {"90": (-2.5, 2.5), "80": (-3.5, 3.5)}
"""Distance of the limits for 90 % and 80 % acceptability, ASHRAE 55. [K]"""

EN_WEIGHTS: Final = (1.0, 0.8, 0.6, 0.5, 0.4, 0.3, 0.2)
"""Weights of yesterday, the day before, ..., in the running mean of EN 16798-1."""
ASHRAE_WEIGHTS: Final = tuple(0.8**day for day in range(7))
"""Weights in the prevailing mean of ASHRAE 55, alpha = 0.8 (appendix I allows 0.6 to 0.9)."""

#: Air speed from which the upper limit rises [m/s], and by how much [K]; the same in both standards.
_RISES: Final = ((0.6, 1.2), (0.9, 1.8), (1.2, 2.2))
_RISES_ABOVE: Final = 25.0  # degC, operative temperature
_EN_RANGE: Final = (10.0, 30.0)  # degC
_ASHRAE_RANGE: Final = (10.0, 33.5)  # degC
_ASHRAE_MET: Final = (1.0, 1.5)  # met


def adaptive_en(conditions: Conditions, category: str) -> Evaluation:
    """Operative temperature between the limits of EN 16798-1 around ``0.33 t_rm + 18.8``."""
    mean = _valid_mean(conditions.running_mean)
    outside = {
        "no running mean: fewer than seven days of weather before": np.isnan(mean),
        f"running mean below {_EN_RANGE[0]:g} degC": below(mean, _EN_RANGE[0]),
        f"running mean above {_EN_RANGE[1]:g} degC": above(mean, _EN_RANGE[1]),
    }
    return _around(conditions, 0.33 * mean + 18.8, EN_CATEGORIES[category], outside)


def adaptive_ashrae(conditions: Conditions, category: str) -> Evaluation:
    """Operative temperature between the limits of ASHRAE 55 around ``0.31 t_pma + 17.8``."""
    mean = _valid_mean(conditions.prevailing_mean)
    low, high = _ASHRAE_MET
    outside = {
        "no prevailing mean: fewer than seven days of weather before": np.isnan(mean),
        f"prevailing mean below {_ASHRAE_RANGE[0]:g} degC": below(mean, _ASHRAE_RANGE[0]),
        f"prevailing mean above {_ASHRAE_RANGE[1]:g} degC": above(mean, _ASHRAE_RANGE[1]),
        f"metabolic rate outside {low:g} to {high:g} met": np.asarray(
            below(conditions.metabolic_rate, low) or above(conditions.metabolic_rate, high)
        ),
    }
    return _around(conditions, 0.31 * mean + 17.8, ASHRAE_CATEGORIES[category], outside)


def weighted_mean(daily: npt.ArrayLike, weights: tuple[float, ...], *, periodic: bool = False) -> Floats:
    """Weighted mean of the days before each day.

    Parameters
    ----------
    daily : array_like, shape (days,)
        Daily mean of the outdoor temperature. [degC]
    weights : tuple of float
        Weight of the day before, of the second day before, ...
    periodic : bool
        Whether the last days come before the first one, as in a typical year.

    Returns
    -------
    ndarray, shape (days,)
        For each day; NaN where the days before it are not all known. [degC]

    Examples
    --------
    >>> weighted_mean([10.0] * 7 + [20.0, 20.0], EN_WEIGHTS)[-2:].round(3)
    array([10.   , 12.632])
    """
    temperatures = np.asarray(daily, dtype=np.float64)
    count = len(weights)
    before = temperatures[-count:] if periodic and len(temperatures) >= count else np.full(count, np.nan)
    padded = np.concatenate([before, temperatures])
    shifted = [padded[count - lag : len(padded) - lag] for lag in range(1, count + 1)]
    return np.asarray(np.average(shifted, axis=0, weights=weights), dtype=np.float64)


def rise_of_limit(air_speed: npt.ArrayLike, operative: npt.ArrayLike) -> Floats:
    """How much higher the upper limit is where people control the air speed.

    Parameters
    ----------
    air_speed : array_like
        Air speed. [m/s]
    operative : array_like
        Operative temperature; there is no rise up to 25 degC. [degC]

    Returns
    -------
    ndarray
        EN 16798-1 table B.4 and ASHRAE 55 table 5-13. [K]

    Examples
    --------
    >>> rise_of_limit([0.3, 0.6, 0.9, 1.2], 28.0)
    array([0. , 1.2, 1.8, 2.2])
    """
    speed, warm = np.broadcast_arrays(np.asarray(air_speed, dtype=np.float64), np.asarray(operative))
    rise = np.zeros(speed.shape)
    for least, kelvin in _RISES:
        rise = np.where(at_least(speed, least), kelvin, rise)
    return np.where(above(warm, _RISES_ABOVE), rise, 0.0)


def _valid_mean(mean: Floats | float | None) -> Floats:
    if mean is None:
        raise ValueError("no outdoor temperature")
    return np.asarray(mean, dtype=np.float64)


def _around(
    conditions: Conditions, centre: Floats, distances: tuple[float, float], outside: dict[str, Flags]
) -> Evaluation:
    values = conditions.operative_temperature
    invalid = np.any(np.stack(np.broadcast_arrays(*outside.values())), axis=0)
    high = centre + distances[1] + rise_of_limit(conditions.air_speed, values)
    return Evaluation(np.where(invalid, np.nan, values), centre + distances[0], high, outside)

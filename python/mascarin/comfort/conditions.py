"""What a person in a room is exposed to, and the operative temperature of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from mascarin.physics import STANDARD_PRESSURE

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Conditions:
    """Air, radiation, humidity and the person. Arrays broadcast; their last axis is time.

    Attributes
    ----------
    air_temperature : ndarray, shape (..., times)
        Temperature of the air. [degC]
    radiant_temperature : ndarray, shape (..., times)
        Mean radiant temperature. [degC]
    relative_humidity : ndarray or float or None
        Relative humidity of the air; None: not known. [%]
    running_mean : ndarray, shape (times,), or float or None
        Running mean of the outdoor temperature by EN 16798-1. [degC]
    prevailing_mean : ndarray, shape (times,), or float or None
        Prevailing mean outdoor temperature by ASHRAE 55. [degC]
    pressure : ndarray or float
        Pressure of the air. [Pa]
    air_speed : ndarray or float
        Mean air speed around the person, from openings and fans. [m/s]
    metabolic_rate : float
        Metabolic rate. [met; 1 met = 58.15 W/m2]
    clothing : float
        Thermal insulation of the clothing. [clo; 1 clo = 0.155 m2 K/W]

    Examples
    --------
    >>> here = Conditions(np.array([26.0, 28.0]), np.array([28.0, 28.0]))
    >>> here.operative_temperature
    array([27., 28.])
    """

    air_temperature: Floats
    radiant_temperature: Floats
    relative_humidity: Floats | float | None = None
    running_mean: Floats | float | None = None
    prevailing_mean: Floats | float | None = None
    pressure: Floats | float = STANDARD_PRESSURE
    air_speed: Floats | float = 0.1
    metabolic_rate: float = 1.2
    clothing: float = 0.5

    @property
    def operative_temperature(self) -> Floats:
        """Temperature that counts air and radiation together. [degC]"""
        return operative_temperature(self.air_temperature, self.radiant_temperature, self.air_speed)

    @property
    def humidity(self) -> Floats:
        """Relative humidity, which an index that needs it has asked for. [%]"""
        if self.relative_humidity is None:
            raise ValueError("no relative humidity")
        return np.asarray(self.relative_humidity, dtype=np.float64)


def operative_temperature(
    air: npt.ArrayLike, radiant: npt.ArrayLike, air_speed: npt.ArrayLike = 0.1
) -> Floats:
    """Operative temperature by ISO 7726, ``(t_r + t_a sqrt(10 v)) / (1 + sqrt(10 v))``.

    Parameters
    ----------
    air, radiant : array_like
        Temperature of the air and mean radiant temperature. [degC]
    air_speed : array_like
        Air speed; at 0.1 m/s the operative temperature is the mean of the two. [m/s]

    Returns
    -------
    ndarray
        Operative temperature. [degC]

    Notes
    -----
    ISO 7726:1998, annex G.3.

    Examples
    --------
    >>> float(operative_temperature(26.0, 30.0, 0.1)), float(operative_temperature(26.0, 30.0, 0.9))
    (28.0, 27.0)
    """
    weight = np.sqrt(10.0 * np.asarray(air_speed, dtype=np.float64))
    t_a, t_r = np.asarray(air, dtype=np.float64), np.asarray(radiant, dtype=np.float64)
    return np.asarray((t_r + weight * t_a) / (1.0 + weight), dtype=np.float64)

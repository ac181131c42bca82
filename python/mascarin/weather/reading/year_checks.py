"""Whether the values of a weather file of a year are plausible in the units that its format fixes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from mascarin.errors import InputError
from mascarin.physics import humidity_of_dew_point
from mascarin.tables.arrays import Array
from mascarin.weather.reading.likely_units import unlikely
from mascarin.weather.records.channels import UNITS

_WINDY: Final = 10.0
"""Mean wind of a year that few stations have: those of mountain tops and of storms at sea. [m/s]"""
_DIM: Final = 400.0
"""The brightest hour of a year is brighter, except near the poles. [W/m2]"""
_POLAR: Final = 65.0
_ABOVE: Final = 0.5
"""A dew point this far above the air temperature is no matter of rounding. [K]"""
_PART: Final = 0.01
"""Part of the rows from which on they are named. [-]"""
_COMPARED: Final = 0.2
"""Part of the rows above freezing, from which on humidities are compared: ice has another one. [-]"""
_APART: Final = 8.0
"""Median difference of the two humidities of a file that is no matter of formulas. [%]"""


def doubts_of_year(
    values: Mapping[str, Array], humidity: Array, latitude: float, where: str
) -> tuple[str, ...]:
    """Warnings about values that few places have, and contradictions between columns.

    Parameters
    ----------
    values : mapping of str to ndarray, shape (n,)
        Channels in their units, NaN where missing.
    humidity : ndarray, shape (n,)
        Relative humidity of the file. [%]
    latitude : float
        Positive north. [deg]
    where : str
        File.

    Raises
    ------
    InputError
        Values are those of another unit: no place has them.
    """
    for name, column in values.items():
        finite = column[np.isfinite(column)]
        doubt = unlikely(name, finite) if len(finite) else None
        if doubt is not None:
            raise InputError(
                f"{where}: {name}: found {doubt[0]}; expected values in {UNITS[name]}, which the format "
                f"fixes. They look like {doubt[1]}: convert this column of the file."
            )
    if not np.isfinite(values["air_temperature"]).any():
        raise InputError(
            f"{where}: air_temperature: found no value in any row, since 99.9 and more mean none; expected "
            "values in degC. They look like K: convert this column of the file."
        )
    said = []
    wind = values["wind_speed"][np.isfinite(values["wind_speed"])]
    if len(wind) and wind.mean() > _WINDY:
        said.append(f"a mean wind of {wind.mean():.1f} m/s, which few places have: are they km/h or knots?")
    total = values["global_horizontal"]
    brightest = float(np.nanmax(total)) if np.isfinite(total).any() else _DIM
    if brightest < _DIM and abs(latitude) < _POLAR:
        said.append(
            f"a brightest hour of {brightest:.0f} W/m2 in global_horizontal: is it an energy of a shorter "
            "interval, or another unit?"
        )
    air, dew = values["air_temperature"], values["dew_point"]
    above = dew > air + _ABOVE
    if above.mean() > _PART:
        said.append(f"a dew point above the air temperature in {int(above.sum())} of {len(air)} rows.")
    comparable = np.isfinite(dew) & (air > 0.0) & (humidity > 0.0) & (humidity <= 110.0)
    if comparable.mean() > _COMPARED:
        derived_humidity = humidity_of_dew_point(air[comparable], dew[comparable])
        apart = float(np.median(np.abs(derived_humidity - humidity[comparable])))
        if apart > _APART:
            said.append(
                f"a relative humidity that differs by {apart:.0f} % (median) from that of dew point and air "
                "temperature: the dew point is used."
            )
    return tuple(f"{where}: warning: found {text}" for text in said)

"""Values of a channel that are not plausible in its unit, and the unit in which they would be."""

from __future__ import annotations

import numpy as np

from mascarin.errors import InputError
from mascarin.tables.arrays import Array, Lines
from mascarin.weather.records.channels import RADIATION, UNITS

#: Higher than the highest air temperature ever measured, 56.7 degC (World Meteorological Organization,
#: doi:10.1175/BAMS-D-12-00093.1). [degC]
_HIGHEST_AIR = 57.0
#: A little more than the highest mean of a month, that of July 2018 in Death Valley (42.3 degC). [degC]
_HIGHEST_MEAN_AIR = 45.0
#: Mean of a year on Mount Washington, one of the windiest stations: 15.7 m/s (Mount Washington Observatory,
#: normals 1991 to 2020). [m/s]
_HIGHEST_MEAN_WIND = 16.0
#: A day has a higher irradiance at noon, even below thick cloud and at high latitudes. [W/m2]
_LOWEST_NOON = 2.0
#: Outdoor air is never that dry. [%]
_DRIEST = 1.05


def require_likely_unit(name: str, values: Array, lines: Lines, column: str, where: str) -> None:
    """Refuse a channel whose unit nobody states, where its values are not plausible in the usual one.

    Parameters
    ----------
    name : str
        Channel.
    values : ndarray, shape (n,)
        In the unit of the channel, NaN where missing.
    lines : ndarray, shape (n,)
        Line of each value.
    column : str
        Its column.
    where : str
        File, for the error.

    Raises
    ------
    InputError
        The values are not plausible; the text names the unit in which they would be.

    Examples
    --------
    >>> require_likely_unit("wind_speed", np.array([30.0, 42.0]), np.array([2, 3]), "Wind", "log.csv")
    Traceback (most recent call last):
    mascarin.errors.InputError: log.csv:3: wind_speed: found a mean of 36 m/s in the column 'Wind', ...
    """
    finite = values[np.isfinite(values)]
    if not len(finite):
        return
    unit = "%" if name == "relative_humidity" else UNITS.get(name, "")
    doubt = unlikely(name, finite)
    if doubt is None:
        return
    said, likely = doubt
    raise InputError(
        f"{where}:{lines[int(np.nanargmax(values))]}: {name}: found {said} in the column {column!r}, for "
        f"which no unit is stated; expected values that are plausible in {unit}. They look like {likely}: "
        f"state the unit, {{column: {column!r}, unit: {likely!r}}} "
        f'(on the command line --column "{name}={column} [{likely}]"), or unit: {unit!r} where they '
        "are right."
    )


def unlikely(name: str, values: Array) -> tuple[str, str] | None:
    """What is not plausible in the values of a channel, and the likely unit; None where all is.

    Parameters
    ----------
    name : str
        Channel.
    values : ndarray, shape (n,)
        In the unit of the channel, without missing ones.
    """
    mean, top = float(values.mean()), float(values.max())
    usual = float(np.quantile(values, 0.95))  # single wrong values are found elsewhere
    if name in ("air_temperature", "dew_point") and (
        usual > _HIGHEST_AIR or np.median(values) > _HIGHEST_MEAN_AIR
    ):
        return f"a mean of {mean:.4g} and a maximum of {top:.4g} degC", "K" if usual > 180.0 else "degF"
    if name == "wind_speed" and float(np.median(values)) > _HIGHEST_MEAN_WIND:
        return f"a mean of {mean:.4g} m/s", "km/h"
    if name in RADIATION and 0.0 < top < _LOWEST_NOON:
        return f"a maximum of {top:.4g} W/m2", "kW/m2"
    if name == "relative_humidity" and 0.0 < top < _DRIEST:
        return f"a maximum of {top:.4g} %", "1"
    if name == "pressure" and 500.0 < mean < 1100.0:
        return f"a mean of {mean:.4g} Pa", "hPa"
    if name == "pressure" and 50.0 < mean < 110.0:
        return f"a mean of {mean:.4g} Pa", "kPa"
    return None

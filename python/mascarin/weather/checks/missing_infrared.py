"""Infrared radiation of the sky in the intervals in which a record has none, by the default model of a site.

The laws of the engine (``crates/engine/src/physics/longwave/sky.rs``) with the values of
`MartinBerdahlSky` and `CloudLayer`: a building that gives a model of the sky itself takes that in all
intervals.

References
----------
Martin & Berdahl 1984, Solar Energy 33(3), 321-336, doi:10.1016/0038-092X(84)90162-2.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from mascarin.physics import KELVIN, STEFAN_BOLTZMANN
from mascarin.tables.arrays import Array
from mascarin.weather.records.record import WeatherRecord

_CLOUD_SCALE_HEIGHT: Final = 8200.0
"""Scale height of the effect of clouds (Martin & Berdahl 1984). [m]"""


def sky_emission(air: Array, dew_point: Array, cloud_cover: Array) -> Array:
    """Emission of the sky on a horizontal plane, by the default model of a site.

    Parameters
    ----------
    air, dew_point : ndarray, shape (n,)
        Temperatures. [degC]
    cloud_cover : ndarray, shape (n,)
        Part of the sky. [tenths]

    Returns
    -------
    ndarray, shape (n,)
        NaN where one of them is missing. [W/m2]

    Examples
    --------
    >>> sky_emission(np.array([20.0]), np.array([10.0]), np.array([5.0])).round(2).tolist()
    [365.07]
    """
    from mascarin.building.parts.site import SKIES, CloudLayer

    sky, cloud = SKIES["MartinBerdahlSky"](), CloudLayer()
    dew = dew_point / 100.0
    clear = float(sky.a) + float(sky.b) * dew + float(sky.c) * dew * dew
    overcast = float(cloud.emissivity) * np.exp(-float(cloud.base) / _CLOUD_SCALE_HEIGHT)
    emissivity = np.minimum(clear + (1.0 - clear) * overcast * 0.1 * cloud_cover, 1.0)
    return np.asarray(emissivity * STEFAN_BOLTZMANN * (air + KELVIN) ** 4)


def with_whole_infrared(record: WeatherRecord) -> WeatherRecord:
    """A weather file of a year whose missing infrared radiation is that of the model; others as they are.

    In a measured table a missing value is a gap: it is refused with its line, or filled on request.

    Parameters
    ----------
    record : WeatherRecord
        With cloud cover, see `mascarin.weather.derived.completion`.

    Returns
    -------
    WeatherRecord
        NaN stays where air, dew point or cloud cover are missing, too.
    """
    values = record.columns.get("infrared")
    needed = ("air_temperature", "dew_point", "cloud_cover")
    if not record.of_year or values is None or any(name not in record.columns for name in needed):
        return record
    missing = np.isnan(values)
    if not missing.any() or missing.all():
        return record
    parts = [_over_intervals(record, name) for name in needed]
    model = sky_emission(*parts)
    closing = dict(record.closing)
    if np.isnan(closing.get("infrared", 0.0)):
        ends = [np.array([closing.get(name, record.columns[name][-1])]) for name in needed]
        closing["infrared"] = float(sky_emission(*ends)[0])
    columns = {**record.columns, "infrared": np.where(missing, model, values)}
    return replace(record, columns=columns, closing=closing)


def _over_intervals(record: WeatherRecord, name: str) -> Array:
    """Means over the intervals, or values at their starts where infrared is such."""
    values = record.columns[name]
    if record.kinds["infrared"] != "mean" or record.kinds[name] == "mean":
        return values
    after = np.append(values[1:], record.closing.get(name, values[-1]))
    return np.where(np.isnan(after), values, 0.5 * (values + after))


def sky_of_runs(record: WeatherRecord) -> str:
    """Which sky a run takes from a record, in a sentence.

    Parameters
    ----------
    record : WeatherRecord
        As read.
    """
    values = record.columns.get("infrared")
    gaps = len(record.lines) if values is None else int(np.isnan(values).sum())
    model = "Martin & Berdahl 1984 with the cloud cover"
    if gaps == len(record.lines):
        return f"no infrared radiation in the file: a model in all rows, site.sky, by default {model}"
    if gaps:
        return (
            f"infrared radiation of the file; in {gaps} of {len(record.lines)} rows, which have none, "
            f"the model "
            f"of {model}. A building with site.sky takes its model in all rows"
        )
    return "infrared radiation of the file in all rows; a building with site.sky takes its model instead"

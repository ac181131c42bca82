"""Weather and measurements: files, tables, the sun, and the input of the engine.

Time, one rule
--------------
Times for people are local times of the climate with their offset: indices of pandas have a time zone, and
plots name the zone on their axis. Stamps without an offset that a user gives are local times of the climate.
xarray and NetCDF hold the coordinate ``time`` (UTC, without zone), the coordinate ``local_time`` (the local
clock, without zone) and the attribute ``timezone``.

A row is labeled by the start of its interval. An `instant` column holds the value at that time, and values
between two stamps are linear. A `mean` column holds the mean over the interval; inside the interval, means
are reconstructed such that their integral is kept, and radiation follows the sun.

Notes
-----
`Climate.provenance` and `Measurements.provenance` say what was read, converted, derived and assumed.
"""

from __future__ import annotations

from mascarin.tables.columns import Column
from mascarin.tables.steps import STAGES
from mascarin.tables.timezones import parse_timezone
from mascarin.weather.climate import Climate
from mascarin.weather.epw_writing import write_epw
from mascarin.weather.morphing import MonthlyChanges, morphed
from mascarin.weather.overview import Overview, overview
from mascarin.weather.reading.measurements import Measurements
from mascarin.weather.reading.shipped import SHIPPED, ShippedClimate
from mascarin.weather.records.channels import (
    CHANNELS,
    COEFFICIENTS,
    IRRADIANCES,
    RADIATION,
    TEMPERATURES,
    UNITS,
)
from mascarin.weather.records.site import Place
from mascarin.weather.schedules import scheduled
from mascarin.weather.summary import summary, summary_of_measurements

__all__ = [
    "CHANNELS",
    "COEFFICIENTS",
    "IRRADIANCES",
    "RADIATION",
    "SHIPPED",
    "STAGES",
    "TEMPERATURES",
    "UNITS",
    "Climate",
    "Column",
    "Measurements",
    "MonthlyChanges",
    "Overview",
    "Place",
    "ShippedClimate",
    "morphed",
    "overview",
    "parse_timezone",
    "scheduled",
    "summary",
    "summary_of_measurements",
    "write_epw",
]


def __dir__() -> list[str]:
    return __all__

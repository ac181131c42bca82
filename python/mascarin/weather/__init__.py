"""Climate: weather files and measured tables, the sun, time rules, and the forcing of the engine.

Stamps label the start of an interval. Instantaneous quantities are interpolated; means keep their integral,
and radiation follows the sun inside the interval. What readers convert, derive and assume is said in
`Climate.provenance`.
"""

from __future__ import annotations

from mascarin.weather.channels import CHANNELS, IRRADIANCES, RADIATION, TEMPERATURES, UNITS
from mascarin.weather.climate import Climate, Place, SiteLike, summary
from mascarin.weather.forcing import STAGES, forcing
from mascarin.weather.measurements import Measurements
from mascarin.weather.place import require_place
from mascarin.weather.schedules import scheduled
from mascarin.weather.table import Column
from mascarin.weather.timezones import parse_timezone

__all__ = [
    "CHANNELS",
    "IRRADIANCES",
    "RADIATION",
    "STAGES",
    "TEMPERATURES",
    "UNITS",
    "Climate",
    "Column",
    "Measurements",
    "Place",
    "SiteLike",
    "forcing",
    "parse_timezone",
    "require_place",
    "scheduled",
    "summary",
]

"""Climate: weather files and measured tables, the sun, time rules, and the forcing of the engine.

Stamps label the start of an interval. Instantaneous quantities are interpolated; means keep their integral,
and radiation follows the sun inside the interval. What readers convert, derive and assume is said in
`Climate.provenance`.
"""

from __future__ import annotations

from .channels import CHANNELS, IRRADIANCES, RADIATION, TEMPERATURES, UNITS
from .forcing import STAGES, forcing
from .measurements import Measurements
from .place import require_place
from .schedules import scheduled
from .table import Column
from .timezones import parse_timezone
from .weather import Climate, Place, SiteLike, summary

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

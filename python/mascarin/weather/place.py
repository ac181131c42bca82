"""Is the weather that of the building's place?"""

from __future__ import annotations

from datetime import timedelta, timezone, tzinfo
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.errors import InputError
from mascarin.weather.table import stamps_of
from mascarin.weather.timezones import parse_timezone, standard_offset, zone_name

if TYPE_CHECKING:
    from mascarin.weather.climate import Climate, SiteLike

_FAR: Final = 2.0
"""Difference of latitude or longitude that is no longer the same place [deg]."""
_HIGH: Final = 500.0
"""Difference of altitude that is no longer the same climate [m]."""
_TODAY: Final = 2024
"""Zones changed; a typical year may be labelled before the change and carry the offset after it."""


def require_place(climate: Climate, site: SiteLike) -> None:
    """Refuse a climate that was measured somewhere else than where the building stands.

    Latitude and longitude may differ by 2 deg, altitude by 500 m. The building's time zone must have the
    standard (winter) offset of a weather file of a year; the clock of a measured table may be any.

    Parameters
    ----------
    climate : Climate
        The weather; passes if it does not know its place, or was read with `elsewhere=True`.
    site : object with latitude and longitude
        The building's place; altitude and time zone are looked at if it has them.

    Raises
    ------
    InputError
        The two are not the same place; both are named.
    """
    if climate.elsewhere:
        return
    if climate.site is not None:
        _require_near(climate, site)
    zone = getattr(site, "timezone", None)
    if climate.of_year and isinstance(zone, str):
        _require_zone(climate, zone)


def _require_near(climate: Climate, site: SiteLike) -> None:
    place = climate.site
    if place is None:
        return
    east = float(site.longitude) - place.longitude
    away = [
        ("latitude", float(site.latitude), place.latitude, abs(float(site.latitude) - place.latitude) > _FAR),
        ("longitude", float(site.longitude), place.longitude, abs((east + 180.0) % 360.0 - 180.0) > _FAR),
    ]
    height = getattr(site, "altitude", None)
    # A table whose altitude was not stated carries 0.
    if height is not None and (climate.of_year or place.altitude != 0.0):
        away.append(("altitude", float(height), place.altitude, abs(float(height) - place.altitude) > _HIGH))
    for name, here, there, far in away:
        if not far:
            continue
        unit, limit = ("m", _HIGH) if name == "altitude" else ("deg", _FAR)
        sign = " (the sign is the other way round)" if abs(here + there) <= limit else ""
        raise InputError(
            f"{climate.file}: the weather is of {name} {there:g} {unit}{_called(climate)}, the building "
            f"stands at {name} {here:g} {unit}{sign}; expected a difference of at most {limit:g} {unit}. "
            f"{_remedy(climate, name)}"
        )


def _require_zone(climate: Climate, text: str) -> None:
    zone = parse_timezone(text, "site.timezone")
    label = int(stamps_of(np.array([climate.grid.start + 86400.0]), climate.grid.zone)[0].year)
    years = (label, _TODAY)
    if _offsets(zone, years) & _offsets(climate.grid.zone, years):
        return
    found = zone_name(timezone(standard_offset(zone, label)))
    raise InputError(
        f"{climate.file}: the weather's clock is {climate.timezone}{_called(climate)}, the building's time "
        f"zone is {text} (winter time {found}); expected the same winter time. "
        f"{_remedy(climate, 'timezone')}"
    )


def _offsets(zone: tzinfo, years: tuple[int, ...]) -> set[timedelta]:
    return {standard_offset(zone, year) for year in years}


def _called(climate: Climate) -> str:
    return f" ({climate.site.name})" if climate.site is not None and climate.site.name else ""


def _remedy(climate: Climate, name: str) -> str:
    if climate.of_year:
        return (
            f"Correct site: {name} in the building file, or take the weather of that place (in Python, "
            "weather from elsewhere that is wanted: elsewhere=True when reading the file)."
        )
    return f"Correct site: {name} in the building file, or the {name} given with the table."

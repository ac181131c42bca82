"""Check that the weather is that of the place of the building."""

from __future__ import annotations

from datetime import timedelta, timezone, tzinfo
from typing import Final

from mascarin.errors import InputError
from mascarin.tables.times import local_time
from mascarin.tables.timezones import parse_timezone, standard_offset, zone_name
from mascarin.weather.records.record import WeatherRecord
from mascarin.weather.records.site import SiteLike

_FAR: Final = 2.0
"""Larger differences of latitude or longitude are another place. [deg]"""
_HIGH: Final = 500.0
"""Larger differences of altitude are another place. [m]"""
_TODAY: Final = 2024
"""Offsets of zones changed; a typical year with an early label may have the offset of today."""


def require_place(record: WeatherRecord, site: SiteLike) -> None:
    """Refuse weather of another place than that of the building.

    Latitude and longitude may differ by 2 deg, altitude by 500 m. The time zone of the building must have
    the winter offset of a weather file of a year; a measured table may have any time zone.

    Parameters
    ----------
    record : WeatherRecord
        The weather; accepted if its place is not known, or if it was read with `elsewhere=True`.
    site : object with latitude and longitude
        The place of the building; altitude and time zone are compared if it has them.

    Raises
    ------
    InputError
        The two are not the same place; both are named.
    """
    if record.elsewhere:
        return
    if record.site is not None:
        _require_near(record, site)
    zone = getattr(site, "timezone", None)
    if record.of_year and isinstance(zone, str):
        _require_zone(record, zone)


def _require_near(record: WeatherRecord, site: SiteLike) -> None:
    weather_site = record.site
    if weather_site is None:
        return
    east = float(site.longitude) - weather_site.longitude
    away = [
        (
            "latitude",
            float(site.latitude),
            weather_site.latitude,
            abs(float(site.latitude) - weather_site.latitude) > _FAR,
        ),
        (
            "longitude",
            float(site.longitude),
            weather_site.longitude,
            abs((east + 180.0) % 360.0 - 180.0) > _FAR,
        ),
    ]
    height = getattr(site, "altitude", None)
    # A table without a stated altitude has 0.
    if height is not None and (record.of_year or weather_site.altitude != 0.0):
        away.append(
            (
                "altitude",
                float(height),
                weather_site.altitude,
                abs(float(height) - weather_site.altitude) > _HIGH,
            )
        )
    for name, site_value, record_value, far in away:
        if not far:
            continue
        unit, limit = ("m", _HIGH) if name == "altitude" else ("deg", _FAR)
        sign = " (opposite sign)" if abs(site_value + record_value) <= limit else ""
        raise InputError(
            f"{record.file}: the weather is of {name} {record_value:g} {unit}{_called(record)}, the building "
            f"is at {name} {site_value:g} {unit}{sign}; expected a difference of at most {limit:g} {unit}. "
            f"{_remedy(record, name)}"
        )


def _require_zone(record: WeatherRecord, text: str) -> None:
    zone = parse_timezone(text, "site.timezone")
    label = local_time(record.grid.start + 86400.0, record.grid.zone).year
    years = (label, _TODAY)
    if _offsets(zone, years) & _offsets(record.grid.zone, years):
        return
    winter_time = zone_name(timezone(standard_offset(zone, label)))
    raise InputError(
        f"{record.file}: the weather's clock is {zone_name(record.grid.zone)}{_called(record)}, the "
        f"building's time zone is {text} (winter time {winter_time}); expected the same winter time. "
        f"{_remedy(record, 'timezone')}"
    )


def _offsets(zone: tzinfo, years: tuple[int, ...]) -> set[timedelta]:
    return {standard_offset(zone, year) for year in years}


def _called(record: WeatherRecord) -> str:
    return f" ({record.site.name})" if record.site is not None and record.site.name else ""


def _remedy(record: WeatherRecord, name: str) -> str:
    if record.of_year:
        return (
            f"Correct site: {name} in the building file, or use the weather of that place (in Python, "
            "if weather of another place is intended: elsewhere=True when reading the file)."
        )
    return f"Correct site: {name} in the building file, or the {name} given with the table."

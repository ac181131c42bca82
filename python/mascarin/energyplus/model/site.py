"""Site, wind and sky; temperatures of the ground."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Final

from mascarin._io.regular import require_regular
from mascarin.energyplus.model.context import Context
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject
from mascarin.energyplus.model.year import DAYS, Year, constant, year_of
from mascarin.errors import InputError
from mascarin.weather.reading.shipped import content

_TERRAINS: Final = {
    "country": "open",
    "suburbs": "suburb",
    "urban": "suburb",
    "city": "city",
    "ocean": "sea",
}
_SKIES: Final = {
    "clarkallen": "clark_allen",
    "brunt": "brunt",
    "idso": "brunt",
    "berdahlmartin": "martin_berdahl",
}
_MONTHS: Final = (
    "january", "february", "march", "april", "may", "june", "july", "august", "september", "october",
    "november", "december",
)  # fmt: skip
_LENGTHS: Final = (31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31)
#: Differences of latitude, longitude [deg], altitude [m] and time zone [h] of one place.
_SAME_PLACE: Final = (1.0, 1.0, 100.0, 0.0)
#: Lines before the data of a weather file, and bytes in which they are.
_HEADER_LINES: Final = 8
_HEADER_BYTES: Final = 65_536
#: Column of the air temperature, from 0, and what stands there for a missing one.
_AIR, _MISSING = 6, "99.9"
#: Temperature of the ground where the file gives none, as in EnergyPlus [degC].
_GROUND: Final = 18.0


@reads("Site:GroundReflectance")
def describe_site(context: Context, weather: Path | None) -> None:
    """Enter the site.

    Raises
    ------
    InputError
        The file has no ``Site:Location`` and no weather file is given.
    """
    site = context.section("site")
    site |= _location(context, weather)
    if weather is not None:
        context.special_days |= _special_days(weather)
        context.yearly_air = _yearly_air(weather)
    reflectance = _monthly(context.model.one("Site:GroundReflectance"), "ground_reflectance")
    if reflectance is not None:
        mean = sum(v * n for v, n in zip(reflectance, _LENGTHS, strict=True)) / 365.0
        site["ground_reflectance"] = round(mean, 4)
        if max(reflectance) - min(reflectance) > 1e-6:
            item = context.model.of("Site:GroundReflectance")[0]
            context.findings.approximated(item, "a reflectance by month", "its mean over the year is used")
    site["wind"] = _wind(context)
    _sky(context, site)


@reads("Site:Location")
def _location(context: Context, weather: Path | None) -> dict[str, Any]:
    item = context.model.one("Site:Location")
    if item is None and weather is None:
        raise InputError(
            f"{context.model.file}: found no Site:Location; expected the place of the building. Add the "
            "object, or name the weather file with --weather"
        )
    keys = ("latitude", "longitude", "elevation", "time_zone")
    values = [] if item is None else [item.number(key) or 0.0 for key in keys]
    if weather is not None:
        stated, values = values, _of_weather(weather)
        pairs = zip(stated, values, _SAME_PLACE, strict=False)
        if item is not None and any(abs(first - second) > limit for first, second, limit in pairs):
            context.findings.approximated(
                item,
                "another place than that of the weather file",
                f"{values[0]:g} deg, {values[1]:g} deg, {values[2]:g} m, as in EnergyPlus",
            )
    latitude, longitude, altitude, zone = values
    hours, minutes = divmod(round(abs(zone) * 60.0), 60)
    offset = f"UTC{'-' if zone < 0.0 else '+'}{hours}" + (f":{minutes:02d}" if minutes else "")
    return {"latitude": latitude, "longitude": longitude, "altitude": altitude, "timezone": offset}


def _of_weather(path: Path) -> list[float]:
    cells = _head(path)[0].split(",")
    try:
        latitude, longitude, zone, altitude = (float(cell) for cell in cells[6:10])
    except ValueError:
        raise InputError(
            f"{path}:1: found no LOCATION; expected a weather file of EnergyPlus (.epw)"
        ) from None
    return [latitude, longitude, altitude, zone]


def _special_days(path: Path) -> dict[str, bool]:
    """Whether a weather file has daylight saving time and holidays."""
    for line in _head(path):
        cells = [cell.strip() for cell in line.split(",")]
        if cells[0].upper() == "HOLIDAYS/DAYLIGHT SAVINGS" and len(cells) > 4:
            return {"daylight saving": cells[2] != "0", "holidays": cells[4] != "0"}
    return {}


def _yearly_air(path: Path) -> float | None:
    """Mean of the outdoor air over a weather file; None if a value of it is no temperature. [degC]

    What is wrong with a file is said where it is read for a run.
    """
    rows = content(require_regular(path)).decode("latin-1").splitlines()[_HEADER_LINES:]
    cells = [row.split(",", _AIR + 1) for row in rows if row.strip()]
    try:
        values = [float(row[_AIR]) for row in cells if row[_AIR].strip() not in ("", _MISSING)]
    except (ValueError, IndexError):
        return None
    mean = sum(values) / len(values) if values else math.nan
    return mean if math.isfinite(mean) else None


def _head(path: Path) -> list[str]:
    """First lines of a weather file, at least one."""
    try:
        raw = content(require_regular(path))
    except FileNotFoundError:
        raise InputError(
            f"{path}: no such file; expected a weather file (.epw). Give the path from the folder you work "
            "in, or shipped:NAME of a climate that 'mascarin weather' lists"
        ) from None
    lines = raw[:_HEADER_BYTES].decode("latin-1").splitlines()[:_HEADER_LINES]
    return lines or [""]


@reads("Building", "Site:HeightVariation", "Site:WeatherStation")
def _wind(context: Context) -> dict[str, Any]:
    building = context.model.one("Building")
    word = building.word("terrain") if building is not None else ""
    wind: dict[str, Any] = {"terrain": _TERRAINS.get(word or "suburbs", "suburb")}
    heights = context.model.one("Site:HeightVariation")
    if heights is not None:
        for key, name in (("exponent", "exponent"), ("layer", "boundary_layer_thickness")):
            entered_value = heights.fields.get(f"wind_speed_profile_{name}")
            wind |= {} if entered_value is None else {key: float(entered_value)}
    station = context.model.one("Site:WeatherStation")
    for key, name in (
        ("mast_height", "wind_sensor_height_above_ground"),
        ("mast_exponent", "wind_speed_profile_exponent"),
        ("mast_layer", "wind_speed_profile_boundary_layer_thickness"),
    ):
        entered_value = None if station is None else station.number(name)
        wind |= {} if entered_value is None else {key: entered_value}
    return wind


@reads("WeatherProperty:SkyTemperature")
def _sky(context: Context, site: dict[str, Any]) -> None:
    items = context.model.of("WeatherProperty:SkyTemperature")
    if not items:
        return
    word = items[0].word("calculation_type")
    if items[0].word("use_weather_file_horizontal_ir") != "no":
        context.findings.no_effect(items, f"sky by {word}", "the weather file states it, and is used")
    elif word in _SKIES:
        site["sky"] = _SKIES[word]
        context.findings.approximated(
            items[0], f"sky by {word}", f"the model '{_SKIES[word]}' with its clouds"
        )
    else:
        context.findings.left_out(items[0], f"sky temperature by {word}", "that of the weather file is used")


def _monthly(item: IdfObject | None, ending: str) -> list[float] | None:
    if item is None:
        return None
    values = [item.number(f"{month}_{ending}") for month in _MONTHS]
    return [_GROUND if value is None else value for value in values]


def ground(context: Context, kind: str = "BuildingSurface") -> Year:
    """Temperature of the ground under the building over the year. [degC]

    Parameters
    ----------
    context : Context
        The conversion.
    kind : str
        Which temperatures: ``BuildingSurface`` or ``FCfactorMethod``.
    """
    item = _under_floors(context) if kind == "BuildingSurface" else _under_factors(context)
    values = _monthly(item, "ground_temperature")
    if values is None:
        return constant(_GROUND)
    ends = [f"{month:02d}-{length:02d}" for month, length in enumerate(_LENGTHS, start=1)]
    return year_of([(end, (((0, value),),) * len(DAYS)) for end, value in zip(ends, values, strict=True)])


@reads("Site:GroundTemperature:BuildingSurface")
def _under_floors(context: Context) -> IdfObject | None:
    return context.model.one("Site:GroundTemperature:BuildingSurface")


@reads("Site:GroundTemperature:FCfactorMethod")
def _under_factors(context: Context) -> IdfObject | None:
    return context.model.one("Site:GroundTemperature:FCfactorMethod")

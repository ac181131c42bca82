"""Site and ground of a new description, from the climate that it will be run with."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from mascarin.errors import InputError, did_you_mean
from mascarin.weather import SHIPPED, Climate

#: Plausible distance of the ground below a floor from the mean of the air. [K]
_GROUND: Final = 3.0


@dataclass(frozen=True, slots=True)
class Place:
    """Where a new building stands.

    Attributes
    ----------
    weather : str
        What ``mascarin run --weather`` takes.
    title : str
        Name of the place.
    site, ground : str
        Sections of the description in one line.
    """

    weather: str
    title: str
    site: str
    ground: str


def _weather(name: str) -> tuple[str, str]:
    """What ``--weather`` takes for a place, and its title."""
    plain = re.sub(r"[\s_]+", "-", name.strip().lower())
    if plain in SHIPPED:
        return f"shipped:{plain}", plain
    if Path(name).is_file():
        return name, re.sub(r"[^\w .-]", " ", Path(name).stem)
    raise InputError(
        f"--place: found '{name}'; expected one of {', '.join(SHIPPED)}, or the path of an EPW file. "
        f"{did_you_mean(name, SHIPPED, known=False)}".rstrip()
    )


def coordinates_of(name: str) -> tuple[float, float, float, str]:
    """Latitude, longitude [deg], altitude [m] and time zone of a place.

    Parameters
    ----------
    name : str
        As for `place_of`.

    Examples
    --------
    >>> coordinates_of("tampa")
    (27.97, -82.53, 6.0, 'UTC-5')
    """
    climate = Climate.from_epw(_weather(name)[0])
    where = climate.site
    if where is None:
        raise InputError(
            f"--place: found {name} without a site; expected a weather file that states its place"
        )
    return where.latitude, where.longitude, where.altitude, str(climate.timezone)


def place_of(name: str) -> Place:
    """A shipped climate by its name, or a weather file.

    Parameters
    ----------
    name : str
        Such as ``saint-denis``, or the path of an EPW file.

    Raises
    ------
    InputError
        No shipped climate and no file of this name.

    Examples
    --------
    >>> place_of("tampa").weather
    'shipped:tampa'
    """
    import numpy as np

    weather, title = _weather(name)
    climate = Climate.from_epw(weather)
    mean = float(np.mean(climate.data["air_temperature"]))
    latitude, longitude, altitude, timezone = coordinates_of(name)
    site = (
        f"{{latitude: {latitude:g}, longitude: {longitude:g}, altitude: {altitude:g}, "
        f"timezone: {timezone}, wind: {{terrain: suburb}}}}"
    )
    ground = (
        f"{{mean: {{value: {mean:.1f}, range: [{mean - _GROUND:.1f}, {mean + _GROUND:.1f}], "
        "source: mean of the air over the year, assumed: true}}"
    )
    return Place(weather, title, site, ground)

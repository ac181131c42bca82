"""Site and ground of a new description, from the climate that it will be run with."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

from mascarin.errors import InputError, did_you_mean

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

    from mascarin.weather import SHIPPED, Climate

    if name in SHIPPED:
        weather, title = f"shipped:{name}", name
    elif Path(name).is_file():
        weather, title = name, Path(name).stem
    else:
        raise InputError(
            f"--place: found '{name}'; expected one of {', '.join(SHIPPED)}, or the path of an EPW file. "
            f"{did_you_mean(name, SHIPPED)}".rstrip()
        )
    climate = Climate.from_epw(weather)
    mean = float(np.mean(climate.data["air_temperature"]))
    where = climate.site
    site = (
        f"{{latitude: {where.latitude:g}, longitude: {where.longitude:g}, altitude: {where.altitude:g}, "
        f"timezone: {climate.timezone}, wind: {{terrain: suburb}}}}"
    )
    ground = (
        f"{{mean: {{value: {mean:.1f}, range: [{mean - _GROUND:.1f}, {mean + _GROUND:.1f}], "
        "source: mean of the air over the year, assumed: true}}"
    )
    return Place(weather, title, site, ground)

"""Where the sun stands over a site, as a table for the page."""

from __future__ import annotations

import base64
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.tables.timezones import parse_timezone, standard_offset
from mascarin.weather.derived.sun import SunPath

if TYPE_CHECKING:
    from mascarin.building.parts.site import Site

#: Any year without a leap day: the sun is at the same place within half a degree in others.
YEAR: Final = 2025
_DAYS: Final = 365
#: Times of a day, every half an hour, midnight twice: between them the page draws a straight line.
_TIMES: Final = 49
_LEVELS: Final = 32_000


def positions(site: Site) -> dict[str, Any]:
    """Directions to the sun over a year.

    Parameters
    ----------
    site : Site
        Site of a building.

    Returns
    -------
    dict
        ``year``; ``offset``: standard time of the site less UTC [h]; ``days``, ``times``; ``levels``: value
        of a full unit; ``data``: unit vectors (east, north, up), shape (days, times, 3), as 16-bit integers
        in base64.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> positions(box().site)["times"]
    49
    """
    offset = standard_offset(parse_timezone(str(site.timezone)), YEAR).total_seconds()
    start = datetime(YEAR, 1, 1, tzinfo=UTC).timestamp() - offset
    times = start + 86400.0 * np.arange(_DAYS)[:, None] + 1800.0 * np.arange(_TIMES)
    sun = SunPath.over(float(site.latitude), float(site.longitude), float(times[0, 0]), float(times[-1, -1]))
    levels = np.round(_LEVELS * sun.vector(times)).astype("<i2")
    return {
        "year": YEAR,
        "offset": offset / 3600.0,
        "days": _DAYS,
        "times": _TIMES,
        "levels": _LEVELS,
        "data": base64.b64encode(levels.tobytes()).decode("ascii"),
    }

"""What reports and files of results say of a climate."""

from __future__ import annotations

from typing import Any

from mascarin.weather.climate import Climate


def summary(climate: Climate) -> dict[str, Any]:
    """What a report prints of a climate: file, hash, range, step, site and provenance.

    Parameters
    ----------
    climate : Climate
        The climate; the provenance includes what was derived for the place where it was last used.

    Returns
    -------
    dict
        Values that JSON can hold.
    """
    place = climate.site
    return {
        "file": climate.file,
        "sha256": climate.sha256,
        "range": climate.grid.span(),
        "step_seconds": climate.grid.interval,
        "timezone": climate.timezone,
        "site": None if place is None else {"latitude": place.latitude, "longitude": place.longitude,
                                           "altitude": place.altitude, "name": place.name},
        "provenance": list(climate.used.provenance),
    }  # fmt: skip

"""Description of a climate for reports and files of results."""

from __future__ import annotations

from typing import Any

from mascarin.weather.climate import Climate


def summary(climate: Climate) -> dict[str, Any]:
    """Description of a climate for a report: file, hash, range, step, site and provenance.

    Parameters
    ----------
    climate : Climate
        The climate; the provenance includes what was derived for the place where it was last used.

    Returns
    -------
    dict
        Values that JSON can hold.

    Examples
    --------
    >>> import pandas as pd
    >>> from mascarin.weather import Climate
    >>> index = pd.date_range("2024-06-01", periods=4, freq="1h", tz="UTC")
    >>> climate = Climate.from_table(
    ...     pd.DataFrame({"T": [12.0, 13.0, 15.0, 16.0]}, index=index),
    ...     columns={"air_temperature": "T"},
    ...     absent=["radiation", "dew_point", "wind_speed", "wind_direction"],
    ... )
    >>> summary(climate)["range"]
    '2024-06-01 00:00 .. 2024-06-01 04:00 (UTC)'
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

"""Description of a climate, and of measurements, for reports and files of results."""

from __future__ import annotations

from typing import Any

from mascarin.weather.climate import Climate
from mascarin.weather.reading.measurements import Measurements


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
    site = climate.site
    return {
        "file": climate.file,
        "sha256": climate.sha256,
        "range": climate.grid.span(),
        "step_seconds": climate.grid.interval,
        "timezone": climate.timezone,
        "site": None if site is None else {"latitude": site.latitude, "longitude": site.longitude,
                                           "altitude": site.altitude, "name": site.name},
        "provenance": list(climate.used.provenance),
    }  # fmt: skip


def summary_of_measurements(measured: Measurements) -> dict[str, Any]:
    """Description of measured columns for a report: file, hash, range, step and what was done with them.

    Parameters
    ----------
    measured : Measurements
        The columns.

    Returns
    -------
    dict
        Values that JSON can hold.

    Examples
    --------
    >>> import pandas as pd
    >>> from mascarin.weather import Measurements
    >>> index = pd.date_range("2024-06-01", periods=4, freq="1h", tz="UTC")
    >>> table = pd.DataFrame({"T_wall": [20.0, 20.5, 21.0, 20.8]}, index=index)
    >>> summary_of_measurements(Measurements.from_table(table))["columns"]
    ['T_wall']
    """
    return {
        "file": measured.file,
        "sha256": measured.sha256,
        "range": measured.grid.span(),
        "step_seconds": measured.grid.interval,
        "timezone": measured.timezone,
        "columns": [str(name) for name in measured.record.columns],
        "provenance": list(measured.provenance),
    }

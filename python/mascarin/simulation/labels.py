"""Times in xarray and NetCDF: coordinate ``time`` in UTC, ``local_time`` along it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd


def time_coordinates(index: pd.DatetimeIndex) -> dict[str, Any]:
    """Coordinates of xarray for stamps with a time zone.

    Parameters
    ----------
    index : pandas.DatetimeIndex, shape (rows,)
        Local times with their zone.

    Returns
    -------
    dict
        ``time``: UTC, without a zone; ``local_time`` along it: the local clock, without a zone. The zone
        itself belongs into the attribute ``timezone``.
    """
    return {
        "time": index.tz_convert("UTC").tz_localize(None),
        "local_time": ("time", index.tz_localize(None)),
    }

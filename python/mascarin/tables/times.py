"""Stamps as seconds since 1970-01-01 UTC."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta, tzinfo
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.tables.arrays import Array

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

_EPOCH: Final = datetime(1970, 1, 1, tzinfo=UTC)


def epoch_seconds(index: pd.DatetimeIndex) -> Array:
    """Seconds since 1970-01-01 UTC of stamps with a zone, shape (n,) [s]."""
    moments = index.tz_convert("UTC").tz_localize(None).to_numpy()
    return np.asarray((moments - np.datetime64(0, "s")) / np.timedelta64(1, "us") * 1e-6, dtype=np.float64)


def local_time(seconds: float, zone: tzinfo) -> datetime:
    """A time in a zone from seconds since 1970-01-01 UTC [s], without pandas."""
    return (_EPOCH + timedelta(seconds=seconds)).astimezone(zone)


def clock(seconds: Array, zone: tzinfo) -> npt.NDArray[np.datetime64]:
    """Readings of the local clock, without a zone, from seconds since 1970-01-01 UTC, shape (n,) [s]."""
    offset = zone.utcoffset(None)
    if offset is None:  # a zone whose clocks change
        return np.asarray(stamps_of(seconds, zone).tz_localize(None).to_numpy())
    return _moments(seconds) + np.timedelta64(round(offset.total_seconds() * 1e6), "us")


def stamps_of(seconds: Array, zone: tzinfo) -> pd.DatetimeIndex:
    """Stamps in a zone from seconds since 1970-01-01 UTC [s]."""
    import pandas as pd

    return pd.DatetimeIndex(_moments(seconds)).tz_localize("UTC").tz_convert(zone)


def _moments(seconds: Array) -> npt.NDArray[np.datetime64]:
    """Times in UTC, to the microsecond."""
    return np.round(np.asarray(seconds) * 1e6).astype(np.int64).astype("datetime64[us]")

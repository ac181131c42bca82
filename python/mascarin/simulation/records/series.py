"""A series of a run: an xarray.DataArray that asks for the offset of a time that is selected."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime
from typing import Any, Self

import pandas as pd
import xarray as xr

from mascarin.errors import InputError


class RunSeries(xr.DataArray):  # type: ignore[no-untyped-call]
    """A series over ``time`` (UTC), with the coordinate ``local_time`` and the attribute ``timezone``.

    `sel` takes times with an offset or a zone. A text or a date without one is refused, because it could be
    meant as local time or as UTC; values of the coordinate itself are UTC.

    Examples
    --------
    >>> import mascarin as mc
    >>> from mascarin.examples import box, box_climate
    >>> air = mc.simulate(box(), box_climate(), step="1h")["room.air_temperature"]
    >>> float(air.sel(time="2001-07-01 12:00-07:00")) == float(air.sel(time="2001-07-01 19:00Z"))
    True
    """

    __slots__ = ()

    def sel(
        self,
        indexers: Mapping[Any, Any] | None = None,
        method: str | None = None,
        tolerance: Any = None,
        drop: bool = False,
        **indexers_kwargs: Any,
    ) -> Self:
        """Values at times; the parameters are those of `xarray.DataArray.sel`.

        Raises
        ------
        InputError
            A time without an offset, or one that was not recorded.
        """
        labels = {**(indexers or {}), **indexers_kwargs}
        if "time" not in labels:
            return super().sel(labels, method, tolerance, drop)
        label = labels["time"]
        labels["time"] = self._in_utc(label)
        try:
            return super().sel(labels, method, tolerance, drop)
        except KeyError:
            raise InputError(
                f"time: found {label!r}; expected the time of a record from {self._clock(0)} to "
                f"{self._clock(-1)}, or method='nearest'"
            ) from None

    def _in_utc(self, label: Any) -> Any:
        """A label, a slice or a list of them in UTC without a zone, as the coordinate is."""
        if isinstance(label, slice):
            return slice(self._in_utc(label.start), self._in_utc(label.stop), label.step)
        if isinstance(label, list | tuple):
            return [self._in_utc(each) for each in label]
        if isinstance(label, pd.DatetimeIndex) and label.tz is not None:
            return label.tz_convert("UTC").tz_localize(None)
        if not isinstance(label, str | datetime):
            return label
        try:
            stamp = pd.Timestamp(label)
        except ValueError:
            raise InputError(f"time: found {label!r}; expected a time such as '{self._clock(0)}'") from None
        if stamp.tz is None:
            raise InputError(
                f"time: found {str(label)!r} without an offset; expected one, because the coordinate time "
                f"is UTC: '{self._clock(0)}' for the local clock, or Z for UTC. Days of the local clock are "
                "taken by to_dataframe().loc"
            )
        return stamp.tz_convert("UTC").tz_localize(None)

    def _clock(self, row: int) -> str:
        """Time of a record: on the local clock with its offset, where the series still has it."""
        time = self.indexes["time"][row]
        local = self.coords.get("local_time")
        if local is None or local.dims != ("time",):
            return f"{time:%Y-%m-%d %H:%M}Z"
        clock = pd.Timestamp(local.to_numpy()[row])
        minutes = round((clock - time).total_seconds() / 60.0)
        sign = "-" if minutes < 0 else "+"
        return f"{clock:%Y-%m-%d %H:%M}{sign}{abs(minutes) // 60:02d}:{abs(minutes) % 60:02d}"

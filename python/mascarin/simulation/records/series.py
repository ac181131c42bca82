"""Series and data sets of xarray that ask for the offset of a time that is selected."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from datetime import datetime
from typing import Any, Self, TypeVar

import pandas as pd
import xarray as xr

from mascarin.errors import InputError

Selected = TypeVar("Selected")


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
        return _selected(self, super().sel, labels, (method, tolerance, drop))


class RunDataset(xr.Dataset):  # type: ignore[no-untyped-call]
    """Series over ``time`` (UTC), with the coordinate ``local_time`` and the attribute ``timezone``.

    `sel`, of the data set and of its series, takes times as that of `RunSeries` does.

    Examples
    --------
    >>> import mascarin as mc
    >>> from mascarin.examples import box, box_climate
    >>> run = mc.simulate(box(), box_climate(), step="1h").to_xarray()
    >>> noon = run.sel(time="2001-07-01 12:00-07:00")
    >>> str(noon["local_time"].to_numpy())[:16]
    '2001-07-01T12:00'
    >>> run["room.air_temperature"].sel(time="2001-07-01 12:00")
    Traceback (most recent call last):
    mascarin.errors.InputError: time: found '2001-07-01 12:00' without an offset; ...
    """

    __slots__ = ()

    def __getitem__(self, key: Any) -> Any:
        """A series by its name, or part of the data set, as `xarray.Dataset` gives it."""
        part = super().__getitem__(key)
        series = isinstance(part, xr.DataArray) and "time" in part.dims
        return RunSeries(part) if series else part

    def sel(
        self,
        indexers: Mapping[Any, Any] | None = None,
        method: str | None = None,
        tolerance: Any = None,
        drop: bool = False,
        **indexers_kwargs: Any,
    ) -> Self:
        """Series at times; the parameters are those of `xarray.Dataset.sel`.

        Raises
        ------
        InputError
            A time without an offset, or one that was not recorded.
        """
        labels = {**(indexers or {}), **indexers_kwargs}
        return _selected(self, super().sel, labels, (method, tolerance, drop))


def _selected(
    data: Any, select: Callable[..., Selected], labels: dict[Any, Any], options: tuple[str | None, Any, bool]
) -> Selected:
    """What `sel` of xarray gives for labels, whose times have an offset."""
    if "time" not in labels or "time" not in data.indexes:
        return select(labels, *options)
    utc = _in_utc(data, labels["time"])
    try:
        return select({**labels, "time": utc}, *options)
    except KeyError:
        method, tolerance, _ = options
        _require_time(data, labels["time"], utc, method, tolerance)
        raise


def _require_time(
    data: xr.DataArray | xr.Dataset, time: Any, utc: Any, method: str | None, tolerance: Any
) -> None:
    """Refuse a time that was not recorded; what else is missing is for xarray to say."""
    stamps = xr.DataArray(data.indexes["time"], dims="time", coords={"time": data.indexes["time"]})
    try:
        stamps.sel({"time": utc}, method, tolerance)
    except KeyError:
        raise InputError(
            f"time: found {time!r}; expected the time of a record from {_clock(data, 0)} to "
            f"{_clock(data, -1)}, or method='nearest'"
        ) from None


def _in_utc(data: xr.DataArray | xr.Dataset, label: Any) -> Any:
    """A label, a slice or a list of them in UTC without a zone, as the coordinate is."""
    if isinstance(label, slice):
        return slice(_in_utc(data, label.start), _in_utc(data, label.stop), label.step)
    if isinstance(label, list | tuple):
        return [_in_utc(data, each) for each in label]
    if isinstance(label, pd.DatetimeIndex) and label.tz is not None:
        return label.tz_convert("UTC").tz_localize(None)
    if not isinstance(label, str | datetime):
        return label
    first = _clock(data, 0)
    try:
        stamp = pd.Timestamp(label)
    except ValueError:
        raise InputError(f"time: found {label!r}; expected a time such as '{first}'") from None
    if stamp.tz is None:
        raise InputError(
            f"time: found {str(label)!r} without an offset; expected one, because the coordinate time "
            f"is UTC: '{first}' for the local clock, or Z for UTC. A day of the local clock is a slice "
            "of two such times"
        )
    return stamp.tz_convert("UTC").tz_localize(None)


def _clock(data: xr.DataArray | xr.Dataset, row: int) -> str:
    """Time of a record: on the local clock with its offset, where the data still have it."""
    time = data.indexes["time"][row]
    local = data.coords.get("local_time")
    if local is None or local.dims != ("time",):
        return f"{time:%Y-%m-%d %H:%M}Z"
    clock = pd.Timestamp(local.to_numpy()[row])
    minutes = round((clock - time).total_seconds() / 60.0)
    sign = "-" if minutes < 0 else "+"
    return f"{clock:%Y-%m-%d %H:%M}{sign}{abs(minutes) // 60:02d}:{abs(minutes) % 60:02d}"
